"""Does "identified" hold outside the model's own world? Default fits of people that tests/studies/independent_people.py simulates.

faults    something is wrong with the files, the people or the model; 10 minutes on two cores
sound     nothing is wrong, but there is noise, and few people; three times as many sets
few       nothing is wrong, but there is one person, or one recording, or all people are alike
power     how much of what the data decide is called identified; and with errors of the pushes' height, gains pooled or not
standing  people whose feet never move

An interval that is called identified and does not hold the truth is wrong; so is any identified drag or lean term of feet that
never moved. Needs NumPy. PUSHID_STUDIES is the number of sets of people per row (default 12).
"""
import concurrent.futures
import dataclasses
import functools
import hashlib
import json
import math
import os
import subprocess
import tempfile

import numpy as np

import independent_people as people
import studies

SETS = int(os.environ.get("PUSHID_STUDIES", "12"))
MASS, ROD = 85.0, 0.95  # the reference person, whom gains are quoted for
STIFFNESS, DAMPING = 0.9 * MASS * people.G * ROD, 0.9 * MASS * ROD**2  # m g l; m l^2
HELD_KD = 70.0 / DAMPING  # 1/s; what default fits hold
FEET = ("mu", "mu_y", "a_x", "a_y")


@dataclasses.dataclass
class Study:
    """A set of people, their pushes, and what is wrong with the files."""
    seed: int
    subjects: int = 6
    pushes: int = 5  # of each
    fps: int = 60
    noise: float = 0.002  # m
    spread: float = 0.1  # of gains between people, of the logarithm
    factor: float = 1.5  # between the truth and the middle of what people are like
    around: bool = False  # pushed from all sides
    turn: float = 0.0  # rad, of everything about the vertical
    kd: float = HELD_KD
    links: int = 0  # of those who stand; 0: they slide
    delay: float = 0.0  # s, of reactions
    scale: float = 1.0  # of the pushes in the files
    mass: float = 1.0  # of the masses
    height: float = 1.0  # of the sensor, over that of the push
    aim: float = 0.0  # m, by which the height of each push in the files is off
    heights: float = 0.0  # within which pushes are below the hip, of the rod
    rests: float = 0.0  # 1/s, how fast the slowest mode of the mean person decays at least; 0: or grows
    drift: float = 0.0  # m, of the cameras over a recording
    rate: float = 1.0  # of the frames
    memory: float = 0.0  # of one frame's noise in the next
    exact_start: bool = False  # frame 0 has no noise
    weighed: float = 0.0  # by how much a person's mass in the files differs between recordings


def truth_of(study, random):
    """The gains of the mean person, per mass."""
    def draw(middle):
        return middle * math.exp(random.uniform(-1, 1) * math.log(study.factor))

    if study.links:
        return {"kp": random.uniform(1.25, 1.9), "kd": random.uniform(0.3, 0.5)}
    while True:
        truth = {"c": draw(0.5), "a": -draw(8.0), "k": draw(2.2), "d": study.kd}
        if not study.rests or growth(truth) < -study.rests:
            return truth


def growth(truth):
    """Of the slowest mode of the mean person who slides, 1/s, without the place of the cart: d(speed, lean, rate)/dt, linearly."""
    inertia = np.array([[1.0, 0.9 * ROD], [0.9 * ROD, 0.9 * ROD**2]])
    forces = np.array([[-truth["c"], truth["a"], 0.0], [0.0, 0.9 * people.G * ROD * (1.0 - truth["k"]), -0.9 * ROD**2 * truth["d"]]])
    speed, rate = np.linalg.solve(inertia, forces)
    return max(np.linalg.eigvals(np.array([speed, [0.0, 0.0, 1.0], rate])).real)


def in_names_of_pushid(study, truth):
    if study.links:
        body = MASS * people.G * ROD
        return {name + axis: truth[name.lower()] * body for name in ("Kp", "Kd") for axis in ("_theta", "_phi")}
    return {"mu": truth["c"] * MASS, "mu_y": truth["c"] * MASS, "a_x": truth["a"], "a_y": truth["a"],
            "Kp_theta": truth["k"] * STIFFNESS, "Kp_phi": truth["k"] * STIFFNESS, "Kd_theta": truth["d"] * DAMPING,
            "Kd_phi": truth["d"] * DAMPING}


def draw_person(study, random, truth):
    mass, rod = random.uniform(55, 95), random.uniform(0.86, 1.0)
    own = {name: value * math.exp(study.spread * random.standard_normal()) for name, value in truth.items()}
    if not study.links:
        return people.Slider(mass, rod, own, study.delay)
    body = mass * people.G * rod
    return people.Stander(mass, rod, own["kp"] * body, own["kd"] * body, study.delay, study.links)


def draw_pushes(study, random, person):
    """(direction, duration, height, force, motion) of each; FloatingPointError of who falls."""
    made = []
    for _ in range(study.pushes):
        direction = random.uniform(-math.pi, math.pi) if study.around else random.uniform(-0.1, 0.1)
        speed = random.uniform(0.05, 0.16) if study.links else random.uniform(0.1, 0.6)  # impulse over mass, m/s
        duration = random.uniform(0.1, 0.4)
        force = people.half_sine(speed * person.mass, duration)
        person.height = 1.0 - (random.uniform(0.0, study.heights) if study.heights else 0.0)
        made.append((direction, duration, person.height, force, person.run(force, direction, 1.5, study.fps)))
    return made


def draw_people(study, random):
    """The truth, and (person, pushes) of everybody; gains with which nearly everybody falls are drawn anew."""
    while True:
        truth, pushed = truth_of(study, random), []
        for _ in range(20 * study.subjects):
            person = draw_person(study, random, truth)
            try:
                pushed.append((person, draw_pushes(study, random, person)))
            except FloatingPointError:
                continue
            if len(pushed) == study.subjects:
                return truth, pushed


def write(folder, study):
    """The files of a study; its truth."""
    random = np.random.default_rng(study.seed)
    truth, pushed = draw_people(study, random)
    recordings, turn = [], people.turned(study.turn)
    for s, (person, pushes) in enumerate(pushed):
        for k, (direction, duration, height, force, (times, hip, feet)) in enumerate(pushes):
            name, hip, feet = f"s{s}_{k}", hip @ turn.T, feet @ turn[:2, :2].T
            people.write_points(f"{folder}/{name}.csv", times / study.rate, people.points_of(hip, feet, turn), study.noise, random,
                                study.drift, study.memory, study.exact_start)
            off = study.aim / person.rod * random.standard_normal() if study.aim else 0.0
            people.write_push(f"{folder}/{name}_push.csv", force, direction + study.turn, hip, feet, study.fps, duration, study.scale,
                              height * study.height + off)
            recordings.append({"id": name, "setting": "single", "pushed_person": 0, "csv": [f"{name}.csv"], "length_unit": "m",
                               "subjects": [{"id": f"s{s}", "mass_kg": round(person.mass * study.mass * (1 + study.weighed * (k % 7 - 3) / 3), 2)}],
                               "push_csv": f"{name}_push.csv", "push_kind": "external"})
    with open(f"{folder}/manifest.json", "w", encoding="utf-8") as file:
        json.dump({"recordings": recordings}, file)
    return in_names_of_pushid(study, truth)


def files_of(study):
    """The folder and the truth of a study's files, which are written once."""
    key = hashlib.sha256(open(people.__file__, "rb").read() + repr(study).encode()).hexdigest()[:16]
    folder = os.path.join(studies.KEPT, f"world-{key}")
    if not os.path.exists(f"{folder}/truth.json"):
        os.makedirs(folder, exist_ok=True)
        truth = write(folder, study)
        with open(f"{folder}/truth.json", "w", encoding="utf-8") as file:
            json.dump(truth, file)
    with open(f"{folder}/truth.json", encoding="utf-8") as file:
        return folder, json.load(file)


def fitted(study, flags=()):
    """The verdict and the free parameters of a fit by these flags, with their truth; None where there is no fit."""
    files, truth = files_of(study)
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/model.json"
        command = [os.path.join(studies.BIN, "pushid-fit"), f"--recordings={files}/manifest.json", f"--model_out={path}", "--quiet",
                   "--num_threads=1", *flags]
        subprocess.run(command, capture_output=True, env=dict(os.environ, OPENBLAS_NUM_THREADS="1"))
        if not os.path.exists(path):
            return None
        with open(path, encoding="utf-8") as file:
            model = json.load(file)
    rows = [dict(e, truth=truth.get(e["name"])) for e in model["parameters"] if e["status"] != "fixed"]
    return model["verdict"]["fails"], rows


def holds(interval, truth):
    return truth is not None and interval[0] <= truth <= interval[1]


def row(name, change, sets, flags=()):
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        every = pool.map(functools.partial(fitted, flags=flags), [Study(seed, **change) for seed in range(1, sets + 1)])
        fits = [fit for fit in every if fit is not None]
    feet_stand = bool(change.get("links"))
    judged = [e for _, rows in fits for e in rows if e["truth"] is not None or (feet_stand and e["name"] in FEET)]
    before = [e for e in judged if e["status"] in ("identified", "model-dependent") or narrow_by_data(e)]
    identified = [e for e in judged if e["status"] == "identified"]
    wrong = [e for e in identified if not holds(e["interval"], e["truth"])]
    known = [e for e in judged if e["truth"] is not None]
    return [name, len(fits), sum(fails for fails, _ in fits), len(before), len(identified), len(wrong),
            ", ".join(f"`{n}`" for n in sorted({e["name"] for e in wrong})),
            f"{sum(holds(e['interval_95'], e['truth']) for e in known)} of {len(known)}",
            f"{sum(holds(e['interval'], e['truth']) for e in known)} of {len(known)}"]


def narrow_by_data(estimate):
    """Whether the interval of the data alone would be called identified: so it was before there were total errors."""
    low, high = estimate["interval_95"]
    shares, error = estimate["shares"], estimate["standard_error"]
    pull = abs(estimate["pull"]["prior"] + estimate["pull"]["settling"])
    return shares["data"] > 0.8 and pull < 0.5 * error and high - low < abs(estimate["value"])


FAULTS = {
    "nothing": {},
    "pushes x 1.2": {"scale": 1.2},
    "masses + 15 %": {"mass": 1.15},
    "sensor 10 cm too high": {"height": 1.11},
    "cameras drift by 3 cm": {"drift": 0.03},
    "frame rate + 5 %": {"rate": 1.05},
    "true `Kd_theta` 20, held 70": {"kd": 20.0 / DAMPING},
    "true `Kd_theta` 200, held 70": {"kd": 200.0 / DAMPING},
    "all but the drag 0.08 s late, true `Kd_theta` 250": {"delay": 0.08, "kd": 250.0 / DAMPING},
    "0.12 s late": {"delay": 0.12, "kd": 250.0 / DAMPING},
    "all turned by 30 degrees": {"turn": math.radians(30)},
    "pushed from all sides": {"around": True},
}
SOUND = {
    "noise of 1 mm": {"noise": 0.001},
    "of 5 mm": {"noise": 0.005},
    "of 8 mm": {"noise": 0.008},
    "of 5 mm, 0.9 of it from the frame before": {"noise": 0.005, "memory": 0.9},
    "two people": {"subjects": 2, "pushes": 8},
    "three people": {"subjects": 3, "pushes": 8},
    "truths within a factor of 5": {"factor": 5.0},
}
# Of one person the truth is that person's own: there is no spread.
FEW = {
    "one recording": {"subjects": 1, "pushes": 1, "spread": 0.0},
    "two recordings of one person": {"subjects": 1, "pushes": 2, "spread": 0.0},
    "one person, weighed anew before each of 6 pushes": {"subjects": 1, "pushes": 6, "spread": 0.0, "weighed": 0.003},
    "six people who are alike, all pushed at one height": {"spread": 0.0},
    "ten people who are alike": {"subjects": 10, "spread": 0.0},
    "ten people who are alike, frame 0 without noise": {"subjects": 10, "spread": 0.0, "exact_start": True},
}
# Ten people who come to rest within about two seconds.
REST = {"subjects": 10, "rests": 2.0}
POWER = {
    "pushed at 0.7 to 1 of the rod": {**REST, "heights": 0.3},
    "at one height": REST,
    "at 0.7 to 1, all 5 cm off in the files": {**REST, "heights": 0.3, "height": 1.055},
    "at one height, all 5 cm off": {**REST, "height": 1.055},
    "at 0.7 to 1, each 5 cm off by itself": {**REST, "heights": 0.3, "aim": 0.05},
    "at one height, each 5 cm off by itself": {**REST, "aim": 0.05},
}
POOLED = ("--pool=all", "--pool_by=subject")
STANDING = {f"{links} link{'s' * (links > 1)}, delay {delay:g} s": {"links": links, "delay": delay, "subjects": 6, "pushes": 6,
                                                                   "spread": 0.05}
            for links in (1, 2) for delay in (0.0, 0.12)}
STANDING["1 link, delay 0 s, markers of 10 mm"] = {**STANDING["1 link, delay 0 s"], "noise": 0.01}


def table(what, rows, sets, ways={"": ()}):
    header = [what, "fits", "model does not fit", "identified by the data alone", "called identified", "of these wrong", "which",
              "95 % intervals that hold the truth", "total ones"]
    return studies.table(header, [row(name + way, change, sets, flags) for way, flags in ways.items() for name, change in rows.items()])


if __name__ == "__main__":
    studies.main(__file__, {"faults": lambda: table("what is wrong", FAULTS, SETS), "sound": lambda: table("sound data", SOUND, 3 * SETS),
                            "few": lambda: table("few people, or all alike", FEW, 2 * SETS),
                            "power": lambda: table("ten people who come to rest", POWER, 2 * SETS, {"": (), "; pooled": POOLED}),
                            "standing": lambda: table("who stands", STANDING, SETS)})
