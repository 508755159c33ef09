"""pip install ./apps/python --no-build-isolation: builds the extension by the project's own CMake.

PUSHID_BUILD=build/release: takes that of an existing build; a relative path starts at the project's folder."""
import os
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
THERE = os.environ.get("PUSHID_BUILD")
BUILD = os.path.join(SOURCE, THERE or os.path.join("build", "pip"))  # pip runs this in apps/python
if THERE and not os.path.exists(os.path.join(BUILD, "CMakeCache.txt")):
    sys.exit(f"PUSHID_BUILD: {BUILD} is no build of CMake; make one (cmake --preset release), or leave PUSHID_BUILD out")
LEFT = os.path.join(BUILD, "setuptools")  # its own files


class ByCMake(build_ext):
    def build_extension(self, ext):
        target = os.path.abspath(self.get_ext_fullpath(ext.name))
        ninja = ["-G", "Ninja"] if shutil.which("ninja") else []  # so that ccache knows what other builds compiled
        if not THERE:
            subprocess.run(["cmake", *ninja, "-S", SOURCE, "-B", BUILD, "-DCMAKE_BUILD_TYPE=Release", "-DPUSHID_TESTS=OFF",
                            "-DPUSHID_BENCHMARKS=OFF", "-DPUSHID_PYTHON=ON", "-DPUSHID_TORCH=OFF",
                            f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "_pushid", "--parallel", str(os.cpu_count())],
                       check=True)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        built = os.path.join(BUILD, "python", "pushid", os.path.basename(target))
        self.copy_file(built, target)


os.makedirs(LEFT, exist_ok=True)
setup(ext_modules=[Extension("pushid._pushid", sources=[])], cmdclass={"build_ext": ByCMake},
      options={"build": {"build_base": LEFT}, "egg_info": {"egg_base": LEFT}})
