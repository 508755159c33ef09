"""From the pendulum to the body: restorations cross-validated as a whole chain, four folds, one seed.

single   the 32 recordings of single people (models/restoration/README.md); one minute
groups   all groups together, by setting, five folds (models/restoration/README.md); half an hour

Times are those of one core. `cvae` takes many minutes of processor time a fold and is left out.
Needs pushid-train-restoration, which is built where LibTorch is found.
"""
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
    json = crossvalidate("single", model)
    rows = [cells(name.replace("_", " "), json["baselines"][name]) for name in json["baselines"]]
    return studies.table(HEADER, [*rows, cells("`window`", json, json["true_pendulum"])])


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


if __name__ == "__main__":
    studies.main(__file__, {"single": single, "groups": groups})
