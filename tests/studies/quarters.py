"""How much data does it take? Fits of parts of the recordings, judged on all the others.

curve     errors by the share of the recordings that were fitted (ident/validation/README.md) and their picture; half an hour of one core
quarters  the ten quarters one by one (ident/validation/README.md); the same fits
bodies    the whole chain on quarters, beside siMLPe (ident/validation/README.md); eight minutes of one core

Parts are drawn stratified by setting, strength and pushed person; deals are whole but for the last, so that a recording is
in at most one part more than another.
`curve` and `quarters`: physics alone, with rigid bodies on the pendulums; MBLE is 0 for these. Three quarters: four of the quarters the other way
round.
"""
import collections
import hashlib
import json
import os
import random
import statistics

import line_chart
import studies
from studies import number

SHARES = [(8, "1/8"), (4, "1/4"), (2, "1/2")]
DRAWS = 10
METRICS = [("MPJPE_m", "MPJPE, m"), ("hipADE_m", "hipADE, m"), ("hipFDE_m", "hipFDE, m")]


def recordings(setting):
    with open(studies.MANIFEST, encoding="utf-8") as file:
        entries = json.load(file)["recordings"]
    return [e for e in entries if (len(e["subjects"]) == 1) == (setting == "single")]


def parts(setting, divisor):
    """DRAWS lists of ids, every stratum dealt out in turn."""
    strata = collections.defaultdict(list)
    for e in recordings(setting):
        strata[(e["setting"], e["magnitude"], e["subjects"][e.get("pushed_person", 0)]["id"])].append(e["id"])
    order = random.Random(divisor)
    drawn = []
    while len(drawn) < DRAWS:
        dealt = [[] for _ in range(divisor)]
        place = 0
        for key in sorted(strata):
            ids = list(strata[key])
            order.shuffle(ids)
            for one in ids:
                dealt[place % divisor].append(one)
                place += 1
        drawn += [sorted(ids) for ids in dealt]
    return drawn[:DRAWS]


def fitted(setting, part):
    preset = "--preset=tail" if setting == "single" else "--preset=group"
    return studies.fit(setting, preset, f"--ids={','.join(part)}", "--quiet")


def score(setting, part, judged):
    """The errors of a fit of some recordings on others, and the model."""
    model = fitted(setting, part)
    out = studies.on_recordings("pushid-evaluate", setting, f"--model={model.path}", f"--ids={','.join(judged)}",
                                "--restoration=rigid", "--quiet").json
    return dict(out["mean"], failed=sum("failure" in r for r in out["recordings"]), model=model.json)


def scores(setting, divisor):
    """Of each part, fitted and judged on all others."""
    ids = [e["id"] for e in recordings(setting)]
    return [score(setting, part, [i for i in ids if i not in part]) for part in parts(setting, divisor)]


def three_quarters(setting):
    """The first four quarters the other way round: judged by what the rest of the recordings gave."""
    ids = [e["id"] for e in recordings(setting)]
    return [score(setting, [i for i in ids if i not in part], part) for part in parts(setting, 4)[:4]]


def curve():
    rows, lines = [], {}
    shares = [*(title for _, title in SHARES), "3/4"]
    for setting in ("single", "groups"):
        lines[setting] = []
        for title, found in [(t, scores(setting, d)) for d, t in SHARES] + [("3/4", three_quarters(setting))]:
            cells = []
            for key, _ in METRICS:
                values = [one[key] for one in found]
                cells.append(f"{number(statistics.mean(values))} ({number(min(values), 2)} to {number(max(values), 2)})")
            feet = f"{number(statistics.mean(one['FSE_cm'] for one in found), 2)}"
            rows.append([setting, title, len(found), *cells, feet, sum(one["failed"] for one in found)])
            hips = [one["hipADE_m"] for one in found]
            lines[setting].append((statistics.mean(hips), min(hips), max(hips)))
    with open(os.path.join(studies.SOURCE, "tests/studies/pictures/quarters.svg"), "w", encoding="utf-8") as file:
        file.write(line_chart.chart("share of the recordings that was fitted", "hipADE on all others, m", shares, lines, 0.3, 0.1))
    return studies.table(["", "share fitted", "parts", *[title for _, title in METRICS], "FSE, cm", "failed rollouts"], rows)


def quarters():
    rows = []
    found = scores("single", 4)
    entries = {e["id"]: e for e in recordings("single")}
    for part, one in sorted(zip(parts("single", 4), found), key=lambda pair: pair[1]["hipADE_m"]):
        people = collections.Counter(entries[i]["subjects"][0]["id"] for i in part)
        strengths = collections.Counter(entries[i]["magnitude"] for i in part)
        values = {p["name"]: p["value"] for p in one["model"]["parameters"]}
        rows.append([number(one["hipADE_m"]), number(one["hipFDE_m"]),
                     ", ".join(f"{n} {name}" for name, n in sorted(strengths.items())),
                     ", ".join(f"{n} {name}" for name, n in sorted(people.items())),
                     *[number(values[name]) for name in ("mu", "Kp_theta", "a_x", "tail_gain", "tail_torque")]])
    return studies.table(["hipADE, m", "hipFDE, m", "pushes", "people", "mu", "Kp_theta", "a_x", "tail_gain", "tail_torque"],
                         rows)


def trained(setting, part, *flags):
    """A restoration of some recordings; the folder is named after what it was made of."""
    name = hashlib.sha256(repr((setting, part, flags)).encode()).hexdigest()[:12]
    folder = os.path.join(studies.KEPT, f"restoration_{name}")
    model = fitted(setting, part)
    studies.on_recordings("pushid-train-restoration", setting, f"--model={model.path}", f"--ids={','.join(part)}",
                          f"--out={folder}", "--quiet", *flags, out=None, keep=False)
    return folder


def chain(setting, part):
    """The chain and siMLPe, trained on a part and judged on all else; siMLPe is given 12 frames and judged after them."""
    judged = [e["id"] for e in recordings(setting) if e["id"] not in part]
    view = "--sees=neighbours" if setting == "groups" else "--sees=pendulum"
    return studies.on_recordings("pushid-evaluate", setting, f"--model={fitted(setting, part).path}",
                                 f"--ids={','.join(judged)}", f"--restoration={trained(setting, part, view)}",
                                 f"--peer={trained(setting, part, '--kind=simlpe')}", "--quiet").json


def bodies():
    rows = []
    for setting in ("single", "groups"):
        found = [chain(setting, part) for part in parts(setting, 4)]
        for title, of in [("physics and `window`", lambda one: one["mean"]),
                          ("siMLPe, given 12 frames", lambda one: one["baselines"]["simlpe"]["mean"])]:
            cells = []
            for key in ("MPJPE_m", "hipADE_m", "hipFDE_m", "FSE_cm"):
                values = [of(one)[key] for one in found]
                cells.append(f"{number(statistics.mean(values))} ({number(min(values), 2)} to {number(max(values), 2)})")
            cells.insert(3, f"{statistics.mean(of(one)['MBLE_m'] for one in found):.3f}")
            rows.append([setting, title, *cells])
    return studies.table(["a quarter", "", *[title for _, title in METRICS], "MBLE, m", "FSE, cm a frame"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"curve": curve, "quarters": quarters, "bodies": bodies})
