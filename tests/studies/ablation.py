"""What are the pendulum and the two halves of the body worth? Restorations with parts left out, four folds, one seed.

table     the five metrics of every variant, single and groups (models/restoration/README.md); an hour of one core
strength  MPJPE by the strength of the push (models/restoration/README.md); the same runs

In every fold pendulum, its out-of-fold predictions and networks are made anew from the other recordings. Without a
pendulum `window` has the first pose and the push, `cvae` the pose before (three draws of z a frame, averaged). `cvae` is
trained for a quarter of its steps (--effort=0.25). Differences with and without are paired by recording, their errors
clustered by the pushed person. Needs pushid-train-restoration, which is built where LibTorch is found.
"""
import collections
import json
import math
import statistics

import studies
from studies import number, with_error

METRICS = [("MPJPE_m", "MPJPE, m"), ("hipADE_m", "hipADE, m"), ("hipFDE_m", "hipFDE, m"), ("MBLE_m", "MBLE, m"),
           ("FSE_cm", "FSE, cm a frame")]
CVAE = ["--kind=cvae", "--effort=0.25"]
WHOLE = ["--nohalves"]
VARIANTS = [  # name, flags with the pendulum
    ("`window`", ["--kind=window"]),
    ("`cvae`, one network", CVAE + WHOLE),
    ("`cvae`, lower then upper", CVAE),
]
SETTINGS = {"single": [], "groups": ["--preset=group"]}


def crossvalidate(setting, flags):
    model = studies.fit(setting, *SETTINGS[setting]).path
    # Post-processing would hold the bones for every variant: the networks are to be seen.
    return studies.on_recordings("pushid-train-restoration", setting, f"--model={model}", "--crossvalidate=4",
                                 "--postprocess=none", "--quiet", *flags).json


def pushed_people():
    with open(studies.MANIFEST, encoding="utf-8") as file:
        return {e["id"]: e["subjects"][e.get("pushed_person", 0)]["id"] for e in json.load(file)["recordings"]}


def paired(without, with_pendulum, metric):
    """Mean of the differences between recordings and its error, clustered by the pushed person."""
    there = {r["id"]: r[metric] for r in with_pendulum["recordings"] if metric in r}
    people = pushed_people()
    differences = {r["id"]: r[metric] - there[r["id"]] for r in without["recordings"]
                   if metric in r and r["id"] in there}
    mean = statistics.mean(differences.values())
    clusters = collections.defaultdict(float)
    for one, difference in differences.items():
        clusters[people[one]] += difference - mean
    count = len(clusters)
    error = math.sqrt(count / (count - 1) * sum(s * s for s in clusters.values())) / len(differences)
    return mean, error


def both(setting, flags):
    return crossvalidate(setting, flags + ["--sees=pose"]), crossvalidate(setting, flags)


def table():
    rows = []
    for setting in SETTINGS:
        for name, flags in VARIANTS:
            without, with_pendulum = both(setting, flags)
            for title, found in [("no pendulum", without), ("pendulum", with_pendulum)]:
                m = found["mean"]
                rows.append([setting, name, title, with_error(m["MPJPE_m"], m["MPJPE_standard_error_m"]),
                             *[number(m[key]) for key, _ in METRICS[1:]]])
            rows.append([setting, name, "difference",
                         *[with_error(*paired(without, with_pendulum, key)) for key, _ in METRICS]])
    return studies.table(["", "", "", *[title for _, title in METRICS]], rows)


def strength():
    rows = []
    for setting in SETTINGS:
        for name, flags in VARIANTS:
            without, with_pendulum = both(setting, flags)
            for magnitude in with_pendulum["by_magnitude"]:
                cells = [f"{number(found['by_magnitude'][magnitude][key])}" for key, _ in METRICS[:3]
                         for found in (without, with_pendulum)]
                rows.append([setting, name, magnitude, *cells])
    header = [f"{title.split(',')[0]} {which}" for _, title in METRICS[:3] for which in ("without", "with")]
    return studies.table(["", "", "push", *header], rows)


if __name__ == "__main__":
    studies.main(__file__, {"table": table, "strength": strength})
