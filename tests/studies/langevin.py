"""People who are no clockwork: process noise and likelihoods of single steps (ident/uncertainty).

known      planted noise and gains, 50 studies: how often 95 % intervals of the innovation fit cover; 3 minutes
likelihood the 32 recordings of single people by each likelihood, with the time it took; seconds

Times are those of one core.
"""
import os
import tempfile
import time

import studies
from studies import with_error

TRUTH = {"sigma_x": 12, "sigma_y": 9, "sigma_theta": 6, "sigma_phi": 5}
NOISE = 0.002  # m, of every joint


def known():
    set_truth = ",".join(f"{name}={value}" for name, value in TRUTH.items())
    covered, apart = {}, {}
    for seed in range(1, 51):
        with tempfile.TemporaryDirectory() as folder:
            made = os.path.join(folder, "made")
            text = studies.run("pushid-simulate", f"--out={made}", "--people=4", f"--seed={seed}", f"--noise={NOISE}",
                               "--truth_noise=diagonal", f"--set={set_truth}", out=None, keep=False).text
            truth = {}
            for line in text.splitlines()[1:]:
                words = line.split()
                if len(words) >= 2 and words[0].replace("_", "").isalpha():
                    try:
                        truth[words[0]] = float(words[1])
                    except ValueError:
                        pass
            truth["measured_cart"], truth["measured_hip"] = NOISE / 2 ** 0.5, NOISE
            fit = studies.run("pushid-fit", f"--recordings={made}/manifest.json", "--likelihood=innovation", "--quiet",
                              out="model_out", keep=False).json
            for p in fit["parameters"]:
                if p["status"] == "fixed" or p["name"] not in truth:
                    continue
                lower, upper = p["interval_95"]
                covered.setdefault(p["name"], []).append(lower <= truth[p["name"]] <= upper)
                of = truth[p["name"]]
                apart.setdefault(p["name"], []).append(p["value"] / of - 1.0 if of != 0.0 else p["value"])
    rows = []
    for name, hits in covered.items():
        mean = sum(apart[name]) / len(apart[name])
        rows.append([f"`{name}`", f"{sum(hits)} of {len(hits)}",
                     f"{100 * mean:+.1f} %" if truth[name] != 0.0 else f"{mean:+.2g}"])
    every = [hit for hits in covered.values() for hit in hits]
    rows.append(["all", f"{sum(every)} of {len(every)} ({100 * sum(every) / len(every):.1f} %)", None])
    return studies.table(["planted", "95 % interval covers", "mean error"], rows)


SHOWN = ["mu", "Kp_theta", "a_x", "tail_gain", "tail_torque", "tail_time", "sigma_x", "sigma_theta", "measured_cart",
         "measured_hip"]


def likelihood():
    rows = []
    for name in ("trajectory", "transition", "innovation"):
        begin = time.time()
        model = studies.on_recordings("pushid-fit", "single", f"--likelihood={name}", "--num_threads=1", "--quiet",
                                      out="model_out", keep=False)
        seconds = time.time() - begin
        found = {p["name"]: p for p in model.json["parameters"]}
        cells = []
        for parameter in SHOWN:
            p = found.get(parameter)
            cells.append(None if p is None or p["status"] == "fixed" else with_error(p["value"], p["standard_error"]))
        score = model.json.get("likelihood")
        rows.append([f"`{name}`", *cells, None if score is None else f"{score['deviance']:.0f}", f"{seconds:.1f}"])
    return studies.table(["32 recordings of single people", *(f"`{p}`" for p in SHOWN), "-2 log L", "whole program, s"],
                         rows)


if __name__ == "__main__":
    studies.main(__file__, {"known": known, "likelihood": likelihood})
