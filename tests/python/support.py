"""Common parts of the tests: a rendered scene with a known camera, and shortcuts."""
import contextlib
import tempfile

import numpy as np

import lensprof as lp

WIDTH, HEIGHT = 240, 180
EXPOSURES = (0.0, 0.8, -0.6)  # EV
RED = (1.0, 1.1, 0.95)        # white balance factors of red
FALLOFF = (-0.35, 0.12, -0.08)
YAWS = (0.0, 16.0, -16.0)


@contextlib.contextmanager
def refused(test, status):
    """Expects a lensprof.Error with this status and a text."""
    with test.assertRaises(lp.Error) as caught:
        yield caught
    test.assertEqual(caught.exception.status, status)
    test.assertGreater(len(caught.exception.text), 10)


def read_only(array):
    """A copy in memory that cannot be written, as of a mapped file."""
    with tempfile.NamedTemporaryFile() as file:
        file.write(array.tobytes())
        file.flush()
        return np.memmap(file.name, array.dtype, "r", shape=array.shape)


def cameras():
    return [lp.Camera(width=WIDTH, height=HEIGHT, hfov_deg=45, yaw_deg=yaw) for yaw in YAWS]


def exposures():
    return [lp.Exposure(ev=ev, white_balance=(red, 1, 1)) for ev, red in zip(EXPOSURES, RED)]


def true_profile():
    """A response that is not a power function, and M = 0.5 in the corners."""
    return lp.Profile(response=lp.Response.from_emor([0.8, -0.4]), vignetting=lp.Vignetting(k=FALLOFF))


def radiance(directions):
    """RGB of directions (longitude, latitude), 0.03..0.6: soft waves in different directions for each channel."""
    longitude, latitude = directions[..., 0], directions[..., 1]
    waves = [np.sin(13 * longitude + 5 * latitude + 1) + np.sin(9 * latitude - 4 * longitude + phase)
             for phase in (0, 1, 2)]
    return 0.03 + 0.57 * ((np.stack(waves, axis=-1) + 2) / 4) ** 2


_rendered = []


def pictures():
    """Three overlapping uint8 pictures of the scene as the true camera records them, with noise. Copies."""
    if not _rendered:
        y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
        random = np.random.default_rng(7)
        for camera, exposure in zip(cameras(), exposures()):
            light = radiance(camera.unproject(x, y)).astype(np.float32)
            options = lp.ApplyOptions(direction=lp.Direction.SIMULATE, input=lp.Encoding.LINEAR, frame_width=WIDTH,
                                      frame_height=HEIGHT, source_sample=lp.SampleType.F32, source=exposure,
                                      target_sample=lp.SampleType.F32, response=true_profile().response,
                                      vignetting=true_profile().vignetting)
            grey = lp.Plan(options).apply(light) + random.normal(0, 1 / 255, light.shape)
            _rendered.append(np.clip(np.rint(grey * 255), 0, 255).astype(np.uint8))
    return [picture.copy() for picture in _rendered]


def sample_images(arrays):
    return [lp.SampleImage(array, camera) for array, camera in zip(arrays, cameras())]


def fit_images():
    free = lp.Free.EV | lp.Free.RED | lp.Free.BLUE
    return [lp.FitImage(i, WIDTH, HEIGHT, free=free) for i in range(len(YAWS))]


def simple_pairs(count=400, gain=1.5):
    """Pairs of two linear pictures; the second got `gain` times the light."""
    random = np.random.default_rng(3)
    pairs = np.zeros(count, dtype=lp.PAIR_DTYPE)
    pairs["image"] = (0, 1)
    pairs["xy"] = random.uniform(0, 150, (count, 2, 2))
    pairs["value"][:, 0] = random.uniform(0.05, 0.6, (count, 1))
    pairs["value"][:, 1] = pairs["value"][:, 0] * gain
    return pairs


def two_images():
    return [lp.FitImage(i, WIDTH, HEIGHT, free=lp.Free.EV) for i in range(2)]


def linear_options(**fields):
    """A fit of exposures only, with the linear response."""
    return lp.FitOptions(**{"response": lp.Response.linear(), "free": lp.Free(0), **fields})
