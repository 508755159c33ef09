"""Matplotlib figures of results."""
import math
import re

from . import _pushid


def _looks():
    """Classes of the report's style sheet: {"ink": {"fill": "#222", ...}, ...}; a selector of several counts for each."""
    looks = {}
    for names, text in re.findall(r"([^{}]+)\{([^{}]*)\}", _pushid.svg_style().split("@media")[0]):
        for name in names.split(","):
            looks.setdefault(name.split(".")[-1], {}).update(_declarations(text))
    return looks


def _declarations(text):
    return dict(part.split(":", 1) for part in text.split(";") if ":" in part)


def _styles(look, looks):
    """(of a line, of an area) as matplotlib takes them."""
    css = {}
    for one in [look] if ":" in look else look.split():
        css.update(_declarations(one) if ":" in one else looks.get(one, {}))
    line = {"color": css.get("stroke", "#222"), "linewidth": float(css.get("stroke-width", 1.0))}
    if "stroke-dasharray" in css:
        line["dashes"] = [float(part) for part in css["stroke-dasharray"].split()]
    fill = css.get("fill", line["color"])
    return line, {"facecolor": fill, "alpha": float(css.get("fill-opacity", 1.0)), "linewidth": 0}


def _panel(axes, panel, looks):
    """Draws one panel as the report's chart has it."""
    def scaled(points):
        """Ends of open intervals go to the edge."""
        xs, ys = zip(*points) if points else ((), ())
        xs = [max(ends[0], min(ends[1], x)) if math.isinf(x) else x for x in xs]
        return [[10.0**v for v in values] if logs else list(values) for values, logs in zip((xs, ys), panel["logarithmic"])]

    finite = [x for points, _, _ in panel["lines"] for x, _ in points if math.isfinite(x)] + panel["marks"]
    ends = (min(finite), max(finite)) if finite else (0.0, 1.0)
    if panel["bare_y"]:
        air = 0.05 * (ends[1] - ends[0] or 1.0)
        ends = (ends[0] - air, ends[1] + air)
    if panel["cells"]:
        import matplotlib.colors
        colours = matplotlib.colors.LinearSegmentedColormap.from_list("signed", ["#3b82f6", "#ffffff", "#e69f00"])
        axes.imshow(panel["cells"], cmap=colours, vmin=-panel["full_cell"], vmax=panel["full_cell"], aspect="auto")
        axes.set_xticks(range(len(panel["x_categories"])), panel["x_categories"], rotation=90)
    for lower, upper, look in panel["bands"]:
        (x1, y1), (x2, y2) = scaled(lower), scaled(upper)
        axes.fill(x1 + x2[::-1], y1 + y2[::-1], **_styles(look, looks)[1])
    for row, first, last, look in panel["bars"]:
        axes.barh(row, last - first, left=first, height=0.72, **_styles(look, looks)[1])
    for points, look, dots in panel["lines"]:
        line, area = _styles(look, looks)
        if dots:
            color = area["facecolor"]
            axes.plot(*scaled(points), "o", markersize=4, markerfacecolor=color,
                      markeredgecolor=line["color"] if color == "none" else color)
        else:
            axes.plot(*scaled(points), **line)
    for level in panel["levels"]:
        axes.axhline(level, **_styles(_pushid.level_look, looks)[0])
    for mark in panel["marks"]:
        axes.axvline(mark, **_styles(_pushid.mark_look, looks)[0])
    for row, (name, bars, look) in enumerate(panel["lanes"]):  # under the plot, in fractions of its height
        height = 0.02 + 0.06 * (len(panel["lanes"]) - 1 - row)
        axes.broken_barh([(first, last - first) for first, last in bars], (height, 0.04),
                         transform=axes.get_xaxis_transform(), **_styles(look, looks)[1])
        axes.annotate(name, (0.01, height), xycoords="axes fraction", fontsize="x-small")
    for logs, limits, set_scale, set_limits in zip(
            panel["logarithmic"], (panel["x_range"], panel["y_range"]), (axes.set_xscale, axes.set_yscale),
            (axes.set_xlim, axes.set_ylim)):
        if logs:
            set_scale("log")
        set_limits(*[10.0**end if logs and end is not None else end for end in limits])
    if panel["y_categories"]:
        axes.set_yticks(range(len(panel["y_categories"])), panel["y_categories"])
        axes.set_ylim(len(panel["y_categories"]) - 0.5, -0.5)
        for row, note in enumerate(panel["y_notes"]):
            axes.annotate(" " + note, (1.0, row), xycoords=("axes fraction", "data"), va="center", fontsize="small")
    elif panel["bare_y"]:
        axes.set_yticks([])
        axes.set_xlim(*[given if given is not None else end for given, end in zip(panel["x_range"], ends)])
    axes.set_title(panel["title"], fontsize="medium", loc="left")
    axes.set_xlabel(panel["x_label"])
    axes.set_ylabel(panel["y_label"])


def draw(result, name, axes=None, panel=None):
    figures = _pushid.figures(result._model)
    if name not in figures:
        raise KeyError(f"this report has no figure '{name}'; it has " + ", ".join(figures))
    panels = figures[name]["panels"]
    if panel is not None:
        chosen = [one for index, one in enumerate(panels)
                  if index == panel or panel in (one["title"], one["title"].split(",")[0])]
        if not chosen:
            raise KeyError(f"'{name}' has no panel {panel!r}; it has " + ", ".join(one["title"] for one in panels))
        panels = chosen[:1]
    if axes is None:
        import matplotlib.pyplot
        columns = 1 if panels[0]["y_categories"] else min(3, len(panels))
        rows = -(-len(panels) // columns)
        each = max(1.2 if panels[0]["bare_y"] else 2.4, 1.0 + 0.2 * len(panels[0]["y_categories"]))  # inches
        axes = matplotlib.pyplot.subplots(rows, columns, figsize=(max(6.4, 3.2 * columns), each * rows),
                                          layout="constrained", squeeze=False)[1].ravel()
        for unused in axes[len(panels):]:
            unused.remove()
        axes = axes[:len(panels)]
    given = list(axes) if hasattr(axes, "__len__") else [axes]
    if len(given) != len(panels):
        raise ValueError(f"'{name}' has {len(panels)} panels and there are {len(given)} axes; panel= chooses one of "
                         + ", ".join(repr(one["title"]) for one in panels))
    looks = _looks()
    for one, content in zip(given, panels):
        _panel(one, content, looks)
    legend = figures[name]["legend"]
    if legend:
        import matplotlib.lines
        given[0].legend([matplotlib.lines.Line2D([], [], **({"color": area["facecolor"], "alpha": area["alpha"], "linewidth": 5}
                                                           if "stroke:none" in look or "band" in look else line))
                         for look in (look for _, look in legend) for line, area in [_styles(look, looks)]],
                        [name for name, _ in legend], fontsize="x-small")
    return given if len(given) > 1 else given[0]
