"""What the first frames of a new push tell (--observed).

single      errors of held-out recordings of single people after 1, 12, 20 and 30 frames (ident/prediction/README.md); 2 minutes
steps       the same by gains of single steps (--likelihood=innovation), 4 folds once (ident/prediction/README.md); a minute
groups      the same of groups, 5 folds (ident/prediction/README.md); 15 minutes
population  how recordings of single people differ (ident/prediction/README.md); seconds

Times are those of one core.
"""
import studies
from studies import number, with_error

FRAMES = [1, 12, 20, 30]
GROUP_FRAMES = [1, 12, 30]  # a fit of groups takes a minute


def scored(setting, observed, *arguments):
    return studies.on_recordings("pushid-crossvalidate", setting, f"--observed={observed}", *arguments).json


def metric(mean, name, unit="m", sign=False):
    return with_error(mean[f"{name}_{unit}"], mean[f"{name}_standard_error_{unit}"], sign)


def rows_of(setting, frames, *arguments):
    rows = []
    for k in frames:
        out = scored(setting, k, *arguments)
        differences = {d["to"]: d for d in out.get("paired_differences", [])}
        for i, p in enumerate(out["predictors"]):
            mean = p["mean"]
            bands = [metric(mean, f"inside90_{axis}", "share") for axis in "xy"] if i == 0 else [None, None]
            difference = metric(differences[p["name"]], "after_hipADE", sign=True) if i else None
            rows.append([k if i == 0 else None, "forecast" if i == 0 else p["name"], metric(mean, "hipADE"),
                         metric(mean, "after_hipADE"), metric(mean, "hipFDE"), difference, *bands])
    return rows


HEADER = ["frames seen", "", "all frames, m", "frames after, m", "last, m", "after, minus forecast, m",
          "inside 90 %, x", "y"]


def single():
    return studies.table(HEADER, rows_of("single", FRAMES))


def steps():
    rows = rows_of("single", FRAMES[1:], "--likelihood=innovation", "--folds=4", "--repeats=1")
    return studies.table(HEADER, [row for row in rows if row[1] in ("forecast", "re-anchored")])


def groups():
    return studies.table(HEADER, rows_of("groups", GROUP_FRAMES, "--folds=5", "--repeats=1"))


def population():
    effect = studies.fit("single").json["recording_effect"]
    rows = [["spread w of b", with_error(effect["spread"], effect["spread_standard_error"])],
            ["error scale s, m", number(effect["error_scale_m"])],
            ["share of the squared error that b takes away", number(effect["explained"], 2)],
            ["blend rate r, 1/s", number(effect["blend_rate_per_s"], 2)],
            ["widening c, 1/s^2: along the push, across, upwards",
             ", ".join(number(c, 2) for c in effect["widening_per_s2"])]]
    for key in ("person", "condition"):
        groups = sorted({r[key] for r in effect["recordings"]})
        means = []
        for name in groups:
            own = [r["effect"] for r in effect["recordings"] if r[key] == name]
            means.append(f"{name} {sum(own) / len(own):+.2f}")
        rows.append([f"mean b by {key}", ", ".join(means)])
    return studies.table(["32 recordings of single people", ""], rows)


if __name__ == "__main__":
    studies.main(__file__, {"single": single, "steps": steps, "groups": groups, "population": population})
