"""Seams of real pictures, independent of any tool's registration: grey values at corresponding places of two pictures.

Places come from SIFT features and a robust homography per pair of images (OpenCV, package python3-opencv). A
homography is exact for planes and rotating cameras; otherwise only places near matched features are used.
"""
import itertools

import numpy as np

import scorer

LONGEST_SIDE = 1000   # px, pictures are reduced to this
RATIO = 0.8           # between the distances to the nearest and the second nearest feature
FEWEST_MATCHES = 15   # inliers for a valid homography
NEAR_PX = 25          # px of the reduced picture from an inlier
STEP_PX = 4
DARK, BRIGHT = 5.0, 250.0
MOST_OF_EDGE = 2000   # places


def reduced(cv2, path):
    """The picture in RGB, and the number of full-frame px per px."""
    picture = cv2.imread(str(path), cv2.IMREAD_COLOR)
    if picture is None:
        raise OSError("%s: cannot be read" % path)
    scale = max(1.0, max(picture.shape[:2]) / LONGEST_SIDE)
    size = (round(picture.shape[1] / scale), round(picture.shape[0] / scale))
    return cv2.resize(picture, size, interpolation=cv2.INTER_AREA)[..., ::-1].copy(), scale


def features(cv2, picture):
    """SIFT on grey levels with equalised local contrast, which makes exposure irrelevant."""
    grey = cv2.createCLAHE(4.0, (8, 8)).apply(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY))
    points, descriptors = cv2.SIFT_create(contrastThreshold=0.01).detectAndCompute(grey, None)
    if descriptors is None:
        return np.zeros((0, 2), np.float32), np.zeros((0, 128), np.float32)
    descriptors = np.sqrt(descriptors / np.maximum(descriptors.sum(axis=1, keepdims=True), 1e-6))
    return np.float32([p.pt for p in points]).reshape(-1, 2), descriptors.astype(np.float32)


def homography(cv2, a, b):
    """(H from a to b, inlier places in a), or None."""
    if min(len(a[1]), len(b[1])) < 4:
        return None
    cv2.setRNGSeed(1)  # the search trees are random
    matches = cv2.FlannBasedMatcher({"algorithm": 1, "trees": 4}, {"checks": 64}).knnMatch(a[1], b[1], k=2)
    good = [m[0] for m in matches if len(m) == 2 and m[0].distance < RATIO * m[1].distance]
    if len(good) < FEWEST_MATCHES:
        return None
    source, target = np.float32([a[0][m.queryIdx] for m in good]), np.float32([b[0][m.trainIdx] for m in good])
    found, kept = cv2.findHomography(source, target, cv2.USAC_MAGSAC, 2.0, maxIters=5000)
    if found is None or kept.sum() < FEWEST_MATCHES:
        return None
    return found, source[kept.ravel() > 0]


def places(cv2, first, second, found, inliers):
    """(xy in both [n, 2 sides, 2], values [n, 2 sides, 3] of 0..255) at places that are quiet in both, and neither
    black nor white."""
    height, width = first.shape[:2]
    warped = cv2.warpPerspective(second, found, (width, height), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
                                 borderValue=(0, 0, 0))
    smooth = [cv2.GaussianBlur(p.astype(np.float32), (0, 0), 2.0) for p in (first, warped)]
    near = np.full((height, width), 255, np.uint8)
    for x, y in inliers:
        near[min(height - 1, int(y)), min(width - 1, int(x))] = 0
    near = cv2.distanceTransform(near, cv2.DIST_L2, 5) < NEAR_PX
    edge = cv2.erode(((warped > DARK) & (warped < BRIGHT)).all(axis=2).astype(np.uint8), np.ones((13, 13)))
    inside = cv2.erode(((first > DARK) & (first < BRIGHT)).all(axis=2).astype(np.uint8), np.ones((13, 13)))
    gradient = sum(np.hypot(*np.gradient(p.mean(axis=2))) for p in smooth)
    grid = np.zeros((height, width), bool)
    grid[STEP_PX // 2::STEP_PX, STEP_PX // 2::STEP_PX] = True
    y, x = np.nonzero(grid & near & (edge > 0) & (inside > 0))
    if not len(x):
        return np.zeros((0, 2, 2)), np.zeros((0, 2, 3))
    quiet = np.argsort(gradient[y, x], kind="stable")[:max(1, min(MOST_OF_EDGE, len(x) // 2))]
    y, x = y[quiet], x[quiet]
    there = cv2.perspectiveTransform(np.float32(np.stack([x, y], axis=1))[:, None], found)[:, 0]
    return (np.stack([np.stack([x, y], axis=1), there], axis=1).astype(float),
            np.stack([s[y, x] for s in smooth], axis=1).astype(float))


def seam_pairs(files):
    """scorer.Pairs of all linked images, from the pictures alone."""
    import cv2  # only this part needs it
    pictures = [reduced(cv2, f) for f in files]
    found = [features(cv2, p) for p, _ in pictures]
    image, xy, value = [], [], []
    for i, j in itertools.combinations(range(len(files)), 2):
        h = homography(cv2, found[i], found[j])
        if h is None:
            continue
        where, values = places(cv2, pictures[i][0], pictures[j][0], *h)
        for side, n in enumerate((i, j)):
            where[:, side] = (where[:, side] + 0.5) * pictures[n][1] - 0.5
        image.append(np.tile([i, j], (len(where), 1)))
        xy.append(where)
        value.append(values / 255.0)
    if not image:
        return scorer.Pairs(np.zeros((0, 2), int), np.zeros((0, 2, 2)), np.zeros((0, 2, 3)))
    return scorer.Pairs(np.concatenate(image), np.concatenate(xy), np.concatenate(value))


def seams(model, pairs, sizes):
    """Median over the places of each link of |B1 - transferred B2|, levels of 255: {(i, j): levels}."""
    size = np.abs(scorer.transfer(model, pairs, sizes)).mean(axis=(1, 2))
    links = {tuple(link) for link in pairs.image.tolist()}
    return {link: float(np.median(size[(pairs.image == link).all(axis=1)])) for link in sorted(links)}
