"""A laboratory's cart and pole, whose motor pushes the cart: mass share, drag, dry friction and the motor's gain, told apart where the
data can. The rig is that of lab_people.py, which has no code of pushid.

rigs       what is found of ten of them

Needs NumPy. PUSHID_STUDIES is the number of rigs (default 10).
"""
import json
import math
import os
import tempfile

import numpy as np

import balance
import independent_people as people
import lab_people as lab
import studies
from studies import number

RIGS = int(os.environ.get("PUSHID_STUDIES", "10"))
RIG = ("--preset=ldp", "--body=table", "--friction=coulomb", "--stance=slide", "--fix=Kp_theta=0,Kp_phi=0,Kd_theta=0,Kd_phi=0,Kp_x=0",
       "--settling_weight=0", "--marker_noise=0.0001",
       "--resample_fps=1000")  # a falling pole: steps of 5 ms are too long for semi-implicit Euler
RIG_FREE = "mu=0.5,mu_coulomb,cart_share=0.65"


def names_of(free):
    return [name.split("=")[0] for name in free.split(",")]


def write_rig(folder, seed, gain=1.0):
    """Recordings of a cart and a pole whose motor pushes `gain` times what is written; -> the truth."""
    random = np.random.default_rng(7000 + seed)
    rig, fps, recordings = lab.CartPole(), 200, []
    for k in range(24):
        # A pull to and fro, after which the pole is still up; who waits longer sees it fall.
        size, turn = random.uniform(1.0, 2.0) * (1 if k % 2 else -1), random.uniform(0.1, 0.16)
        times, place, angle, force = rig.run(lambda t: size if t < turn else -size if t < 2 * turn else 0.5 * size, 0.5, fps)
        seen = place + 1e-4 * random.standard_normal(len(place)), angle + 5e-4 * random.standard_normal(len(angle))
        feet = np.column_stack([seen[0], np.zeros_like(times)])
        hip = np.column_stack([seen[0] + rig.length * np.sin(seen[1]), np.zeros_like(times), rig.length * np.cos(seen[1])])
        people.write_points(f"{folder}/r{k}.csv", times, people.points_of(hip, feet, np.eye(3)), 0.0, random)
        # The motor holds a force from frame to frame; a row is the mean over half a frame before and after its own.
        rows = 0.5 * (force + np.concatenate([[0.0], force[:-1]]))[:-1]
        with open(f"{folder}/r{k}_push.csv", "w", encoding="utf-8") as file:
            file.write("frame,fx,fy,ftheta,fphi\n" + "".join(f"{i},{f / gain:.6f},0,0,0\n" for i, f in enumerate(rows)))
        recordings.append({"id": f"r{k}", "setting": "single", "pushed_person": 0, "subjects": [{"id": "rig", "mass_kg": 0.7}],
                           "csv": [f"r{k}.csv"], "length_unit": "m", "push_csv": f"r{k}_push.csv", "push_kind": "external"})
    with open(f"{folder}/manifest.json", "w", encoding="utf-8") as file:
        json.dump({"recordings": recordings}, file)
    return {"mu": rig.drag, "mu_coulomb": rig.dry, "cart_share": rig.cart / (rig.cart + rig.pole), "com_height": 0.5,
            "gyration_radius": 1 / math.sqrt(12.0), "push_gain": gain}


CASES = (("mass share, drag and dry friction of a uniform pole", RIG_FREE, 1.0),
         ("and the motor's gain", RIG_FREE + ",push_gain", 1.3),
         ("and where the pole's mass is", RIG_FREE + ",com_height=0.52,gyration_radius=0.3", 1.0))


def fitted(seed, free, gain):
    """(truth, estimates of what is free by name, whether a combination is named)."""
    with tempfile.TemporaryDirectory() as folder:
        truth = write_rig(folder, seed, gain)
        held = ",".join(f"{n}={truth[n]:.6g}" for n in ("cart_share", "com_height", "gyration_radius") if n not in names_of(free))
        flags = [f if not f.startswith("--fix=") or not held else f"{f},{held}" for f in RIG]
        report, model = balance.fit(folder, f"--free={free}", *flags)
    named = any("cannot be separated" in line for line in report.splitlines())
    return truth, {e["name"]: e for e in model["parameters"] if e["name"] in names_of(free)}, named


def rigs():
    rows = []
    for name, free, gain in CASES:
        found = [fitted(seed, free, gain) for seed in range(1, RIGS + 1)]
        named = sum(named for _, _, named in found)
        for parameter in names_of(free):
            values = [estimates[parameter]["value"] for _, estimates, _ in found]
            truth = found[0][0][parameter]
            hold = [balance.holds(estimates[parameter], truth) for _, estimates, _ in found if "interval_95" in estimates[parameter]]
            statuses = [estimates[parameter]["status"] for _, estimates, _ in found]
            status = max(sorted(set(statuses)), key=statuses.count)
            mean, deviation = float(np.mean(values)), float(np.std(values, ddof=1))
            rows.append([name, f"`{parameter}`", number(truth, 3), studies.with_error(mean, deviation),
                         f"{sum(hold)} of {len(hold)}", f"{status} ({statuses.count(status)})", f"{named} of {len(found)}" if name else ""])
            name = ""
    return studies.table(["fitted", "parameter", "truth", f"mean and deviation of {RIGS} rigs", "intervals that hold it", "status (rigs)",
                          "inseparable ones named"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"rigs": rigs})
