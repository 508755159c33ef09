"""From the pendulum to the body: restorations cross-validated as a whole chain, four folds, one seed.

single   the 32 recordings of single people (models/restoration/README.md); one minute
groups   all groups together, by setting, five folds (models/restoration/README.md); half an hour
whole    pendulum and network trained as a whole, four folds (models/restoration/README.md); twenty minutes
adds     what bodies add to the identification (models/restoration/README.md); one minute

Times are those of one core. `cvae` takes many minutes of processor time a fold and is left out.
Needs pushid-train-restoration, which is built where LibTorch is found.
"""
import os

import studies
from studies import number, with_error

def crossvalidate(setting, model, *flags, folds=4):
    return studies.on_recordings("pushid-train-restoration", setting, f"--model={model}", f"--crossvalidate={folds}",
                                 *flags).json


def cells(name, summary, pendulum=None):
    m = summary["mean"]
    return [name, with_error(m["MPJPE_m"], m["MPJPE_standard_error_m"]), number(m["hipADE_m"]), number(m["hipFDE_m"]),
            number(m["relative_MPJPE_m"], 2), pendulum and number(pendulum["mean"]["relative_MPJPE_m"], 2),
            f"{m['MBLE_m']:.3f}", f"{m['FSE_cm']:.2f}"]


HEADER = ["held out, 4 folds", "MPJPE, m", "hipADE, m", "hipFDE, m", "relative to the hip, m",
          "the same, true pendulum", "MBLE, m", "FSE, cm a frame"]


def single():
    model = studies.fit("single").path
    rows = []
    for flags in ([], ["--predicted_pendulums=false"]):
        json = crossvalidate("single", model, *flags)
        if not flags:
            rows += [cells(name.replace("_", " "), json["baselines"][name]) for name in json["baselines"]]
        rows.append(cells("`window`" + "".join(f" `{f}`" for f in flags), json, json["true_pendulum"]))
    return studies.table(HEADER, rows)


NETWORK = ["--interaction=spring,damping,network:4", "--network_prior=0.2"]  # tests/studies/interactions.py


def groups():
    found = []
    for name, fitted, flags in [("`window`", [], []),
                                ("`window --sees=neighbours`", [], ["--sees=neighbours"]),
                                ("the same, pendulums with a learned interaction", NETWORK, ["--sees=neighbours"])]:
        model = studies.fit("groups", "--preset=group", *fitted).path
        found.append((name, crossvalidate("groups", model, *flags, folds=5)))
    rows = [["all", *cells("`rigid`", found[0][1]["baselines"]["rigid"])]]
    rows += [["all", *cells(name, json, json["true_pendulum"])] for name, json in found]
    for setting in found[0][1]["by_setting"]:
        rows += [[setting, *cells(name, {"mean": json["by_setting"][setting]})] for name, json in found]
    return studies.table(["", "held out, 5 folds", *HEADER[1:]], rows)


def whole():
    model = studies.fit("single").path
    rows = []
    for name, flags in [("apart", []), ("as a whole, `--body_weight=1`", ["--body_weight=1"])]:
        json = crossvalidate("single", model, *flags)
        rounds = ", ".join(map(str, json["run"]["rounds"]))
        rows.append([*cells(name, json, json["true_pendulum"]), rounds])
    return studies.table([*HEADER, "rounds, by fold"], rows)


def adds():
    model = studies.fit("single")
    restoration = os.path.join(studies.KEPT, "restoration_of_adds")
    studies.on_recordings("pushid-train-restoration", "single", f"--model={model.path}", f"--out={restoration}",
                          out=None, keep=False)
    fits = [("pendulums alone", model.json)]
    for weight in ("0.3", "1", "3"):
        fits.append((f"`--body_weight={weight}`", studies.fit(
            "single", f"--body_weight={weight}", f"--body_restoration={restoration}").json))
    names = [p["name"] for p in fits[0][1]["parameters"] if p["status"] != "fixed"]
    rows = []
    for name in names:
        row = [f"`{name}`"]
        for _, json in fits:
            p = next(p for p in json["parameters"] if p["name"] == name)
            row.append(f"{with_error(p['value'], p['standard_error'])} ({100 * p['shares']['data']:.0f} %)")
        rows.append(row)
    return studies.table(["value +- error (share of the data)", *[title for title, _ in fits]], rows)


if __name__ == "__main__":
    studies.main(__file__, {"single": single, "groups": groups, "whole": whole, "adds": adds})
