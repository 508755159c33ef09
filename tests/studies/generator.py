"""Learned generators of motion: particles on motion capture, and on pushes (models/generators/README.md).

validation   errors on the validation split of the clips: baselines, one network, three averaged and blended
spread       coverage and scores of sampled futures on the same windows
ablations    one network of 600 steps with something left out, changed or charged besides
pushes       the published pushes of single people, four folds, beside what physics and restorations score

PUSHID_MOCAP is the folder of the clips (default ../shared/cmu_mocap beside the source). Trainings take two to
three minutes of one core a network, half of that in the ablations, and twice as long with ATLAS as with OpenBLAS. Needs pushid-train-generator, which is built where LibTorch is found.
"""
import os
import sys

import studies
from studies import number, with_error

MOCAP = os.path.abspath(os.environ.get("PUSHID_MOCAP", os.path.join(studies.SOURCE, "../shared/cmu_mocap")))
CLIPS = ["--dataset=cmu", f"--folder={MOCAP}"]
HORIZONS = ["80", "160", "320", "400", "1000"]
IN_MS = [f"{h} ms" for h in HORIZONS]
SAMPLES = 39
ALONE = ["--seeds=1", "--ridge_share=0"]
ABLATIONS = [("as it is", []),
             ("without displacements, `--particles=false`", ["--particles=false"]),
             ("without the sum, `--pose_operator=false`", ["--pose_operator=false"]),
             ("`--cell=lstm`", ["--cell=lstm"]),
             ("`--bone_weight=1`", ["--bone_weight=1"]),
             ("`--critic_weight=0.001`", ["--critic_weight=0.001"]),
             ("`--squared_weight=10`", ["--squared_weight=10"])]


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
    ridge = evaluate(model, "--ridge_share=1", "--project_bones=false")
    one = train(*ALONE, "--noise_steps=0")
    rows = [("the last pose held", whole["baselines"]["zero_velocity"]),
            ("ridge, `--ridge_share=1 --project_bones=false`", ridge),
            ("one network, `--project_bones=false --mirror=false`",
             evaluate(one, "--project_bones=false", "--mirror=false")),
            ("one network, `--mirror=false`", evaluate(one, "--mirror=false")),
            ("one network", evaluate(one)),
            ("three networks, `--ridge_share=0`", evaluate(model, "--ridge_share=0")),
            ("**three networks and ridge** (default)", whole)]
    return studies.table(["mean joint error, mm", *IN_MS],
                         [by_horizon(name, json["mean"]["MPJPE_mm"]) for name, json in rows])


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


def ablations():
    rows = []
    for name, flags in ABLATIONS:
        model = train(*ALONE, "--steps=600", "--noise_steps=0", "--correction=false", *flags)
        rows.append(by_horizon(name, evaluate(model, "--project_bones=false", "--mirror=false")["mean"]["MPJPE_mm"]))
    return studies.table(["one network, 600 steps, `--mirror=false --correction=false`; mean joint error, mm", *IN_MS], rows)


METRICS = ["hipADE_m", "hipFDE_m", "MBLE_m"]


def cells(name, summary):
    mean = summary["mean"]
    return [name, with_error(mean["MPJPE_m"], mean["MPJPE_standard_error_m"]),
            *(number(mean[key]) if mean[key] >= 0.001 else "0.000" for key in METRICS), f"{mean['FSE_cm']:.2f}"]


def pushes():
    rows = []
    for observed, name in ((20, "20 frames observed"), (1, "1 frame and the push")):
        json = studies.on_recordings("pushid-train-generator", "single", "--dataset=pushes", "--crossvalidate=4",
                                     "--seeds=1", "--steps=200", "--noise_steps=0", "--batch=16",
                                     f"--observed={observed}").json
        rows.append(cells(f"particles, {name}", json))
        if observed > 1:
            rows.append(cells(f"particles, {name}, all frames", json["baselines"]["generator_all_frames"]))
    rows.append(cells("the first pose held", json["baselines"]["static"]))
    rows.append(cells("constant velocity after the push", json["baselines"]["constant_velocity"]))
    model = studies.fit("single").path

    def restored(*flags):
        return studies.on_recordings("pushid-train-restoration", "single", f"--model={model}", "--crossvalidate=4",
                                     *flags).json

    seen, simlpe, plain = restored("--observed=20"), restored("--kind=simlpe"), restored()
    rows.append(cells("physics and `window` bodies, 20 frames observed", seen))
    rows.append(cells("siMLPe, 12 frames observed", simlpe["baselines"]["simlpe"]))
    rows.append(cells("siMLPe, 12 frames observed, all frames", simlpe["baselines"]["simlpe_all_frames"]))
    rows.append(cells("physics and `rigid` bodies, 1 frame and the push", plain["baselines"]["rigid"]))
    rows.append(cells("physics and `window` bodies, 1 frame and the push", plain))
    return studies.table(["held out, 4 folds", "MPJPE, m", "hipADE, m", "hipFDE, m", "MBLE, m", "FSE, cm a frame"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"validation": validation, "spread": spread, "ablations": ablations, "pushes": pushes})
