"""SDE (Lyu et al., ACM MM 2021) as published, pushid-train-generator --published=sde (models/generators/README.md).

table2   its Table 2's layout: errors per action at five horizons, both readings of Eq. 6
table3   its Table 3's layout: what is left out or replaced, one at a time, of what is published
fig5     its Fig. 5 without a given end: the most probable of sampled futures, by action
times    how long the commands of these tables took, one core

PUSHID_MOCAP is a folder of clips (default ../shared/cmu_mocap beside the source): of CMU, of Human3.6M with a folder
per subject, or made by simulate-others --clips. Windows are those of --protocol=test where clips are kept apart for
it, otherwise of the validation clips, which are then not learned from. PUSHID_SDE_STEPS is the number of training
steps of table2 and fig5 (default 150; the rate is constant, so that shorter trainings are parts of longer ones),
PUSHID_SDE_SHORT_STEPS that of table3 and times (default 150).
"""
import os
import sys

import studies
from generator import CLIPS, HORIZONS, IN_MS, MOCAP, by_horizon
from studies import number

STEPS = os.environ.get("PUSHID_SDE_STEPS", "150")
SHORT = os.environ.get("PUSHID_SDE_SHORT_STEPS", "150")
HAS_TEST = any(os.path.isdir(os.path.join(MOCAP, place)) for place in ("test", "S5"))
PROTOCOL = f"--protocol={'test' if HAS_TEST else 'validation'}"
HELD = [] if HAS_TEST else ["--hold_out=true"]
SAMPLES = 39
NAMED = ["walking", "eating", "smoking", "discussion"]  # Table 3's; all actions of a folder that lacks them
ABLATIONS = [("as published", []),
             ("with the determinant, `--without=draw`", ["--without=draw"]),
             ("without particles, `--without=particles`", ["--without=particles"]),
             ("without the pose operator (Eq. 7-9), `--without=operator`", ["--without=operator"]),
             ("an LSTM in place of the GRU, `--without=gru`", ["--without=gru"]),
             ("without noise and Eq. 6, `--without=noise`", ["--without=noise"]),
             ("without bone lengths (Eq. 11), `--without=bones`", ["--without=bones"]),
             ("without the critic (Eq. 12), `--without=critic`", ["--without=critic"])]


def train(steps, *flags):
    if not os.path.isdir(MOCAP):
        sys.exit(f"{MOCAP} holds no clips: PUSHID_MOCAP names their folder")
    return studies.run("pushid-train-generator", "--published=sde", *CLIPS, *HELD, f"--steps={steps}", *flags,
                       out="out")


def evaluate(model, *flags):
    return studies.run("pushid-generate", "--published=sde", f"--model={model}", *CLIPS, PROTOCOL, *flags)


def readings():
    return [("as printed", train(STEPS)), ("with the determinant", train(STEPS, "--without=draw"))]


def table2():
    published = [(f"SDE, {reading}", evaluate(trained.path).json) for reading, trained in readings()]
    rows = []
    for action in [*sorted(published[0][1]["actions"]), None]:
        of = (lambda errors: errors["actions"][action]) if action else (lambda errors: errors["mean"])
        name = action or "**mean of actions**"
        rows.append([name, "last pose held", *by_horizon("", of(published[0][1]["baselines"]["zero_velocity"])["MPJPE_mm"])[1:]])
        for forecaster, errors in published:
            rows.append([name, forecaster, *by_horizon("", of(errors)["MPJPE_mm"])[1:]])
    return studies.table([f"{PROTOCOL}; mean joint error, mm", f"{STEPS} steps", *IN_MS], rows)


def table3():
    scored = [(name, evaluate(train(SHORT, *flags).path).json["actions"]) for name, flags in ABLATIONS]
    actions = [a for a in NAMED if a in scored[0][1]]
    if len(actions) < len(NAMED):
        actions = sorted(scored[0][1])
    rows = []
    for name, errors in scored:
        means = {h: sum(errors[a]["MPJPE_mm"][h] for a in actions) / len(actions) for h in HORIZONS}
        rows.append([name, *(f"{number(errors[a]['MPJPE_mm'][HORIZONS[-1]])}" for a in actions),
                     *(number(means[h]) for h in HORIZONS)])
    return studies.table([f"{SHORT} steps; mean joint error, mm", *(f"{a}, 1000 ms" for a in actions),
                          *(f"mean, {h}" for h in IN_MS)], rows)


def fig5():
    errors = evaluate(train(STEPS, "--without=draw").path, f"--samples={SAMPLES}").json
    rows = []
    for action in [*sorted(errors["actions"]), None]:
        scores = errors["actions"][action] if action else errors["mean"]
        rows.append([action or "**mean of actions**", *(number(scores[key][h]) for key in (
            "MPJPE_mm", "most_probable_MPJPE_mm", "best_of_n_MPJPE_mm") for h in (HORIZONS[0], HORIZONS[-1]))])
    return studies.table([f"{SAMPLES} futures; mean joint error, mm", *(
        f"{what}, {h} ms" for what in ("path without noise", "most probable", "best") for h in (HORIZONS[0], HORIZONS[-1]))],
                         rows)


def times():
    rows = [[f"`pushid-train-generator --published=sde --steps={SHORT} {' '.join(flags)}`".replace(" `", "`"),
             f"{train(SHORT, *flags).seconds:.0f}"] for _, flags in ABLATIONS]
    rows.append([f"`pushid-generate --published=sde {PROTOCOL}`", f"{evaluate(train(SHORT).path).seconds:.1f}"])
    return studies.table(["command", "s"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"table2": table2, "table3": table3, "fig5": fig5, "times": times})
