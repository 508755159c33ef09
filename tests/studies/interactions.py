"""What people do to each other, learned beside contact: does it predict what was not fitted?

learned  held-out errors of groups, settling and false movers (tests/studies/README.md); 20 minutes of one core
"""
import studies
from studies import number, with_error

PRESET = ["--preset=group", "--stance=slide"]  # of feet that slide: those that step know no networks
NETWORK = "--interaction=spring,damping,network:4"
# Name in the table, and what is added to the preset.
CANDIDATES = [
    ("network beside contact", NETWORK),
    ("half the prior", f"{NETWORK} --network_prior=0.5"),
    ("a fifth of it", f"{NETWORK} --network_prior=0.2"),
    ("network, no spring and no damping", "--interaction=network:4"),
]


def cells(p):
    mean, moves = p["mean"], p["propagation"]
    text = [with_error(mean["hipADE_m"], mean["hipADE_standard_error_m"]),
            with_error(mean["hipFDE_m"], mean["hipFDE_standard_error_m"])]
    if "fits" not in p:
        return text + [None, None, None]
    onset = moves["onset_error_frames"]
    return text + [f"{p['fits_that_settle']} of {p['fits']}", "-" if onset is None else number(onset["value"]),
                   f"{moves['false_movers']:.2g} of {moves['bystanders']:.0f}"]


def learned():
    compare = "; ".join(f"{name}: {flags}" for name, flags in CANDIDATES)
    out = studies.on_recordings("pushid-crossvalidate", "groups", *PRESET, "--folds=5", "--repeats=1",
                                f"--compare={compare}")
    flags = dict(CANDIDATES)
    rows = []
    for p in sorted(out.json["predictors"], key=lambda p: p["mean"]["hipADE_m"]):
        title = f"**`{' '.join(PRESET)}`**" if p["name"] == "group" else p["name"]
        if p["name"] in flags:
            title += f" (`{flags[p['name']]}`)"
        rows.append([title, *cells(p)])
    return studies.table(["held out, 5 folds", "hipADE, m", "hipFDE, m", "settle", "onset error, frames", "false movers"],
                         rows)


if __name__ == "__main__":
    studies.main(__file__, {"learned": learned})
