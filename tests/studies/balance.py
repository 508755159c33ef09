"""Balance as a laboratory measures it: reaction delay, moving ground, force platforms. People are those of lab_people.py,
which has no code of pushid (tests/models/late_person_test.cc holds rollouts against such code).

delay      fits of people who react late, with platforms and without; half an hour on two cores
lag        the same people fitted without a delay: is it named; and people who do not react late: is it not
speed      a fit of 20 recordings of 10 s at 100 Hz with platforms

Needs NumPy. PUSHID_STUDIES is the number of studies of `delay` (default 100, half of them for `lag`).
"""
import concurrent.futures
import dataclasses
import json
import math
import os
import subprocess
import tempfile
import time

import numpy as np

import independent_people as people
import lab_people as lab
import studies
from studies import number

SETS = int(os.environ.get("PUSHID_STUDIES", "100"))
FPS, SECONDS, SUBJECTS, TRIALS = 100, 3.0, 6, 6
GAINS = ("Kp_theta", "Kd_theta", "reaction_delay")


@dataclasses.dataclass
class Study:
    seed: int
    platform: bool = True  # steps of the ground; pushes at the hip otherwise
    plates: bool = True
    late: bool = True
    seconds: float = SECONDS
    trials: int = TRIALS
    subjects: int = SUBJECTS
    spread: float = 0.05  # of gains between people, of the logarithm


def truth_of(study, random):
    def factor():
        return 2.0 ** random.uniform(-0.5, 0.5)

    gains = {"Kp": 1600.0 * factor(), "Kd": 300.0 * factor(), "share": random.uniform(0.0, 0.6), "delay": random.uniform(0.08, 0.18)}
    if not study.late:
        gains["delay"] = 0.0
    return gains


def draw_person(study, random, truth):
    own = dict(truth)
    for name in ("Kp", "Kd"):
        own[name] *= math.exp(study.spread * random.standard_normal())
    return lab.Stander(random.uniform(55, 95), random.uniform(0.86, 1.0), own)


def draw_trial(study, random, k):
    """Push (N per kg at t), platform (m at t, m/s^2 at t), and how long the push lasts."""
    size, seconds = random.uniform(0.02, 0.05), random.uniform(0.3, 0.5)
    speed, lasts = random.uniform(0.05, 0.14), random.uniform(0.1, 0.4)
    if study.platform:
        return (lambda t: 0.0), lab.minimum_jerk(size if k % 2 else -size, 0.2, seconds), 0.0
    bump = people.half_sine(speed, lasts)
    return bump, lab.still(), lasts


def draw(study):
    """The truth, and (person, trial, motion) of all; gains with which somebody falls are drawn anew."""
    random = np.random.default_rng(1000 + study.seed)
    while True:
        truth, made = truth_of(study, random), []
        try:
            for s in range(study.subjects):
                person = draw_person(study, random, truth)
                for k in range(study.trials):
                    trial = draw_trial(study, random, k)
                    push, ground = trial[0], trial[1]
                    motion = person.run(lambda t: push(t) * person.mass, ground[1], study.seconds, FPS)
                    if abs(motion[1][-1]) > 0.02:
                        raise FloatingPointError("swings")
                    made.append((s, k, person, trial, motion))
            return random, truth, made
        except FloatingPointError:
            continue


def write(folder, study):
    random, truth, made = draw(study)
    noise = random.uniform(0.001, 0.005)
    recordings = []
    for s, k, person, (push, (shift, _), lasts), motion in made:
        name = f"s{s}_{k}"
        keys = lab.write_person(folder, name, person, motion, shift, noise, 0.002 if study.plates else None, random)
        if lasts:
            times, lean = motion[0], motion[1]
            hip = np.column_stack([person.rod * np.sin(lean), np.zeros_like(lean), person.rod * np.cos(lean)])
            people.write_push(f"{folder}/{name}_push.csv", lambda t: push(t) * person.mass, 0.0, hip, np.zeros((len(times), 2)), FPS,
                              lasts)
            keys.update(push_csv=f"{name}_push.csv", push_kind="external")
        recordings.append({"id": name, "setting": "single", "pushed_person": 0,
                           "subjects": [{"id": f"s{s}", "mass_kg": round(person.mass, 2)}], **keys})
    with open(f"{folder}/manifest.json", "w", encoding="utf-8") as file:
        json.dump({"recordings": recordings}, file)
    return {"Kp_theta": truth["Kp"], "Kd_theta": truth["Kd"], "reaction_delay": truth["delay"], "passive_stiffness": truth["share"],
            "passive_damping": truth["share"], "com_height": 1.09}


def fit(folder, *flags):
    """The printed report and the model; None where there is no fit."""
    path = f"{folder}/model.json"
    if os.path.exists(path):
        os.remove(path)
    command = [os.path.join(studies.BIN, "pushid-fit"), f"--recordings={folder}/manifest.json", f"--model_out={path}", "--quiet",
               "--num_threads=1", *flags]
    done = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, OPENBLAS_NUM_THREADS="1"))
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        return done.stdout, json.load(file)


def fitted(arguments):
    """(truth, free parameters, report) of a study's fit; kept under the programs' hash."""
    study, flags = arguments
    program = studies.program_bytes(os.path.join(studies.BIN, "pushid-fit"))
    key = studies.hashlib.sha256(program + (repr(study) + repr(flags)).encode()).hexdigest()[:16]
    kept = os.path.join(studies.KEPT, f"balance-{key}.json")
    if not os.path.exists(kept):
        os.makedirs(studies.KEPT, exist_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            truth = write(folder, study)
            done = fit(folder, *flags)
        found = None if done is None else [truth, [p for p in done[1]["parameters"] if p["status"] != "fixed"], done[0]]
        with open(kept, "w", encoding="utf-8") as file:
            json.dump(found, file)
    with open(kept, encoding="utf-8") as file:
        return json.load(file)


def all_fitted(each, sets, *flags):
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        found = list(pool.map(fitted, [(dataclasses.replace(each, seed=seed), flags) for seed in range(1, sets + 1)]))
    return [f for f in found if f is not None]


def holds(estimate, truth, total=True):
    low, high = map(float, estimate["interval" if total else "interval_95"])  # or "infinity"
    return low <= truth <= high


def percent(part, whole):
    return "-" if whole == 0 else f"{100.0 * part / whole:.0f} %"


LATE = ("--stance=fixed", "--delay=one")


def delay():
    rows = []
    for name, each in (("ground steps, platforms", Study(0)), ("ground steps, markers alone", Study(0, plates=False)),
                       ("pushes, platforms", Study(0, platform=False)), ("pushes, markers alone", Study(0, platform=False, plates=False))):
        found = all_fitted(each, SETS, *LATE)
        judged = [(e, truth[e["name"]]) for truth, estimates, _ in found for e in estimates if e["name"] in truth]
        called = [(e, t) for e, t in judged if e["status"] == "identified"]
        off = sorted(abs(e["value"] - t) for e, t in judged if e["name"] == "reaction_delay")
        bias = {n: np.median([e["value"] / t for e, t in judged if e["name"] == n]) for n in GAINS}
        share = [percent(sum(e["status"] == "identified" for e, _ in judged if e["name"] == n), len(found)) for n in GAINS]
        rows.append([name, len(found), percent(sum(holds(e, t) for e, t in called), len(called)), len(called),
                     percent(sum(holds(e, t, False) for e, t in judged), len(judged)), number(1000.0 * off[len(off) // 2], 3),
                     *share, " / ".join(f"{bias[n]:.2f}" for n in GAINS)])
    return studies.table(["data", "fits", "identified that hold the truth", "of", "all 95 % intervals that do", "delay off by, ms (median)",
                          "`Kp_theta` identified", "`Kd_theta`", "`reaction_delay`", "median over the truth"], rows)


def lag():
    rows = []
    for name, each in (("late, ground steps, platforms", Study(0)), ("late, pushes, platforms", Study(0, platform=False)),
                       ("late, ground steps, markers", Study(0, plates=False)),
                       ("late, pushes, markers", Study(0, platform=False, plates=False)),
                       ("not late, ground steps, platforms", Study(0, late=False)),
                       ("not late, pushes, platforms", Study(0, platform=False, late=False)),
                       ("not late, pushes, markers", Study(0, platform=False, plates=False, late=False))):
        found = all_fitted(each, max(10, SETS // 2), "--stance=fixed")
        named = sum("The response lags" in report for _, _, report in found)
        kd = np.median([e["value"] / truth["Kd_theta"] for truth, estimates, _ in found for e in estimates if e["name"] == "Kd_theta"])
        identified = sum(e["status"] == "identified" for _, estimates, _ in found for e in estimates if e["name"] == "Kd_theta")
        rows.append([name, len(found), percent(named, len(found)), number(kd, 2), percent(identified, len(found))])
    return studies.table(["people, fitted without a delay", "fits", "the lag is named", "`Kd_theta` over the truth (median)",
                          "`Kd_theta` called identified"], rows)


def speed():
    """20 recordings of 10 s: five of each of four people."""
    rows = []
    for name, flags in (("without a delay", ["--stance=fixed"]), ("`--delay=one`", list(LATE))):
        with tempfile.TemporaryDirectory() as folder:
            write(folder, Study(1, seconds=10.0, subjects=4, trials=5))
            times = []
            for _ in range(3):
                begin = time.monotonic()
                fit(folder, *flags)
                times.append(time.monotonic() - begin)
        rows.append([name, number(min(times), 2)])
    return studies.table(["20 recordings of 10 s at 100 Hz, platforms, one thread", "s, with files and report"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"delay": delay, "lag": lag, "speed": speed})
