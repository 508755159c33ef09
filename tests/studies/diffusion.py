"""Whole groups by diffusion: held-out errors, and whether groups then do what groups do.

groups     errors of the 49 recordings of groups, four folds, beside physics and baselines
motion     what groups do: social states, words of motion, who moved first; with the same runs

PUSHID_RECORDINGS is the folder of the recordings. The same runs serve both, a quarter of an hour of one core for
diffusion and ten minutes for `window` bodies, which carry physics on the same folds.
Needs pushid-train-generator and pushid-train-restoration, which are built where LibTorch is found.
"""
from json import load as json_of

import studies
from studies import number, with_error

BLEND = 0.5  # chosen on these folds
FOLDS = ["--crossvalidate=4", "--scheme=interleaved"]


def diffused():
    return studies.on_recordings("pushid-train-generator", "groups", "--kind=diffusion", *FOLDS,
                                 f"--physics={studies.fit('groups').path}", f"--blend={BLEND}").json


def restored():
    return studies.on_recordings("pushid-train-restoration", "groups", f"--model={studies.fit('groups').path}",
                                 *FOLDS).json


def rows():
    """What a row is called, and the scores in it."""
    beside = diffused()["baselines"]
    return [("**diffusion and physics**, `--blend=0.5`", diffused()),
            ("diffusion", beside["generator_unblended"]),
            ("diffusion, 20 frames observed", beside["generator_shown_20"]),
            ("physics, `rigid` bodies", beside["rigid"]),
            ("physics, `window` bodies", restored()),
            ("constant velocity after the push", beside["constant_velocity"]),
            ("the first poses held", beside["static"])]


def errors(json):
    mean = json["mean"]
    return [with_error(mean["MPJPE_m"], mean["MPJPE_standard_error_m"]), number(mean["hipADE_m"]),
            number(mean["hipFDE_m"]), number(mean["MBLE_m"]) if mean["MBLE_m"] >= 0.001 else "0.000",
            f"{mean['FSE_cm']:.2f}"]


def groups():
    return studies.table(["held out, 4 folds", "MPJPE, m", "hipADE, m", "hipFDE, m", "MBLE, m", "FSE, cm a frame"],
                         [[title, *errors(json)] for title, json in rows()])


def share(value):
    return "none" if value is None else number(value)


def motion():
    cells = []
    for title, json in rows():
        m = json["group_metrics"]
        cells.append([title, share(m["sscp"]), share(m["sscp_changes"]), share(m["ndms"]),
                      f"{m['pushed_named']} of {m['recordings']}", share(m["onset_order"]), share(m["onset_error_s"]),
                      m["false_movers"], m["missed_movers"]])
    return studies.table(["held out, 4 folds", "SSCP", "its changes", "NDMS", "pushed person moves first",
                          "onsets in order", "onset error, s", "false movers", "missed movers"], cells)


def of_fold(fold):
    """The ids of the recordings of groups that the interleaved fold holds out."""
    with open(studies.MANIFEST, encoding="utf-8") as file:
        recordings = json_of(file)["recordings"]
    seen, ids = {}, []
    for recording in recordings:
        if len(recording["subjects"]) < 2:
            continue
        position = seen.get(recording["setting"], 0)
        seen[recording["setting"]] = position + 1
        if position % 4 == fold:
            ids.append(recording["id"])
    return ",".join(ids)


if __name__ == "__main__":
    studies.main(__file__, {"groups": groups, "motion": motion})
