"""What a build costs.

log    tests/README.md; of build/release as it stands, by Ninja's log: objects, object seconds, the slowest ones. After
       `CCACHE_DISABLE=1 bash tests/run.sh` in a fresh clone these are the two commands of README.md

    python3 tests/studies/build.py --check BUILD   the headers that cost most and the number of objects; fails where they grow

Object seconds are the time on the clock that Ninja noted for each object, added up; objects are compiled side by side. So that
machines compare, they are given in reference objects too: in the seconds of REFERENCE, compiled at the end. The quickstart's are
those objects that its programs need.
"""
import os
import re
import subprocess
import sys

import studies

REFERENCE = """
#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <iostream>
#include <nlohmann/json.hpp>

struct Residual {
  template <class T>
  bool operator()(const T* x, T* r) const {
    r[0] = T(10.0) - x[0];
    r[1] = ceres::sin(x[0]);
    return true;
  }
};

int main() {
  double x = 0.5;
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual, 2, 1>(new Residual), nullptr, &x);
  ceres::Solver::Options options;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(5, 5);
  std::cout << x << nlohmann::json::parse("[1]").dump() << a.jacobiSvd().singularValues();
}
"""

# What a build may cost. Lines are those that a header is after preprocessing: Eigen's alone are 81,000.
MOST_OBJECTS, MOST_QUICKSTART_OBJECTS = 88, 42
HEADERS = {"models/options.h": 28000, "datasets/files/error.h": 22000, "datasets/loading/load_recordings.h": 92000,
           "ident/parameters/fit_options.h": 92000, "ident/model/fitted_model.h": 96000, "ident/prediction/prediction.h": 99000,
           "apps/flags/command_line.h": 98500, "apps/flags/recording_flags.h": 102000}
INCLUDES = ["-std=c++17", f"-I{studies.SOURCE}", "-isystem", "/usr/include/eigen3"]


def compile_seconds(source):
    """Processor seconds of one object file."""
    before = os.times()
    subprocess.run(["g++", "-O2", *INCLUDES, "-x", "c++", "-c", "-", "-o", os.devnull], input=source, text=True, check=True)
    after = os.times()
    return after.children_user - before.children_user + after.children_system - before.children_system


def preprocessed_lines(header):
    text = subprocess.run(["g++", "-E", "-P", *INCLUDES, "-x", "c++", "-"], input=f'#include "{header}"\n', text=True,
                          capture_output=True, check=True).stdout
    return text.count("\n")


def objects(build):
    """Object file -> seconds, by Ninja's log; the last entry of each counts."""
    seconds = {}
    try:
        with open(os.path.join(build, ".ninja_log"), encoding="utf-8") as log:
            for line in log:
                fields = line.rstrip("\n").split("\t")
                if len(fields) == 5 and fields[3].endswith(".o"):
                    seconds[fields[3]] = (int(fields[1]) - int(fields[0])) / 1000
    except FileNotFoundError:
        sys.exit(f"{build}: no log of Ninja's: build with -G Ninja")
    return seconds


def short(name):
    """unity_ident_problem_0_cxx.cxx.o of target pushid_ident -> pushid_ident: batch ident_problem 0."""
    target = re.search(r"CMakeFiles/([^/]+)\.dir", name).group(1)
    batch = re.search(r"unity_(.+)_(\d+)_cxx", name)
    source = f"batch {batch.group(1)} {batch.group(2)}" if batch else os.path.basename(name)[:-2]
    return f"{target}: {source}"


def targets_objects(build, target):
    printed = subprocess.run(["ninja", "-C", build, "-t", "commands", target], capture_output=True, text=True, check=True).stdout
    return re.findall(r" -o (\S+\.o) -c ", printed)


def log():
    build = os.path.join(studies.SOURCE, "build/release")
    every = objects(build)
    quickstart = {name: every[name] for name in targets_objects(build, "pushid_quickstart") if name in every}
    reference = compile_seconds(REFERENCE)
    rows = [[name, len(some), f"{sum(some.values()):.0f}", f"{sum(some.values()) / reference:.0f}"]
            for name, some in (("`bash apps/quickstart.sh`", quickstart), ("and `bash tests/run.sh`", every))]
    slowest = sorted(every.items(), key=lambda item: -item[1])[:10]
    return (studies.table(["command", "objects", "object seconds", "reference objects"], rows) +
            f"\n\nA reference object took {reference:.1f} s. The slowest objects: " +
            "; ".join(f"{short(name)}, {value / reference:.1f}" for name, value in slowest) + ".")


def check(build):
    found = {"objects": (len(targets_objects(build, "pushid_tests")), MOST_OBJECTS),
             "objects of the quickstart": (len(targets_objects(build, "pushid_quickstart")), MOST_QUICKSTART_OBJECTS),
             **{f"lines of {header}": (preprocessed_lines(header), most) for header, most in HEADERS.items()}}
    for name, (count, most) in sorted(found.items(), key=lambda item: -item[1][0]):
        print(f"{name}: {count}, at most {most}")
    return all(count <= most for count, most in found.values())


if __name__ == "__main__":
    if sys.argv[1:2] == ["--check"]:
        sys.exit(0 if check(sys.argv[2]) else 1)
    studies.main(__file__, {"log": log})
