"""What a build costs.

commands    tests/README.md; the two commands of README.md in a fresh clone, one after the other, without a
            compiler cache: a quarter of an hour

    python3 tests/studies/build.py log     of build/release as it stands: objects, seconds, the slowest ten

Object seconds are the time on the clock that Ninja noted for each object, added up; objects are compiled side by side.
"""
import os
import re
import subprocess
import sys
import tempfile
import time

import studies

COMMANDS = {"quickstart": "apps/quickstart.sh", "tests": "tests/run.sh"}


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


def log():
    build = os.path.join(studies.SOURCE, "build/release")
    seconds = objects(build)
    print(f"build: {len(seconds)} objects, {sum(seconds.values()):.0f} object seconds", flush=True)
    for name, value in sorted(seconds.items(), key=lambda item: -item[1])[:10]:
        print(f"  {value:5.1f} s  {short(name)}")


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
            rows.append([f"`bash {script}`", len(new), f"{sum(new.values()):.0f}", minutes(took)])
            before = now
        rows.append(["both", len(before), f"{sum(before.values()):.0f}", minutes(total)])
        slowest = sorted(before.items(), key=lambda item: -item[1])[:10]
    return (studies.table(["command", "objects", "object seconds", "on the clock"], rows) + "\n\nThe slowest objects: " +
            "; ".join(f"{short(name)}, {value:.0f} s" for name, value in slowest) + ".")


if __name__ == "__main__":
    if sys.argv[1:] == ["log"]:
        log()
    else:
        studies.main(__file__, {"commands": commands})
