"""Feet that hold and step (--stance=steps) against feet that slide.

single    errors on held-out recordings of single people, every scheme (models/README.md); 8 minutes
groups    the same of groups, with who moves for nothing (models/README.md); 10 minutes
heights   groups, by the height at which they touch (tests/studies/README.md); 10 minutes
external  75 kg pushed at hip and trunk as ten people were whose pushes were measured (models/README.md); seconds
values    what the fit of single people says of the feet (models/README.md); seconds
steps     who steps: AUC, Brier score, calibration, lift-off and first place, held out (ident/prediction/README.md);
          with single and groups
reliability  P(step) held out against the share that stepped (ident/prediction/README.md); with single and groups

Times are those of one core.
"""
import csv
import json
import math
import os

import studies
from studies import number, with_error

STANCE = "--stance=steps"
SCHEMES = [("5 x 4 folds", "stratified", ("--repeats=5",)), ("a person left out", "subject", ()),
           ("strong pushes left out", "strong", ())]
GROUP_SCHEMES = [("5 folds", "stratified", ("--folds=5", "--repeats=1")), ("a setting left out", "setting", ()),
                 ("strong pushes left out", "strong", ())]
HEIGHTS = [0.95, 1.05, 1.15, 1.25, 1.35]  # of contact, in lengths of the rod; the preset's is 0.95
# Means of 350 pushes of ten adults by hand at the trunk, from the public table of Jensen and others (Push-Recovery), bins of
# impulse over mass: that, m/s; duration, s; share that step; where who stands and who steps end, m; their peak speeds, m/s.
MEASURED = [(0.20, 0.60, 0.15, 0.02, 0.19, 0.16, 0.28), (0.29, 0.69, 0.31, 0.02, 0.22, 0.16, 0.28),
            (0.35, 0.73, 0.51, 0.02, 0.35, 0.17, 0.36), (0.41, 0.77, 0.57, 0.02, 0.47, 0.21, 0.36),
            (0.49, 0.81, 0.72, 0.01, 0.52, 0.21, 0.38), (0.62, 0.86, 0.88, 0.01, 0.68, 0.18, 0.45)]
MASS, ROD, FPS, SECONDS = 75, 0.95, 60, 8
HEIGHTS_OF_PUSH = {"hip": 1.0, "trunk": 1.25}  # in lengths of the rod


def compared(setting, scheme, *arguments):
    """Cross-validations by name, and their paired differences from the first."""
    out = studies.on_recordings("pushid-crossvalidate", setting, f"--scheme={scheme}", "--yardsticks=false",
                                "--stance=slide", *arguments, f"--compare=steps: {STANCE}").json
    scores = {p["name"]: p for p in out["predictors"][1:]}
    return {"slide": out["predictors"][0], **scores}, {d["to"]: d for d in out["paired_differences"]}


def groups_compared():
    return compared("groups", GROUP_SCHEMES[0][1], *GROUP_SCHEMES[0][2])


def error_cells(p):
    mean = p["mean"]
    return [with_error(mean["hipADE_m"], mean["hipADE_standard_error_m"]),
            with_error(mean["hipFDE_m"], mean["hipFDE_standard_error_m"]),
            f"{p['fits_that_settle']} of {p['fits']}"]


def difference_cell(name, differences):
    if name not in differences:
        return None
    d = differences[name]
    return with_error(d["hipADE_m"], d["hipADE_standard_error_m"], sign=True)


def single():
    rows = []
    for title, scheme, arguments in SCHEMES:
        scores, differences = compared("single", scheme, *arguments)
        for name, p in scores.items():
            rows.append([title, f"`{name}`", *error_cells(p), difference_cell(name, differences)])
    return studies.table(["32 recordings of single people", "feet", "hipADE, m", "hipFDE, m", "settle",
                          "hipADE - `slide`, m"], rows)


def groups():
    rows = []
    for title, scheme, arguments in GROUP_SCHEMES:
        scores, differences = compared("groups", scheme, *arguments)
        for name, p in scores.items():
            moves = p["propagation"]
            onset = moves["onset_error_frames"]
            rows.append([title, f"`{name}`", *error_cells(p), difference_cell(name, differences),
                         f"{moves['false_movers']:.3g} of {moves['bystanders']:.0f}",
                         f"{moves['missed_movers']:.3g} of {moves['movers']:.0f}",
                         with_error(onset["value"], onset["standard_error"])])
    return studies.table(["49 recordings of groups", "feet", "hipADE, m", "hipFDE, m", "settle", "hipADE - `slide`, m",
                          "false movers", "missed movers", "onset error, frames"], rows)


def heights():
    others = [f"--compare={h}: --fix=contact_height={h}" for h in HEIGHTS]
    rows = []
    for title, scheme, arguments in GROUP_SCHEMES:
        scores = studies.on_recordings("pushid-crossvalidate", "groups", f"--scheme={scheme}", "--yardsticks=false",
                                       *arguments, *others).json["predictors"][1:]
        rows.append([title, *(f"{p['mean']['hipADE_m']:.4f} / {p['mean']['hipFDE_m']:.3f}" for p in scores)])
    return studies.table(["held out: hipADE / hipFDE, m", *(f"contact at {h} rod lengths" for h in HEIGHTS)], rows)


def pushed_manifest():
    """Recordings of somebody who stands still, with the measured pushes as half-sines; their manifest."""
    folder = os.path.join(studies.KEPT, "external")
    os.makedirs(folder, exist_ok=True)
    points = {"hip": (0, 0, ROD), "left_ankle": (0, 0.1, 0), "right_ankle": (0, -0.1, 0)}
    with open(os.path.join(folder, "still.csv"), "w", encoding="utf-8") as file:
        file.write(",".join(["time", *(f"{name}_{axis}" for name in points for axis in "xyz")]) + "\n")
        still = ",".join(str(x) for place in points.values() for x in place)
        file.writelines(f"{t / FPS},{still}\n" for t in range(SECONDS * FPS + 1))
    recordings = []
    for velocity, duration, *_ in MEASURED:
        frames = round(duration * FPS)
        shape = [math.sin(math.pi * (t + 0.5) / frames) for t in range(frames)]
        newtons = MASS * velocity * FPS / sum(shape)
        with open(os.path.join(folder, f"{velocity}.csv"), "w", encoding="utf-8") as file:
            file.write("frame,fx,fy\n" + "".join(f"{t},{newtons * f},0\n" for t, f in enumerate(shape)))
        recordings += [{"id": f"{place}_{velocity}", "setting": "single", "pushed_person": 0, "length_unit": "m",
                        "subjects": [{"id": "person", "mass_kg": MASS}], "csv": ["still.csv"],
                        "push_csv": f"{velocity}.csv", "push_kind": "external", "push_height_m": height * ROD}
                       for place, height in HEIGHTS_OF_PUSH.items()]
    path = os.path.join(folder, "manifest.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"recordings": recordings}, file)
    return path


def external():
    manifest = pushed_manifest()
    rows = []
    for velocity, duration, share, stands, steps_to, slow, fast in MEASURED:
        row = [velocity, duration, share, f"{stands:.2f} / {steps_to:.2f}", f"{slow:.2f} / {fast:.2f}"]
        for stance in ("slide", "steps"):
            model = studies.fit("single", f"--stance={stance}").path
            ends, peaks, probabilities = [], [], []
            for place in HEIGHTS_OF_PUSH:
                predicted = studies.run("pushid-predict", f"--model={model}", f"--recordings={manifest}",
                                        f"--id={place}_{velocity}", out="out", ending="csv")
                with open(predicted.path, encoding="utf-8") as file:
                    path = list(csv.DictReader(file))
                hip = [float(frame["hip_x_m"]) for frame in path]
                ends.append(hip[-1] - hip[0])
                peaks.append(max(abs(b - a) for a, b in zip(hip, hip[1:])) * FPS)
                probabilities.append(float(path[0]["step_probability"]))
            row += [" / ".join(f"{round(value, 2) + 0.0:.2f}" for value in values)
                    for values in (probabilities, ends, peaks)]
        rows.append(row)
    return studies.table(["J/M, m/s", "in, s", "people who step", "they end: stand / step, m",
                          "peak: stand / step, m/s", "`slide`, hip / trunk: P(step)", "ends, m", "peak, m/s",
                          "`steps`, hip / trunk: P(step)", "ends, m", "peak, m/s"], rows)


def values():
    shared = {p["name"]: p for p in studies.fit("single", STANCE).json["parameters"]}
    rows = []
    for name in ("Kp_theta", "Kd_theta", "support_front", "foot_front", "step_gain", "step_onset", "step_swing"):
        p = shared[name]
        rows.append([f"`{name}`", with_error(p["value"], p["standard_error"]), p["unit"],
                     f"{100 * p['shares']['data']:.0f}", p["status"]])
    return studies.table(["", "value", "unit", "share of the data, %", "status"], rows)


def pooled(*predictors):
    """AUC, Brier score and the worst fifth of all tracks of several cross-validations together."""
    tracks = sorted((t["probability"], t["stepped"]) for p in predictors for r in p["recordings"]
                    for t in r.get("predicted_steps", []))
    stepped = [p for p, s in tracks if s]
    stood = [p for p, s in tracks if not s]
    auc = sum((a > b) + 0.5 * (a == b) for a in stepped for b in stood) / (len(stepped) * len(stood))
    brier = sum((p - s) ** 2 for p, s in tracks) / len(tracks)
    fifths = [tracks[k * len(tracks) // 5:(k + 1) * len(tracks) // 5] for k in range(5)]
    worst = max(abs(sum(p - s for p, s in fifth)) / len(fifth) for fifth in fifths)
    return [f"{len(stepped)} of {len(tracks)}", number(auc), number(brier), number(worst, 2)]


def timing_cells(lift_off):
    if lift_off is None:
        return [None, None]
    return [f"{number(lift_off['mean_absolute_error_s'], 2)} ({lift_off['people']} people)",
            f"{number(lift_off['place_error_m'], 2)} ({lift_off['landed']})"]


def steps():
    single_people = compared("single", *SCHEMES[0][1:2], *SCHEMES[0][2])[0]
    tried = [("single people, 5 x 4 folds", single_people),
             ("single people, a person left out", compared("single", "subject")[0]),
             ("groups, 5 folds", groups_compared()[0])]
    rows = []
    for title, scores in tried:
        for name, p in scores.items():
            s = p["who_steps"]
            worst = max(abs(f["predicted"] - f["observed"]) for f in s["fifths"])
            rows.append([title, f"`{name}`", f"{s['stepped']} of {s['tracks']}",
                         with_error(s["auc"], s["auc_error"]), with_error(s["brier"], s["brier_error"]),
                         number(worst, 2), *timing_cells(s.get("lift_off"))])
    for name in single_people:
        rows.append(["both together", f"`{name}`", *pooled(single_people[name], groups_compared()[0][name]), None, None])
    return studies.table(["held out", "feet", "step", "AUC", "Brier score", "worst fifth: P(step) - share",
                          "lift-off, mean error, s", "first place, mean error, m"], rows)


def reliability():
    """How many tracks have a P(step) in a fifth of 0 to 1, their mean P(step) and the share that stepped."""
    tried = [("single people, a person left out", compared("single", "subject")[0]),
             ("groups, 5 folds", groups_compared()[0])]
    rows = []
    for title, scores in tried:
        for name, p in scores.items():
            bins = [[] for _ in range(5)]
            for track in (t for r in p["recordings"] for t in r.get("predicted_steps", [])):
                bins[min(4, int(5 * track["probability"]))].append(track)
            rows.append([title, f"`{name}`", *(reliability_cell(tracks) for tracks in bins)])
    return studies.table(["held out: P(step) -> share that stepped (tracks)", "feet",
                          *(f"{k / 5:.1f} to {(k + 1) / 5:.1f}" for k in range(5))], rows)


def reliability_cell(tracks):
    if not tracks:
        return None
    mean = sum(t["probability"] for t in tracks) / len(tracks)
    share = sum(t["stepped"] for t in tracks) / len(tracks)
    return f"{mean:.2f} -> {share:.2f} ({len(tracks)})"


if __name__ == "__main__":
    studies.main(__file__, {"single": single, "groups": groups, "heights": heights, "external": external,
                            "values": values, "steps": steps, "reliability": reliability})
