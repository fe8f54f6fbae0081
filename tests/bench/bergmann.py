"""Response, falloff and exposures of a clip as Bergmann, Wang & Cremers 2018 find them ("Online Photometric Calibration of
Auto Exposure Video for Realtime Visual Odometry and SLAM"), the reference of the table of clips.

Corners are tracked by the gain-robust method of Kim et al. 2007. The patch of pixels of a track p has the radiances L_p;
response f (mean and four modes of EMoR), falloff V = 1 + a2 r^2 + a4 r^4 + a6 r^6 and exposures e_i minimise

    sum over frames i, tracks p  w h(O - f(e_i V(r) L_p)),    w = mu / (mu + |gradient|^2),    h: Huber

by turns of a Levenberg-Marquardt step of (f, V, e) and a Gauss-Newton step of each radiance, over keyframes. The fast
estimate of the paper gives the exposure of a frame from the radiances that its tracks had in the M frames before."""
import numpy as np

import clips
import tools

POINTS, CELLS = 200, 10  # tracks; cells of the grid in each direction
TRACKER, LEVELS, TURNS = 3, 4, 6  # half width of the tracker's patch, levels of the pyramid, iterations in each
RETURN_PX, CONVERGED_PX = 1.2, 0.02
PATCH = 3  # half width of the patch of radiances
WINDOW = 10  # M
SPACING, SEEN = 15, 3  # frames between keyframes, least keyframes of a track
MU, HUBER = 25.0, 4.0  # levels^2 per pixel^2, levels
BLACK, WHITE = 4.0, 250.0  # grey values outside determine nothing
MODES, TERMS = 4, 3
ROUNDS, SETTLED, LEAST = 300, 1e-5, 1e-4  # turns, relative decrease of the energy in the last, smallest radiance


def patches(picture, xy, half):
    """[n, 2 half + 1, 2 half + 1] around xy, bilinear."""
    import cv2
    step = np.arange(-half, half + 1, dtype=np.float32)
    x = (xy[:, None, None, 0] + step[None, None, :]) + np.zeros_like(step)[None, :, None]
    y = (xy[:, None, None, 1] + step[None, :, None]) + np.zeros_like(step)[None, None, :]
    side = len(step)
    values = cv2.remap(picture, x.reshape(-1, side).astype(np.float32), y.reshape(-1, side).astype(np.float32),
                       cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return values.reshape(-1, side, side)


def logarithm_and_slopes(picture, xy):
    wide = np.log(np.maximum(patches(picture, xy, TRACKER + 1), 1.0))
    return wide[:, 1:-1, 1:-1], (wide[:, 1:-1, 2:] - wide[:, 1:-1, :-2]) / 2, (wide[:, 2:, 1:-1] - wide[:, :-2, 1:-1]) / 2


def pyramid(picture):
    import cv2
    levels = [picture.astype(np.float32)]
    while len(levels) < LEVELS:
        levels.append(cv2.pyrDown(levels[-1]))
    return levels


def follow(first, second, xy):
    """Positions in the second picture (pyramids): displacements and one common gain, of the logarithm, in turns."""
    at = xy.copy()
    for level in range(LEVELS - 1, -1, -1):
        scale = 0.5 ** level
        one, x1, y1 = logarithm_and_slopes(first[level], (xy * scale).astype(np.float32))
        for _ in range(TURNS):
            two, x2, y2 = logarithm_and_slopes(second[level], (at * scale).astype(np.float32))
            a, b, beta = (x1 + x2) / 2, (y1 + y2) / 2, two - one
            u = np.stack([np.stack([(a * a).sum((1, 2)), (a * b).sum((1, 2))], -1),
                          np.stack([(a * b).sum((1, 2)), (b * b).sum((1, 2))], -1)], -1)
            u += 1e-6 * np.eye(2)
            w, v = (np.stack([(m * t).sum((1, 2)) for m in (a, b)], -1) for t in (np.ones_like(beta), beta))
            solved = np.linalg.solve(u, np.stack([w, v], -1))
            gain = (beta.sum() - (w * solved[..., 1]).sum()) / max(beta.size - (w * solved[..., 0]).sum(), 1e-9)
            step = np.clip(gain * solved[..., 0] - solved[..., 1], -2, 2)
            at += step / scale
            if np.median(np.abs(step)) < CONVERGED_PX:
                break
    return at


def new_corners(picture, xy):
    """In the cells without a track, up to POINTS."""
    import cv2
    height, width = picture.shape
    high, wide = height // CELLS, width // CELLS
    taken = np.zeros((CELLS, CELLS), int)
    np.add.at(taken, tuple(np.minimum((xy[:, ::-1] / (high, wide)).astype(int), CELLS - 1).T), 1)
    empty = np.argwhere(taken == 0)
    if len(xy) >= POINTS or not len(empty):
        return np.zeros((0, 2))
    each, found = int(np.ceil((POINTS - len(xy)) / len(empty))), []
    for row, column in empty:
        part = picture[row * high:(row + 1) * high, column * wide:(column + 1) * wide]
        corners = cv2.goodFeaturesToTrack(part, each, 0.01, 7, blockSize=7)
        if corners is not None:
            found.append(corners.reshape(-1, 2) + (column * wide, row * high))
    found = np.concatenate(found or [np.zeros((0, 2))])
    return found[inside(found, picture.shape)]


def inside(xy, shape):
    margin = TRACKER + 2
    return (xy[:, 0] >= margin) & (xy[:, 1] >= margin) & (xy[:, 0] < shape[1] - margin) & (xy[:, 1] < shape[0] - margin)


def gradient2(picture):
    """Squared gradient of the blurred picture, levels^2 per pixel^2."""
    import cv2
    even = cv2.GaussianBlur(picture.astype(np.float32), (3, 3), 0)
    return (cv2.Sobel(even, cv2.CV_32F, 1, 0) ** 2 + cv2.Sobel(even, cv2.CV_32F, 0, 1) ** 2) / 64


class Tracks:
    """Observations in the order of the frames. track, frame [n]; r2 [n]; grey, weight [n, pixels of the patch]."""

    def __init__(self, track, frame, r2, grey, weight):
        self.track, self.frame, self.r2, self.grey, self.weight = track, frame, r2, grey, weight
        self.weight = np.where((grey > BLACK) & (grey < WHITE), weight, 0.0)

    def select(self, rows):
        return Tracks(self.track[rows], self.frame[rows], self.r2[rows], self.grey[rows], self.weight[rows])


def track(frames):
    rows, before, xy, ids, last = [], None, np.zeros((0, 2)), np.zeros(0, int), 0
    for i, picture in enumerate(frames):
        now = pyramid(picture)
        if len(xy):
            ahead = follow(before, now, xy)
            kept = inside(ahead, picture.shape)
            xy, ids, ahead = xy[kept], ids[kept], ahead[kept]
            if len(xy):
                kept = np.hypot(*(follow(now, before, ahead) - xy).T) < RETURN_PX
                xy, ids = ahead[kept], ids[kept]
        added = new_corners(picture, xy)
        xy, ids = np.concatenate([xy, added]), np.concatenate([ids, last + np.arange(len(added))])
        last += len(added)
        half = (np.array(picture.shape[::-1]) - 1) / 2
        weight = MU / (MU + patches(gradient2(picture), xy, PATCH))
        rows.append((ids, np.full(len(ids), i), ((xy - half) ** 2).sum(1) / ((np.array(picture.shape) ** 2).sum() / 4),
                     patches(now[0], xy, PATCH).reshape(len(ids), -1), weight.reshape(len(ids), -1)))
        before = now
    return Tracks(*(np.concatenate(part) for part in zip(*rows)))


def sampled(tables, x):
    """Tables over 0..1 at x, [..., n], linear in between, and their slopes."""
    at = np.clip(x, 0.0, 1.0) * (tables.shape[-1] - 1)
    low = np.minimum(at.astype(np.int32), tables.shape[-1] - 2)
    left = np.take(tables, low, -1)
    rise = np.take(np.diff(tables), low, -1)
    return left + rise * (at - low), rise * (tables.shape[-1] - 1)


def response(c):
    """f of 4 modes, levels; it need not rise everywhere."""
    return 255 * np.tensordot(np.concatenate([[1.0], c]), tools.emor_table()[:1 + MODES], 1)


def inverse(c, grey):
    """f^-1 of grey values."""
    f = np.maximum.accumulate(response(c))
    rises = np.concatenate([[True], np.diff(f) > 0])
    return np.interp(grey, f[rises], np.linspace(0, 1, len(f))[rises])


def attenuation(a, r2):
    return np.maximum(clips.falloff(a, r2), 0.05)


def huber(r):
    """Its value, and the weight of r^2 in its normal equations."""
    size = np.abs(r)
    return np.where(size < HUBER, r * r / 2, HUBER * (size - HUBER / 2)), HUBER / np.maximum(size, HUBER)


class Fit:
    """Turns of (f, V, e) and L. Frames are numbered 0..count - 1 and points 0.. without gaps."""

    def __init__(self, tracks, count):
        self.count, self.pixels = count, tracks.grey.shape[1]
        _, point = np.unique(tracks.track, return_inverse=True)
        self.points = (point.max() + 1) * self.pixels
        point = (point[:, None] * self.pixels + np.arange(self.pixels)).ravel()
        used = tracks.weight.ravel() > 0
        self.point, self.weight, self.grey = point[used], tracks.weight.ravel()[used], tracks.grey.ravel()[used]
        self.frame, self.r2 = np.repeat(tracks.frame, self.pixels)[used], np.repeat(tracks.r2, self.pixels)[used]
        self.powers = np.stack([self.r2 ** (n + 1) for n in range(TERMS)])

    def radiances(self, c, a, e):
        """Means of what the observations tell."""
        told = inverse(c, self.grey) / (attenuation(a, self.r2) * e[self.frame])
        return self.of_points(self.weight * told) / np.maximum(self.of_points(self.weight), 1e-12)

    def of_points(self, values):
        return np.bincount(self.point, values, self.points)

    def residuals(self, c, a, e, light):
        """Residuals, levels; and their derivatives by f's argument, and the argument's factors e and V."""
        by_frame, v = e[self.frame], attenuation(a, self.r2)
        x = by_frame * v * light[self.point]
        value, slope = sampled(response(c), x)
        return value - self.grey, np.where(x < 1, slope, 0.0), by_frame, v

    def energies(self, *state):
        return self.weight * huber(self.residuals(*state)[0])[0]

    def camera(self, c, a, e, light, damping, energy):
        """A Levenberg-Marquardt step of (f, V, e) -> (c, a, e, damping, energy)."""
        residual, slope, by_frame, v = self.residuals(c, a, e, light)
        weight, of_point = self.weight * huber(residual)[1], light[self.point]
        modes, _ = sampled(tools.emor_table()[1:1 + MODES], by_frame * v * of_point)
        shared, by_e = np.concatenate([255 * modes, slope * by_frame * of_point * self.powers]), slope * v * of_point
        n = MODES + TERMS
        normal, right = np.zeros((n + self.count,) * 2), np.zeros(n + self.count)
        weighted = shared * weight
        normal[:n, :n], right[:n] = weighted @ shared.T, weighted @ residual
        for row in range(n):
            normal[row, n:] = normal[n:, row] = np.bincount(self.frame, weighted[row] * by_e, self.count)
        diagonal = np.arange(n, n + self.count)
        normal[diagonal, diagonal] = np.bincount(self.frame, weight * by_e * by_e, self.count)
        right[n:] = np.bincount(self.frame, weight * by_e * residual, self.count)
        for _ in range(12):
            step = np.linalg.solve(normal + np.diag(damping * np.diag(normal) + 1e-9), -right)
            found = c + step[:MODES], a + step[MODES:n], np.maximum(e + step[n:], 1e-3)
            lower = self.energies(*found, light).sum()
            if lower < energy:
                return (*found, max(damping / 4, 1e-6), lower)
            damping *= 4
        return c, a, e, min(damping, 1e3), energy

    def light(self, c, a, e, light):
        """A Gauss-Newton step of every radiance where it lowers its energy -> (radiances, energy)."""
        residual, slope, by_frame, v = self.residuals(c, a, e, light)
        value, weight = huber(residual)
        weight, by_light, before = self.weight * weight, slope * by_frame * v, self.of_points(self.weight * value)
        step = -self.of_points(weight * by_light * residual) / np.maximum(self.of_points(weight * by_light ** 2), 1e-9)
        for _ in range(2):
            tried = np.clip(light + step, LEAST, 1.0 / max(e.min(), 1e-3))
            after = self.of_points(self.energies(c, a, e, tried))
            better = after < before
            light, before = np.where(better, tried, light), np.minimum(before, after)
            step = np.where(better, 0.0, step / 4)
        return light, before.sum()

    def run(self, c, a, e):
        """-> c, a, e, radiances, turns."""
        light = self.radiances(c, a, e)
        damping, energy = 1e-2, self.energies(c, a, e, light).sum()
        for turn in range(ROUNDS):
            start = energy
            c, a, e, damping, energy = self.camera(c, a, e, light, damping, energy)
            light, energy = self.light(c, a, e, light)
            if start - energy < SETTLED * start:
                break
        return c, a, e, light, turn + 1


def fast_exposures(tracks, c, a):
    """Of every frame in turn: least squares of f^-1(O) / V - e L over its tracks, where L is the mean of their radiances
    in the WINDOW frames before."""
    told = inverse(c, tracks.grey) / attenuation(a, tracks.r2)[:, None]
    count = int(tracks.frame.max()) + 1
    bounds = np.searchsorted(tracks.frame, np.arange(count + 1))
    known = np.zeros((int(tracks.track.max()) + 1, WINDOW, 2, told.shape[1]), np.float32)  # weight, and that by radiance
    e = np.ones(count)
    for i in range(count):
        rows = slice(bounds[i], bounds[i + 1])
        ids, weight, seen = tracks.track[rows], tracks.weight[rows], told[rows]
        total = known[ids].sum(1)
        light = total[:, 1] / np.maximum(total[:, 0], 1e-9)
        used = np.where(total[:, 0] > 0, weight, 0.0)
        if i:
            e[i] = (used * light * seen).sum() / max((used * light * light).sum(), 1e-12) or e[i - 1]
        known[:, i % WINDOW] = 0
        known[ids, i % WINDOW, 0], known[ids, i % WINDOW, 1] = weight, weight * seen / e[i]
    return e


def fit(tracks):
    """-> response c, falloff a, log2 exposures of all frames by the backend and by the fast estimate."""
    count = int(tracks.frame.max()) + 1
    c, a = np.zeros(MODES), np.zeros(TERMS)
    e = fast_exposures(tracks, c, a)
    rows = tracks.frame % SPACING == 0
    rows &= np.bincount(tracks.track[rows], minlength=tracks.track.max() + 1)[tracks.track] >= SEEN
    keyframes = tracks.select(rows)
    keyframes.frame = keyframes.frame // SPACING
    problem = Fit(keyframes, (count - 1) // SPACING + 1)
    start = e[::SPACING] / np.median(e)
    start = start * min(1.0, 0.9 / np.max(start))
    c, a, e, light, _ = problem.run(c, a, start)
    ids = np.unique(keyframes.track)
    return c, a, np.log2(of_frames(tracks, c, a, ids, light.reshape(len(ids), -1))), np.log2(fast_exposures(tracks, c, a))


def of_frames(tracks, c, a, ids, light):
    """Exposures of all frames by least squares from the radiances of the fit."""
    at = np.minimum(np.searchsorted(ids, tracks.track), len(ids) - 1)
    weight = np.where((ids[at] == tracks.track)[:, None], tracks.weight, 0.0)
    told = inverse(c, tracks.grey) / attenuation(a, tracks.r2)[:, None]
    above, below = ((weight * light[at] * other).sum(1) for other in (told, light[at]))
    return np.bincount(tracks.frame, above) / np.maximum(np.bincount(tracks.frame, below), 1e-12)


def calibrate(clip, radii):
    """-> log2 exposures of the backend, fast ones, falloff at the radii, f^-1 at the levels 0..255."""
    c, a, ev, fast = fit(track(clips.luma_of(clip)))
    return ev, fast, attenuation(a, radii ** 2), inverse(c, np.arange(256))
