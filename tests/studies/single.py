"""The 32 recordings of single people: what the fit says, and three kinds of intervals of the same parameters.

summary     the drag of the feet in a sentence (README.md)
transcript  the report of pushid-fit (ident/README.md)
depends     the same fit with other assumptions and without one person (ident/README.md)
intervals   clustered, profile and bootstrap (ident/uncertainty/README.md); a minute
coupled     mu, Kp_x and Kp_y all free (ident/uncertainty/README.md); a second

Times are those of one core; without one, seconds.
"""
import json
import math
import re

import studies
from studies import number, with_error

FREE = ["--preset_priors=false", "--settling_weight=0"]


def fit(*flags):
    return studies.fit("single", *flags)


def transcript():
    text = studies.on_recordings("pushid-fit", "single", out=None, keep=False).text
    return studies.transcript("pushid-fit --recordings=M/manifest.json --setting=single", text)


def interval(bounds):
    return " to ".join(number(float(end)) if math.isfinite(float(end)) else "open" for end in bounds)


def estimates(model):
    """By name; parameters and what is derived from them."""
    return {p["name"]: p for p in model["derived"] + model["parameters"]}


def estimate(p):
    error = p.get("total", p).get("standard_error")
    return number(p["value"]) if error is None else with_error(p["value"], error)


def summary():
    told = estimates(fit().json)
    free = estimates(fit(*FREE).json)
    return (f"On the 32 published recordings of four people the drag of the stepping feet, c_x = mu + Kp_x, is "
            f"{with_error(told['c_x']['value'], told['c_x']['total']['standard_error'])} N s/m for 85 kg (95 %: {interval(told['c_x']['interval'])}); without priors "
            f"and settling simulations the same data give {estimate(free['c_x'])}: a net push holds all forces "
            f"while it lasts, and little is recorded after it.")


def without(subject):
    with open(studies.MANIFEST, encoding="utf-8") as file:
        recordings = json.load(file)["recordings"]
    ids = [r["id"] for r in recordings if r["setting"] == "single" and r["subjects"][0]["id"] == subject]
    return f"--leave_out={','.join(ids)}"


def depends():
    variants = [("all 32 recordings, default flags", []), ("`--preset_priors=false`", ["--preset_priors=false"]),
                ("`--settling_weight=0`", ["--settling_weight=0"]), ("both", FREE)]
    variants += [(f"without {s}", [without(s)]) for s in fit().json["subjects"]]
    rows = []
    for title, flags in variants:
        model = fit(*flags).json
        told = estimates(model)
        names = ("c_x", "Kp_theta/(m g l)", "a_x", "tail_gain", "tail_time")
        rows.append([title] + [estimate(told[n]) for n in names] + ["yes" if model["behaviour"]["settles"] else "no"])
    return studies.table(["", "c_x, N s/m", "Kp_theta/(m g l)", "a_x, m/s^2/rad", "tail_gain", "tail_time, s",
                          "settles"], rows)


def intervals():
    model = studies.check(fit(), "--profile", "--bootstrap=199").json
    profiles = {p["name"]: p for p in model["profiles"]}
    resampled = {p["name"]: p for p in model["bootstrap"]["parameters"]}
    rows = []
    for p in model["parameters"]:
        if p["status"] == "fixed":
            continue
        name = p["name"]
        rows.append([f"`{name}`", p["unit"], with_error(p["value"], p["standard_error"]),
                     number(p["standard_error_naive"], 2), interval(p["interval_95"]),
                     interval(profiles[name]["interval_95"]), interval(resampled[name]["interval_95"]),
                     (profiles[name]["class_by_data_alone"] or "-").replace("_", " ")])
    return studies.table(["parameter", "unit", "estimate, clustered error", "naive error", "clustered 95 %",
                          "profile 95 %", "bootstrap 95 %, 199 replicas", "by the data alone"], rows)


def coupled():
    told = re.search(r"Unidentifiable(.|\n)*?(?=\n[A-Z])", fit("--free=Kp_x,Kp_y", "--details").text)[0]
    return studies.transcript("pushid-fit --recordings=M/manifest.json --setting=single --free=Kp_x,Kp_y --details",
                              "...\n" + told)


if __name__ == "__main__":
    studies.main(__file__, {"summary": summary, "transcript": transcript, "depends": depends, "intervals": intervals,
                            "coupled": coupled})
