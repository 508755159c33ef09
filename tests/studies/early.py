"""What the first frames of a new push tell (--observed).

All in ident/prediction/README.md.

first       errors from frame 0 and the push alone, beside the baselines; 2 minutes
single      errors of held-out recordings of single people after 1 to 45 frames, 5 x 4 folds; half a minute
person      the same, a person left out
groups      the forecast of groups, 5 folds; 6 minutes
thirds      each third of what is to come of single people, beside the best baseline; after single and person seconds
bands       share of hips inside 50 and 90 % bands, and CRPS; after person and groups seconds
forecasters each forecaster alone, a person left out; seconds
unseen      people of another simulator whose push goes on unseen (unseen_pushes.py; the Python module); a minute

Times are those of two cores.
"""
import json
import os
import sys

import studies
from studies import number, with_error

FRAMES = [1, 6, 12, 20, 30, 45]
SCHEMES = {"5 x 4 folds": ("single", ()), "a person left out": ("single", ("--scheme=subject",)),
           "groups, 5 folds": ("groups", ("--folds=5", "--repeats=1"))}
MODEL = {"single": "tail", "groups": "group"}


def moments(scheme):
    """Frames seen; of groups those from which on the filter has a word."""
    return FRAMES[3:] if SCHEMES[scheme][0] == "groups" else FRAMES


def longer_than(setting, frames):
    """--leave_out of the recordings that have no frame left."""
    with open(studies.MANIFEST, encoding="utf-8") as file:
        recordings = json.load(file)["recordings"]
    short = [r["id"] for r in recordings if (r["setting"] == "single") == (setting == "single") and r["frames"] <= frames]
    return [f"--leave_out={','.join(short)}"] if short else []


def predictors(scheme, observed, *arguments):
    setting, flags = SCHEMES[scheme]
    if setting == "groups":
        arguments += ("--yardsticks=false",)  # a minute instead of five
    out = studies.on_recordings("pushid-crossvalidate", setting, f"--observed={observed}", "--num_threads=2", *flags,
                                *longer_than(setting, observed), *arguments).json
    return out["predictors"], {d["to"]: d for d in out.get("paired_differences", [])}


def metric(mean, name, unit="m", sign=False):
    return with_error(mean[f"{name}_{unit}"], mean[f"{name}_standard_error_{unit}"], sign)


def errors(scheme):
    rows = []
    for k in moments(scheme):
        scored, differences = predictors(scheme, k)
        for i, p in enumerate(scored):
            mean = p["mean"]
            rows.append([k if i == 0 else None, "forecast" if i == 0 else p["name"], metric(mean, "hipADE"),
                         metric(mean, "after_hipADE"), metric(mean, "hipFDE"),
                         metric(differences[p["name"]], "after_hipADE", sign=True) if i else None])
            if k == 1:
                break  # baselines without any frame are in the first table
    return studies.table(["frames seen", "", "all frames, m", "frames after, m", "last, m", "after, minus forecast, m"],
                         rows)


def single():
    return errors("5 x 4 folds")


def person():
    return errors("a person left out")


def groups():
    return errors("groups, 5 folds")


def thirds():
    rows = []
    for scheme in [name for name, (setting, _) in SCHEMES.items() if setting == "single"]:
        for k in FRAMES[1:]:
            scored, _ = predictors(scheme, k)
            cells = []
            for third in ("first", "second", "last"):
                key = f"{third}_third_hipADE_m"
                best = min(scored[1:], key=lambda p: p["mean"][key])
                own, other = scored[0]["mean"][key], best["mean"][key]
                cells.append(f"{'**' if other < own else ''}{number(own)} / {number(other)} ({best['name']})"
                             f"{'**' if other < own else ''}")
            rows.append([scheme, k, *cells])
    return studies.table(["held out", "frames seen", "first third: forecast / best baseline, m", "second", "last"], rows)


def bands():
    rows = []
    for scheme in SCHEMES:
        for k in moments(scheme):
            mean = predictors(scheme, k)[0][0]["mean"]
            rows.append([scheme, k, *[metric(mean, f"inside{share}_{axis}", "share") for share in (50, 90) for axis in "xy"],
                         metric(mean, "crps")])
    return studies.table(["held out", "frames seen", "inside 50 %, x", "y", "inside 90 %, x", "y", "CRPS, m"], rows)


def forecasters():
    rows = []
    for k in FRAMES[1:]:
        means = [predictors("a person left out", k, "--yardsticks=false", f"--forecast={who}")[0][0]["mean"]
                 for who in ("physics", "input")]
        means.append(predictors("a person left out", k)[0][0]["mean"])
        rows.append([k, *[f"{number(m['after_hipADE_m'])} / {number(m['hipFDE_m'])}" for m in means]])
    return studies.table(["frames seen", "physics: after / last, m", "input", "both"], rows)


def first():
    rows = []
    cases = [("5 x 4 folds", "single", ()), ("a person left out", "single", ("--scheme=subject",)),
             ("strong pushes left out", "single", ("--scheme=strong",)),
             ("groups, 5 folds", "groups", ("--folds=5", "--repeats=1"))]
    for name, setting, flags in cases:
        scored = studies.on_recordings("pushid-crossvalidate", setting, "--num_threads=2", *flags).json["predictors"]
        rows.append([name, *[next((f"{metric(p['mean'], 'hipADE')} / {number(p['mean']['hipFDE_m'])}" for p in scored
                                   if p["name"] == who and (who != "template" or setting == "single")), None)
                             for who in (MODEL[setting], "template", "ridge", "constant velocity", "static")]])
    return studies.table(["held out", "physics: mean / last, m", "template", "ridge", "constant velocity", "static"], rows)


def unseen():
    sys.path.insert(0, os.path.join(os.path.dirname(studies.BIN), "python"))
    import numpy as np
    import pushid
    import unseen_pushes
    rows = []
    for hidden in (0.0, 0.5, 1.0, 2.0):
        errors_of = {"physics": [], "input": [], "both": []}
        for seed in range(4):
            recordings = []
            for i, (name, mass, (hip, left, right, push)) in enumerate(unseen_pushes.study(seed, hidden=hidden)):
                recordings.append(pushid.Recording(np.array(hip), np.array(left), np.array(right), mass=mass, fps=60,
                                                   push=np.array(push), push_height=1.0, id=f"{name}_{i}", subjects=name))
            people = sorted({r.subjects[0] for r in recordings})
            for left_out in people:
                result = pushid.fit([r for r in recordings if r.subjects[0] != left_out], stance="slide")
                result.learn_forecasts()
                for recording in recordings:
                    if recording.subjects[0] != left_out:
                        continue
                    for who, kept in errors_of.items():
                        hip = result.predict(recording, observed=20, forecast=who)["hip"]
                        kept.append(np.linalg.norm(hip[20:, 0] - recording.hip[20:, 0], axis=1).mean())
        rows.append([number(hidden, 2), len(errors_of["both"]),
                     *[number(float(np.mean(kept))) for kept in errors_of.values()]])
    return studies.table(["unknown force, m/s^2", "recordings", "after 20 frames: physics, m", "input", "both"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"first": first, "single": single, "person": person, "groups": groups, "thirds": thirds,
                            "bands": bands, "forecasters": forecasters, "unseen": unseen})
