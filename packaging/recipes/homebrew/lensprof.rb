# Homebrew. Tried: Ruby reads it, and its CMake command with Debian's libraries (recipes.py --try). Not tried: brew, macOS.
class Lensprof < Formula
  desc "Camera response, vignetting and exposure from overlapping pictures"
  homepage "https://pypi.org/project/lensprof"
  url "https://pypi.org/packages/source/l/lensprof/lensprof-0.3.0.tar.gz"
  sha256 "f26ebbffe566454958c88ddbb11c31940fc2d55999d84de0882f611f7a6c262c"
  license "MIT"

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "eigen" => :build
  depends_on "nlohmann-json" => :build
  depends_on "pkgconf" => :build
  depends_on "cairo"
  depends_on "jpeg-turbo"
  depends_on "libpng"
  depends_on "libtiff"
  depends_on "libzip"
  depends_on "nlopt"
  depends_on "opencv"
  depends_on "pugixml"
  depends_on "sqlite"

  def install
    system "cmake", "-S", ".", "-B", "build", "-DLENSPROF_TESTS=OFF", "-DLENSPROF_EXIV2=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"lensprof", "simulate", "-o", "pictures", "--size", "320x240"
    system bin/"lensprof", "calibrate", "pictures", "-o", "calibrated", "--db", "lenses.db"
  end
end
