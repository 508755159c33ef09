"""What are the pendulum and the two halves of the body worth? Restorations with parts left out, four folds, one seed.

table     the five metrics of every variant, single and groups (models/restoration/README.md); an hour and a half of one core
strength  MPJPE by the strength of the push (models/restoration/README.md); the same runs

The runs are two plans of pushid-batch, ablation_single.toml and ablation_groups.toml: in every fold pendulum, its
out-of-fold predictions and networks are made anew from the other recordings. Without a pendulum `window` has the first pose
and the push, `cvae` the pose before (three draws of z a frame, averaged). `cvae` is trained for a quarter of its steps
(--effort=0.25), and nothing is post-processed, which would hold the bones for every variant. Differences with and without
are paired by recording, their errors clustered by the pushed person. What was run stays in build/ablation; remove it to run
anew. Needs pushid-train-restoration, which is built where LibTorch is found.
"""
import collections
import json
import math
import os
import statistics
import subprocess

import studies
from studies import number, with_error

METRICS = [("MPJPE_m", "MPJPE, m"), ("hipADE_m", "hipADE, m"), ("hipFDE_m", "hipFDE, m"), ("MBLE_m", "MBLE, m"),
           ("FSE_cm", "FSE, cm a frame")]
SETTINGS = ["single", "groups"]
VARIANTS = ["window", "cvae, one network", "cvae, lower then upper"]  # in the plans also with ", no pendulum"


def scores(setting):
    """Variant -> recording -> scores of the fold that held it out."""
    plan = os.path.join(studies.SOURCE, f"tests/studies/ablation_{setting}.toml")
    subprocess.run([os.path.join(studies.BIN, "pushid-batch"), f"--plan={plan}", f"--jobs={os.cpu_count()}", "--quiet"],
                   check=True, stdout=subprocess.DEVNULL)
    folder = os.path.join(studies.SOURCE, f"build/ablation/{setting}")
    found = collections.defaultdict(dict)
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        for job in json.load(file)["jobs"]:
            with open(os.path.join(folder, "jobs", job["id"], "scores.json"), encoding="utf-8") as one:
                for recording in json.load(one)["recordings"]:
                    found[job["variant"]][recording["id"]] = recording
    return found


def manifest():
    with open(studies.MANIFEST, encoding="utf-8") as file:
        return {e["id"]: e for e in json.load(file)["recordings"]}


def both(found, variant):
    """The scores without and with the pendulum, of the recordings that both could be scored on."""
    without, with_pendulum = found[f"{variant}, no pendulum"], found[variant]
    ids = [i for i in with_pendulum if "MPJPE_m" in with_pendulum[i] and "MPJPE_m" in without[i]]
    return [without[i] for i in ids], [with_pendulum[i] for i in ids]


def mean(rows, metric):
    return statistics.mean(row[metric] for row in rows)


def paired(without, with_pendulum, metric, entries):
    """Mean of the differences between recordings and its error, clustered by the pushed person."""
    differences = {a["id"]: a[metric] - b[metric] for a, b in zip(without, with_pendulum)}
    average = statistics.mean(differences.values())
    clusters = collections.defaultdict(float)
    for one, difference in differences.items():
        entry = entries[one]
        clusters[entry["subjects"][entry.get("pushed_person", 0)]["id"]] += difference - average
    count = len(clusters)
    error = math.sqrt(count / (count - 1) * sum(s * s for s in clusters.values())) / len(differences)
    return average, error


def table():
    rows, entries = [], manifest()
    for setting in SETTINGS:
        found = scores(setting)
        for variant in VARIANTS:
            without, with_pendulum = both(found, variant)
            for title, of in [("no pendulum", without), ("pendulum", with_pendulum)]:
                first = METRICS[0][0]
                error = statistics.stdev(row[first] for row in of) / math.sqrt(len(of))
                rows.append([setting, f"`{variant}`", title, with_error(mean(of, first), error),
                             *[number(mean(of, key)) for key, _ in METRICS[1:]]])
            rows.append([setting, f"`{variant}`", "difference",
                         *[with_error(*paired(without, with_pendulum, key, entries)) for key, _ in METRICS]])
    return studies.table(["", "", "", *[title for _, title in METRICS]], rows)


def strength():
    rows, entries = [], manifest()
    for setting in SETTINGS:
        found = scores(setting)
        for variant in VARIANTS:
            without, with_pendulum = both(found, variant)
            for magnitude in sorted({entries[row["id"]]["magnitude"] for row in without}):
                def of(rows_of):
                    return [row for row in rows_of if entries[row["id"]]["magnitude"] == magnitude]
                cells = [number(mean(of(one), key)) for key, _ in METRICS[:3] for one in (without, with_pendulum)]
                rows.append([setting, f"`{variant}`", magnitude, *cells])
    header = [f"{title.split(',')[0]} {which}" for _, title in METRICS[:3] for which in ("without", "with")]
    return studies.table(["", "", "push", *header], rows)


if __name__ == "__main__":
    studies.main(__file__, {"table": table, "strength": strength})
