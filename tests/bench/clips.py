"""Rendered clips of a moving camera with known response, falloff and exposures: light of a scene times falloff and
exposure, response, noise of the encoded values, and a codec (FFmpeg). Scenes: a pan over pictures (photographs of a
folder, else painted ones), and a walk through a room of textured walls and panels, drawn by their homographies."""
import functools
import json
import pathlib
import shutil
import subprocess

import numpy as np

FFMPEG = shutil.which("ffmpeg")
WIDTH, HEIGHT, RATE = 640, 480, 25
HIGH = 660  # of the strip of pictures, px
MEAN = 0.2  # linear light at which the automatic exposure aims
FOLLOWS = 0.08  # share of the difference that it removes per frame
FINE = np.linspace(0.0, 1.0, 65537)
BT709 = np.array([0.0722, 0.7152, 0.2126], np.float32)  # luma of blue, green, red


def s_curve(e):
    return 1.15 * e ** 1.2 / (e ** 1.2 + 0.15)


RESPONSES = {"gamma 2.2": lambda e: e ** (1 / 2.2), "S curve": s_curve}
CODECS = {"H.264": (".mp4", ["-c:v", "libx264", "-preset", "veryfast", "-pix_fmt", "yuv420p"]),
          "HEVC 10 bit": (".mp4", ["-c:v", "libx265", "-preset", "veryfast", "-pix_fmt", "yuv420p10le", "-x265-params",
                                   "log-level=error:pools=2"]),
          "VP9": (".webm", ["-c:v", "libvpx-vp9", "-b:v", "0", "-deadline", "realtime", "-cpu-used", "6", "-pix_fmt",
                            "yuv420p"])}
USUAL = {"scene": "pan", "frames": 300, "speed": 4.0, "codec": "H.264", "crf": 12, "response": "gamma 2.2",
         "k": (-0.45, 0.0, 0.0), "range": 2.0, "jitter": 0.03, "noise": 1.0}


def radius2(shape=(HEIGHT, WIDTH)):
    """r^2 of every pixel; r = 1 in the corner."""
    h, w = shape
    y, x = np.mgrid[0:h, 0:w].astype(np.float32)
    return ((x - (w - 1) / 2) ** 2 + (y - (h - 1) / 2) ** 2) / ((w * w + h * h) / 4)


def falloff(k, r2):
    return 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))


def smooth(random, count, scale):
    """A smooth random function of one variable, -1 to 1."""
    import cv2
    values = cv2.GaussianBlur(random.normal(size=(1, count + 8 * int(scale))), (0, 0), scale)[0]
    values = values[4 * int(scale):][:count]
    return 2 * (values - values.min()) / np.ptp(values) - 1


def painted(random, width):
    """A picture of light: texture of all sizes, and patches with edges and a texture of their own."""
    import cv2
    light = np.zeros((HIGH, width), np.float32)
    for sigma, amount in ((1.2, 0.18), (4, 0.22), (15, 0.3), (60, 0.45)):
        noise = cv2.GaussianBlur(random.normal(size=light.shape).astype(np.float32), (0, 0), sigma)
        light += amount * noise / noise.std()
    colour = random.normal(0, 0.15, 3)
    picture = np.repeat(light[..., None], 3, 2) + colour.astype(np.float32)
    for _ in range(width // 10):
        x, y = int(random.integers(0, width)), int(random.integers(0, HIGH))
        a, b = (int(v) for v in random.integers(8, 60, 2))
        shade = random.normal(0, 0.8) + random.normal(0, 0.2, 3)
        patch = picture[max(y - b, 0):y + b, max(x - a, 0):x + a]
        patch[:] = 0.5 * patch + shade.astype(np.float32)
    return np.exp(picture - np.float32(1.7))


@functools.lru_cache(maxsize=8)
def photograph(path):
    import cv2
    picture = cv2.imread(path)
    scale = HIGH / picture.shape[0]
    return (cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA) / np.float32(255)) ** 2.2


def pictures(folder, random):
    """Endless pictures of light, HIGH high."""
    files = sorted(str(p) for p in pathlib.Path(folder).glob("*.jpg")) if folder else []
    while True:
        if not files:
            yield painted(random, 1000)
        for i in random.permutation(2 * len(files)):
            picture = photograph(files[i // 2])
            yield picture[:, ::-1] if i % 2 else picture


class Pan:
    """The camera looks along a strip of pictures, swings up and down and rolls a little."""

    def __init__(self, c, random, folder):
        width = int(c["frames"] * c["speed"]) + WIDTH + 200
        strip, source = [], pictures(folder, random)
        while sum(p.shape[1] for p in strip) < width:
            strip.append(next(source))
        strip = np.concatenate(strip, 1)
        start = int(random.integers(0, strip.shape[1] - width + 1))
        self.strip = strip[:, start:start + width].copy()
        self.strip *= np.exp2(1.3 * smooth(random, width, 250))[:, None].astype(np.float32)
        self.speed, self.phase = c["speed"], random.uniform(0, 6, 2)

    def light(self, i, shape=(HEIGHT, WIDTH)):
        import cv2
        scale = WIDTH / shape[1]
        x = 60 + i * self.speed
        y = (HIGH - HEIGHT) / 2 + 35 * np.sin(i / 31 + self.phase[0])
        roll = 0.03 * np.sin(i / 57 + self.phase[1])
        cut = int(x) - 50
        turn = scale * np.array([[np.cos(roll), -np.sin(roll)], [np.sin(roll), np.cos(roll)]])
        middle = np.array([x - cut + WIDTH / 2, y + HEIGHT / 2])
        shift = middle - turn @ (np.array(shape[::-1]) / 2)
        return cv2.warpAffine(self.strip[:, cut:cut + WIDTH + 100], np.column_stack([turn, shift]), shape[::-1],
                              flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP, borderMode=cv2.BORDER_REFLECT)


class Room:
    """A walk through a room of 9 x 3 x 7 m with panels, which hide what is farther; one end is darker."""
    FOCAL, DENSITY, SIZE = 480.0, 100.0, np.array([9.0, 3.0, 7.0])

    def __init__(self, c, random, folder):
        source = pictures(folder, random)
        x, y, z = self.SIZE
        walls = [((0, 0, 0), (x, 0, 0), (0, y, 0)), ((0, 0, z), (x, 0, 0), (0, y, 0)), ((0, 0, 0), (0, 0, z), (0, y, 0)),
                 ((x, 0, 0), (0, 0, z), (0, y, 0)), ((0, 0, 0), (x, 0, 0), (0, 0, z)), ((0, y, 0), (x, 0, 0), (0, 0, z))]
        for _ in range(7):
            at, angle = random.uniform((1.5, 1.2, 1.5), (x - 1.5, 1.8, z - 1.5)), random.uniform(0, np.pi)
            if np.hypot(at[0] - x / 2, at[2] - z / 2) > 2.3:  # off the path
                walls.append((at, (0.8 * np.cos(angle), 0, 0.8 * np.sin(angle)), (0, random.uniform(0.6, 1.2), 0)))
        self.planes = [self.textured(random, source, *(np.array(v, float) for v in wall)) for wall in walls]
        self.turns, self.phase, self.frames = random.choice((-1, 1)), random.uniform(0, 2 * np.pi), c["frames"]

    def textured(self, random, source, corner, along, up):
        """(texture, corner, unit vectors along its columns and rows) of a rectangle."""
        import cv2
        sides = [np.linalg.norm(along), np.linalg.norm(up)]
        w, h = (int(side * self.DENSITY) for side in sides)
        parts = []
        while sum(p.shape[1] for p in parts) < w:
            parts.append(next(source)[:, :1000])
        picture = np.concatenate(parts, 1)
        if h > HIGH:
            picture = np.concatenate([picture, picture[::-1]], 0)
        y = int(random.integers(0, picture.shape[0] - h + 1))
        texture = cv2.GaussianBlur(picture[y:y + h, :w], (0, 0), 0.7)
        columns = corner[0] + along[0] * np.arange(w) / w
        dark = np.exp2(-2.0 * columns / self.SIZE[0])[None, :, None]
        return (texture * dark).astype(np.float32), corner, along / sides[0], up / sides[1]

    def pose(self, i):
        """Position and rotation (camera to room; x right, y down, z forward)."""
        t = i / self.frames * 1.6 * np.pi * min(1.0, self.frames / 300) * self.turns + self.phase
        step = i / 6.0
        at = np.array([self.SIZE[0] / 2 + 1.8 * np.cos(t), 1.45 + 0.03 * np.sin(2 * step),
                       self.SIZE[2] / 2 + 1.4 * np.sin(t)]) + [0.03 * np.sin(step), 0, 0]
        heading = t * 0.8 + 0.1 * np.sin(i / 23)
        pitch, roll = 0.06 * np.sin(i / 37), 0.02 * np.sin(step)

        def turn(a, b, angle):
            m = np.eye(3)
            m[a, a] = m[b, b] = np.cos(angle)
            m[a, b], m[b, a] = -np.sin(angle), np.sin(angle)
            return m

        return at, turn(2, 0, heading) @ turn(1, 2, pitch) @ turn(0, 1, roll)

    def light(self, i, shape=(HEIGHT, WIDTH)):
        import cv2
        h, w = shape
        at, rotation = self.pose(i)
        x, y = np.meshgrid((np.arange(w) - (w - 1) / 2) * WIDTH / w, (np.arange(h) - (h - 1) / 2) * WIDTH / w)
        rays = np.stack([x, y, np.full_like(x, self.FOCAL)], -1).astype(np.float32)
        seen, nearest = np.zeros((h, w, 3), np.float32), np.zeros((h, w), np.float32)  # of 1 / depth
        for texture, corner, along, up in self.planes:
            homography = np.linalg.inv(np.column_stack([along, up, corner - at])) @ rotation  # ray -> (u, v, 1) / depth
            if not self.in_view(homography, rays[::16, ::16], texture):
                continue
            inverse_depth, u, v = self.met(homography, rays)
            rows, columns = texture.shape[:2]
            inside = (inverse_depth > nearest) & (u >= 0) & (v >= 0) & (u < columns) & (v < rows)
            if not inside.any():
                continue
            box = cv2.boundingRect(inside.astype(np.uint8))
            part = np.s_[box[1]:box[1] + box[3], box[0]:box[0] + box[2]]
            drawn = cv2.remap(texture, u[part] - np.float32(0.5), v[part] - np.float32(0.5), cv2.INTER_LINEAR,
                              borderMode=cv2.BORDER_REPLICATE)
            np.copyto(seen[part], drawn, where=inside[part][..., None])
            np.copyto(nearest, inverse_depth, where=inside)
        return seen

    def met(self, homography, rays):
        """1 / depth, and the column and row of the texture at which the rays meet the plane; depth < 0: they do not."""
        m = (rays.reshape(-1, 3) @ homography.T.astype(np.float32)).reshape(rays.shape)
        scale = np.float32(self.DENSITY) / np.where(np.abs(m[..., 2]) < 1e-9, np.float32(1e-9), m[..., 2])
        return m[..., 2], np.clip(m[..., 0] * scale, -1e4, 1e4), np.clip(m[..., 1] * scale, -1e4, 1e4)

    def in_view(self, homography, rays, texture):
        inverse_depth, u, v = self.met(homography, rays)
        near = 0.3 * np.array(texture.shape[:2])
        return ((inverse_depth > 0) & (u > -near[1]) & (v > -near[0]) & (u < texture.shape[1] + near[1]) &
                (v < texture.shape[0] + near[0])).any()


SCENES = {"pan": Pan, "room": Room}


def automatic(scene, c, random):
    """EV of every frame: follows the mean of what the camera sees, its range scaled to c["range"], and jitter."""
    m = falloff(c["k"], radius2((HEIGHT // 8, WIDTH // 8)))[..., None]
    value, values = None, []
    for i in range(c["frames"]):
        if i % 3 == 0:
            wanted = np.log2(MEAN / (scene.light(i, m.shape[:2]) * m).mean())
        value = wanted if value is None else value + FOLLOWS * (wanted - value)
        values.append(value)
    values = np.array(values)
    return values.mean() + (values - values.mean()) * c["range"] / np.ptp(values) + random.normal(0, 1, len(values)) * \
        (c["jitter"] if c["range"] else 0)


def encoder(path, words, crf, wide):
    return subprocess.Popen([FFMPEG, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "bgr48le" if wide else "bgr24",
                             "-s", "%dx%d" % (WIDTH, HEIGHT), "-r", str(RATE), "-i", "-", "-vf",
                             "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int", "-colorspace",
                             "bt709", "-color_range", "tv", "-crf", str(crf), *words, str(path)], stdin=subprocess.PIPE)


def luma_of(path, width=WIDTH, height=HEIGHT):
    """Every frame, full range, 8 bits."""
    reader = subprocess.Popen([FFMPEG, "-loglevel", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                              stdout=subprocess.PIPE)
    while True:
        data = reader.stdout.read(width * height)
        if len(data) < width * height:
            break
        yield np.frombuffer(data, np.uint8).reshape(height, width)
    reader.wait()


def blocks(luma):
    """Means of 16 x 16 pixels."""
    return luma.reshape(HEIGHT // 16, 16, WIDTH // 16, 16).mean((1, 3))


def encoding(path, rendered, response):
    """EV by which the codec changed each frame: the median over blocks of what decoded and rendered luma tell."""
    table, changes = RESPONSES[response](FINE) * 255, []
    for before, luma in zip(rendered, luma_of(path)):
        after = blocks(luma)
        used = (np.minimum(before, after) > 20) & (np.maximum(before, after) < 235)
        told = [np.log2(np.interp(values[used], table, FINE)) for values in (after, before)]
        changes.append(float(np.median(told[0] - told[1])) if used.any() else 0.0)
    return changes


def render(c, seed, folder, photographs=None):
    """Writes folder/clip.*, times.txt and truth.json -> (path of the clip, truth). c: USUAL with the changes of a case."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng([seed, 71])
    scene = SCENES[c["scene"]](c, random, photographs)
    ev = automatic(scene, c, random)
    end, words = CODECS[c["codec"]]
    wide = "10" in c["codec"]
    top = 65535 if wide else 255
    table = (RESPONSES[c["response"]](FINE) * top).astype(np.float32)
    m = falloff(c["k"], radius2())[..., None]
    coder, rendered = encoder(folder / ("clip" + end), words, c["crf"], wide), []
    for i in range(c["frames"]):
        light = scene.light(i) * m * np.float32(2 ** ev[i])
        value = table[(np.clip(light, 0, 1) * 65536 + 0.5).astype(np.int32)]
        rendered.append(blocks(value @ BT709) * (255 / top))
        value += np.float32(c["noise"] * top / 255) * random.standard_normal(value.shape, np.float32)
        coder.stdin.write(np.clip(value + 0.5, 0, top).astype(np.uint16 if wide else np.uint8).tobytes())
    coder.stdin.close()
    if coder.wait():
        raise RuntimeError("FFmpeg cannot encode %s" % c["codec"])
    truth = {"ev": ev.tolist(), "k": c["k"], "response": c["response"], "clip": "clip" + end,
             "encoding": encoding(folder / ("clip" + end), rendered, c["response"])}
    (folder / "truth.json").write_text(json.dumps(truth) + "\n")
    (folder / "times.txt").write_text("".join("%05d %.6f %.6f\n" % (i + 1, i / RATE, 10 * 2 ** e) for i, e in enumerate(ev)))
    return folder / ("clip" + end), truth
