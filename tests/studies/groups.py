"""People who touch: what the 49 recordings of groups identify, and how candidates of contact predict.

values      contact by setting (ident/README.md); one fit, half a minute
settling    where people end up three seconds after a push (ident/README.md); the same fit
candidates  errors on held-out recordings beside settling (ident/validation/README.md); 15 minutes
schemes     strong pushes, and whole settings, held out (ident/validation/README.md); 3 minutes
travel      how the push travels (ident/prediction/README.md); with what the others ran, seconds

Times are those of one core.
"""
import studies
from studies import number, with_error

CONTACT = [("contact_distance", "contact distance, m"), ("contact_stiffness", "contact stiffness, N/m"),
           ("contact_damping", "contact damping, N s/m")]
# Name in the table, and what is added to --preset=group.
CANDIDATES = [
    ("no contact", "--interaction=none"),
    ("nothing pooled", "--pool=none"),
    ("free to move on", "--settling_weight=0"),
    ("distance and stiffness pooled", "--pool=contact_distance,contact_stiffness"),
    ("ankles and steps by setting as well", "--pool=all"),
    ("feet that slide", "--stance=slide"),
]
PRESET = "--preset=group"


def group():
    return studies.fit("groups", PRESET)


def candidates_output():
    compare = "; ".join(f"{name}: {flags}" for name, flags in CANDIDATES)
    return studies.on_recordings("pushid-crossvalidate", "groups", PRESET, "--folds=5", "--repeats=1",
                                 f"--compare={compare}")


def values():
    model = group().json
    settings = model["settings"]
    shared = {p["name"]: p for p in model["parameters"]}
    rows = []
    for name, title in CONTACT:
        cells = [shared[name]] + [settings[s][name] for s in settings]
        rows.append([title] + [with_error(c["value"], c["standard_error"]) for c in cells])
    return studies.table(["", "shared", *settings], rows)


def settling():
    rows = []
    for d in group().json["behaviour"]["demonstrations"]:
        if d["impulse_Ns"] != 80.0 or (d["people"] == 1 and d["mass_kg"] != 100.0):
            continue
        who = "one person of 100 kg" if d["people"] == 1 else f"a line of {d['people']}"
        rows.append([d["setting"] or "shared", who, f"{d['speed_m_s']:.3f}", number(d["pushed_advance_m"], 2),
                     None if d["people"] == 1 else number(d["advance_m"], 2), "yes" if d["settled"] else "no"])
    return studies.table(["parameters of", "after a push of 80 N s", "fastest person, m/s",
                          "pushed person ahead of the start, m", "the line on average, m", "settles"], rows)


def score_cells(p):
    mean = p["mean"]
    cells = [with_error(mean["hipADE_m"], mean["hipADE_standard_error_m"]),
             with_error(mean["hipFDE_m"], mean["hipFDE_standard_error_m"])]
    if "fits" not in p:
        return cells + [None, None]
    return cells + [f"{p['fits_that_settle']} of {p['fits']}", f"{p['slowest_to_settle_m_s']:.3f}"]


def candidates():
    scores = {p["name"]: p for p in candidates_output().json["predictors"]}
    flags = dict(CANDIDATES, group=PRESET)
    rows = []
    for name, p in sorted(scores.items(), key=lambda item: -item[1]["mean"]["hipADE_m"]):
        title = f"**`{PRESET}`**" if name == "group" else f"{name} (`{flags[name]}`)" if name in flags else name
        moves = p["propagation"]
        rows.append([title] + score_cells(p) + [f"{moves['false_movers']:.2g} of {moves['bystanders']:.0f}"])
    return studies.table(["held out, 5 folds", "hipADE, m", "hipFDE, m", "settle", "fastest still, m/s",
                          "false movers"], rows)


def schemes():
    rows = []
    for scheme, title in (("strong", "strong pushes"), ("setting", "one setting at a time")):
        out = studies.on_recordings("pushid-crossvalidate", "groups", PRESET, f"--scheme={scheme}",
                                    "--compare=nothing pooled: --pool=none")
        for p in out.json["predictors"]:
            rows.append([title, f"`{PRESET}`" if p["name"] == "group" else p["name"]] + score_cells(p)[:2])
    return studies.table(["held out", "", "hipADE, m", "hipFDE, m"], rows)


# Row and key in the scores.
FIGURES = [
    ("onset error, frames, of who moves in both", "onset_error_frames"),
    ("... without the pushed person", "onset_error_reached_frames"),
    ("... predicted - measured, all", "onset_bias_frames"),
    ("share of movers missed", "missed_movers_share"),
    ("share of bystanders who move for nothing", "false_movers_share"),
    ("speed measured, m/s, from the mean slowness", "speed_measured_m_per_s"),
    ("speed predicted, m/s", "speed_predicted_m_per_s"),
    ("momentum passed on to the next person, measured", "momentum_passed_on_measured"),
    ("momentum passed on, predicted", "momentum_passed_on_predicted"),
    ("work of contact per recording, J", "contact_work_J"),
    ("share of the energy given back", "contact_returned_share"),
]


def travel():
    fitted, row_1 = (studies.on_recordings("pushid-evaluate", setting, f"--model={group().path}").json["propagation"]
                     for setting in ("groups", "row_1"))
    held_out = candidates_output().json["predictors"][0]["propagation"]
    rows = []
    for title, key in FIGURES:
        cells = [source[key] for source in (fitted, row_1, held_out)]
        rows.append([title] + [with_error(c["value"], c["standard_error"]) for c in cells])
    text = studies.table(["", "fitted to all 49", "of these `row_1`", "held out, 5 folds"], rows)
    return (f"{text}\n\nOf {fitted['movers'] + fitted['bystanders']:.0f} people {fitted['movers']:.0f} move and "
            f"{fitted['bystanders']:.0f} do not while they are watched.")


if __name__ == "__main__":
    studies.main(__file__, {"values": values, "settling": settling, "candidates": candidates, "schemes": schemes,
                            "travel": travel})
