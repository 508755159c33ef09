"""From the pendulum to the body: restorations cross-validated as a whole chain, four folds, one seed.

single   the 32 recordings of single people (models/restoration/README.md); one minute
groups   two settings of groups (models/restoration/README.md); three minutes

Times are those of one core. `cvae` takes many minutes of processor time a fold and is left out.
Needs pushid-train-restoration, which is built where LibTorch is found.
"""
import studies
from studies import number, with_error

SETTINGS = ["group_1", "row_1"]  # two of the four: each takes minutes


def crossvalidate(setting, model, *flags):
    return studies.on_recordings("pushid-train-restoration", setting, f"--model={model}", "--crossvalidate=4",
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


def groups():
    model = studies.fit("groups", "--preset=group").path
    rows = []
    for setting in SETTINGS:
        json = crossvalidate(setting, model)
        rows.append(cells(f"{setting}, `rigid`", json["baselines"]["rigid"]))
        rows.append(cells(f"{setting}, **`window`**", json, json["true_pendulum"]))
    return studies.table(HEADER, rows)


if __name__ == "__main__":
    studies.main(__file__, {"single": single, "groups": groups})
