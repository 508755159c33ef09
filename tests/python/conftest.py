"""What the tests of the Python module share: synthetic recordings and their fit."""
import pytest

import pushid


@pytest.fixture(scope="session")
def made():
    return pushid.simulate(people=3, recordings_per_person=4, joint_noise_m=0.001, seed=7)


@pytest.fixture(scope="session")
def result(made):
    fitted = pushid.fit(made[0])
    fitted.learn_forecasts()
    return fitted
