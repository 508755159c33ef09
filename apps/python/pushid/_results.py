"""Fits and their results."""
import difflib
import json
import os
from collections import namedtuple

import numpy as np

from . import _pushid
from ._options import as_call, given, text_of
from ._recordings import checked

Parameter = namedtuple("Parameter", "name value standard_error interval unit status shares fixed")
Parameter.__doc__ = """A parameter of a result: value, standard error and 95 % interval (low, high) in `unit`, with the errors of
what is taken as known; status ("identified", "model-dependent", "weak", "prior-held", "fixed", "derived", ...); shares: fractions due
to data, priors and settling. What is fixed, or derived from fixed values alone, has neither error nor interval: both are None."""


def _numbers(found):
    """Replaces the strings that stand for infinities and nan in JSON by numbers."""
    if isinstance(found, dict):
        return {name: _numbers(item) for name, item in found.items()}
    if isinstance(found, list):
        return [_numbers(item) for item in found]
    return float(found) if found in ("infinity", "-infinity", "nan") else found


def _parameter(row, status):
    interval = row.get("interval")
    known = status != "fixed" and interval is not None and interval[0] < interval[1]
    return Parameter(row["name"], row["value"], row.get("total", row).get("standard_error") if known else None,
                     tuple(interval) if known else None, row.get("unit", ""), status, row.get("shares", {}), status == "fixed")


def _flat(row, prefix=""):
    """A row without parts: {"shares": {"data": 1.0}} as {"shares_data": 1.0}, a pair as its lower and upper end."""
    cells = {}
    for name, item in row.items():
        if isinstance(item, (list, tuple)):
            item = dict(zip(("lower", "upper") if len(item) == 2 else map(str, range(len(item))), item))
        cells.update(_flat(item, f"{prefix}{name}_") if isinstance(item, dict) else {prefix + name: item})
    return cells


class Table(list):
    """A row (dict) for every parameter."""

    def to_frame(self):
        """As a pandas DataFrame with one column for each number: interval_lower, shares_data, ..., without those of
        fixed parameters. Raises ImportError without pandas."""
        import pandas
        held = ("standard_error", "interval", "interval_95", "shares")
        return pandas.DataFrame([_flat({name: item for name, item in row.items()
                                        if row.get("status") != "fixed" or name not in held}) for row in self])


class _Printed:
    """A container of what a program writes as JSON; print() shows the program's text."""

    def __init__(self, found, text=""):
        super().__init__(_numbers(json.loads(found)))
        self.text = text

    def __str__(self):
        return self.text

    __repr__ = __str__


class Scores(_Printed, dict):
    """Scores as pushid-evaluate writes them; print() shows its table, without the single recordings."""


class CrossValidation(_Printed, list):
    """The scores of each predictor, as pushid-crossvalidate writes them; print() shows its table."""


class Result:
    """The result of a fit. result["mu"] is a Parameter, as is a quantity derived from several, such as result["c_x"]; `json`
    holds everything, as the programs write it."""

    def __init__(self, model):
        self._model, self._json = model, None

    @property
    def verdict(self):
        """Whether the model fits these recordings: a dict; "fails", and the tests behind it."""
        return _numbers(self.json["verdict"])

    @property
    def json(self):
        """The whole result, as pushid-fit --model_out writes it."""
        if self._json is None:
            self._json = json.loads(self._model.json())
        return self._json

    @property
    def table(self):
        """All values of each parameter, one dict per parameter."""
        return Table(_numbers(self.json["parameters"]))

    @property
    def names(self):
        """Names of all parameters, fitted or not."""
        return [row["name"] for row in self.json["parameters"]]

    def __getitem__(self, name):
        for row in self.table:
            if row["name"] == name:
                return _parameter(row, row.get("status"))
        derived = {row["name"]: row for row in _numbers(self.json["derived"])}
        if name in derived:
            return _parameter(derived[name], "derived")
        near = difflib.get_close_matches(name, [*self.names, *derived], 1)
        raise KeyError(f"there is no parameter '{name}'" + (f"; did you mean '{near[0]}'?" if near else ""))

    @property
    def covariance(self):
        """(names, (n, n) matrix) of the n fitted parameters, on the fitted scale (positive parameters: their logarithm)."""
        found = self.json["uncertainty"]
        return found["fitted"], np.array(found["covariance_fitted_scale"], dtype=float)

    @property
    def converged(self):
        """Whether the solver converged; if not, see advice."""
        return self._model.converged

    @property
    def warnings(self):
        """Warnings about the files, the fit and the fitted person."""
        return self._model.warnings

    @property
    def advice(self):
        """Suggested next steps: [(sentence, call)]."""
        return [(sentence, as_call(command)) for sentence, command in self._model.advice]

    @property
    def contrast(self):
        """The differences between two values of a label, of a fit with contrast="LABEL": a dict with the label, its
        values, the people of each and rows, one per parameter; None without."""
        found = self.json.get("contrast")
        return None if found is None else _numbers(found)

    def _part(self, name):
        """A part of the JSON that was just recomputed."""
        self._json = None
        return _numbers(self.json[name])

    def profile(self, *names, num_threads=1, progress=None):
        """Profile likelihoods of these parameters (none: all), with all others refitted: {name: profile}.

        A profile has "interval_95", "class" ("identifiable", ...) and "points", each a dict of the value, the cost
        and the other parameters. It replaces earlier profiles. progress: called with (done, total).
        """
        _pushid.profile(self._model, list(names), num_threads, progress)
        return {row["name"]: row for row in self._part("profiles")}

    @property
    def profiles(self):
        """Results of the last profile(), one dict per parameter."""
        return _numbers(self.json.get("profiles", []))

    def bootstrap(self, replicas=199, *, seed=1, num_threads=1, progress=None):
        """Refits of people (or recordings) drawn with replacement; returns the JSON's part `bootstrap`."""
        _pushid.bootstrap(self._model, replicas, seed, num_threads, progress)
        return self._part("bootstrap")

    def horizon_check(self, *, num_threads=1, progress=None):
        """Refits of the first 8, 16, 32 and 64 frames; returns the JSON's part `horizon_check`."""
        _pushid.horizon_check(self._model, num_threads, progress)
        return self._part("horizon_check")

    def learn_forecasts(self, *, num_threads=1):
        """Learns the rule and the bands of predictions after first frames (`observed`), on people left out in turn.

        Returns the JSON's part `forecasts`.
        """
        _pushid.learn_forecasts(self._model, num_threads)
        return self._part("forecasts")

    def design(self, parameter="all"):
        """Finds the further push that would reduce the error of a parameter (or of all together) most; see Design."""
        return Design(_pushid.design(self._model, parameter))

    def predict(self, recording, *, observed=0, forecast="both", frames=0, samples=0, seed=1, set=None, push_scale=1.0,
                push_again=()):
        """Predicts the motion from the first frame (or `observed` frames) and the push.

        {"hip": (frames, people, 3), "states": (frames, people, 8: q and its rate), ...}; with `observed` also the
        90 % bands "lower90" and "upper90" of the later frames, forecast by "physics" (the rollout), "input" (a filter with
        an unknown force) or "both". samples: number of futures to draw, as "samples" of shape (samples, frames, people,
        3), without `observed`: from the covariance of the parameters and the errors of the fitted recordings. frames: number of frames (0: as in the recording). set: {name: value} for "what if";
        push_scale multiplies the push, and push_again lists frames at which it comes again. Raises FitError if a
        rollout leaves the model's domain; warns about pushes unlike the fitted ones. "person" says whose answer it is where
        pushes are external and those of the fit were not, else "".
        """
        return _pushid.predict(self._model, *checked(recording), observed, frames, samples, seed, text_of("set", set or {}),
                               push_scale, list(push_again), forecast)

    def evaluate(self, recordings, *, observed=0, forecast="both"):
        """Errors of the predictions and of two baselines; see Scores."""
        return Scores(*self._model.evaluate(checked(recordings), observed, forecast))

    def loop(self, *, mass=85.0, rod=0.95):
        """The linearized loop of a person at rest, as a control engineer quotes it: {"theta": {...}, "phi": {...}}.

        "stiffness_ratio" (of the ankles, over m g l), "stable", "fastest_growth" (1/s), "damping_ratio" and "natural_hz"
        of the oscillation that dies out last, "phase_margin" (rad) at "crossover_hz", "delay_margin" (s), and
        "gain_down" and "gain_up": the factors between which gains may change. None where there is none. Raises
        UsageError for models with learned terms. mass: kg; rod: m.
        """
        return _pushid.loop(self._model, mass, rod)

    def report(self, path):
        """Writes the report as one page of HTML (path ends in .html); returns its path."""
        self._model.report(os.fspath(path), self.advice)
        return path

    def save(self, path):
        """Writes the same JSON as pushid-fit; pushid.load and the programs read it."""
        self._model.save(os.fspath(path))

    def attach(self, recordings):
        """Attaches the fitted recordings to a loaded result, for profiles, bootstrap and the report's figure."""
        self._model.attach(checked(recordings))
        return self

    @property
    def figures(self):
        """The figures of the report: {name: caption}. Those of motions need the recordings (see attach)."""
        return {name: parts["caption"] for name, parts in _pushid.figures(self._model).items()}

    def plot(self, name="forest", axes=None, panel=None):
        """Draws a figure of the report (see figures), the same data as its page, with matplotlib.

        axes: matplotlib Axes to draw on, one for each panel (None: a new picture of all). panel: only this one, by its
        title or its number from 0. Returns the Axes, a list of them for several panels. Raises KeyError for unknown
        names and ValueError for another number of axes than of panels.
        """
        from . import _plots
        return _plots.draw(self, name, axes, panel)

    @property
    def details(self):
        """The report as text; print(result) shows one screen of it."""
        return self._model.details(self.advice)

    def __str__(self):
        return self._model.text(self.advice)

    def __repr__(self):
        free = [self[name] for name in self.names if not self[name].fixed]
        return "<pushid result: " + ", ".join(f"{p.name} {p.value:.4g}" for p in free) + ">"

    def __reduce__(self):
        return _from_json, (self._model.json(),)


def _from_json(text):
    return Result(_pushid.from_json(text))


def fit(recordings, *, progress=None, **asked):
    """Identifies the parameters that act on these recordings.

    Options have the names, defaults and checks of pushid-fit's flags (pushid.options()): preset="auto",
    fix={"mu": 30} (or fix=["mu"]: held at the default), free={"Kp_x": 50}, prior={"mu": (30, 10)}, ...
    progress: called with (phase, iteration, cost). Ctrl-C ends a fit. Raises DataError, UsageError, FitError.
    """
    told = list(getattr(recordings, "_told", ()))
    return Result(_pushid.fit(checked(recordings), given(asked), progress, told))


def load(path):
    """Loads a result that pushid-fit or Result.save wrote."""
    return Result(_pushid.load(os.fspath(path)))


def crossvalidate(recordings, candidates=None, *, scheme="stratified", folds=4, repeats=1, seed=1, observed=0,
                  forecast="both", baselines=True, num_threads=1, progress=None, **asked):
    """Errors on recordings that were not fitted, for the options given and each of `candidates`.

    candidates: {name: {option: value}}, in addition to the options given. Returns the scores of each predictor; see
    CrossValidation.
    """
    all_of_them = [("model", given(asked))]
    for name, more in (candidates or {}).items():
        all_of_them.append((name, given({**asked, **more})))
    return CrossValidation(*_pushid.crossvalidate(checked(recordings), all_of_them, scheme, folds, repeats, seed, observed,
                                                  forecast, baselines, num_threads, progress))


class Design(_Printed, dict):
    """Benefit of one more recording; print() shows it as pushid-check does.

    "pushes": a Table, best first: direction_deg (from forwards to the left), acceleration (peak force over mass, m/s^2),
    height (of the rod), duration_s, mass_kg, sensor (whether the whole push is measured), error_ratio {name: standard
    error with it over the present one} and their mean; "no_push": the reason if there are none.
    """

    def __init__(self, found):
        super().__init__(found)
        self["pushes"], self.text = Table(self["pushes"]), self["text"]
