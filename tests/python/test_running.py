"""Long calls: progress, Ctrl-C, threads, memory."""
import gc
import os
import signal
import threading
import time

import pytest

import pushid


def test_progress_is_told_and_its_errors_come_back(made, result):
    told = []
    pushid.fit(made[0], progress=lambda *step: told.append(step))
    assert len(told) > 3 and isinstance(told[0][0], str)

    def stop(*_):
        raise RuntimeError("enough")
    with pytest.raises(RuntimeError, match="enough"):
        pushid.fit(made[0], progress=stop)
    for threads in (1, 2):  # out of a thread of its own an error would end Python
        with pytest.raises(RuntimeError, match="enough"):
            result.bootstrap(9, num_threads=threads, progress=stop)
    told.clear()
    pushid.crossvalidate(made[0], folds=2, baselines=False, progress=lambda *step: told.append(step))
    assert told == [(1, 2), (2, 2)]


def seconds_until_interrupted(call):
    """How long a call goes on after Ctrl-C."""
    pressed = []

    def press():
        pressed.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)
    threading.Timer(0.3, press).start()
    with pytest.raises(KeyboardInterrupt):
        call()
    return time.monotonic() - pressed[0]


def test_ctrl_c_ends_what_takes_long(made, result):
    # Within a second by processor time; this machine may be busy.
    assert seconds_until_interrupted(lambda: pushid.crossvalidate(made[0], folds=2, repeats=10000)) < 5.0
    assert seconds_until_interrupted(lambda: result.bootstrap(100000)) < 5.0
    assert seconds_until_interrupted(lambda: result.bootstrap(100000, num_threads=2)) < 5.0


def test_fits_in_threads_agree(made, result):
    found = []
    threads = [threading.Thread(target=lambda: found.append(pushid.fit(made[0])["mu"])) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [result["mu"]] * 3


def test_a_result_is_read_while_another_thread_extends_it(made):
    shared = pushid.fit(made[0])
    thread = threading.Thread(target=lambda: shared.bootstrap(20))
    thread.start()
    while thread.is_alive():
        assert shared.predict(made[0][0])["hip"].shape == (90, 1, 3) and str(shared)
    thread.join()
    assert shared.json["bootstrap"]["replicas"] == 20


def test_results_outlive_recordings():
    recordings = pushid.simulate(people=2, recordings_per_person=2)[0]
    found = pushid.fit(recordings)
    first = recordings[0]
    del recordings
    gc.collect()
    assert found.profile("mu") and found.predict(first)["hip"].shape[0] == 90


def test_many_fits_leave_nothing_behind():
    def pages():
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1])
    few = pushid.simulate(people=2, recordings_per_person=1, frames=30, fps=30.0)[0]
    for _ in range(25):
        pushid.fit(few).predict(few[0])
    gc.collect()
    before = pages()
    for _ in range(100):
        pushid.fit(few).predict(few[0])
    gc.collect()
    assert pages() - before < 100  # 4 kB a fit
