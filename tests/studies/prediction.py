"""Prediction of single people who were not in the fit: schemes of folds, changes of the model, bands.

summary  the first page's table of errors on folds (README.md)
schemes  `tail` and `ldp` beside baselines, three ways of holding out (ident/validation/README.md); half a minute
changes  what was tried on top of `tail`, paired differences (ident/validation/README.md); half a minute
networks learned forces on top of `tail`, 4 folds (ident/validation/README.md); ten minutes
bands    how often predictive bands hold what was not fitted (ident/validation/README.md); ten seconds

Times are those of one core. All on the 32 recordings, 5 x 4 folds unless it says otherwise.
"""
import diffusion
import studies
from studies import number, with_error

LDP = [("`--preset=ldp`", "--preset=ldp")]
CHANGES = ["--preset_priors=false", "--posture=upright", "--self_force=linear",
           "--fix=Kp_theta=1500,tail_gain=1,tail_time=0.2", "--push_tail=none"]
# Networks trained by their gradient take hours here.
NETWORKS = ["--self_force=mlp:4 --network_prior=0.5"]
SCHEMES = [("stratified", "5 x 4 folds"), ("subject", "one person"), ("strong", "strong pushes")]


def validate(candidates, *arguments):
    """Scores and paired differences by name; candidates: (name, flags)."""
    compare = "; ".join(f"{name}: {flags}" for name, flags in candidates)
    json = studies.on_recordings("pushid-crossvalidate", "single", f"--compare={compare}", *arguments).json
    return ({p["name"]: p for p in json["predictors"]},
            {d["to"]: d for d in json["paired_differences"]})


def difference(d):
    return with_error(d["hipADE_m"], d["hipADE_standard_error_m"], sign=True)


def settle(p):
    return f"{p['fits_that_settle']} of {p['fits']}" if "fits" in p else None


def summary():
    scores, _ = validate(LDP, "--scheme=subject")
    diffused = diffusion.diffused()
    of_groups = {name: diffused["baselines"][key]["mean"] for name, key in (
        ("static", "static"), ("constant velocity", "constant_velocity"), ("physics (`tail`, `group`)", "rigid"))}
    of_groups["diffusion and physics"] = diffused["mean"]
    of_one = {name: scores[key]["mean"] for name, key in (
        ("static", "static"), ("constant velocity", "constant velocity"), ("ridge", "ridge"),
        ("physics (`tail`, `group`)", "tail"))}

    def cell(mean):
        if mean is None:
            return None
        error = mean["hipADE_standard_error_m"]
        return f"{with_error(mean['hipADE_m'], error)} / {number(mean['hipFDE_m'])}"

    names = ["static", "constant velocity", "ridge", "physics (`tail`, `group`)", "diffusion and physics"]
    rows = [[name, cell(of_one.get(name)), cell(of_groups.get(name))] for name in names]
    return studies.table(["error of the hip, m: mean / at the end", "a person outside the fit",
                          "groups, four folds"], rows)


def schemes():
    scores, differences = {}, {}
    for scheme, _ in SCHEMES:
        scores[scheme], differences[scheme] = validate(LDP, f"--scheme={scheme}")
    first = scores["stratified"]
    rows = []
    for name in sorted(first, key=lambda n: -first[n]["mean"]["hipADE_m"]):
        cells = [f"**`--preset={name}`**" if name == "tail" else name]
        for scheme, _ in SCHEMES:
            mean = scores[scheme][name]["mean"]
            cells.append(with_error(mean["hipADE_m"], mean["hipADE_standard_error_m"]) +
                         " / " + number(mean["hipFDE_m"]))
        cells.append(difference(differences["stratified"][name]) if name in differences["stratified"] else None)
        cells += [first[name]["falls"] or None, settle(first[name])]
        rows.append(cells)
    return studies.table(["held out", *[title for _, title in SCHEMES], "difference of hipADE, 5 x 4 folds",
                          "fell, of 160", "settle"], rows)


def on_top(candidates, *arguments):
    names = {flags: flags.replace(":", " ") for flags in candidates}  # a colon ends a name
    scores, differences = validate([(name, flags) for flags, name in names.items()], "--yardsticks=false",
                                   *arguments)
    rows = []
    for flags, name in names.items():
        p = scores[name]
        rows.append([f"`{flags}`", difference(differences[name]), p["falls"], settle(p)])
    return studies.table(["on top of `--preset=tail`", "difference of hipADE, m", "leave the model's domain", "settle"],
                         rows)


def changes():
    return on_top(CHANGES)


def networks():
    return on_top(NETWORKS, "--repeats=1")


def bands():
    mean = studies.on_recordings("pushid-crossvalidate", "single", "--bands", "--yardsticks=false").json["predictors"][1]["mean"]

    def metric(name, unit):
        return with_error(mean[f"{name}_{unit}"], mean[f"{name}_standard_error_{unit}"])

    return studies.table(["held out, 5 x 4 folds", "inside 50 %", "inside 90 %"],
                         [[axis, metric(f"inside50_{axis}", "share"), metric(f"inside90_{axis}", "share")] for axis in "xy"])


if __name__ == "__main__":
    studies.main(__file__, {"summary": summary, "schemes": schemes, "changes": changes, "networks": networks,
                            "bands": bands})
