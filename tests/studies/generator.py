"""Particles on motion capture (models/generators/README.md).

validation   errors on the validation split of the clips: baselines, one network, three averaged and blended
apart        the choices behind that, judged on whole actions and on whole clips left out in turn; short trainings
spread       coverage and scores of sampled futures on the same windows

PUSHID_MOCAP is the folder of the clips (default ../shared/cmu_mocap beside the source). Trainings take two to
three minutes of one core a network, and twice as long with ATLAS as with OpenBLAS. Needs pushid-train-generator, which is built where LibTorch is found.
"""
import os
import sys

import studies
from studies import number

MOCAP = os.path.abspath(os.environ.get("PUSHID_MOCAP", os.path.join(studies.SOURCE, "../shared/cmu_mocap")))
CLIPS = [f"--folder={MOCAP}"]
HORIZONS = ["80", "160", "320", "400", "1000"]
IN_MS = [f"{h} ms" for h in HORIZONS]
SAMPLES = 39
APART_ACTIONS = ["soccer", "jumping", "running"]  # each is a fold
APART_CLIPS = [1]  # likewise the places of clips, counted from the last
APART_STEPS = os.environ.get("PUSHID_APART_STEPS", "200")
SHORT = ["--seeds=3", f"--steps={APART_STEPS}", "--noise_steps=0"]
ALONE = "--without=ridge,simlpe"
FORECASTS = [("three networks", [ALONE]),
             ("three networks, bones as they come", [ALONE + ",bones"]),
             ("three networks and ridge", ["--without=simlpe"]),
             ("three networks and siMLPe", ["--without=ridge"]),
             ("**three networks, ridge and siMLPe** (default)", [])]


def train(*flags):
    if not os.path.exists(os.path.join(MOCAP, "skeleton.json")):
        sys.exit(f"{MOCAP} holds no clips: PUSHID_MOCAP names their folder")
    return studies.run("pushid-train-generator", *CLIPS, *flags, out="out").path


def evaluate(model, *flags):
    return studies.run("pushid-generate", f"--model={model}", *CLIPS, *flags).json


def by_horizon(name, errors):
    return [name, *(number(errors[h]) for h in HORIZONS)]


def validation():
    model = train()
    whole = evaluate(model)
    rows = [("the last pose held", whole["baselines"]["zero_velocity"]),
            ("three networks, bones as they come", evaluate(model, ALONE + ",bones")),
            ("three networks", evaluate(model, ALONE)),
            ("three networks and ridge", evaluate(model, "--without=simlpe")),
            ("**three networks, ridge and siMLPe** (default)", whole)]
    return studies.table(["mean joint error, mm", *IN_MS],
                         [by_horizon(name, json["mean"]["MPJPE_mm"]) for name, json in rows])


def link(file, folder):
    at = os.path.join(folder, os.path.basename(file))
    if not os.path.lexists(at):
        os.symlink(file, at)


def apart_folds():
    """Folders of clips to learn from and of those left out: whole actions, then one clip of every action."""
    root = os.path.join(MOCAP, "train")
    clips = {action: sorted(os.listdir(os.path.join(root, action)), key=lambda name: (len(name), name))
             for action in sorted(os.listdir(root))}
    folds = [("action", f"without_{action}", {action: clips[action]}) for action in APART_ACTIONS]
    folds += [("clip", f"without_clip_{place}", {a: names[-place:][:1] for a, names in clips.items() if len(names) >= place})
              for place in APART_CLIPS]
    for kind, name, left_out in folds:
        places = [os.path.join(studies.KEPT, "apart", name, part) for part in ("learnt", "held")]
        for action, names in clips.items():
            for clip in names:
                folder = os.path.join(places[clip in left_out.get(action, [])], "train", action)
                os.makedirs(folder, exist_ok=True)
                link(os.path.join(root, action, clip), folder)
        for place in places:
            link(os.path.join(MOCAP, "skeleton.json"), place)
        yield kind, *(f"--folder={place}" for place in places)


def apart():
    sums = {}
    for kind, learnt, held in apart_folds():
        model = studies.run("pushid-train-generator", learnt, "--hold_out=false", *SHORT, out="out").path
        for name, flags in FORECASTS:
            errors = studies.run("pushid-generate", f"--model={model}", held, "--protocol=all", *flags).json
            kinds = sums.setdefault(name, {"action": [], "clip": []})
            kinds[kind].append([errors["mean"]["MPJPE_mm"][h] for h in HORIZONS])
    measured = [kind for kind, folds in (("action", APART_ACTIONS), ("clip", APART_CLIPS)) if folds]
    rows = [[name, *(number(sum(of) / len(of)) for kind in measured for of in zip(*kinds[kind]))]
            for name, kinds in sums.items()]
    return studies.table([f"mean joint error, mm; {APART_STEPS} steps", *(
        f"{kind} left out, {h} ms" for kind in measured for h in HORIZONS)], rows)


def spread():
    json = evaluate(train(), f"--samples={SAMPLES}")
    actions = json["actions"]
    rows = [by_horizon("coverage of 90 % intervals", json["mean"]["coverage_90"])]
    worst = min(actions, key=lambda a: min(actions[a]["coverage_90"].values()))
    rows.append(by_horizon(f"the same, {worst} (the least)", actions[worst]["coverage_90"]))
    for key, name in (("CRPS_mm", "CRPS, mm"), ("energy_score_mm", "energy score, mm"),
                      ("best_of_n_MPJPE_mm", f"best of {SAMPLES}, mean joint error, mm")):
        rows.append(by_horizon(name, json["mean"][key]))
    return studies.table([f"{SAMPLES} sampled futures", *IN_MS], rows)


if __name__ == "__main__":
    studies.main(__file__, {"validation": validation, "apart": apart, "spread": spread})
