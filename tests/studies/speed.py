"""What takes how long: the benchmarks, in the words of a table, and whole processes.

benchmarks  tests/benchmarks/README.md; two minutes; needs pushid-benchmarks (-DPUSHID_BENCHMARKS=ON, the default)
processes   tests/benchmarks/README.md; a minute
batch       tests/benchmarks/README.md; a batch of 101 fits; a minute
against     tests/benchmarks/README.md; this commit's fits and another's, whose folder of programs PUSHID_BIN_BEFORE
            names; three minutes

Times on one core, busy with nothing else if they are to be compared.
"""
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile

import studies
from studies import number

# Row of the table, and the benchmarks whose times stand in it.
ROWS = [
    ("one step of the model / with feet that hold and step", ["IpmStep", "IpmStepOfStance"]),
    ("one rollout of 72 frames", ["RolloutOfDoubles"]),
    ("Jacobian of the 32 recordings by forward sensitivities, P = 6 / 12 / 64",
     [f"JacobianBySensitivities/{p}" for p in (6, 12, 64)]),
    ("the same by Jets, stride 4", [f"JacobianByJets<4>/{p}" for p in (6, 12, 64)]),
    ("the same by Jets, full width", ["JacobianByJets<6>/6", "JacobianByJets<12>/12", "JacobianByJets<28>/64"]),
    ("solve of the 32 recordings, `tail` / `ldp`", ["SolveOnly/tail", "SolveOnly/ldp"]),
    ("the same 32 by the innovation likelihood, `tail`", ["SolveByInnovations"]),
    ("fit with uncertainty and behaviour, `tail` / `ldp`", ["WholeFit/tail", "WholeFit/ldp"]),
    ("Jacobian of the 49 recordings of groups: contact / with linear self forces / and drive",
     [f"GroupJacobian/{c}" for c in ("contact", "linear_and_contact", "linear_contact_drive")]),
    ("bodies of 13 people, a frame: `rigid` / `window` / `cvae`", ["RestoreRigid", "RestoreWindow", "RestoreCvae"]),
    ("96 frames of a group by diffusion, one sample of 25 steps: 5 / 13 people",
     ["BM_DiffusionSample/5", "BM_DiffusionSample/13"]),
    ("Jacobian of the 32 recordings with a network: `mlp:4` / `gru:4`",
     ["NetworkJacobian/mlp:4", "NetworkJacobian/gru:4"]),
    ("one second of a crowd of 1,000 / 10,000 people who touch",
     [f"CrowdSecond/people:{n}/threads:1/real_time" for n in (1000, 10000)]),
    ("learning from first frames: one frame / a prediction after 30 / a whole recording",
     ["OnlineObserve", "OnlinePredict", "OnlineRecording"]),
    ("reading a BVH file / C3D / TRC / CSV", [f"BM_Read{f}" for f in ("BvhHipAndAnkles", "C3d", "Trc", "Csv")]),
]


def benchmarks():
    names = "|".join(name for _, needed in ROWS for name in needed)
    report = studies.run("pushid-benchmarks", f"--benchmark_filter=^({names})$", "--benchmark_format=json", out=None)
    times = {b["name"]: b for b in json.loads(report.text)["benchmarks"]}
    rows = []
    for title, needed in ROWS:
        cells = []
        for name in needed:
            found = times[name]
            if "bytes_per_second" in found:
                cells.append(f"{number(found['bytes_per_second'] / 1e6)} MB/s")
            elif "per_frame" in found:
                cells.append(f"{number(1e3 * found['per_frame'])} ms")
            else:
                cells.append(f"{number(found['cpu_time'])} {found['time_unit']}")
        rows.append([title, " / ".join(cells)])
    return studies.table(["what", "processor time"], rows)


def processor_seconds_once(*command):
    """Of a process and its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True,
                   env=dict(os.environ, OPENBLAS_NUM_THREADS="1"))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def processor_seconds(*command):
    """Median of three runs."""
    return statistics.median(processor_seconds_once(*command) for _ in range(3))


def processes():
    fit = [os.path.join(studies.BIN, "pushid-fit"), f"--recordings={studies.MANIFEST}", "--setting=single"]
    report = [os.path.join(studies.BIN, "pushid-report"), f"--model={studies.fit('single').path}",
              f"--recordings={studies.MANIFEST}"]

    def told(*command):
        return f"{number(processor_seconds(*command), 2)} s"

    with tempfile.TemporaryDirectory() as folder:
        page = os.path.join(folder, "report.html")
        rows = [["`pushid-fit --setting=single`", told(*fit)],
                ["... `--preset=ldp`", told(*fit, "--preset=ldp")],
                ["... `--profile`", told(*fit, "--profile")],
                ["... `--bootstrap=199`", told(*fit, "--bootstrap=199")],
                ["`pushid-report --html_out`", told(*report, f"--html_out={page}")]]
        size = os.path.getsize(page) / 1e6
    text = studies.table(["the 32 recordings of single people, one thread", "processor time"], rows)
    return f"{text}\n\nThe page has {number(size)} MB."


PLAN = """[data]
recordings = "{manifest}"
setting = "single"
[jobs]
group_by = "none"
bootstrap = 100
[[variant]]
name = "tail"
flags = ["--preset=tail"]
[output]
dir = "out"
"""


def batch():
    with tempfile.TemporaryDirectory() as folder:
        plan = os.path.join(folder, "plan.toml")
        with open(plan, "w", encoding="utf-8") as file:
            file.write(PLAN.format(manifest=studies.MANIFEST))
        command = [os.path.join(studies.BIN, "pushid-batch"), f"--plan={plan}", "--jobs=1"]
        seconds = processor_seconds(*command, "--resume=false")
        jobs = len(os.listdir(os.path.join(folder, "out/jobs")))
    return (f"`pushid-batch --jobs=1` runs {jobs} fits of the 32 recordings of single people (one, and "
            f"{jobs - 1} bootstrap replicas), each in a process of its own, in {number(seconds)} s of processor time.")


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        lines = dict(line.split(":", 1) for line in file if ":" in line)
    names = {name.strip(): value for name, value in lines.items()}
    return f"{names['model name'].strip()}, {os.cpu_count()} cores"


def against():
    """In turns, so that what else the machine does hits both alike."""
    folder = os.environ.get("PUSHID_BIN_BEFORE")
    if not folder:
        sys.exit("speed.py: against needs PUSHID_BIN_BEFORE, the folder of the other commit's programs")
    rows = []
    for title, runs, flags in [
            ("the 32 recordings of single people, `--setting=single`", 9, ["--setting=single"]),
            ("... `--bootstrap=99`", 3, ["--setting=single", "--bootstrap=99"]),
            ("... `--profile`", 1, ["--setting=single", "--profile"]),
            ("the 49 recordings of groups, `--setting=groups`", 3, ["--setting=groups"])]:
        seconds = {folder: [], studies.BIN: []}
        for _ in range(runs):
            for programs, times in seconds.items():
                command = [os.path.join(programs, "pushid-fit"), f"--recordings={studies.MANIFEST}", "--quiet", *flags]
                times.append(processor_seconds_once(*command))
        before, now = (statistics.median(times) for times in seconds.values())
        rows.append([title, f"{number(before, 2)} s", f"{number(now, 2)} s", f"{number(before / now, 2)}"])
    text = studies.table(["a whole `pushid-fit`, one thread, medians of processor time", "before", "now", "ratio"], rows)
    return f"{text}\n\nMeasured on {machine()}."


if __name__ == "__main__":
    studies.main(__file__, {"benchmarks": benchmarks, "processes": processes, "batch": batch, "against": against})
