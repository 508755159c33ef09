"""pip install ./apps/python --no-build-isolation: builds the extension by the project's own CMake."""
import os
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


class ByCMake(build_ext):
    def build_extension(self, ext):
        target = os.path.abspath(self.get_ext_fullpath(ext.name))
        build = os.path.join(SOURCE, "build", "pip")
        subprocess.run(["cmake", "-S", SOURCE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DPUSHID_TESTS=OFF",
                        "-DPUSHID_BENCHMARKS=OFF", "-DPUSHID_PYTHON=ON", "-DPUSHID_TORCH=OFF",
                        f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "_pushid", "--parallel", str(os.cpu_count())],
                       check=True)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        built = os.path.join(build, "python", "pushid", os.path.basename(target))
        self.copy_file(built, target)


setup(ext_modules=[Extension("pushid._pushid", sources=[])], cmdclass={"build_ext": ByCMake})
