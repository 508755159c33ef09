"""What a build costs.

commands    tests/README.md; the two commands of README.md in a fresh clone, one after the other, without a
            compiler cache: a quarter of an hour

    python3 tests/studies/build.py log             of build/release as it stands: objects, seconds, the slowest ten
    python3 tests/studies/build.py --check BUILD   the headers that cost most and the number of objects; fails where they grow

Object seconds are the time on the clock that Ninja noted for each object, added up; objects are compiled side by side. So that
machines compare, they are given in reference objects too: in the seconds of REFERENCE, compiled at the same time.
"""
import os
import re
import subprocess
import sys
import tempfile
import time

import studies

COMMANDS = {"quickstart": "apps/quickstart.sh", "tests": "tests/run.sh"}
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
MOST_OBJECTS, MOST_QUICKSTART_OBJECTS = 93, 55
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
    seconds = objects(build)
    reference, total = compile_seconds(REFERENCE), sum(seconds.values())
    quickstart = sum(seconds.get(name, 0.0) for name in targets_objects(build, "pushid_quickstart"))
    print(f"build: {len(seconds)} objects, {total:.0f} object seconds; a reference object takes {reference:.1f} s: "
          f"{total / reference:.0f} of them, {quickstart / reference:.0f} of the quickstart's", flush=True)
    for name, value in sorted(seconds.items(), key=lambda item: -item[1])[:10]:
        print(f"  {value:5.1f} s  {short(name)}")


def check(build):
    found = {"objects": (len(targets_objects(build, "pushid_tests")), MOST_OBJECTS),
             "objects of the quickstart": (len(targets_objects(build, "pushid_quickstart")), MOST_QUICKSTART_OBJECTS),
             **{f"lines of {header}": (preprocessed_lines(header), most) for header, most in HEADERS.items()}}
    for name, (count, most) in sorted(found.items(), key=lambda item: -item[1][0]):
        print(f"{name}: {count}, at most {most}")
    return all(count <= most for count, most in found.values())


def minutes(seconds):
    return f"{int(seconds) // 60} min {int(seconds) % 60:02d} s"


def commands():
    rows, before, total = [], {}, 0.0
    environment = dict(os.environ, CCACHE_DISABLE="1", PUSHID_RECORDINGS=studies.RECORDINGS, PUSHID_FUZZ_SECONDS="0")
    with tempfile.TemporaryDirectory() as folder:
        clone = os.path.join(folder, "pushid")
        subprocess.run(["git", "clone", "-q", studies.SOURCE, clone], check=True)
        for name, script in COMMANDS.items():
            start = time.monotonic()
            with open(os.path.join(folder, name), "w", encoding="utf-8") as output:
                subprocess.run(["bash", script], cwd=clone, env=environment, stdout=output, stderr=output, check=True)
            took = time.monotonic() - start
            total += took
            now = objects(os.path.join(clone, "build/release"))
            new = {key: value for key, value in now.items() if key not in before}
            reference = compile_seconds(REFERENCE)
            rows.append([f"`bash {script}`", len(new), f"{sum(new.values()):.0f}", f"{sum(new.values()) / reference:.0f}",
                         minutes(took)])
            before = now
        rows.append(["both", len(before), f"{sum(before.values()):.0f}", f"{sum(before.values()) / reference:.0f}",
                     minutes(total)])
        slowest = sorted(before.items(), key=lambda item: -item[1])[:10]
    return (studies.table(["command", "objects", "object seconds", "reference objects", "on the clock"], rows) + "\n\nThe slowest objects: " +
            "; ".join(f"{short(name)}, {value:.0f} s" for name, value in slowest) + ".")


if __name__ == "__main__":
    if sys.argv[1:] == ["log"]:
        log()
    elif sys.argv[1:2] == ["--check"]:
        sys.exit(0 if check(sys.argv[2]) else 1)
    else:
        studies.main(__file__, {"commands": commands})
