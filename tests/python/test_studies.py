"""What is asked of a fit beyond its table: refits, designs, futures, paths, formations, pictures."""
import numpy as np
import pytest

import pushid


@pytest.fixture(scope="module")
def noisy(made):
    """A model that knows the noise of single steps."""
    return pushid.fit(made[0], likelihood="innovation")


def test_profiles(result):
    found = result.profile("mu", "Kp_theta")
    assert list(found) == ["mu", "Kp_theta"]
    low, high = found["mu"]["interval_95"]
    assert low < result["mu"].value < high and found["mu"]["class"] == "identifiable"
    assert {"value", "cost"} <= set(found["mu"]["points"][0])
    with pytest.raises(pushid.UsageError, match="nu"):
        result.profile("nu")


def test_bootstrap_and_crossvalidation(made, result):
    assert result.bootstrap(9)["replicas"] == 9
    assert "bootstrap" in result.details
    scores = pushid.crossvalidate(made[0], {"pd": {"preset": "ldp"}}, folds=2)
    assert [s["name"] for s in scores] == ["model", "pd", "static", "constant velocity"]
    with pytest.raises(pushid.UsageError, match="scheme"):
        pushid.crossvalidate(made[0], scheme="nonsense")


def test_fewer_frames(made, result):
    assert {row["frames"] for row in result.horizon_check()["refits"]} == {8, 16, 32, 64}
    assert "horizon_check" in result.json


def test_designs(made, result):
    design = result.design("mu")
    ratios = [row["error_ratio"]["mu"] for row in design["pushes"]]
    assert ratios == sorted(ratios) and ratios[0] < 1.0
    # By the data alone: more recordings leave the errors of what is taken as known as they are.
    assert 0.0 < design["standard_error"]["mu"] < result["mu"].standard_error
    assert "error of mu" in str(design) and any(row["sensor"] for row in design["pushes"])
    with pytest.raises(pushid.UsageError, match="choose from all, mu"):
        result.design("nu")
    few = pushid.fit(made[0][:2]).design()
    assert not few["pushes"] and "more recordings" in few["no_push"]


def test_advice_is_in_python(made, result):
    for sentence, call in result.advice:
        assert sentence and "--" not in call and call.startswith(("result.", "pushid."))
        compile(call, "advice", "eval")


def test_futures(made, result):
    recording = made[0][1]
    drawn = result.predict(recording, samples=50, seed=3)
    samples = drawn["samples"]
    assert samples.shape == (50, 90, 1, 3) and np.isfinite(samples).all()
    assert 0.0 < samples[:, -1, 0, 0].std() < 1.0
    again = result.predict(recording, samples=50, seed=3)["samples"]
    assert np.array_equal(samples, again)
    assert np.abs(np.median(samples[:, -1, 0, 0]) - drawn["hip"][-1, 0, 0]) < 0.2
    with pytest.raises(pushid.UsageError, match="observed"):
        result.predict(recording, observed=20, samples=5)
    with pytest.raises(pushid.UsageError, match="frames=10"):
        result.predict(recording, observed=20, frames=10)
    with pytest.raises(pushid.UsageError, match="set"):
        result.predict(recording, samples=5, set={"mu": 3})
    assert result.predict(recording, frames=120, samples=5)["samples"].shape == (5, 120, 1, 3)


def test_a_push_unlike_the_fitted_ones_is_warned_of(made, result):
    hard = made[0][0]
    hard = pushid.Recording(hard.hip, hard.left_ankle, hard.right_ankle, mass=hard.mass, fps=hard.fps,
                            push=4.0 * hard.push[:, 0], push_kind=hard.push_kind)
    with pytest.warns(UserWarning, match="fitted"):
        try:
            result.predict(hard)
        except pushid.FitError:  # so hard a push may leave the model's domain
            pass


@pytest.mark.filterwarnings("ignore:the model was fitted without interaction")
def test_formations(result):
    line = pushid.simulate_formation(result, "line", 4, push=60.0, onset_bands=True)
    assert line["hip"].shape[1:] == (4, 3) and line["speed"].shape == line["hip"].shape[:2]
    assert len(line["onset_s"]) == 4 and line["onset_s"][0] is not None
    low, high = line["onset_band90"][0]
    assert low <= high and line["fps"] == 60.0
    assert line["wave_speed"] is None or line["wave_speed"] > 0.0
    right = pushid.simulate_formation(result, "line", 1, push=60.0, push_direction=-90.0)
    assert right["hip"][-1, 0, 1] < -0.03 and right["displacement"][0] > 0.03
    for wrong in (dict(shape="circle"), dict(people=0), dict(spacing=-1.0), dict(set={"nu": 1})):
        with pytest.raises(pushid.UsageError):
            pushid.simulate_formation(result, **{"shape": "line", "people": 4, **wrong})


def test_people_who_do_not_touch_are_warned_of(result):
    with pytest.warns(UserWarning, match="interaction"):
        pushid.simulate_formation(result, "line", 2)


def test_whole_bodies(made, result):
    rigid = pushid.Restoration.load("rigid")
    with pytest.raises(pushid.DataError, match="joints"):
        rigid.apply(result, made[0][0])  # of hip and ankles alone
    with pytest.raises(pushid.DataError):
        pushid.Restoration.load("/no/such/folder")


@pytest.mark.filterwarnings("ignore:the model was fitted without interaction")
def test_pictures(made, result, monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.figure
    import matplotlib.pyplot

    def whole(axes):
        """Whether all words lie within the saved figure."""
        axes.figure.canvas.draw()
        box = axes.figure.get_tightbbox(axes.figure.canvas.get_renderer())  # inches
        width, height = axes.figure.get_size_inches()
        return box.x0 > -0.02 and box.y0 > -0.02 and box.x1 < width + 0.02 and box.y1 < height + 0.02

    drawn = result.plot()
    assert whole(drawn[0])
    assert "mu, N s/m" in [axes.get_title(loc="left") for axes in drawn]
    one = result.plot("forest", axes=matplotlib.figure.Figure().subplots(), panel="mu")
    low, high = result["mu"].interval
    ends = [end for line in one.lines for end in line.get_xdata()]
    assert any(end == pytest.approx(low) for end in ends) and any(end == pytest.approx(high) for end in ends)
    result.profile("mu")
    axes = result.plot("profiles", panel="mu")
    assert axes.lines[0].get_ydata().min() == pytest.approx(0.0, abs=0.01)
    figures = pushid._pushid.figures(result._model)  # once: made with every picture they take half a minute
    monkeypatch.setattr(pushid._pushid, "figures", lambda model: figures)
    for name in figures:  # each of them can be drawn
        result.plot(name)
        matplotlib.pyplot.close("all")
    # what the report's picture of the recording draws: the motion itself
    hip = made[0][0].hip[:, 0, 0]
    axes = result.plot(f"motion_{made[0][0].id}", panel="hip forward")
    assert any(np.allclose(line.get_ydata(), hip - hip[0]) for line in axes.lines if len(line.get_ydata()) == len(hip))
    with pytest.raises(KeyError, match="no figure 'none'"):
        result.plot("none")
    with pytest.raises(ValueError, match="panels"):
        result.plot("forest", axes=axes)


def test_loop(made, result):
    standing = pushid.fit(made[0], stance="fixed", fix={"Kp_theta": 1500, "Kd_theta": 300})
    loop = standing.loop()
    assert set(loop) == {"theta", "phi"} and loop["theta"]["stable"]
    assert loop["theta"]["phase_margin"] > 0 and loop["theta"]["gain_down"] < 1 < loop["theta"]["stiffness_ratio"]
    with pytest.raises(pushid.UsageError, match="mass"):
        standing.loop(mass=0.0)
