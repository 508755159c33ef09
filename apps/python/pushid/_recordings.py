"""Recordings: read from manifests, made from arrays, or simulated."""
import os

import numpy as np

from . import _pushid
from ._options import in_python, text_of


class Recordings(list):
    """A list of recordings, with the warnings about their files (`warnings`)."""
    # _told: of each warning the sentence, its recording, and what it says of several.

    def __init__(self, recordings=(), warnings=()):
        super().__init__(recordings)
        self._told = list(warnings)

    @property
    def warnings(self):
        """Warnings about the files; equal ones once."""
        return [in_python(text) for text in _pushid.grouped(self._told)]

    def __repr__(self):
        people = {subject for recording in self for subject in recording.subjects}
        return f"<{len(self)} recordings of {len(people)} people>"


def _listed(names):
    return [str(name) for name in ([names] if isinstance(names, (str, int)) else names)]


_DEFAULT = _pushid.defaults  # those of the library's structs


def read(manifest, setting=_DEFAULT["setting"], *, ids=(), leave_out=(), all_joints=False,
         max_gap_s=_DEFAULT["max_gap_s"], lowpass_hz=_DEFAULT["lowpass_hz"], resample_fps=_DEFAULT["resample_fps"],
         length_unit="", length_scale=0.0):
    """Recordings of a manifest, or of several (a list of paths).

    setting: settings of the manifest, comma-separated, "groups" or "all". ids, leave_out: ids to use or to skip.
    all_joints: keep whole bodies, for restorations and the report's figure. max_gap_s (s), lowpass_hz (Hz, 0: none)
    and resample_fps (0: as recorded) prepare the motion; length_unit ("mm", "cm", "m") overrides the unit
    of the files; length_scale, instead, gives the metres per length unit of the files (0: use the unit). Raises
    DataError with file and line.
    """
    paths = [manifest] if isinstance(manifest, (str, os.PathLike)) else manifest
    found, told = _pushid.read(",".join(os.fspath(path) for path in paths), setting, _listed(ids),
                               _listed(leave_out), all_joints, max_gap_s, lowpass_hz, resample_fps, length_unit,
                               length_scale)
    return Recordings(found, told)


def _positions(name, values, metres):
    array = np.asanyarray(values)
    if array.dtype.kind not in "fiu":
        raise _pushid.DataError(f"{name} holds {array.dtype}; it must hold numbers")
    if isinstance(array, np.ma.MaskedArray):  # masked: not seen
        array = array.astype(float).filled(np.nan)
    return _by_person(array * metres if metres != 1.0 else array.astype(float, copy=False), 3)


def _by_person(array, columns):
    """(frames, columns) of one person as (frames, 1, columns)."""
    return array[:, None] if array.ndim == 2 and array.shape[1] == columns else array


def _numbers(values):
    return None if values is None else np.asarray(values, dtype=float)


def Recording(hip, left_ankle, right_ankle, mass, fps, push=None, *, id="recording", subjects=(), pushed_person=0,
              push_start=0, push_height=1.0, push_height_m=None, push_kind="external", initial_velocity="zero",
              setting="single", magnitude="unknown", condition="", length_unit="m", ground=None, plates=None):
    """A recording from arrays, with the same checks as one from files.

    hip, left_ankle, right_ankle: (frames, 3), or (frames, people, 3), in length_unit ("mm", "cm" or "m"), z up and x
    forward; NaN or masked where missing. mass: kg, a number or one for each person. fps: frames per second.
    push: from frame `push_start` on, on `pushed_person`: (rows,) forwards, (rows, 2) or (rows, 3) in N at the height
    `push_height` (a fraction of the way from the ankles to the hip, 0 to 1) or `push_height_m` (m above the ground),
    or (rows, 4): generalized forces in N and N m.
    push_kind: what the push means: "external" (measured, the whole push), "net" (from inverse dynamics: the sum of all
    forces on the person) or "net_without_friction" (that sum without the friction of the feet). initial_velocity: "zero",
    "estimated" or "free". subjects: ids of the people, by which errors are clustered. setting, magnitude, condition:
    labels to group results by. ground: how the ground moves under the people, from rest: (frames, 2), x and y in m, or
    (frames, 4) with the tilts theta and phi in rad. plates: what force platforms under them measured, which move with
    the ground: (frames, 5) or (frames, people, 5), fx, fy, fz in N on the person and the centre of pressure px, py in
    m; NaN where nothing was measured. A recording's `ground` is (frames, 4) and its `plates` (frames, people, 5), or
    None. id: of this recording alone among those of a fit. Raises DataError; warns where much of hip or ankles is
    missing, and where the ankles look exchanged.
    """
    rows, plates = _numbers(push), _numbers(plates)
    metres = _pushid.metres_per(length_unit)
    return _pushid.from_arrays(_positions("hip", hip, metres), _positions("left_ankle", left_ankle, metres),
                               _positions("right_ankle", right_ankle, metres), [float(m) for m in np.atleast_1d(mass)],
                               float(fps), rows[:, None] if rows is not None and rows.ndim == 1 else rows, str(id), _listed(subjects), pushed_person, push_start, push_height,
                               push_height_m, push_kind, initial_velocity, setting, magnitude, condition,
                               _numbers(ground), plates if plates is None else _by_person(plates, 5))


def simulate(*, people=_DEFAULT["people"], recordings_per_person=_DEFAULT["recordings_per_person"],
             people_in_row=_DEFAULT["people_in_row"], fps=_DEFAULT["fps"], frames=_DEFAULT["frames"],
             seed=_DEFAULT["seed"], push_kind=_DEFAULT["push_kind"], joint_noise_m=0.002, set=None):
    """Recordings of synthetic people with known parameters: (recordings, {name: true value}).

    people_in_row: more than one stand one behind the other and touch; the last of them is pushed.
    set: {name: value} of true values that differ from the defaults. joint_noise_m: m, one sigma.
    """
    changed = text_of("set", set or {})
    found, truth = _pushid.simulate(people, recordings_per_person, people_in_row, fps, frames, seed, push_kind,
                                    joint_noise_m, changed)
    return Recordings(found), truth


def checked(recordings):
    """One recording, or several, as a list of recordings."""
    found = [recordings] if isinstance(recordings, _pushid.Recording) else list(recordings)
    for one in found:
        if not isinstance(one, _pushid.Recording):
            raise _pushid.UsageError(f"expected a recording, found {type(one).__name__}; make one by "
                                     "pushid.Recording(hip, left_ankle, right_ankle, mass, fps, push) or pushid.read")
    return found


def estimate_push(recording, *, person=0, first_frame=-1, end_frame=-1, smoothing=9):
    """Estimates a missing push by inverse dynamics: (rows of 4 generalized forces, first frame, kind).

    first_frame, end_frame: the window; -1: detected. smoothing: Savitzky-Golay window in frames, odd; 0: none.
    Everything that accelerates the hip is attributed to the push, which often overestimates it.
    """
    return _pushid.estimate_push(*checked(recording), person, first_frame, end_frame, smoothing)


def findings(recordings):
    """Contradictions in recordings: pushes that do not fit the motion, masses, copies, ...; a fit warns of them.

    A list of dicts: kind, recording, about (a person, or the copies), value and its unit, what it means, and advice.
    """
    return _pushid.findings(checked(recordings))


def _described(recording):
    return f"<{recording.id}: {recording.num_people} people, {recording.num_frames} frames at {recording.fps:g} Hz>"


def _from_bytes(content):
    return _pushid.from_bytes(content)


_pushid.Recording.__repr__ = _described
_pushid.Recording.__reduce__ = lambda recording: (_from_bytes, (_pushid.to_bytes(recording),))
