"""What takes how long: the benchmarks, in the words of a table, and whole processes.

benchmarks  tests/benchmarks/README.md; two minutes; needs pushid-benchmarks (-DPUSHID_BENCHMARKS=ON, the default)
crowds      tests/benchmarks/README.md; two minutes; needs pushid-benchmarks
processes   tests/benchmarks/README.md; two minutes
batch       tests/benchmarks/README.md; a batch of 101 fits; half a minute
rivals      tests/benchmarks/README.md; the same fit in SciPy and PyTorch (python3-scipy, python3-torch); a minute
limits      tests/benchmarks/README.md; what the processor could do in the same time; half a minute
derivatives tests/benchmarks/README.md; whole fits by the quickest derivatives and by autodiff alone, and of earlier programs
            where PUSHID_BEFORE names their folder; five minutes

Times on one core, busy with nothing else if they are to be compared.
"""
import json
import os
import re
import resource
import statistics
import subprocess
import tempfile
import time

import studies
from studies import number

# Row of the table, and the benchmarks whose times stand in it.
ROWS = [
    ("one step of the model / with feet that step", ["IpmStep", "IpmStepOfStance"]),
    ("one rollout of 72 frames", ["RolloutOfDoubles"]),
    ("Jacobian of the 32 recordings by autodiff, P = 6 / 12 / 64",
     [f"JacobianByAutodiff/{p}" for p in (6, 12, 64)]),
    ("normal equations of the 32 recordings side by side, `tail` (8 columns): 256-bit / 128",
     [f"EquationsSideBySide/0/{w}" for w in (1, 0)]),
    ("Jacobian by Ceres' Jets, stride 4", [f"JacobianByJets<4>/{p}" for p in (6, 12, 64)]),
    ("Jacobian by Ceres' Jets, full width", ["JacobianByJets<6>/6", "JacobianByJets<12>/12", "JacobianByJets<28>/64"]),
    ("solve of the 32 recordings, `tail` / `ldp`", ["SolveOnly/tail", "SolveOnly/ldp"]),
    ("the same 32 by the innovation likelihood, `tail`", ["SolveByInnovations"]),
    ("fit with uncertainty and behaviour, `tail` / `ldp`", ["WholeFit/tail", "WholeFit/ldp"]),
    ("Jacobian of the 49 recordings of groups: contact / with linear self forces",
     [f"GroupJacobian/{c}" for c in ("contact", "linear_and_contact")]),
    ("bodies of 13 people, a frame: `rigid` / `window` / `cvae`", ["RestoreRigid", "RestoreWindow", "RestoreCvae"]),
    ("96 frames of a group by diffusion, one sample of 25 steps: 5 / 13 people",
     ["BM_DiffusionSample/5", "BM_DiffusionSample/13"]),
    ("Jacobian of the 32 recordings with a network: `mlp:4`", ["NetworkJacobian/mlp:4"]),
    ("one second of a crowd of 1,000 / 10,000 people who touch",
     [f"CrowdSecond/people:{n}/real_time" for n in (1000, 10000)]),
    ("the same of 10,000 whose feet step", ["CrowdSecondOfSteps/people:10000/real_time"]),
    ("the same of 10,000 who do not touch", ["CrowdSecondWithoutContact/people:10000/real_time"]),
    ("learning from first frames: one frame / a prediction after 30 / a whole recording",
     ["OnlineObserve/1", "OnlinePredict/1", "OnlineRecording"]),
    ("without an end: a frame and the second after it, when 20 / 2,000 / 20,000 were seen",
     [f"OnlineFrameAfter/{n}" for n in (20, 2000, 20000)]),
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


def crowds():
    rows = []
    for people in (100, 1_000, 10_000, 100_000, 1_000_000):
        command = [os.path.join(studies.BIN, "pushid-benchmarks"), "--benchmark_format=json",
                   f"--benchmark_filter=^CrowdSecond/people:{people}/real_time$"]
        out = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
        steps = f"{number(json.loads(out)['benchmarks'][0]['person_steps'] / 1e6, 2)} million"
        most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss  # kB, of the largest so far
        rows.append([f"{people:,}", steps, f"{number(most / 1e3)} MB"])
    return studies.table(["people, 0.45 m apart", "person-steps a second", "memory of the process"], rows)


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
    groups = [*fit[:-1], "--setting=groups"]
    validate = [os.path.join(studies.BIN, "pushid-crossvalidate"), *fit[1:], "--folds=4", "--repeats=5"]
    report = [os.path.join(studies.BIN, "pushid-report"), f"--model={studies.fit('single').path}",
              f"--recordings={studies.MANIFEST}"]

    def told(*command):
        return f"{number(processor_seconds(*command), 2)} s"

    with tempfile.TemporaryDirectory() as folder:
        page = os.path.join(folder, "report.html")
        rows = [["`pushid-fit --setting=single`", told(*fit)],
                ["... `--preset=ldp`", told(*fit, "--preset=ldp")],
                ["`pushid-crossvalidate --folds=4 --repeats=5`", told(*validate)],
                ["`pushid-report --html_out`", told(*report, f"--html_out={page}")],
                ["`pushid-fit --setting=groups`, the 49 recordings of groups", told(*groups)]]
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
        begin = time.perf_counter()
        subprocess.run([os.path.join(studies.BIN, "pushid-batch"), f"--plan={plan}", "--jobs=1"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        seconds = time.perf_counter() - begin
        with open(os.path.join(folder, "out/summary.json"), encoding="utf-8") as file:
            jobs = [job["run"]["seconds"] for job in json.load(file)["jobs"]]
    return (f"`pushid-batch --jobs=1` runs {len(jobs)} fits of the 32 recordings of single people (one, and "
            f"{len(jobs) - 1} bootstrap replicas), each in a process of its own, in {number(seconds)} s: "
            f"{number(sum(jobs))} s in these processes, {number(1e3 * (seconds - sum(jobs)) / len(jobs), 2)} ms a job "
            "beside them.")


def solve_seconds(*flags, setting="single"):
    fit = studies.on_recordings("pushid-fit", setting, *flags, "--quiet", out="model_out", keep=False)
    return fit.json["run"]["solve_seconds"]


def rivals():
    """One start each; the physics, recordings and six parameters of the published PD model."""
    def script(name, *flags):
        return ["/usr/bin/python3", os.path.join(studies.SOURCE, f"tests/benchmarks/{name}_pd_fit.py"), studies.MANIFEST,
                "--start=textbook", *flags]

    def told(name, *flags):  # "... 58 evaluations, 3.91 s"
        printed = subprocess.run(script(name, *flags), check=True, stdout=subprocess.PIPE, text=True,
                                 env=dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")).stdout
        return float(re.search(r"evaluations, ([0-9.]+) s", printed).group(1))

    six_parameters = ["--preset=ldp", "--friction=anisotropic", "--free=mu_y", "--gain_scaling=mass"]
    fit = [os.path.join(studies.BIN, "pushid-fit"), f"--recordings={studies.MANIFEST}", "--setting=single"]
    groups = [*fit[:-1], "--setting=groups"]
    times = {"`pushid-fit --preset=ldp`, with six parameters": ([], []), "`pushid-fit`, its default of 6 parameters and 2 pooled": ([], []),
             "SciPy, `least_squares`, plain squares": ([], []), "SciPy, the same with a robust loss": ([], []),
             "PyTorch, autograd and `LBFGS`": ([], []), "`pushid-fit --setting=groups`": ([], [])}
    for _ in range(5):  # in turns
        for (solves, processes_of), (solve, command) in zip(times.values(), [
                (lambda: solve_seconds(*six_parameters), [*fit, *six_parameters]), (solve_seconds, fit),
                (lambda: told("scipy", "--loss=linear"), script("scipy", "--loss=linear")),
                (lambda: told("scipy"), script("scipy")), (lambda: told("torch"), script("torch")),
                (lambda: solve_seconds("--num_threads=1", setting="groups"), [*groups, "--num_threads=1"])]):
            solves.append(solve())
            processes_of.append(processor_seconds_once(*command))
    rows = [[title, *(f"{number(statistics.median(of), 2)} s" for of in found)] for title, found in times.items()]
    return (studies.table(["", "the solve alone", "the whole process"], rows) +
            f"\n\nMedians of five, in turns, one thread; {machine()}.")


def derivatives():
    """Whole fits, medians of five in turns."""
    before = os.environ.get("PUSHID_BEFORE")
    with tempfile.TemporaryDirectory() as folder:
        laboratory = os.path.join(folder, "laboratory")
        manifest = f"--recordings={laboratory}/manifest.json"

        def run(program, *flags):
            subprocess.run([os.path.join(studies.BIN, program), *flags], check=True, stdout=subprocess.DEVNULL)

        run("simulate-others", "--laboratory=4", "--seed=1", f"--out={laboratory}")
        ids = ",".join(sorted(name[:-4] for name in os.listdir(os.path.join(laboratory, "force"))))
        run("pushid-push", manifest, f"--ids={ids}", f"--sensor={laboratory}/force/{{id}}.csv",
            f"--out={laboratory}/push/{{id}}.csv", "--update", "--overwrite")
        single = [f"--recordings={studies.MANIFEST}", "--setting=single"]
        fits = {"the 32 recordings": single, "the 49 recordings of groups": [single[0], "--setting=groups"],
                "... 32, `--self_force=mlp:4`": [*single, "--self_force=mlp:4"],
                "... 32, `--delay=one`": [*single, "--delay=one"],
                "who stand on platforms, `--stance=fixed --delay=one`":
                    [manifest, "--setting=standing", "--stance=fixed", "--delay=one"]}
        kinds = {"auto": [studies.BIN, []], "autodiff": [studies.BIN, ["--derivatives=autodiff"]]}
        if before:
            kinds["before"] = [before, []]
        rows = []
        for title, flags in fits.items():
            seconds = {kind: [] for kind in kinds}
            for _ in range(5):
                for kind, (programs, more) in kinds.items():
                    command = [os.path.join(programs, "pushid-fit"), *flags, *more, "--quiet", "--num_threads=1"]
                    seconds[kind].append(processor_seconds_once(*command))
            rows.append([title, *(f"{number(statistics.median(of), 3)} s" for of in seconds.values())])
    return f"{studies.table(['', *kinds], rows)}\n\nMedians of five, in turns, one thread; {machine()}."


SOLVING = ("starts and horizons", "weights", "settling")  # purposes of run.work
LANES = {"cost of": "CostsSideBySide", "normal equations of": "EquationsSideBySide"}


def limits():
    """Sums and products alone, at the rate of products of small matrices (lane_benchmark.cc); a group's by the step of a
    person alone, times 1 + columns: contact, quotients and roots come on top."""
    names = "|".join(f"{name}/0/1" for name in LANES.values())
    report = studies.run("pushid-benchmarks", f"--benchmark_filter=^({names})$", "--benchmark_format=json", out=None)
    of = {b["name"].split("/")[0]: b for b in json.loads(report.text)["benchmarks"]}
    peak = of["CostsSideBySide"]["peak"]
    rows = []

    def add(title, evaluations, operations, seconds):
        limit = operations / peak
        rows.append([title, evaluations, f"{number(operations / 1e6)} million", f"{number(1e3 * limit)} ms",
                     f"{number(1e3 * seconds)} ms", number(seconds / limit, 2)])

    for title, name in LANES.items():
        add(f"{title} the 32 recordings", "1", 1e6 * of[name]["million_operations"], 1e-3 * of[name]["cpu_time"])
    for setting, title in (("single", "the 32 recordings"), ("groups", "the 49 recordings of groups")):
        fit = studies.on_recordings("pushid-fit", setting, "--quiet", out="model_out", keep=False).json
        work = [w for w in fit["run"]["work"] if w["purpose"] in SOLVING]
        jacobians, costs = (sum(w[kind] for w in work) for kind in ("jacobians", "costs"))
        if setting == "single":
            operations = 1e6 * (jacobians * of["EquationsSideBySide"]["million_operations"] +
                                costs * of["CostsSideBySide"]["million_operations"])
        else:
            frames = sum(r["frames"] * r["people"] for r in fit["data"]["recordings"])
            columns = sum(p["status"] != "fixed" for p in fit["parameters"])
            operations = (frames * of["CostsSideBySide"]["operations_a_frame"] *
                          (jacobians * (1 + columns) + costs))
        add(f"a solve of {title}", f"{jacobians} / {costs}", operations, sum(w["seconds"] for w in work))
    text = studies.table(["", "normal equations / costs", "sums and products", "limit", "measured", "ratio"],
                         rows)
    return (f"{text}\n\nAt {number(peak / 1e9)} 10^9 sums and products a second, one core, "
            f"{of['CostsSideBySide']['label'].split(',')[0]}; {machine()}.")


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        lines = dict(line.split(":", 1) for line in file if ":" in line)
    names = {name.strip(): value for name, value in lines.items()}
    return f"{names['model name'].strip()}, {os.cpu_count()} cores"


if __name__ == "__main__":
    studies.main(__file__, {"benchmarks": benchmarks, "crowds": crowds, "processes": processes, "batch": batch,
                            "rivals": rivals, "limits": limits, "derivatives": derivatives})
