from os import PathLike
from typing import Any, Callable, Iterable, Mapping, NamedTuple, Sequence

from numpy import ndarray
from numpy.typing import ArrayLike

__version__: str

class DataError(ValueError):
    file: str | None
    line: int | None

class UsageError(ValueError):
    file: str | None
    line: int | None

class FitError(RuntimeError):
    file: str | None
    line: int | None

class _Recording:
    id: str
    setting: str
    magnitude: str
    condition: str
    fps: float
    pushed_person: int
    content_hash: str
    num_frames: int
    num_people: int
    push_kind: str
    initial_velocity: str
    subjects: list[str]
    mass: list[float]
    known: list[dict[str, float | str]]  # of each person: what the manifest says beside the mass
    hip: ndarray
    left_ankle: ndarray
    right_ankle: ndarray
    states: ndarray
    push: ndarray
    ground: ndarray | None
    plates: ndarray | None

class Recordings(list[_Recording]):
    warnings: list[str]

class Parameter(NamedTuple):
    name: str
    value: float
    standard_error: float | None
    interval: tuple[float, float] | None
    unit: str
    status: str
    shares: dict[str, float]
    fixed: bool

class Table(list[dict[str, Any]]):
    def to_frame(self) -> Any: ...

_Path = str | PathLike[str]
_Names = str | Sequence[str]
_Jobs = Callable[[int, int], Any] | None

def Recording(hip: ArrayLike, left_ankle: ArrayLike, right_ankle: ArrayLike, mass: float | Sequence[float], fps: float,
              push: ArrayLike | None = ..., *, id: str = ..., subjects: _Names = ..., pushed_person: int = ...,
              push_start: int = ..., push_height: float = ..., push_height_m: float | None = ..., push_kind: str = ..., initial_velocity: str = ...,
              setting: str = ..., magnitude: str = ..., condition: str = ..., length_unit: str = ...,
              ground: ArrayLike | None = ..., plates: ArrayLike | None = ...) -> _Recording: ...
def read(manifest: _Path | Sequence[_Path], setting: str = ..., *, ids: _Names = ..., leave_out: _Names = ...,
         all_joints: bool = ..., max_gap_s: float = ..., lowpass_hz: float = ..., resample_fps: float = ...,
         length_unit: str = ..., length_scale: float = ...) -> Recordings: ...
def simulate(*, people: int = ..., recordings_per_person: int = ..., people_in_row: int = ..., fps: float = ...,
             frames: int = ..., seed: int = ..., push_kind: str = ..., joint_noise_m: float = ...,
             set: Mapping[str, float] | None = ...) -> tuple[Recordings, dict[str, float]]: ...
def estimate_push(recording: _Recording, *, person: int = ..., first_frame: int = ..., end_frame: int = ...,
                  smoothing: int = ...) -> tuple[ndarray, int, str]: ...
def findings(recordings: _Recording | Iterable[_Recording]) -> list[dict[str, Any]]: ...

class Result:
    json: dict[str, Any]
    verdict: dict[str, Any]
    table: Table
    names: list[str]
    covariance: tuple[list[str], ndarray]
    converged: bool
    warnings: list[str]
    advice: list[tuple[str, str]]
    contrast: dict[str, Any] | None
    def __getitem__(self, name: str) -> Parameter: ...
    profiles: list[dict[str, Any]]
    def profile(self, *names: str, num_threads: int = ..., progress: _Jobs = ...) -> dict[str, Any]: ...
    def bootstrap(self, replicas: int = ..., *, seed: int = ..., num_threads: int = ...,
                  progress: _Jobs = ...) -> dict[str, Any]: ...
    def horizon_check(self, *, num_threads: int = ..., progress: _Jobs = ...) -> dict[str, Any]: ...
    def learn_forecasts(self, *, num_threads: int = ...) -> dict[str, Any]: ...
    def design(self, parameter: str = ...) -> Design: ...
    def predict(self, recording: _Recording, *, observed: int = ..., forecast: str = ..., frames: int = ...,
                samples: int = ..., seed: int = ..., set: Mapping[str, float] | None = ..., push_scale: float = ...,
                push_again: Iterable[int] = ...) -> dict[str, Any]: ...
    def evaluate(self, recordings: Iterable[_Recording], *, observed: int = ..., forecast: str = ...) -> Scores: ...
    def loop(self, *, mass: float = ..., rod: float = ...) -> dict[str, dict[str, Any]]: ...
    def report(self, path: _Path) -> _Path: ...
    def save(self, path: _Path) -> None: ...
    def attach(self, recordings: Iterable[_Recording]) -> Result: ...
    @property
    def figures(self) -> dict[str, str]: ...
    @property
    def details(self) -> str: ...
    def plot(self, name: str = ..., axes: Any = ..., panel: str | int | None = ...) -> Any: ...

class Scores(dict[str, Any]):
    text: str

class CrossValidation(list[dict[str, Any]]):
    text: str

class Design(dict[str, Any]): ...

def fit(recordings: _Recording | Iterable[_Recording], *, progress: Callable[[str, int, float], Any] | None = ...,
        **asked: Any) -> Result: ...
def load(path: _Path) -> Result: ...
def options() -> dict[str, tuple[str, str | None]]: ...
def crossvalidate(recordings: Iterable[_Recording], candidates: Mapping[str, Mapping[str, Any]] | None = ..., *,
                  scheme: str = ..., folds: int = ..., repeats: int = ..., seed: int = ..., observed: int = ...,
                  forecast: str = ...,
                  baselines: bool = ..., num_threads: int = ..., progress: _Jobs = ..., **asked: Any) -> CrossValidation: ...
def simulate_formation(result: Result, shape: str = ..., people: int = ..., *, spacing: float = ..., pushed: int = ...,
                       push: float | None = ..., push_duration: float | None = ..., push_direction: float = ...,
                       mass: float | None = ..., rod: float | None = ..., duration: float = ..., fps: float = ..., set: Mapping[str, float] | None = ...,
                       onset_bands: bool = ...) -> dict[str, Any]: ...

class OnlinePredictor:
    def __init__(self, result: Result, recording: _Recording, frames: int = ..., *, forecast: str = ...) -> None: ...
    def observe(self, hip: ArrayLike, left_ankle: ArrayLike, right_ankle: ArrayLike) -> None: ...
    observed: int
    def predict(self) -> dict[str, Any]: ...
    def push(self, force: ArrayLike, person: int = ...) -> None: ...
    def next(self, frames: int) -> ndarray: ...

class Restoration:
    @classmethod
    def load(cls, folder: _Path) -> Restoration: ...
    def apply(self, result: Result, recording: _Recording, *, observed: int = ...) -> ndarray: ...
