"""Rendered views of 7 megapixels from a camera that is carried around an object: a box on the floor of a room, both
covered with photographs (of a folder, else painted pictures), with automatic exposure, falloff and noise. The room is
convex, and so is the box: walls first, then the faces that look at the camera."""
import pathlib

import numpy as np

import clips

WIDTH, HEIGHT, FOCAL = 3072, 2304, 2600.0
ROOM, BOX = np.array([7.0, 2.8, 7.0]), np.array([1.3, 1.0, 0.9])  # m; x right, y down, z forward
DISTANCE = 2.3  # from the middle of the box, m


def faces(low, size):
    """(corner, along, up) of the four sides, the top and the bottom of a box; along x up looks inwards or outwards."""
    x, y, z = np.diag(size)
    return [(low, x, y), (low + z, x, y), (low, z, y), (low + x, z, y), (low, x, z), (low + y, x, z)]


def textures(folder, random, count):
    """`count` pictures of light."""
    source = clips.pictures(folder, random)
    return [np.ascontiguousarray(next(source), np.float32) for _ in range(count)]


class Object:
    def __init__(self, views, random, folder=None):
        self.views, self.phase = views, random.uniform(0, 2 * np.pi)
        low = np.array([(ROOM[0] - BOX[0]) / 2, ROOM[1] - BOX[1], (ROOM[2] - BOX[2]) / 2])
        self.middle = low + BOX / 2
        self.planes = list(zip(textures(folder, random, 11), faces(np.zeros(3), ROOM) + faces(low, BOX)[:5]))

    def pose(self, i):
        """Position and rotation (camera to room)."""
        t = 2 * np.pi * i / self.views + self.phase
        at = self.middle + [DISTANCE * np.cos(t), -0.6 + 0.15 * np.sin(3 * t), DISTANCE * np.sin(t)]
        forward = self.middle + [0.05 * np.sin(7 * t), 0.05 * np.sin(5 * t), 0] - at
        forward /= np.linalg.norm(forward)
        right = np.cross([0, 1, 0], forward)
        right /= np.linalg.norm(right)
        return at, np.column_stack([right, np.cross(forward, right), forward])

    def light(self, i, shape=(HEIGHT, WIDTH)):
        import cv2
        at, rotation = self.pose(i)
        scale = shape[1] / WIDTH
        camera = np.array([[FOCAL * scale, 0, (shape[1] - 1) / 2], [0, FOCAL * scale, (shape[0] - 1) / 2], [0, 0, 1]])
        seen = np.zeros((*shape, 3), np.float32)
        for n, (texture, (corner, along, up)) in enumerate(self.planes):
            outwards = np.cross(along, up) * np.sign(np.cross(along, up) @ (corner + (along + up) / 2 - self.middle))
            if n >= 6 and outwards @ (at - corner) <= 0:
                continue  # hidden
            rows, columns = texture.shape[:2]
            plane = np.column_stack([along / columns, up / rows, corner - at])
            self.draw(texture, camera @ rotation.T @ plane, seen)
        return seen

    @staticmethod
    def draw(texture, homography, seen):
        """The part of a texture before the camera; a wall may reach past the camera's side."""
        import cv2
        shape = seen.shape[:2]
        back = np.linalg.inv(homography)
        y, x = np.mgrid[0:shape[0]:16, 0:shape[1]:16]
        u, v, w = np.tensordot(back, np.stack([x, y, np.ones_like(x)]), 1)
        near = (w > 0) & (u > -0.1 * w * texture.shape[1]) & (u < 1.1 * w * texture.shape[1])
        near &= (v > -0.1 * w * texture.shape[0]) & (v < 1.1 * w * texture.shape[0])
        if not near.any():
            return
        drawn = cv2.warpPerspective(texture, homography, shape[::-1], flags=cv2.INTER_LINEAR)
        inside = cv2.warpPerspective(np.full(texture.shape[:2], 255, np.uint8), homography, shape[::-1],
                                     flags=cv2.INTER_NEAREST) > 0
        ahead = cv2.resize((w > 0).astype(np.uint8), shape[::-1], interpolation=cv2.INTER_NEAREST) > 0
        np.copyto(seen, drawn, where=(inside & ahead)[..., None])


def render(views, seed, folder, photographs=None, k=(-0.45, 0.0, 0.0)):
    """Writes folder/view0001.jpg ... -> EV per view."""
    import cv2
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng([seed, 17])
    scene = Object(views, random, photographs)
    m = clips.falloff(k, clips.radius2((HEIGHT, WIDTH)))[..., None].astype(np.float32)
    grain = random.normal(0, 1.0, (HEIGHT + 64, WIDTH + 64, 3)).astype(np.float32)  # levels; shifted for every view
    table = (clips.FINE ** (1 / 2.2) * 255).astype(np.float32)
    all_ev = []
    for i in range(views):
        light = scene.light(i) * m
        all_ev.append(float(np.log2(clips.MEAN / max(light[::8, ::8].mean(), 1e-3)) + random.normal(0, 0.03)))
        value = table[(np.clip(light * np.float32(2 ** all_ev[-1]), 0, 1) * 65536 + 0.5).astype(np.int32)]
        y, x = random.integers(0, 64, 2)
        value += grain[y:y + HEIGHT, x:x + WIDTH]
        cv2.imwrite(str(folder / ("view%04d.jpg" % (i + 1))), np.clip(value + 0.5, 0, 255).astype(np.uint8),
                    [cv2.IMWRITE_JPEG_QUALITY, 93])
    return all_ev
