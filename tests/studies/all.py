"""One person model from all 81 recordings beside those of single people and of groups alone.

people      what further people bring to the intervals of the gains (ident/README.md); three fits, minutes

Times are those of one core.
"""
import studies
from studies import number, with_error

GAINS = [("Kp_theta", "Kp_theta, N m/rad"), ("support_front", "support_front, m"), ("step_gain", "step_gain"),
         ("step_swing", "step_swing, s")]
# What is fitted, and --setting.
FITS = [("single people", "single"), ("groups", "groups"), ("all", "all")]


def people():
    rows = []
    for title, setting in FITS:
        model = studies.fit(setting, "--stance=steps").json
        found = {p["name"]: p for p in model["parameters"]}
        cells = []
        for name, _ in GAINS:
            p = found[name]
            lower, upper = p["interval"]
            cells.append(f"{with_error(p['value'], p['standard_error'])} ({number(lower)} to {number(upper)})")
        rows.append([title, len(model["subjects"]), len(model["data"]["recordings"]), *cells,
                     "yes" if model["behaviour"]["settles"] else "no"])
    return studies.table(["fitted to", "people", "recordings", *(f"{t} (95 %)" for _, t in GAINS), "settles"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"people": people})
