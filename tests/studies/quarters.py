"""How much data does it take? Fits of parts of the recordings, judged on all the others.

curve     errors by the share of the recordings that were fitted (ident/validation/README.md) and their picture; half an hour of one core
quarters  the ten quarters one by one (ident/validation/README.md); the same fits
ridge     ridge regression and who stays still on the same parts (ident/validation/README.md); ten minutes
bodies    the whole chain on quarters, (ident/validation/README.md); eight minutes of one core

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

import studies
from studies import number

SHARES = [(8, "1/8"), (4, "1/4"), (2, "1/2")]
DRAWS = 10
METRICS = [("MPJPE_m", "MPJPE, m"), ("hipADE_m", "hipADE, m"), ("hipFDE_m", "hipFDE, m")]


# Of the picture; safe for the colour-blind.
COLOURS = ["#0072b2", "#d55e00"]
DASHES = ["", "6 4"]
WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 640, 320, 60, 48, 20, 90


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


def chart(x_title, y_title, ticks, lines, top, step):
    """An SVG. lines: name -> a (mean, least, most) for each of the ticks, which stand side by side. The y axis goes from 0 to
    top in steps."""
    def x(i, shift=0):
        return LEFT + (i + 0.5) * (WIDTH - LEFT - RIGHT) / len(ticks) + shift

    def y(value):
        return HEIGHT - BOTTOM - value / top * (HEIGHT - BOTTOM - TOP)

    def text(at_x, at_y, words, anchor="middle", more=""):
        return f'<text x="{at_x:.1f}" y="{at_y:.1f}" text-anchor="{anchor}"{more}>{words}</text>'

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for k in range(round(top / step) + 1):
        height = y(k * step)
        parts.append(f'<path d="M{LEFT} {height:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
        parts.append(text(LEFT - 8, height + 4, f"{k * step:.1f}", "end"))
    parts += [text(x(i), HEIGHT - BOTTOM + 18, tick) for i, tick in enumerate(ticks)]
    parts.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, x_title))
    middle = (HEIGHT - BOTTOM + TOP) / 2
    parts.append(text(16, middle, y_title, more=f' transform="rotate(-90 16 {middle:.1f})"'))
    for (name, points), colour, dash, shift in zip(lines.items(), COLOURS, DASHES, (-4, 4)):
        places = [(x(i, shift), *map(y, point)) for i, point in enumerate(points)]
        path = "L".join(f"{px:.1f} {mean:.1f}" for px, mean, _, _ in places)
        parts.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        for px, mean, least, most in places:
            parts.append(f'<path d="M{px:.1f} {least:.1f}V{most:.1f}" stroke="{colour}" opacity="0.6"/>')
            parts.append(f'<circle cx="{px:.1f}" cy="{mean:.1f}" r="4" fill="{colour}"/>')
        parts.append(text(places[-1][0] + 10, places[-1][1] + (-6 if shift < 0 else 14), name, "start", f' fill="{colour}"'))
    return "\n".join(parts + ["</svg>"]) + "\n"


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
        file.write(chart("share of the recordings that was fitted", "hipADE on all others, m", shares, lines, 0.3, 0.1))
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


def folds_file(setting, divisor):
    """The parts as folds: each is fitted, all else held out."""
    ids = [e["id"] for e in recordings(setting)]
    fitted_ids = [[i for i in ids if i not in part] for part in parts(setting, 4)[:4]] if divisor is None else parts(setting, divisor)
    folds = [{"name": str(k + 1), "held_out": [i for i in ids if i not in part]} for k, part in enumerate(fitted_ids)]
    text = json.dumps({"folds": folds})
    path = os.path.join(studies.KEPT, f"folds_{hashlib.sha256(text.encode()).hexdigest()[:12]}.json")
    os.makedirs(studies.KEPT, exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def ridge():
    rows = []
    for setting in ("single", "groups"):
        preset = "--preset=tail" if setting == "single" else "--preset=group"
        for divisor, title in [*SHARES, (None, "3/4")]:
            found = studies.on_recordings("pushid-crossvalidate", setting, preset,
                                          f"--folds_file={folds_file(setting, divisor)}", "--quiet").json["predictors"]
            cells = []
            for predictor in (found[0], *(p for p in found if p["name"] in ("ridge", "static"))):
                for key in ("hipADE_m", "hipFDE_m"):
                    values = [fold[key] for fold in predictor["folds"]]
                    cells.append(f"{number(statistics.mean(values))} ({number(min(values), 2)} to {number(max(values), 2)})")
            rows.append([setting, title, len(found[0]["folds"]), *cells])
    heads = [f"{name}, {metric}" for name in ("physics", "ridge", "stays still") for metric in ("hipADE m", "hipFDE m")]
    return studies.table(["", "share fitted", "parts", *heads], rows)


def trained(setting, part, *flags):
    """A restoration of some recordings; the folder is named after what it was made of."""
    name = hashlib.sha256(repr((setting, part, flags)).encode()).hexdigest()[:12]
    folder = os.path.join(studies.KEPT, f"restoration_{name}")
    model = fitted(setting, part)
    studies.on_recordings("pushid-train-restoration", setting, f"--model={model.path}", f"--ids={','.join(part)}",
                          f"--out={folder}", "--quiet", *flags, out=None, keep=False)
    return folder


def others(setting, part):
    return ",".join(e["id"] for e in recordings(setting) if e["id"] not in part)


def chain(setting, part):
    """The chain, trained on a part and judged on all else."""
    view = "--sees=neighbours" if setting == "groups" else "--sees=pendulum"
    return studies.on_recordings("pushid-evaluate", setting, f"--model={fitted(setting, part).path}",
                                 f"--ids={others(setting, part)}", f"--restoration={trained(setting, part, view)}",
                                 "--quiet").json


def bodies():
    rows = []
    for setting in ("single", "groups"):
        found = [chain(setting, part)["mean"] for part in parts(setting, 4)]
        cells = []
        for key in ("MPJPE_m", "hipADE_m", "hipFDE_m", "FSE_cm"):
            values = [one[key] for one in found]
            cells.append(f"{number(statistics.mean(values))} ({number(min(values), 2)} to {number(max(values), 2)})")
        cells.insert(3, f"{statistics.mean(one['MBLE_m'] for one in found):.3f}")
        rows.append([setting, *cells])
    return studies.table(["a quarter", *[title for _, title in METRICS], "MBLE, m", "FSE, cm a frame"], rows)


if __name__ == "__main__":
    studies.main(__file__, {"curve": curve, "quarters": quarters, "ridge": ridge, "bodies": bodies})
