"""Profiles as source code and as cubes, run by what reads them: compilers and FFmpeg."""
import ctypes
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import numpy as np

import lensprof as lp
from lensprof import formats
from support import refused

Format = formats.Format
CXX, CC = os.environ.get("CXX", "c++"), os.environ.get("CC", "cc")
FRAME = (61, 47)
UNSAFE = "50mm */ f/1.8 /* // ??/ \u2028\u0085\u202e \udcff \u00e9 \\"  # a comment must not end in it, nor continue after it

# GLSL's types and functions in C++.
SHIM = """
#include <algorithm>
#include <cmath>
namespace {
struct vec2 { float v[2]; vec2(float a, float b) : v{a, b} {} };
struct vec3 {
    float v[3];
    vec3(float a, float b, float c) : v{a, b, c} {}
    float operator[](int i) const { return v[i]; }
};
vec2 operator-(vec2 a, vec2 b) { return {a.v[0] - b.v[0], a.v[1] - b.v[1]}; }
vec2 operator*(float a, vec2 b) { return {a * b.v[0], a * b.v[1]}; }
vec2 operator/(vec2 a, float b) { return {a.v[0] / b, a.v[1] / b}; }
vec3 operator+(vec3 a, vec3 b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
vec3 operator+(float a, vec3 b) { return {a + b[0], a + b[1], a + b[2]}; }
vec3 operator*(float a, vec3 b) { return {a * b[0], a * b[1], a * b[2]}; }
vec3 operator/(vec3 a, vec3 b) { return {a[0] / b[0], a[1] / b[1], a[2] / b[2]}; }
float dot(vec2 a, vec2 b) { return a.v[0] * b.v[0] + a.v[1] * b.v[1]; }
float length(vec2 a) { return std::sqrt(dot(a, a)); }
float mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }
float clamp(float a, float low, float high) { return std::min(std::max(a, low), high); }
float max(float a, float b) { return std::max(a, b); }
int min(int a, int b) { return std::min(a, b); }
vec3 max(vec3 a, vec3 b) { return {std::max(a[0], b[0]), std::max(a[1], b[1]), std::max(a[2], b[2])}; }
vec3 pow(vec3 a, vec3 b) { return {std::pow(a[0], b[0]), std::pow(a[1], b[1]), std::pow(a[2], b[2])}; }
}
"""
# The functions of program N for many values: 0 falloff, 1 to_light, 2 from_light, 3 correct.
CALL = """
extern "C" void call_%(n)d(int what, int count, float w, float h, const float *xy, const float *in, float *out) {
    using namespace n%(n)d;
    for (int i = 0; i < count; i++) {
        const vec2 position(xy[2 * i], xy[2 * i + 1]), size(w, h);
        const vec3 value(in[3 * i], in[3 * i + 1], in[3 * i + 2]);
        const vec3 result = what == 0   ? lensprof_falloff(position, size)
                            : what == 1 ? lensprof_to_light(value)
                            : what == 2 ? lensprof_from_light(value)
                                        : lensprof_correct(value, position, size);
        for (int c = 0; c < 3; c++) out[3 * i + c] = result[c];
    }
}
"""


def cxx_of_glsl(text):
    text = re.sub(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d+)?|\d+e[-+]?\d+)", r"\1f", text.replace("precision highp float;", ""))
    return re.sub(r"= (?:float|vec3)\[\d+\]\((.*?)\);", r"= {\1};", text, flags=re.DOTALL)


def glsl_of_wgsl(text):
    text = re.sub(r"vec(\d)<f32>", r"vec\1", text).replace("f32", "float").replace("i32", "int")
    text = re.sub(r"var<private> (\w+): array<(\w+), (\d+)> = array<\w+, \d+>\(", r"const \2 \1[\3] = \2[\3](", text)
    text = re.sub(r"\b(?:let|var) ", "auto ", text)
    return re.sub(r"fn (\w+)\((.*?)\) -> (\w+)",
                  lambda f: f[3] + " " + f[1] + "(" + re.sub(r"(\w+): (\w+)", r"\2 \1", f[2]) + ")", text)


class Programs:
    """Texts of GLSL, compiled as C++ in one library."""

    def __init__(self, texts, folder):
        source, library = pathlib.Path(folder, "programs.cpp"), pathlib.Path(folder, "programs.so")
        source.write_text(SHIM + "".join(f"namespace n{n} {{\n{cxx_of_glsl(text)}\n}}\n{CALL % {'n': n}}"
                                         for n, text in enumerate(texts)), encoding="utf-8")
        subprocess.run([CXX, "-std=c++17", "-Wall", "-Werror", "-Wno-unused-function", "-O1", "-ffp-contract=off", "-shared",
                        "-fPIC", source, "-o", library], check=True)
        self.library = ctypes.CDLL(str(library))

    def call(self, n, what, xy, values, frame=FRAME):
        xy, values = (np.ascontiguousarray(array, np.float32) for array in (xy, values))
        out = np.empty((len(values), 3), np.float32)
        pointers = (array.ctypes.data_as(ctypes.c_void_p) for array in (xy, values, out))
        getattr(self.library, f"call_{n}")(what, len(values), ctypes.c_float(frame[0]), ctypes.c_float(frame[1]), *pointers)
        return out.astype(float)


def responses():
    """One response or three of each kind."""
    gamma, emor = lp.Response.from_gamma, lp.Response.from_emor
    grid = np.linspace(0, 1, 1024)
    steps = np.interp(grid, [0, 0.02, 0.3, 0.31, 0.6, 0.9, 1], [0, 0, 0.35, 0.6, 0.6, 1, 1])  # flat, steep, clipped
    return {"linear": lp.Response(), "gamma": gamma(2.2), "gamma below 1": gamma(0.5), "three gammas": [gamma(1.8), lp.Response(), gamma(2.4)],
            "sRGB": lp.Response.srgb(), "EMoR": emor([0.8, -0.4, 0.1]), "typical": lp.Response.typical(lp.CameraKind.STILL)[0],
            "phone": lp.Response.typical(lp.CameraKind.PHONE)[0], "three EMoR": [emor([0.8, -0.4]), emor([0.6, -0.3]), emor([1, -0.2])],
            "EMoR and gamma": [emor([0.8, -0.4]), gamma(4), lp.Response()], "steps": lp.Response.from_table(steps)}


FALLOFFS = {"none": lp.Vignetting(), "centred": lp.Vignetting(k=(-0.35, 0.12, -0.08)),
            "off centre": lp.Vignetting(k=(-0.5, 0.1, -0.15), center=(0.09, -0.06)),
            "three": [lp.Vignetting(k=(-0.3 - 0.1 * c, 0.05 * c, -0.1), center=(-0.05, 0.08)) for c in range(3)],
            "deep": lp.Vignetting(k=(-1.1, 0.7, -0.4))}


def profiles():
    return [(f"{response}, {falloff}", lp.Profile(response=of_response, vignetting=of_falloff, key=lp.ProfileKey(lens=UNSAFE)))
            for response, of_response in responses().items() for falloff, of_falloff in FALLOFFS.items()]


def of_channel(curves, c):
    return curves[c if len(curves) == 3 else 0]


def places():
    """Pixels of the frame, as x and y of their middles."""
    y, x = np.mgrid[0:FRAME[1]:2, 0:FRAME[0]:2]
    return np.stack([x.ravel(), y.ravel()], axis=-1)


def exact_falloff(profile, xy):
    curves = [of_channel(profile.vignetting, c) for c in range(3)]
    return np.stack([v.eval(v.r2(*FRAME, xy[:, 0], xy[:, 1])) for v in curves], axis=-1)


class Shaders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not shutil.which(CXX):
            raise unittest.SkipTest(f"no compiler {CXX}")
        cls.cases = profiles()
        cls.glsl = [formats.encode_profiles([profile], format=Format.GLSL).decode() for _, profile in cls.cases]
        cls.wgsl = [formats.encode_profiles([profile], format=Format.WGSL).decode() for _, profile in cls.cases]
        with tempfile.TemporaryDirectory() as folder:
            cls.programs = Programs(cls.glsl + [glsl_of_wgsl(text) for text in cls.wgsl], folder)

    def test_falloff(self):
        xy = places()
        for n, (name, profile) in enumerate(self.cases):
            found = self.programs.call(n, 0, xy + 0.5, np.zeros((len(xy), 3)))
            np.testing.assert_allclose(found, exact_falloff(profile, xy), rtol=2e-5, err_msg=name)

    def test_response(self):
        """Into light exactly at the values of the table, and back: the pair are inverses."""
        grey = np.repeat(np.linspace(0, 1, 1021)[:, None], 3, axis=1)
        for n, (name, profile) in enumerate(self.cases):
            xy = np.zeros((len(grey), 2))
            light = self.programs.call(n, 1, xy, grey)
            np.testing.assert_allclose(self.programs.call(n, 2, xy, light), grey, atol=1e-4, err_msg=name)
            table = re.search(r"lensprof_table\[(\d+)\]", self.glsl[n])
            every = 1020 // (int(table[1]) - 1) if table and 1020 % (int(table[1]) - 1) == 0 else 1020 if table else 1
            for c in range(3):
                exact = of_channel(profile.response, c).invert(grey[::every, c])
                np.testing.assert_allclose(light[::every, c], exact, atol=2e-6, err_msg=name)

    def test_correction(self):
        """All levels of 8 bit at all places, within half a level of the model and of lensprof_apply."""
        xy, worst = places(), {}
        for n, (name, profile) in enumerate(self.cases):
            m = exact_falloff(profile, xy)
            for level in range(0, 256, 5):
                grey = np.full((len(xy), 3), level / 255)
                found = np.clip(self.programs.call(n, 3, xy + 0.5, grey), 0, 1)
                curves = [of_channel(profile.response, c) for c in range(3)]
                exact = np.stack([f.eval(f.invert(level / 255) / m[:, c]) for c, f in enumerate(curves)], axis=-1)
                kind = name.split(",")[0]
                worst[kind] = max(worst.get(kind, 0), 255 * np.abs(found - exact).max())
                self.assertLess(255 * np.abs(found - exact).max(), 0.35, f"{name}, level {level}")
        if os.environ.get("LENSPROF_SHOW"):
            print("\nlevels of 255:", {kind: round(float(value), 4) for kind, value in worst.items()})

    def test_same_as_apply(self):
        """Pictures of 8 bit, and of floats, between the values of a table, where that has no jump."""
        y, x = np.mgrid[0:FRAME[1], 0:FRAME[0]]
        xy = np.stack([x.ravel(), y.ravel()], axis=-1)
        floats = np.random.default_rng(3).random((FRAME[1], FRAME[0], 3), dtype=np.float32)
        floats[::3] *= 0.1
        levels = np.rint(255 * floats).astype(np.float32) / np.float32(255)
        worst = [0.0, 0.0]
        for n, (name, profile) in enumerate(self.cases):
            for kind, picture in enumerate((levels, floats)):
                if picture is floats and name.startswith("steps"):
                    continue
                corrected = lp.correct(picture, profile, saturated=lp.Saturated.AS_VALUE).reshape(-1, 3)
                found = np.clip(self.programs.call(n, 3, xy + 0.5, picture.reshape(-1, 3)), 0, 1)
                error = 255 * np.abs(found - np.clip(corrected, 0, 1)).max()
                self.assertLess(error, 0.5, name)
                worst[kind] = max(worst[kind], error)
        self.assertGreater(255 * np.abs(levels.reshape(-1, 3) - corrected).max(), 20)  # there was much to correct
        if os.environ.get("LENSPROF_SHOW"):
            print("\nlevels of 255 from lensprof_apply, 8 bit and float:", worst)

    def test_stated_error(self):
        """The error that a comment states is that of the table."""
        for (name, profile), text in zip(self.cases, self.glsl):
            table = re.search(r"Table of (\d+) values: a corrected value is within ([\d.]+) levels", text)
            self.assertEqual(bool(table), "lensprof_table" in text, name)
            if table:
                self.assertIn(int(table[1]), (65, 129, 256, 511, 1021))
                self.assertLessEqual(float(table[2]), 0.3)

    def test_wgsl_gives_the_same(self):
        xy, more = places(), len(self.cases)
        grey = np.random.default_rng(5).random((len(xy), 3))
        for n, (name, _) in enumerate(self.cases):
            for what in range(4):
                np.testing.assert_array_equal(self.programs.call(n, what, xy + 0.5, grey),
                                              self.programs.call(n + more, what, xy + 0.5, grey), err_msg=name)

    def test_names_stay_in_the_comment(self):
        for text in self.glsl + self.wgsl:
            self.assertNotRegex(text, "[\u0080-\u009f\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff]")
            comment, code = text[:text.index("\n\n")], text[text.index("\n\n"):]
            self.assertIn("50mm * / f/1.8 / * / / ? ?/ ___ _ \u00e9 _", comment)
            self.assertTrue(all(line.startswith("// ") and not line.endswith("\\") for line in comment.split("\n")))
            self.assertNotIn("//", code)

    def test_refused(self):
        grid = lp.Profile(vignetting=FALLOFFS["centred"], grid=lp.GainGrid(np.full((3, 4), 0.9)))
        for format in (Format.GLSL, Format.WGSL):
            with refused(self, lp.Status.ERROR_UNSUPPORTED) as caught:
                formats.encode_profiles([grid], format=format)
            self.assertIn(f"profile 0: has a gain grid, which {format.name.lower()} cannot hold", caught.exception.text)
        for format, name in ((Format.GLSL, "a.glsl"), (Format.WGSL, "a.wgsl"), (Format.C, "a.h")):
            self.assertEqual(formats.info(format)[3:], (True, False, False))
            for options in ({"format": format}, {"name": name}):
                with refused(self, lp.Status.ERROR_UNSUPPORTED) as caught:
                    formats.read_profiles(b"text", **options)
                self.assertIn("is written only; export JSON or a blob", caught.exception.text)


class Headers(unittest.TestCase):
    PROGRAM = """
#include "profile.h"
#include "profile.h"
#include <stdio.h>
int main(void) {
    for (int i = 0; i < LENSPROF_PROFILE_BLOB_BYTES; i++) printf("%02x", lensprof_profile_blob[i]);
    printf("\\n%.9g %.9g\\n", lensprof_profile_center[0], lensprof_profile_center[1]);
    for (int c = 0; c < 3; c++)
        printf("%.9g %.9g %.9g\\n", lensprof_profile_k1[c], lensprof_profile_k2[c], lensprof_profile_k3[c]);
    return sizeof lensprof_profile_blob != LENSPROF_PROFILE_BLOB_BYTES;
}
"""

    def test_compiled(self):
        if not shutil.which(CC):
            self.skipTest(f"no compiler {CC}")
        key = lp.ProfileKey(camera_maker="Acme", camera_model="C*", lens=UNSAFE, focal_mm=50, aperture=2.8)
        grid = lp.GainGrid(np.full((3, 4), 0.9))
        for response in (lp.Response(), lp.Response.from_emor([0.8, -0.4]), [lp.Response.from_gamma(g) for g in (1.8, 2, 2.2)]):
            for falloff in FALLOFFS.values():
                profile = lp.Profile(key=key, response=response, vignetting=falloff, grid=grid)
                self.check_header(profile, formats.encode_profiles([profile], "a.h").decode())

    def check_header(self, profile, text):
        self.assertIn("Acme C*, 50mm * / f/1.8 / * / / ? ?/ ___ _ \u00e9 _, 50 mm, f/2.8\n", text)
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "profile.h").write_text(text, encoding="utf-8")
            pathlib.Path(folder, "main.c").write_text(self.PROGRAM)
            subprocess.run([CC, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "main.c", "-o", "main"], cwd=folder,
                           check=True)
            blob, center, *k = subprocess.run(["./main"], cwd=folder, check=True, capture_output=True).stdout.decode().splitlines()
        self.assertEqual(bytes.fromhex(blob), profile.pack())
        np.testing.assert_allclose([float(x) for x in center.split()], profile.vignetting[0].center, rtol=1e-7)
        for c in range(3):
            np.testing.assert_allclose([float(x) for x in k[c].split()], of_channel(profile.vignetting, c).k, rtol=1e-7)


class Cubes(unittest.TestCase):
    def test_round_trip(self):
        for name, response in responses().items():
            given = lp.Profile(response=response)
            text = formats.encode_profiles([given], "a.cube")
            self.assertEqual(formats.detect(text), Format.CUBE)
            self.assertIn(b"\nLUT_1D_SIZE 1024\n", text)
            (found, _), = formats.read_profiles(text)
            self.assertEqual(len(found.response), len(given.response))
            for a, b in zip(given.response, found.response):
                full = a.invert(1.0)  # a file's last value counts as 1
                grey = np.linspace(0, 1, 333)
                error = np.abs(b.invert(grey) - a.invert(grey) / full)
                self.assertLess((error > 1e-3).sum(), 3 if name == "steps" else 1, name)  # next to its two jumps

    def test_curves(self):
        profile = lp.Profile(response=lp.Response.from_gamma(2.2))
        text = formats.encode_profiles([profile], "a.cube", curve=formats.CurveKind.FORWARD, tables=(0, 65536))
        (found, _), = formats.read_profiles(text, curve=formats.CurveKind.FORWARD)
        x = np.linspace(0, 1, 1024)
        np.testing.assert_allclose(found.response[0].eval(x), x**(1 / 2.2), atol=3e-4)
        for kind in (formats.CurveKind.LOG, formats.CurveKind.LOG10):
            for call in (lambda: formats.encode_profiles([profile], "a.cube", curve=kind),
                         lambda: formats.read_profiles(text, curve=kind)):
                with refused(self, lp.Status.ERROR_UNSUPPORTED) as caught:
                    call()
                self.assertIn("choose the inverse or forward curve", caught.exception.text)

    def test_ffmpeg(self):
        """FFmpeg's lut1d gives the response in both directions, for each channel."""
        if not shutil.which("ffmpeg"):
            self.skipTest("no ffmpeg")
        for name, response in responses().items():
            profile = lp.Profile(response=response, key=lp.ProfileKey(lens=UNSAFE))
            for kind, rows in ((formats.CurveKind.INVERSE, 1024), (formats.CurveKind.FORWARD, 1021)):
                x = np.linspace(0, 1, rows, dtype=np.float32)
                found = self.filtered(formats.encode_profiles([profile], "a.cube", curve=kind, tables=(0, rows)), x)
                for c in range(3):
                    f = of_channel(profile.response, c)
                    exact = (f.invert if kind == formats.CurveKind.INVERSE else f.eval)(x.astype(float))
                    np.testing.assert_allclose(found[c], exact, atol=2e-5, err_msg=f"{name}, {kind}")

    def filtered(self, cube, x):
        """Red, green and blue of grey values, by lut1d."""
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "a.cube").write_bytes(cube)
            raw = ["-f", "rawvideo", "-pix_fmt", "gbrpf32le"]
            done = subprocess.run(["ffmpeg", "-v", "error", *raw, "-s", f"{len(x)}x1", "-i", "-", "-vf",
                                   "lut1d=file=a.cube:interp=linear", *raw, "-"], cwd=folder, input=np.tile(x, 3).tobytes(),
                                  capture_output=True, check=True)
        green, blue, red = np.frombuffer(done.stdout, np.float32).reshape(3, len(x))
        return red, green, blue


if __name__ == "__main__":
    unittest.main()
