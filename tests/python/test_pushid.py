"""The Python module as its users call it (pytest, through ctest)."""
import gc
import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import pushid

BIN = os.environ.get("PUSHID_BIN", "")


@pytest.fixture(scope="module")
def made():
    recordings, truth = pushid.simulate(people=3, recordings_per_person=4, joint_noise_m=0.001, seed=7)
    return recordings, truth


@pytest.fixture(scope="module")
def result(made):
    return pushid.fit(made[0])


def arrays(recording):
    return recording.hip[:, 0], recording.left_ankle[:, 0], recording.right_ankle[:, 0]


def from_arrays(recording, **changed):
    hip, left, right = arrays(recording)
    given = dict(hip=hip, left_ankle=left, right_ankle=right, mass=recording.mass[0], fps=recording.fps,
                 push=recording.push[:20, 0], push_kind=recording.push_kind, id=recording.id,
                 subjects=recording.subjects[0])
    given.update(changed)
    return pushid.Recording(**given)


def test_recordings_are_read_only_arrays(made):
    recording = made[0][0]
    assert recording.hip.shape == (90, 1, 3) and recording.states.shape == (90, 1, 8)
    assert recording.push.shape == (90, 1, 4)
    for array in (recording.hip, recording.left_ankle, recording.states, recording.push):
        assert array.dtype == np.float64
        with pytest.raises(ValueError):
            array[0] = 0
    assert "person" in repr(made[0]) or "people" in repr(made[0])


def test_arrays_outlive_their_recording():
    hip = pushid.simulate(people=1, recordings_per_person=1)[0][0].hip
    gc.collect()
    assert np.isfinite(hip).all() and abs(hip[0, 0, 2] - 0.95) < 0.3


def test_one_persons_track_is_a_view(made):
    recording = made[0][0]
    assert recording.hip.ctypes.data == recording.hip.ctypes.data  # no copy
    row = pushid.simulate(people=2, people_in_row=2, recordings_per_person=1)[0][0]
    assert row.hip.shape[1:] == (2, 3)


def test_the_default_fit_finds_the_truth(made, result):
    assert result.converged
    inside = [result[name].interval[0] <= value <= result[name].interval[1] for name, value in made[1].items()]
    assert sum(inside) >= len(inside) - 1
    assert result["mu"].unit == "N s/m" and not result["mu"].fixed
    assert abs(sum(result["mu"].shares.values()) - 1.0) < 1e-9
    names, matrix = result.covariance
    assert matrix.shape == (len(names), len(names)) and (np.linalg.eigvalsh(matrix) > 0).all()
    assert "mu" in str(result) and "mu" in repr(result) and "<svg" in result._repr_html_()


def test_a_misspelt_parameter_is_guessed(result):
    with pytest.raises(KeyError, match="Kp_theta"):
        result["Kp_teta"]


def test_options_are_those_of_the_flags(made):
    with pytest.raises(pushid.UsageError, match="is 'friction' meant"):
        pushid.fit(made[0], fricton="anisotropic")
    with pytest.raises(pushid.UsageError, match="preset"):
        pushid.fit(made[0], preset="nonsense")
    with pytest.raises(pushid.UsageError, match="no parameter"):
        pushid.fit(made[0], fix={"nu": 3})
    held = pushid.fit(made[0], fix={"mu": 25.0}, prior={"Kp_theta": (1500, 300)})
    assert held["mu"].value == 25.0 and held["mu"].fixed
    assert "tail" in pushid.options()["preset"][0]


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_arrays_of_any_layout(made, order, dtype):
    recording = made[0][0]
    changed = {name: np.asarray(array, dtype=dtype, order=order)
               for name, array in zip(("hip", "left_ankle", "right_ankle"), arrays(recording))}
    wide = np.zeros((90, 6))
    wide[:, ::2] = changed["hip"]
    changed["hip"] = wide[:, ::2]
    again = from_arrays(recording, **changed)
    assert np.allclose(again.hip, recording.hip, atol=1e-6)
    assert np.allclose(again.push, from_arrays(recording).push)


@pytest.mark.parametrize("changed, says", [
    (dict(hip=np.zeros((90, 2))), r"hip has the shape \(90, 2\)"),
    (dict(hip=np.zeros((80, 3))), "frames"),
    (dict(hip=np.full((90, 3), np.nan)), "not seen"),
    (dict(hip=np.full((90, 3), "a")), "must hold numbers"),
    (dict(mass=-3.0), "mass"),
    (dict(mass=[70.0, 80.0]), "as many"),
    (dict(fps=0.0), "fps"),
    (dict(push=np.zeros((20, 7))), "push has the shape"),
    (dict(push=np.zeros(400)), "is not within"),
    (dict(push=[np.nan, 1.0]), "not finite"),
    (dict(push_kind="hard"), "push_kind"),
    (dict(pushed_person=3), "pushed_person"),
])
def test_bad_arrays_are_told(made, changed, says):
    with pytest.raises((pushid.DataError, pushid.UsageError), match=says):
        from_arrays(made[0][0], **changed)


def test_gaps_are_filled(made):
    hip = arrays(made[0][0])[0].copy()
    hip[30:33] = np.nan
    filled = from_arrays(made[0][0], hip=hip)
    assert np.abs(filled.hip[30:33, 0] - made[0][0].hip[30:33, 0]).max() < 0.01


def test_forces_become_generalized_ones(made):
    recording = from_arrays(made[0][0], push=np.full(10, 100.0), push_start=5, push_kind="external")
    assert (recording.push[5:15, 0, 0] == 100.0).all() and (recording.push[:5] == 0).all()
    assert (recording.push[5:15, 0, 2] > 60.0).all()  # times the rod


def test_errors_say_file_and_line(tmp_path):
    path = tmp_path / "manifest.json"
    path.write_text('{"recordings": [\n{"id": "a"}]}')
    with pytest.raises(pushid.DataError) as told:
        pushid.read(path)
    assert told.value.file == str(path) and told.value.line == 2
    with pytest.raises(pushid.DataError):
        pushid.load(tmp_path / "none.json")


def test_a_recording_without_push_is_told(made):
    with pytest.raises(pushid.DataError, match="no push"):
        pushid.fit(from_arrays(made[0][0], push=None))
    rows, first, kind = pushid.estimate_push(made[0][0])
    assert rows.shape[1] == 4 and first >= 0 and kind == "net"


def test_predictions(made, result):
    recording = made[0][1]
    predicted = result.predict(recording)
    assert predicted["hip"].shape == (90, 1, 3)
    assert np.abs(predicted["hip"][1:, 0, 0] - recording.hip[1:, 0, 0]).mean() < 0.05
    seen = result.predict(recording, observed=20)
    assert (seen["lower90"] <= seen["upper90"]).all() and seen["observed"] == 20
    less = result.predict(recording, set={"mu": 0.0})
    assert less["hip"][-1, 0, 0] > predicted["hip"][-1, 0, 0]
    with pytest.raises(pushid.UsageError):
        result.predict(recording, samples=5)  # a model without process noise
    scores = result.evaluate(made[0])
    assert 0 < scores["mean"]["hipADE_m"] < 0.05


def test_online(made, result):
    recording = made[0][1]
    online = pushid.OnlinePredictor(result, recording, 90)
    first = online.predict()["hip"]
    assert np.array_equal(first, result.predict(recording)["hip"])
    for t in range(1, 20):
        online.observe(recording.hip[t], recording.left_ankle[t], recording.right_ankle[t])
    assert online.observed == 20
    assert np.allclose(online.predict()["hip"], result.predict(recording, observed=20)["hip"], atol=1e-9)
    with pytest.raises(pushid.DataError):
        online.observe(np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3)))


def test_formations(result):
    line = pushid.simulate_formation(result, "line", 4, push=60.0)
    assert line["hip"].shape[1:] == (4, 3) and len(line["onset_s"]) == 4
    with pytest.raises(pushid.UsageError):
        pushid.simulate_formation(result, "circle", 4)


def test_saved_loaded_and_pickled(made, result, tmp_path):
    result.save(tmp_path / "model.json")
    loaded = pushid.load(tmp_path / "model.json")
    assert loaded["mu"] == result["mu"]
    assert pickle.loads(pickle.dumps(result))["mu"] == result["mu"]
    with pytest.raises(pushid.UsageError, match="recordings"):
        loaded.profile("mu")
    assert loaded.attach(made[0]).profile("mu")
    with pytest.raises(pushid.UsageError):
        loaded.attach(made[0][:3])


def test_profile_bootstrap_crossvalidation(made, result):
    assert "mu" in result.profile("mu")
    assert result.bootstrap(9)["replicas"] == 9
    scores = pushid.crossvalidate(made[0], {"pd": {"preset": "ldp"}}, folds=2)
    assert [s["name"] for s in scores] == ["model", "pd", "static", "constant velocity"]


def test_report_is_a_page(result, tmp_path):
    page = result.report(tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.lstrip().startswith("<!DOCTYPE html>") and "mu" in page


def test_progress_is_told_and_its_errors_come_back(made):
    told = []
    pushid.fit(made[0], progress=lambda *step: told.append(step))
    assert len(told) > 3 and isinstance(told[0][0], str)

    def stop(phase, iteration, cost):
        raise RuntimeError("enough")
    with pytest.raises(RuntimeError, match="enough"):
        pushid.fit(made[0], progress=stop)


def test_ctrl_c_ends_a_fit(made):
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        pushid.fit(made[0], starts=100000)
    assert time.monotonic() - begin < 5.0


def test_fits_in_threads_agree(made, result):
    found = []
    threads = [threading.Thread(target=lambda: found.append(pushid.fit(made[0])["mu"])) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [result["mu"]] * 3


def test_pictures(made, result):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = result.plot()
    assert any(label.get_text().startswith("mu ") for label in axes.get_yticklabels())
    axes = result.plot_motion(made[0][0], observed=20)
    assert len(axes.lines) == 2 and axes.collections  # measured, predicted, the band


def test_no_leak(made):
    pages = lambda: int(open("/proc/self/statm", encoding="ascii").read().split()[1])
    one = made[0][:2]
    for _ in range(20):
        pushid.fit(one)
    gc.collect()
    before = pages()
    for _ in range(200):
        pushid.fit(one).predict(one[0])
    gc.collect()
    assert pages() - before < 2000  # 8 MB


@pytest.mark.skipif(not BIN, reason="PUSHID_BIN names no programs")
def test_results_are_the_programs(tmp_path):
    made = tmp_path / "made"
    subprocess.run([f"{BIN}/pushid-simulate", f"--out={made}", "--people=2"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([f"{BIN}/pushid-fit", f"--recordings={made}/manifest.json", f"--model_out={tmp_path}/m.json"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(tmp_path / "m.json", encoding="utf-8") as file:
        program = json.load(file)
    here = pushid.fit(pushid.read(made / "manifest.json"))
    assert here.json["values"] == program["values"]
    assert here.json["parameters"] == program["parameters"]
    here.save(tmp_path / "here.json")
    report = subprocess.run([f"{BIN}/pushid-report", f"--model={tmp_path}/here.json"], check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    assert "mu" in report


def test_stubs_name_everything():
    folder = os.path.dirname(pushid.__file__)
    with open(os.path.join(folder, "__init__.pyi"), encoding="utf-8") as file:
        stubs = file.read()
    for name in pushid.__all__:
        assert f"class {name}" in stubs or f"def {name}" in stubs, name
        assert (getattr(pushid, name).__doc__ or "").strip(), name
    compile(stubs, "__init__.pyi", "exec")


if __name__ == "__main__":
    sys.exit(pytest.main([__file__]))
