"""The libraries of the photograph library for one platform, static: OpenCV's modules, libjpeg-turbo, libpng, libtiff, zlib.

All come from the archive of pictures.txt. The folder receives lib/, include/, licenses/ and lensprof-photo.cdx.json; CMake
takes it as -DLENSPROF_PICTURES (cmake/sources).
"""

import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import urllib.error
import urllib.request

import sources

HERE = pathlib.Path(__file__).resolve().parent
MODULES = ("core", "flann", "imgproc", "features2d", "calib3d")

# Name, licence (SPDX), the folder in OpenCV's 3rdparty, the library, the licence's file, the public headers, and what states
# the version in one of them.
PARTS = (
    ("libjpeg-turbo", "IJG AND BSD-3-Clause AND Zlib", "libjpeg-turbo", "jpeg", "LICENSE.md",
     ("jconfig.h", "jerror.h", "jmorecfg.h", "jpeglib.h"), r"LIBJPEG_TURBO_VERSION +([\d.]+)"),
    ("libpng", "libpng-2.0", "libpng", "png", "LICENSE", ("png.h", "pngconf.h", "pnglibconf.h"),
     r"PNG_LIBPNG_VER_STRING \"([\d.]+)\""),
    ("libtiff", "libtiff", "libtiff", "tiff", "COPYRIGHT", ("tiffvers.h", "tiff.h", "tiffconf.h", "tiffio.h"),
     r"Version ([\d.]+)"),
    ("zlib", "Zlib", "zlib", "z", "LICENSE", ("zlib.h", "zconf.h"), r"ZLIB_VERSION \"([\d.]+)\""),
)  # fmt: skip

# Nothing that is not needed, nothing found on this machine.
OPTIONS = {
    "BUILD_LIST": ",".join(MODULES), "BUILD_SHARED_LIBS": "OFF", "CV_TRACE": "OFF",
    "OPENCV_PYTHON_SKIP_DETECTION": "ON", "BUILD_WITH_DEBUG_INFO": "OFF", "CMAKE_BUILD_TYPE": "Release", "ENABLE_CCACHE": "OFF",
    **{f"BUILD_{name}": "ON" for name in ("ZLIB", "PNG", "JPEG", "TIFF")},
    **{f"BUILD_{name}": "OFF" for name in ("opencv_apps", "TESTS", "PERF_TESTS", "EXAMPLES", "JAVA")},
    **{f"WITH_{name}": "OFF" for name in (
        "IPP", "ITT", "OPENCL", "LAPACK", "EIGEN", "PROTOBUF", "QUIRC", "TBB", "WEBP", "OPENEXR", "OPENJPEG", "JASPER", "FFMPEG",
        "GSTREAMER", "V4L", "GTK", "1394", "ADE", "CAROTENE")},
}  # fmt: skip


def fetch(folder: pathlib.Path) -> pathlib.Path:
    """The archive of pictures.txt, unpacked; its hash is checked. pip would build it, so that its page is read here."""
    text = (HERE / "pictures.txt").read_text()
    name, version, wanted = re.search(r"^(\S+)==(\S+) --hash=sha256:(\w+)$", text, re.MULTILINE).groups()
    unpacked = folder / f"{name}-{version}"
    if (unpacked / "opencv/CMakeLists.txt").exists():
        return unpacked
    try:
        page = urllib.request.Request(f"https://pypi.org/simple/{name}/", headers={"Accept": "application/vnd.pypi.simple.v1+json"})
        files = json.load(urllib.request.urlopen(page, timeout=60))["files"]
        url = next(file["url"] for file in files if file["hashes"].get("sha256") == wanted)
        data = urllib.request.urlopen(url, timeout=600).read()
    except (urllib.error.URLError, TimeoutError, StopIteration, ConnectionError) as error:
        sys.exit(f"pictures.py: {name} {version} of PyPI: cannot be fetched ({error}); try again later")
    if hashlib.sha256(data).hexdigest() != wanted:
        sys.exit(f"pictures.py: {name} {version}: has another hash than in pictures.txt; try again")
    with tempfile.TemporaryDirectory(dir=folder) as work:
        archive = pathlib.Path(work) / "archive.tar.gz"
        archive.write_bytes(data)
        with tarfile.open(archive) as opened:
            opened.extractall(work)
        (pathlib.Path(work) / unpacked.name).rename(unpacked)
    return unpacked


def collect(source: pathlib.Path, build: pathlib.Path, folder: pathlib.Path, product: dict) -> None:
    """Libraries, headers, licences and the bill of materials."""
    shutil.copytree(build / "install/include", folder / "include", dirs_exist_ok=True)
    (folder / "lib").mkdir()
    (folder / "licenses/opencv").mkdir(parents=True)
    shutil.copy(source / "LICENSE", folder / "licenses/opencv/LICENSE")
    header = (source / "modules/core/include/opencv2/core/version.hpp").read_text()
    version = ".".join(re.findall(r"#define CV_VERSION_(?:MAJOR|MINOR|REVISION) +(\d+)", header))
    archive = "pkg:pypi/opencv-python-headless@" + re.search(r"==(\S+)", (HERE / "pictures.txt").read_text())[1]
    components = [sources.component("opencv", version, "Apache-2.0", archive)]
    for module in MODULES:
        shutil.copy(next(build.glob(f"install/lib*/libopencv_{module}.a")), folder / "lib")
    for name, license_name, room, library, text, headers, pattern in PARTS:
        third, built = source / "3rdparty" / room, build / "3rdparty" / room
        shutil.copy(next(build.glob(f"3rdparty/lib/lib*{room.removeprefix('lib')}.a")), folder / "lib" / f"lib{library}.a")
        for header in headers:
            shutil.copy(next(place / header for place in (built, third, third / "src") if (place / header).exists()),
                        folder / "include")  # fmt: skip
        (folder / "licenses" / name).mkdir()
        shutil.copy(third / text, folder / "licenses" / name / text)
        found = re.search(pattern, (folder / "include" / headers[0]).read_text())
        components.append(sources.component(name, found[1], license_name, archive))
    product["components"] = components + product["components"]
    (folder / "lensprof-photo.cdx.json").write_text(json.dumps(product, indent=1) + "\n")


def make(zig: pathlib.Path, target: str, common: pathlib.Path, folder: pathlib.Path) -> None:
    """`common`: the sources of the base library (sources.py)."""
    settings = json.dumps([OPTIONS, target, PARTS]) + "".join((HERE / name).read_text() for name in ("pictures.txt", "pictures.py", "zig.cmake"))
    stamp = hashlib.sha256(settings.encode()).hexdigest()
    if (folder / "stamp").exists() and (folder / "stamp").read_text() == stamp:
        return
    if not shutil.which("nasm"):
        sys.exit("pictures.py: nasm: is not installed; install the packages of packages-wheels.txt (make wheels)")
    folder.parent.mkdir(parents=True, exist_ok=True)
    source = fetch(folder.parent) / "opencv"
    build, ready = folder.parent / f"{folder.name}.build", folder.parent / f"{folder.name}.part"
    for old in (build, ready):
        shutil.rmtree(old, ignore_errors=True)
    build.mkdir()
    defines = {**OPTIONS, "CMAKE_TOOLCHAIN_FILE": HERE / "zig.cmake", "LENSPROF_ZIG": zig, "LENSPROF_ZIG_TARGET": target,
               "CMAKE_INSTALL_PREFIX": build / "install",
               **{f"CMAKE_{language}_FLAGS": f"-ffile-prefix-map={source}=. -ffile-prefix-map={build}=." for language in ("C", "CXX")}}  # fmt: skip
    is_x86 = target.startswith("x86_64")
    defines["CPU_DISPATCH"] = "AVX2" if is_x86 else ""  # is used where the processor has it
    if is_x86:
        defines["CMAKE_ASM_NASM_COMPILER"] = shutil.which("nasm")
    environment = {**os.environ, "ZIG_LOCAL_CACHE_DIR": str(build / "cache")}
    with open(build / "log.txt", "w") as log:
        for command in (["cmake", "-S", source, "-B", build, *[f"-D{name}={value}" for name, value in defines.items()]],
                        ["cmake", "--build", build, "--parallel", os.cpu_count()], ["cmake", "--install", build],
                        # Modules of OpenCV that are not built would use these.
                        ["cmake", "--build", build, "--target", *(part[2] for part in PARTS)]):  # fmt: skip
            if subprocess.run([str(word) for word in command], stdout=log, stderr=subprocess.STDOUT, env=environment).returncode:
                sys.exit(f"pictures.py: OpenCV for {target}: cannot be built; read {build / 'log.txt'}")
    ready.mkdir()
    product = json.loads((common / "lensprof.cdx.json").read_text())
    component = product["metadata"]["component"]
    component.update(name="lensprof-photo", purl=component["purl"].replace("/lensprof@", "/lensprof-photo@"))
    product["components"] = [c for c in product["components"] if c["name"] != "nlopt"]
    product.pop("dependencies")
    shutil.copytree(common / "licenses", ready / "licenses")
    for name in ("nlopt", "mingw-w64"):
        shutil.rmtree(ready / "licenses" / name)
    collect(source, build, ready, product)
    (ready / "stamp").write_text(stamp)
    shutil.rmtree(folder, ignore_errors=True)
    ready.rename(folder)
    shutil.rmtree(build)
