"""Predictions of a fitted model: formations, frame-by-frame prediction, and whole bodies."""
import os

import numpy as np

from . import _pushid
from ._options import text_of
from ._recordings import checked


def simulate_formation(result, shape="line", people=10, *, spacing=0.45, pushed=0, push=None, push_duration=None,
                       push_direction=0.0, mass=None, rod=None, duration=4.0, fps=60.0, set=None, onset_bands=False):
    """Rolls a fitted model out on a formation of people.

    Returns "hip" (frames, people, 3), "states" (frames, people, 8), "speed" (frames, people), in m/s, negative backwards,
    "onset_s" (None: never), "displacement" (m along the push), "outcome", "fps", "wave_speed" (m/s, from the first person
    that moves to the foremost; None: undefined), and "onset_band90" and "wave_speed_band90" if requested.

    shape: "line", "diamond" or "grid"; spacing: m. push: N s (None: usual in the fit) on person `pushed`, of the kind, at
    the height and (None) within the push_duration (s) of the fit's pushes, push_direction degrees from +x to the left.
    People are those of the fit as they stood, or, with mass (kg) or rod (ankles to hip, m), upright and alike. duration
    (s) of the simulation; fps: frames per second. onset_bands: also compute 90 % bands of the onsets, by drawing
    parameters from their covariance.
    """
    return _pushid.simulate_formation(result._model, shape, people, spacing, pushed, push, push_duration, push_direction,
                                      mass, rod, duration, fps, text_of("set", set or {}), onset_bands)


class OnlinePredictor:
    """A prediction that is updated with every observed frame; recording: people, pushes and frame 0.

    frames: of predict; -1 for next alone, without an end.
    forecast: "both" together, "physics" (the rollout) or "input" (a filter with an unknown force).
    """

    def __init__(self, result, recording, frames=-1, *, forecast="both"):
        self._online = _pushid.Online(result._model, *checked(recording), frames, forecast)

    def observe(self, hip, left_ankle, right_ankle):
        """Adds the next frame, starting with frame 1: (people, 3) each, or (3,) for one person, in m."""
        self._online.observe(*(np.atleast_2d(np.asarray(a, dtype=float)) for a in (hip, left_ankle, right_ankle)))

    @property
    def observed(self):
        """Number of observed frames, including frame 0."""
        return self._online.observed

    def predict(self):
        """As Result.predict, from the frames observed so far, without bands."""
        return self._online.predict()

    def push(self, force, person=0):
        """Adds a push until the next frame to those of the recording: [Fx, Fy, Mtheta, Mphi] in N and N m. Only next uses it."""
        self._online.push(person, np.asarray(force, dtype=float))

    def next(self, frames):
        """Hips in the next frames: (frames, people, 3), in m; their cost does not depend on how many were observed."""
        return self._online.next(frames)


class Restoration:
    """Networks that convert pendulum motion into whole-body motion."""

    def __init__(self, restoration):
        self._restoration = restoration

    @classmethod
    def load(cls, folder):
        """Loads a folder that pushid-train-restoration wrote, or "rigid"."""
        return cls(_pushid.load_restoration(os.fspath(folder)))

    def apply(self, result, recording, *, observed=0):
        """The predicted motion of whole bodies: (frames, people, 22, 3), in m. Needs read(all_joints=True)."""
        return self._restoration.apply(result._model, *checked(recording), observed)
