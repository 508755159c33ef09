"""Matplotlib figures of results."""
import html

from . import _pushid


def _axes(axes):
    if axes is not None:
        return axes
    import matplotlib.pyplot
    return matplotlib.pyplot.subplots(layout="constrained")[1]  # labels of any length lie within the figure


_FARTHEST = 10.0  # times the value; bars end there


def _free(result):
    return [result[name] for name in result.names if not result[name].fixed]


def intervals(result, axes=None):
    """Each free parameter with its 95 % interval, relative to its value."""
    axes = _axes(axes)
    shown = [p for p in _free(result) if p.interval and p.value != 0]
    for row, p in enumerate(shown):
        low, high = sorted(max(-_FARTHEST, min(_FARTHEST, end / p.value)) for end in p.interval)
        axes.plot([low, high], [row, row], "-", color="C0" if p.status == "identified" else "C1")
        axes.plot([1], [row], "o", color="C0" if p.status == "identified" else "C1")
    axes.set_yticks(range(len(shown)), [f"{p.name} {p.value:.4g} {p.unit if p.unit != '1' else ''}" for p in shown])
    axes.invert_yaxis()
    axes.set_xlabel("95 % interval over the value (orange: not identified by the data)")
    return axes


def motion(result, recording, axes=None, **how):
    """x of all hips over time: measured, predicted, and the band."""
    axes = _axes(axes)
    predicted = result.predict(recording, **how)
    seconds = [t / recording.fps for t in range(recording.num_frames)]
    for n, subject in enumerate(recording.subjects):
        line, = axes.plot(seconds, recording.hip[:, n, 0], label=f"{subject}, measured")
        path = predicted["hip"][:, n, 0]
        axes.plot([t / recording.fps for t in range(len(path))], path, "--", color=line.get_color(),
                  label=f"{subject}, predicted")
        if "lower90" in predicted:
            low, high = (predicted[key][:, n, 0] for key in ("lower90", "upper90"))
            first = predicted["observed"]
            axes.fill_between([(first + t) / recording.fps for t in range(len(low))], low, high, alpha=0.2,
                              color=line.get_color())
    axes.set_xlabel("time, s")
    axes.set_ylabel("hip, m forwards")
    axes.legend()
    return axes


def profile(result, name, axes=None):
    """The cost along a parameter, in units of the threshold of its 95 % interval."""
    found = {row["name"]: row for row in result.profiles}
    if name not in found:
        raise KeyError(f"there is no profile of '{name}'; ask for it by result.profile('{name}')")
    row = found[name]
    axes = _axes(axes)
    points = [(point["value"], (point["cost"] - row["cost"]) / row["threshold"]) for point in row["points"]]
    axes.plot(*zip(*points), "o-")
    axes.axhline(1.0, color="C3", linestyle="--")
    axes.axvline(row["estimate"], color="C3", linewidth=1)
    axes.set_ylim(-0.1, 2.0)
    axes.set_xlabel(f"{name}, {row['unit']}")
    axes.set_ylabel("rise of the cost over the threshold of 95 %")
    return axes


def wave(formation, axes=None):
    """Propagation of a push through people: speed of the hips, onsets, and their bands if there are any."""
    axes = _axes(axes)
    speed = formation["speed"].T
    people, frames = speed.shape
    fastest = abs(speed).max() or 1.0
    image = axes.imshow(speed, aspect="auto", cmap="PuOr_r", vmin=-fastest, vmax=fastest, interpolation="nearest",
                        extent=(-0.5 / formation["fps"], (frames - 0.5) / formation["fps"], people - 0.5, -0.5))
    axes.figure.colorbar(image, ax=axes, label="speed of the hip, m/s (negative: back)")
    moved = [(onset, n) for n, onset in enumerate(formation["onset_s"]) if onset is not None]
    if moved:
        axes.plot(*zip(*moved), "o", color="white", markeredgecolor="black")
    for n, band in enumerate(formation.get("onset_band90", [])):
        if band is not None:
            axes.plot(band, [n, n], color="black")
    axes.set_xlabel("time, s")
    axes.set_ylabel("person")
    return axes


def _bar(p):
    """The interval relative to the value, from 0 to 2, as a small picture."""
    if not p.interval or p.value == 0:
        return ""
    low, high = (max(0.0, min(2.0, end / p.value)) for end in p.interval)
    low, high = sorted((60 * low, 60 * high))
    return ('<svg width="120" height="12"><line x1="60" x2="60" y1="0" y2="12" stroke="#999"/>'
            f'<line x1="{low:.1f}" x2="{high:.1f}" y1="6" y2="6" stroke="#0072b2" stroke-width="4"/></svg>')


def html_table(result):
    rows = []
    for p in _free(result):
        cells = [p.name, f"{p.value:.4g}", _pushid.interval_text(p.value, *p.interval) if p.interval else "",
                 p.unit, p.status or ""]
        rows.append("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in cells) +
                    f"<td>{_bar(p)}</td></tr>")
    head = "".join(f"<th>{name}</th>" for name in ("parameter", "value", "95 % interval", "unit", "status", ""))
    return f"<table><tr>{head}</tr>{''.join(rows)}</table>"
