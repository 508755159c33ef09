"""Whole groups by diffusion: held-out errors, and whether groups then do what groups do.

groups     errors of the 49 recordings of groups, four folds, beside physics and baselines
motion     what groups do: social states, words of motion, who moved first; with the same runs

PUSHID_RECORDINGS is the folder of the recordings. One run serves both, a quarter of an hour of one core.
Needs pushid-train-generator, which is built where LibTorch is found.
"""
import studies
from studies import number, with_error

BLEND = 0.5  # chosen on these folds
FOLDS = ["--kind=diffusion", "--crossvalidate=4", "--scheme=interleaved"]
# Name in the table, and which predictor of the run beside physics.
ROWS = [("**diffusion and physics**, `--blend=0.5`", None),
        ("diffusion", "generator_unblended"),
        ("diffusion, 20 frames observed", "generator_shown_20"),
        ("physics, `rigid` bodies", "rigid"),
        ("constant velocity after the push", "constant_velocity"),
        ("the first poses held", "static")]


def beside_physics():
    physics = studies.fit("groups").path
    return studies.on_recordings("pushid-train-generator", "groups", *FOLDS, f"--physics={physics}",
                                 f"--blend={BLEND}").json


def found(json, name):
    return json if name is None else json["baselines"][name]


def errors(json):
    mean = json["mean"]
    return [with_error(mean["MPJPE_m"], mean["MPJPE_standard_error_m"]), number(mean["hipADE_m"]),
            number(mean["hipFDE_m"]), number(mean["MBLE_m"]) if mean["MBLE_m"] >= 0.001 else "0.000",
            f"{mean['FSE_cm']:.2f}"]


def groups():
    json = beside_physics()
    return studies.table(["held out, 4 folds", "MPJPE, m", "hipADE, m", "hipFDE, m", "MBLE, m", "FSE, cm a frame"],
                         [[title, *errors(found(json, name))] for title, name in ROWS])


def share(value):
    return "none" if value is None else number(value)


def motion():
    json = beside_physics()
    rows = []
    for title, name in ROWS:
        m = found(json, name)["group_metrics"]
        rows.append([title, share(m["sscp"]), share(m["sscp_changes"]), share(m["ndms"]),
                     f"{m['pushed_named']} of {m['recordings']}", share(m["onset_order"]), share(m["onset_error_s"]),
                     m["false_movers"], m["missed_movers"]])
    return studies.table(["held out, 4 folds", "SSCP", "its changes", "NDMS", "pushed person moves first",
                          "onsets in order", "onset error, s", "false movers", "missed movers"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"groups": groups, "motion": motion})
