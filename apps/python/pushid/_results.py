"""Fits and what they found."""
import difflib
import json
import os
from collections import namedtuple

import numpy as np

from . import _pushid

Parameter = namedtuple("Parameter", "name value standard_error interval unit status shares fixed")
Parameter.__doc__ = """A parameter of a result: value, standard error and 95 % interval (low, high) in `unit`; status
("identified", "weak", "prior-held", "fixed", ...); shares: what of it data, priors and settling decide."""


def options():
    """The options of a fit: {name: (what it means, default)}; None where the preset decides."""
    return {name: (meaning, default) for name, meaning, default in _pushid.options()}


def _text(name, value):
    """A value as the command line spells it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        if name == "prior":  # {name: (mean, sigma)}
            return ",".join(f"{key}:{mean!r}:{sigma!r}" for key, (mean, sigma) in value.items())
        return ",".join(key if item is None else f"{key}={item!r}" for key, item in value.items())
    if isinstance(value, (list, tuple)):
        return ",".join(str(item) for item in value)
    return repr(value) if isinstance(value, float) else str(value)


def _given(asked):
    known = options()
    for name in asked:
        if name in known:
            continue
        near = difflib.get_close_matches(name, known, 1)
        raise _pushid.UsageError(f"there is no option '{name}'" + (f"; is '{near[0]}' meant?" if near else
                                                                   "; pushid.options() lists them"))
    return [(name, _text(name, value)) for name, value in asked.items() if value is not None]


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
        return Table(self.json["parameters"])

    @property
    def names(self):
        return [row["name"] for row in self.json["parameters"]]

    def __getitem__(self, name):
        for row in self.json["parameters"]:
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
        return self._model.converged

    @property
    def warnings(self):
        return self._model.warnings

    @property
    def advice(self):
        """What to try next: [(sentence, command)]."""
        return self._model.advice

    def profile(self, *names):
        """The cost along each of these parameters, all others fitted anew: {name: profile}."""
        self._model.profile(list(names))
        self._json = None
        return {row["name"]: row for row in self.json.get("profiles", []) if row["name"] in names}

    def bootstrap(self, replicas=199, *, seed=1, num_threads=1):
        """Refits of people (or recordings) drawn with replacement; the json's part `bootstrap`."""
        self._model.bootstrap(replicas, seed, num_threads)
        self._json = None
        return self.json["bootstrap"]

    def predict(self, recording, *, observed=0, frames=0, samples=0, seed=1, set=None):
        """What the model says will happen, from the first frame (or `observed` of them) and the push.

        {"hip": (frames, people, 3), "states": (frames, people, 8), ...}; with `observed` also the 90 % bands
        "lower90" and "upper90", with `samples` (models with process noise) "samples", (samples, frames, people, 3).
        set: {name: value} asks "what if". Raises FitError where a rollout leaves the model's domain.
        """
        return _pushid.predict(self._model, recording, observed, frames, samples, seed, _text("set", set or {}))

    def evaluate(self, recordings, *, observed=0):
        """Errors of the predictions beside two baselines, as pushid-evaluate writes them."""
        return self._model.evaluate(list(recordings), observed)

    def report(self, path):
        """Writes the report as one page; returns its path."""
        self._model.report(os.fspath(path))
        return path

    def save(self, path):
        """Writes the same JSON as pushid-fit; pushid.load and the programs read it."""
        self._model.save(os.fspath(path))

    def attach(self, recordings):
        """Gives a loaded result the recordings it was fitted to, for profiles, bootstrap and the report's figure."""
        self._model.attach(list(recordings))
        return self

    def plot(self, **options):
        """Values and intervals (matplotlib); returns the axes."""
        from . import _plots
        return _plots.intervals(self, **options)

    def plot_motion(self, recording, **options):
        """A recording's hips and the prediction's, with bands where there are any; returns the axes."""
        from . import _plots
        return _plots.motion(self, recording, **options)

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
    return Result(_pushid.fit(_recordings(recordings), _given(asked), progress))


def load(path):
    """A result that pushid-fit or Result.save wrote."""
    return Result(_pushid.load(os.fspath(path)))


def _recordings(recordings):
    return [recordings] if isinstance(recordings, _pushid.Recording) else list(recordings)


def crossvalidate(recordings, candidates=None, *, scheme="stratified", folds=4, repeats=1, seed=1, observed=0,
                  baselines=True, num_threads=1, **asked):
    """Errors on recordings that were not fitted, for the options given and each of `candidates`.

    candidates: {name: {option: value}}, on top of the options given. A list of what pushid-crossvalidate writes
    for each predictor.
    """
    all_of_them = [("model", _given(asked))]
    for name, more in (candidates or {}).items():
        all_of_them.append((name, _given({**asked, **more})))
    return _pushid.crossvalidate(_recordings(recordings), all_of_them, scheme, folds, repeats, seed, observed,
                                 baselines, num_threads)


def simulate_formation(result, shape="line", people=10, *, spacing=0.45, pushed=0, push=80.0, push_duration=0.2,
                       mass=85.0, rod=0.95, duration=4.0, fps=60.0, set=None):
    """A fitted model on people who stand together: {"hip": ..., "states": ..., "onset_s": [...], "outcome": [...]}.

    shape: "line", "diamond" or "grid"; spacing in m, push in N s along +x at the hip of person `pushed`.
    """
    return _pushid.simulate_formation(result._model, shape, people, spacing, pushed, push, push_duration, mass, rod,
                                      duration, fps, _text("set", set or {}))


class OnlinePredictor:
    """A prediction that learns from every frame it is shown; recording: people, pushes and frame 0."""

    def __init__(self, result, recording, frames):
        self._online = _pushid.Online(result._model, recording, frames)

    def observe(self, hip, left_ankle, right_ankle):
        """The next frame, frame 1 first: (people, 3) each, or (3,) of one person, in m."""
        self._online.observe(*(np.atleast_2d(np.asarray(a, dtype=float)) for a in (hip, left_ankle, right_ankle)))

    @property
    def observed(self):
        """How many frames were seen, frame 0 among them."""
        return self._online.observed

    def predict(self):
        return self._online.predict()


class Restoration:
    """Networks that turn pendulums into bodies."""

    def __init__(self, restoration):
        self._restoration = restoration

    @classmethod
    def load(cls, folder):
        """Of a folder that pushid-train-restoration wrote, or "rigid"."""
        return cls(_pushid.load_restoration(os.fspath(folder)))

    def apply(self, result, recording, *, observed=0):
        """The predicted motion of whole bodies: (frames, people, 22, 3), in m. Read with all_joints=True."""
        return self._restoration.apply(result._model, recording, observed)


