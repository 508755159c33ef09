"""Draws README.md's first picture: a push that travels through a row of people, predicted over recorded.

    python3 tests/studies/pictures/draw_row.py PAGE OUT.png   PAGE: what pushid-animate --restoration --out wrote
"""
import json
import re
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import colors, patches, pyplot  # noqa: E402

TIMES = (0.0, 0.6, 1.0, 1.65)  # s, one panel each
FARTHEST = 0.5  # m, the end of the scale of colours
# joint, joint, radius at each, m; joints as in models/restoration/body.h
LIMBS = [(0, 14, .10, .09), (0, 18, .10, .09), (0, 1, .125, .12), (1, 2, .12, .13), (2, 3, .13, .12), (3, 4, .07, .055),
         (3, 7, .085, .06), (3, 11, .085, .06), (7, 8, .05, .042), (8, 9, .04, .03), (11, 12, .05, .042), (12, 13, .04, .03),
         (14, 15, .085, .06), (15, 16, .06, .042), (16, 17, .045, .04), (18, 19, .085, .06), (19, 20, .06, .042),
         (20, 21, .045, .04)]


def data_of(page):
    with open(page, encoding="utf-8") as file:
        text = file.read()
    return json.JSONDecoder().raw_decode(text[re.search(r"data\s*=\s*(\{)", text).start(1):])[0]


def on_paper(points):
    """Oblique projection: x along the row, z up, y away from the viewer."""
    points = np.asarray(points, float)
    return np.stack([points[..., 0] - .30 * points[..., 1], points[..., 2] + .16 * points[..., 1]], axis=-1)


def capsule(axes, a, b, ra, rb, **style):
    way = b - a
    length = np.hypot(*way)
    angle = np.arctan2(way[1], way[0]) if length > 0 else 0.
    lean = np.arccos(np.clip((ra - rb) / length, -1, 1)) if length > abs(ra - rb) else np.pi / 2
    first = np.linspace(angle + lean, angle + 2 * np.pi - lean, 16)
    second = np.linspace(angle - lean, angle + lean, 16)
    circle = [a + ra * np.stack([np.cos(first), np.sin(first)], 1), b + rb * np.stack([np.cos(second), np.sin(second)], 1)]
    axes.add_patch(patches.Polygon(np.concatenate(circle), closed=True, linewidth=0, **style))


def draw_body(axes, joints, fill, edge, layer, alpha=1.):
    flat = on_paper(joints)
    order = sorted(LIMBS, key=lambda limb: -(joints[limb[0], 1] + joints[limb[1], 1]))
    head = joints[5] + .05 * (joints[5] - joints[4]) / max(1e-6, np.linalg.norm(joints[5] - joints[4]))
    for grow, colour, z in ((.012, edge, layer), (0., fill, layer + .1)):  # the outline of all, then all
        for a, b, ra, rb in order:
            away = .5 * (joints[a, 1] + joints[b, 1]) - joints[0, 1]  # what is far is darker
            shade = 1. if grow else np.clip(.93 - .9 * away, .78, 1.06)
            shaded = tuple(min(1., shade * c) for c in colors.to_rgb(colour))
            capsule(axes, flat[a], flat[b], ra + grow, rb + grow, color=shaded, zorder=z, alpha=alpha)
        axes.add_patch(patches.Circle(on_paper(head), .105 + grow, color=colour, linewidth=0, zorder=z, alpha=alpha))


def footprints(axes, body, until, dt, **style):
    """Where a foot has stood: its ankle and toe slower than 0.25 m/s for 0.1 s."""
    for ankle, toe in ((16, 17), (20, 21)):
        last = None
        for frame in range(0, until + 1, 3):
            near = body[max(0, frame - 3):frame + 4]
            speed = np.linalg.norm(near[-1][[ankle, toe], :2] - near[0][[ankle, toe], :2], axis=1).max() / (dt * (len(near) - 1))
            middle = .5 * (body[frame][ankle] + body[frame][toe])
            if speed > .25 or (last is not None and np.linalg.norm(middle[:2] - last[:2]) < .12):
                continue
            last = middle
            way = body[frame][toe] - body[frame][ankle]
            across = np.array([-way[1], way[0], 0.]) / max(1e-6, np.hypot(*way[:2])) * .07
            along = np.array([way[0], way[1], 0.]) / max(1e-6, np.hypot(*way[:2])) * .15
            turn = np.linspace(0, 2 * np.pi, 24)
            ground = np.array([middle[0], middle[1], 0.])
            ring = [ground + np.cos(t) * along + np.sin(t) * across for t in turn]
            axes.add_patch(patches.Polygon(on_paper(ring), closed=True, zorder=1, **style))


def ground(axes, left, right, y):
    corners = [(left, y - .9, 0), (right, y - .9, 0), (right, y + .9, 0), (left, y + .9, 0)]
    axes.add_patch(patches.Polygon(on_paper(corners), closed=True, color="#f1f1ee", linewidth=0, zorder=0))
    for x in np.arange(np.ceil(left * 2) / 2, right, .5):
        line = on_paper([(x, y - .9, 0), (x, y + .9, 0)])
        axes.plot(line[:, 0], line[:, 1], color="#ddddda", linewidth=.8, zorder=.5)


def main(page, out):
    data = data_of(page)
    bodies = {flag: [np.array(p["body"], float).reshape(len(p["body"]), 22, 3) / 1000 for p in data["people"]
                     if p["recorded"] == flag] for flag in (True, False)}
    names = [p["name"] for p in data["people"] if not p["recorded"]]
    push, dt = data["pushes"][0], data["dt"]
    pushed = names.index(push["person"])
    largest = max(np.linalg.norm(f) for f in push["force"])
    lift = min(b[0, [17, 21], 2].min() for b in bodies[True])
    for flag in bodies:
        for body in bodies[flag]:
            body[:, :, 2] -= lift
    y = np.mean([b[0, 0, 1] for b in bodies[True]])
    for flag in bodies:
        for body in bodies[flag]:
            body[:, :, 1] -= y
    everything = np.concatenate([b[:, :, 0].ravel() for b in bodies[True] + bodies[False]])
    left, right = everything.min() - .75, everything.max() + .35
    colours = colors.LinearSegmentedColormap.from_list("moved", ["#2f6db5", "#35a79c", "#f0a030"])
    figure, panels = pyplot.subplots(2, 2, figsize=(12.4, 6.5))
    for axes, time in zip(panels.ravel(), TIMES):
        frame = min(int(round(time / dt)), data["frames"] - 1)
        ground(axes, left, right, 0.)
        for i in np.argsort([-b[frame, 0, 1] for b in bodies[True]]):
            recorded, predicted = bodies[True][i], bodies[False][i]
            moved = np.linalg.norm(predicted[frame, 0] - predicted[0, 0])
            fill = colours(min(1., moved / FARTHEST))
            edge = tuple(.55 * c for c in fill[:3])
            footprints(axes, recorded, frame, dt, facecolor="none", edgecolor="#888888", linewidth=1.)
            footprints(axes, predicted, frame, dt, facecolor=(*fill[:3], .55), edgecolor="none")
            draw_body(axes, recorded[frame], "#d9d9d6", "#7d7d7a", 2. + .01 * i)
            draw_body(axes, predicted[frame], fill, edge, 3. + .01 * i, alpha=.86)
        if time == TIMES[0]:
            tip = on_paper(bodies[False][pushed][0, 3]) - [.16, 0]
            axes.annotate("", tip, tip - [.62, 0], zorder=6,
                          arrowprops=dict(arrowstyle="-|>,head_width=.5,head_length=.7", color="#d1350f", linewidth=5))
            axes.text(tip[0] - .36, tip[1] + .13, f"{round(largest, -1):.0f} N", color="#d1350f", fontsize=12, weight="bold",
                      ha="center")
        axes.text(left + .42, 1.93, f"{frame * dt:.2f} s", fontsize=13, weight="bold", color="#222222")
        axes.set_xlim(left, right)
        axes.set_ylim(-.28, 2.12)
        axes.set_aspect("equal")
        axes.axis("off")
    legend = [patches.Patch(facecolor="#d9d9d6", edgecolor="#7d7d7a", label="recorded"),
              patches.Patch(facecolor=colours(0.), label="predicted, at rest"),
              patches.Patch(facecolor=colours(1.), label=f"predicted, moved {FARTHEST:g} m or more")]
    figure.legend(handles=legend, loc="lower center", ncols=3, frameon=False, fontsize=12)
    figure.subplots_adjust(left=0, right=1, top=1, bottom=.05, wspace=0, hspace=0)
    figure.savefig(out, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
