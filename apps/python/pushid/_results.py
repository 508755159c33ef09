"""Fits and what they found."""
import difflib
import json
import os
from collections import namedtuple

import numpy as np

from . import _pushid
from ._options import as_call, given, text_of
from ._recordings import checked

Parameter = namedtuple("Parameter", "name value standard_error interval unit status shares fixed")
Parameter.__doc__ = """A parameter of a result: value, standard error and 95 % interval (low, high) in `unit`; status
("identified", "weak", "prior-held", "fixed", ...); shares: what of it data, priors and settling decide."""


def _numbers(found):
    """With numbers in place of the texts that stand for those JSON does not know."""
    if isinstance(found, dict):
        return {name: _numbers(item) for name, item in found.items()}
    if isinstance(found, list):
        return [_numbers(item) for item in found]
    return float(found) if found in ("infinity", "-infinity", "nan") else found


class Table(list):
    """A row (dict) for every parameter."""

    def to_frame(self):
        """As a pandas DataFrame; raises ImportError where pandas is not there."""
        import pandas
        return pandas.DataFrame(self)


class Result:
    """What a fit found. result["mu"] is a Parameter; `json` holds everything, as the programs write it."""

    def __init__(self, model):
        self._model, self._json = model, None

    @property
    def json(self):
        """The whole result, as pushid-fit --model_out writes it."""
        if self._json is None:
            self._json = json.loads(self._model.json())
        return self._json

    @property
    def table(self):
        """Everything about each parameter, one dict each."""
        return Table(_numbers(self.json["parameters"]))

    @property
    def names(self):
        """Of all parameters, fitted or not."""
        return [row["name"] for row in self.json["parameters"]]

    def __getitem__(self, name):
        for row in self.table:
            if row["name"] == name:
                interval = row.get("interval_95")
                return Parameter(name, row["value"], row.get("standard_error"), tuple(interval) if interval else None,
                                 row.get("unit", ""), row.get("status"), row.get("shares", {}),
                                 row.get("status") == "fixed")
        near = difflib.get_close_matches(name, self.names, 1)
        raise KeyError(f"there is no parameter '{name}'" + (f"; is '{near[0]}' meant?" if near else ""))

    @property
    def covariance(self):
        """(names, matrix) of what was fitted, on the fitted scale (positive parameters: their logarithm)."""
        found = self.json["uncertainty"]
        return found["fitted"], np.array(found["covariance_fitted_scale"], dtype=float)

    @property
    def converged(self):
        """Whether the solver did; advice says what to try where it did not."""
        return self._model.converged

    @property
    def warnings(self):
        """What to keep in mind: of the files, the fit and the person it found."""
        return self._model.warnings

    @property
    def advice(self):
        """What to try next: [(sentence, call)]."""
        return [(sentence, as_call(command)) for sentence, command in self._model.advice]

    def _part(self, name):
        """A part of the json that was just made anew."""
        self._json = None
        return _numbers(self.json[name])

    def profile(self, *names, num_threads=1, progress=None):
        """The cost along each of these parameters (none: all), all others fitted anew: {name: profile}.

        A profile has "interval_95", "class" ("identifiable", ...) and "points", a dict of value, cost and the others
        each. It takes the place of earlier ones. progress: called with (done, total), as by all that fit many times.
        """
        _pushid.profile(self._model, list(names), num_threads, progress)
        return {row["name"]: row for row in self._part("profiles")}

    @property
    def profiles(self):
        """What profile() found last, a dict each."""
        return _numbers(self.json.get("profiles", []))

    def bootstrap(self, replicas=199, *, seed=1, num_threads=1, file="", progress=None):
        """Refits of people (or recordings) drawn with replacement; the json's part `bootstrap`.

        file: keeps finished replicas, so that a run that was interrupted goes on from there.
        """
        _pushid.bootstrap(self._model, replicas, seed, num_threads, os.fspath(file), progress)
        return self._part("bootstrap")

    def prior_check(self):
        """Refits with centres and widths of all priors halved, and doubled; the json's part `prior_check`."""
        _pushid.prior_check(self._model)
        return self._part("prior_check")

    def push_check(self, *, noise=0.01, seed=1, num_threads=1, progress=None):
        """Refits with pushes that might as well have been recorded; the json's part `push_check`.

        noise: of a measured push's sensor, as a share of the push's peak.
        """
        _pushid.push_check(self._model, noise, seed, num_threads, progress)
        return self._part("push_check")

    def horizon_check(self, *, num_threads=1, progress=None):
        """Refits of the first 8, 16, 32 and 64 frames; the json's part `horizon_check`."""
        _pushid.horizon_check(self._model, num_threads, progress)
        return self._part("horizon_check")

    def design(self, parameter="all"):
        """Which further push would lower the error of a parameter (or of all together) most; see Design."""
        return Design(_pushid.design(self._model, parameter))

    def predict(self, recording, *, observed=0, frames=0, samples=0, seed=1, set=None):
        """What the model says will happen, from the first frame (or `observed` of them) and the push.

        {"hip": (frames, people, 3), "states": (frames, people, 8: q and its rate), ...}; with `observed` also the
        90 % bands "lower90" and "upper90" of the frames to come. samples: so many futures drawn, "samples" of the
        shape (samples, frames, people, 3): after `observed` frames from the distribution behind those bands; else
        from the process noise of a model that has one, or parameters from their covariance, with errors of the
        fitted recordings. frames: how far (0: as far as the recording). set: {name: value} asks "what if". Raises
        FitError where a rollout leaves the model's domain; warns of pushes unlike the fitted ones.
        """
        return _pushid.predict(self._model, *checked(recording), observed, frames, samples, seed, text_of("set", set or {}))

    def path_between(self, start, end, *, frames=90, fps=60.0, mass=85.0, rod=0.95):
        """The most probable path of a person between two states under the model's process noise.

        start, end: {"x": 0.4, "theta": 0.05, "xd": 0.3, ...}: x, y (m), theta, phi (rad) and their rates xd, yd,
        thetad, phid; what is not named is 0, and the rates at the end are free where none is named. Returns "states"
        (frames, 1, 8), "noise" (frames, 1, 4), the generalized force that drove it, and "action", -log of its
        probability density up to a constant: of several ends the most probable one has the least.
        """
        return _pushid.path_between(self._model, text_of("start", start), text_of("end", end), frames, fps, mass, rod)

    def smooth(self, recording):
        """A recording smoothed, its gaps filled, under the model's process noise: as path_between, for everybody."""
        return _pushid.smooth(self._model, *checked(recording))

    def evaluate(self, recordings, *, observed=0):
        """Errors of the predictions beside two baselines, as pushid-evaluate writes them."""
        return self._model.evaluate(checked(recordings), observed)

    def report(self, path):
        """Writes the report as one page; returns its path."""
        self._model.report(os.fspath(path))
        return path

    def save(self, path):
        """Writes the same JSON as pushid-fit; pushid.load and the programs read it."""
        self._model.save(os.fspath(path))

    def attach(self, recordings):
        """Gives a loaded result the recordings it was fitted to, for profiles, bootstrap and the report's figure."""
        self._model.attach(checked(recordings))
        return self

    def plot(self, **options):
        """Values and intervals (matplotlib); returns the axes."""
        from . import _plots
        return _plots.intervals(self, **options)

    def plot_motion(self, recording, **options):
        """A recording's hips and the prediction's, with bands where there are any; returns the axes."""
        from . import _plots
        return _plots.motion(self, recording, **options)

    def plot_profile(self, name, **options):
        """The profile of a parameter that profile() was asked for; returns the axes."""
        from . import _plots
        return _plots.profile(self, name, **options)

    def __str__(self):
        return self._model.text()

    def __repr__(self):
        free = [self[name] for name in self.names if not self[name].fixed]
        return "<pushid result: " + ", ".join(f"{p.name} {p.value:.4g}" for p in free) + ">"

    def _repr_html_(self):
        from . import _plots
        return _plots.html_table(self)

    def __reduce__(self):
        return _from_json, (self._model.json(),)


def _from_json(text):
    return Result(_pushid.from_json(text))


def fit(recordings, *, progress=None, **asked):
    """Identifies the parameters that act on these recordings.

    Options have the names, defaults and checks of pushid-fit's flags (pushid.options()): preset="auto",
    fix={"mu": 30} (or fix=["mu"]: held where they are), free={"Kp_x": 50}, prior={"mu": (30, 10)}, ...
    progress: called with (phase, iteration, cost). Ctrl-C ends a fit. Raises DataError, UsageError, FitError.
    """
    told = list(getattr(recordings, "warnings", ()))
    return Result(_pushid.fit(checked(recordings), given(asked), progress, told))


def load(path):
    """A result that pushid-fit or Result.save wrote."""
    return Result(_pushid.load(os.fspath(path)))


def crossvalidate(recordings, candidates=None, *, scheme="stratified", folds=4, repeats=1, seed=1, observed=0,
                  baselines=True, num_threads=1, progress=None, **asked):
    """Errors on recordings that were not fitted, for the options given and each of `candidates`.

    candidates: {name: {option: value}}, on top of the options given. A list of what pushid-crossvalidate writes
    for each predictor.
    """
    all_of_them = [("model", given(asked))]
    for name, more in (candidates or {}).items():
        all_of_them.append((name, given({**asked, **more})))
    return _pushid.crossvalidate(checked(recordings), all_of_them, scheme, folds, repeats, seed, observed,
                                 baselines, num_threads, progress)


class Design(dict):
    """What one more recording, a force sensor and more people would bring; print() shows it as pushid-fit does.

    "pushes": a Table, best first: direction_deg (from forwards to the left), acceleration (peak force over mass, m/s^2),
    height (of the rod), duration_s, mass_kg, error_ratio {name: standard error with it over the present one} and their
    mean; "no_push" says why there are none. "sensor_ratio": {name: error with the whole push measured over that
    without} or "no_sensor"; "sizes": studies of more people and pushes with the errors they would leave.
    """

    def __init__(self, found):
        super().__init__(found)
        self["pushes"] = Table(self["pushes"])

    def __str__(self):
        return self["text"]
