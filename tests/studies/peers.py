"""Forecasters without a pendulum and a push beside the chain of physics and bodies, cross-validated on the same folds.

groups    MRT, siMLPe and the chain on all groups, five folds (models/restoration/README.md); three quarters of an hour
sizes     what an epoch of MRT costs in its two sizes (models/restoration/README.md); five minutes

Peers are given everybody's first frames; the chain the first one and the push, and with --observed as many as MRT. Times
are those of one core. Needs pushid-train-restoration and pushid-train-generator, which are built where LibTorch is found.
"""
import json
import os
import re
import statistics

import studies
from studies import number, with_error

HEADER = ["held out, 5 folds", "given", "frames that count", "MPJPE, m", "hipADE, m", "hipFDE, m", "MBLE, m",
          "FSE, cm a frame", "training, s a fold (median)"]


def cells(name, given, frames, summary, seconds=None):
    m = summary["mean"]
    return [name, given, frames, with_error(m["MPJPE_m"], m["MPJPE_standard_error_m"]),
            with_error(m["hipADE_m"], m["hipADE_standard_error_m"]),
            with_error(m["hipFDE_m"], m["hipFDE_standard_error_m"]), f"{m['MBLE_m']:.4f}", f"{m['FSE_cm']:.2f}",
            seconds and number(seconds, 2)]


def crossvalidate(model, *flags):
    return studies.on_recordings("pushid-train-restoration", "groups", f"--model={model}", "--crossvalidate=5",
                                 "--quiet", *flags).json


def seconds(found):
    return statistics.median(found["run"]["training_seconds"])


def groups():
    model = studies.fit("groups", "--preset=group").path
    view = "--sees=neighbours"
    first, seen = crossvalidate(model, view), crossvalidate(model, view, "--observed=20")
    still = seen["baselines"]
    physics = f"physics and `window {view}`"
    rows = [cells("the last pose held", "20 frames", "after those", still["static"]),
            cells("constant velocity", "20 frames", "after those", still["constant_velocity"])]
    simlpe = studies.on_recordings("pushid-train-generator", "groups", "--kind=simlpe", "--dataset=pushes",
                                   "--crossvalidate=5", "--quiet").json
    mrt = crossvalidate(model, "--kind=mrt")
    for title, given, found, after, whole in [
            ("siMLPe", "12 frames", simlpe, simlpe, simlpe["baselines"]["generator_all_frames"]),
            ("MRT", "20 frames", mrt, mrt["baselines"]["mrt"], mrt["baselines"]["mrt_all_frames"])]:
        rows.append(cells(title, given, "after those", after, seconds(found)))
        rows.append(cells(title, given, "all", whole))
    rows.append(cells(physics, "1 frame, the push", "all", first, seconds(first)))
    rows.append(cells(physics, "20 frames, the push", "after those", seen))  # trained as before
    rows.append(cells(physics, "20 frames, the push", "all", still["restoration_all_frames"]))
    return studies.table(HEADER, rows)


def sizes():
    model = studies.fit("groups", "--preset=group").path
    rows = []
    for size in ("small", "published"):
        folder = os.path.join(studies.KEPT, f"mrt_{size}")
        out = studies.on_recordings("pushid-train-restoration", "groups", f"--model={model}", "--kind=mrt",
                                    f"--mrt_size={size}", "--effort=0.05", f"--out={folder}", "--quiet", out=None,
                                    keep=False)
        with open(os.path.join(folder, "restoration.json"), encoding="utf-8") as file:
            written = json.load(file)
        weights = sum(t["rows"] * t["columns"] for t in written["tensors"] if not t["name"].startswith("scaling"))
        curve = written["training"]["curve"]
        took = float(re.search(r", ([0-9.]+) s;", out.text)[1])
        rows.append([f"`--mrt_size={size}`", f"{weights / 1e6:.2f} million", number(took / len(curve), 2),
                     number(curve[-1]["held_out_loss"])])
    return studies.table(["", "weights", "s an epoch", f"held-out distance of joints after {len(curve)} epochs, m"],
                         rows)


if __name__ == "__main__":
    studies.main(__file__, {"groups": groups, "sizes": sizes})
