"""The 32 recordings of single people: what the fit says, and three kinds of intervals of the same parameters.

transcript  the report of pushid-fit (ident/README.md); a tenth of a second
intervals   clustered, profile and bootstrap (ident/uncertainty/README.md); two minutes
coupled     mu, Kp_x and Kp_y all free (ident/uncertainty/README.md); a second
starts      another optimum from other starts? (ident/solver/README.md); ten seconds

Times are those of one core.
"""
import studies
from studies import number, with_error


def fit(*flags):
    return studies.fit("single", *flags)


def transcript():
    text = fit().text.split("\n\nexplained least")[0]  # the diagnostics name recordings
    return studies.transcript("pushid-fit --recordings=M/manifest.json --setting=single", text)


def interval(bounds):
    return f"{number(bounds[0])} to {number(bounds[1])}"


def intervals():
    model = fit("--profile", "--bootstrap=199").json
    profiles = {p["name"]: p for p in model["profiles"]}
    resampled = {p["name"]: p for p in model["bootstrap"]["parameters"]}
    rows = []
    for p in model["parameters"]:
        if p["status"] == "fixed":
            continue
        name = p["name"]
        rows.append([f"`{name}`", p["unit"], with_error(p["value"], p["standard_error"]),
                     number(p["standard_error_naive"], 2), interval(p["interval_95"]),
                     interval(profiles[name]["interval_95"]), interval(resampled[name]["interval_95"])])
    return studies.table(["parameter", "unit", "estimate, clustered error", "naive error", "clustered 95 %",
                          "profile 95 %", "bootstrap 95 %, 199 replicas"], rows)


def coupled():
    lines = fit("--free=Kp_x,Kp_y").text.splitlines()
    told = [line for line in lines if "cannot be told apart" in line]
    return studies.transcript("pushid-fit --recordings=M/manifest.json --setting=single --free=Kp_x,Kp_y",
                              "...\n" + "\n".join(told))


def starts():
    found = fit("--starts=32").json["fit"]["starts"]
    best = min(s["cost"] for s in found if s["usable"])
    same = sum(1 for s in found if s["usable"] and s["cost"] - best <= 1e-6 * best)
    return (f"`pushid-fit --setting=single --starts=32`, every gain wrong by up to 5 times either way: {same} of "
            f"{len(found)} starts end at the same cost, {number(best, 6)}, to a relative 1e-6.")


if __name__ == "__main__":
    studies.main(__file__, {"transcript": transcript, "intervals": intervals, "coupled": coupled, "starts": starts})
