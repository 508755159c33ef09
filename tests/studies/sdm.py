"""Social Diffusion (Tanke et al., ICCV 2023) as published, pushid-train-generator --published=sdm (models/generators/README.md).

table1   its Tables 1 and 2: total, root and pose errors up to 1, 2 and 3 s, of pushed groups and of people who talk in turns
table3   its Table 3: states and words of motion, of recordings trained on and left out; recorded states of both
table4   its Tables 4 and 5: how people see each other (mean, attention, not at all), on recordings left out
times    how long the trainings of these tables took

Pushed groups are the published ones (PUSHID_RECORDINGS), fold 3 left out; those who talk are made by simulate-others
--turns, the last four left out, with the true states. PUSHID_SDM_STEPS is the number of training steps (default 1500, the
full length). Forecasts are given 20 frames. MRT is that of peers.py, trained for a tenth of its length; without PyTorch its
row is missing.
"""
import math
import os
import sys

import studies
from diffusion import of_fold
from studies import number

STEPS = os.environ.get("PUSHID_SDM_STEPS", "1500")
TURNS = os.path.join(studies.KEPT, "turns")
LEFT_OUT = ",".join(f"turns_{i}" for i in range(13, 17))
POOLINGS = [("mean (as published)", "mean_all"), ("attention, `--pooling=heads`", "heads"), ("none, `--pooling=none`", "none")]


class Pushed:
    title, given = "pushed groups", []

    @staticmethod
    def left_out():
        return of_fold(3)

    @staticmethod
    def run(program, *flags, **options):
        return studies.on_recordings(program, "groups", *flags, **options)


class Talking:
    title, given = "who talk in turns", [f"--states={TURNS}/states.csv"]

    @staticmethod
    def left_out():
        return LEFT_OUT

    @staticmethod
    def run(program, *flags, **options):
        if not os.path.exists(os.path.join(TURNS, "manifest.json")):
            studies.run("simulate-others", "--turns=16", "--frames=240", f"--out={TURNS}", out=None, keep=False)
        return studies.run(program, f"--recordings={TURNS}/manifest.json", *flags, **options)


DATA = [Pushed, Talking]


def train(data, pooling):
    return data.run("pushid-train-generator", "--published=sdm", f"--steps={STEPS}", f"--pooling={pooling}",
                    f"--leave_out={data.left_out()}", "--quiet", out="out")


def forecast(data, pooling, chosen=None):
    return data.run("pushid-generate", f"--model={train(data, pooling).path}", "--published=sdm", "--steps=25",
                    "--observed=20", *data.given, chosen or f"--ids={data.left_out()}", "--quiet").json


def mrt(data):
    try:
        import peers
    except SystemExit as skipped:
        print(skipped, file=sys.stderr)
        return []
    return [[data.title, "MRT", *map(share, peers.at_seconds(data.left_out().split(",")))]]


def share(value):
    return "none" if value is None else number(value)


def at(scores):
    return [share(row[part]) for part in ("total_m", "root_m", "pose_m") for row in scores["errors_at"]]


AT = [f"{part}, to {s} s" for part in ("total", "root", "pose") for s in (1, 2, 3)]


def table1():
    rows = []
    for data in DATA:
        json = forecast(data, "mean_all")
        rows.append([data.title, "SDM", *at(json)])
        if data is Pushed:
            rows += mrt(data)
        for name, key in (("last poses held", "static"), ("constant velocity", "constant_velocity")):
            rows.append([data.title, name, *at(json["baselines"][key])])
    return studies.table([f"left out; mean error, m; {STEPS} steps", "", *AT], rows)


def social(json):
    row = json["social"]["by"]["generator"]
    return [share(row[key]) for key in ("sscp", "ndms")]


def distance(*counts):
    """Jensen and Shannon's, of two matrices of transitions (SSCP)."""
    p, q = ([v / sum(map(sum, of)) for row in of for v in row] for of in counts)
    return math.sqrt(sum(0.5 * a * math.log(2 * a / (a + b)) for x in (zip(p, q), zip(q, p)) for a, b in x if a > 0))


def table3():
    rows = []
    for data in DATA:
        transitions = []
        for name, chosen in (("trained on", f"--leave_out={data.left_out()}"), ("left out", None)):
            json = forecast(data, "mean_all", chosen)
            recorded = json["social"]["by"]["recorded"]
            transitions.append(json["social"]["transitions"])
            rows.append([data.title, name, *social(json), number(json["mean"]["MPJPE_m"]), share(recorded["sscp"])])
        rows.append([data.title, "recorded, both against each other", number(distance(*transitions)), None, None, None])
    return studies.table([f"SDM, {STEPS} steps", "", "SSCP", "NDMS", "MPJPE, m",
                          "SSCP of recorded motion, states found"], rows)


def table4():
    rows = []
    for data in DATA:
        for name, pooling in POOLINGS:
            json = forecast(data, pooling)
            rows.append([data.title, name, *social(json), number(json["mean"]["MPJPE_m"]), *at(json)[:2]])
    return studies.table([f"left out; {STEPS} steps", "people see each other by", "SSCP", "NDMS", "MPJPE, m",
                          *AT[:2]], rows)


def times():
    rows = [[data.title, name, f"{train(data, pooling).seconds:.0f}"] for data in DATA for name, pooling in POOLINGS]
    return studies.table([f"training of {STEPS} steps", "", "processor time, s"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"table1": table1, "table3": table3, "table4": table4, "times": times})
