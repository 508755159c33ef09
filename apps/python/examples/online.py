"""Prediction while a person moves: 60 frames a second are shown one by one, each followed by a new prediction.

    PYTHONPATH=build/release/python python3 apps/python/examples/online.py

Draws the error of the prediction half a second ahead against the time since the push, live against the recording, and
prints how long a frame takes (observe and predict) as a histogram.
"""
import time

import numpy as np
import pushid

AHEAD = 30  # frames

recordings, _ = pushid.simulate(people=4, recordings_per_person=6, seed=1)
result = pushid.fit(recordings[:-1])
result.learn_forecasts()
new = recordings[-1]
milliseconds = []
print(f"error {AHEAD / new.fps:.1f} s ahead against the time since the push")
for run in range(20):
    online = pushid.OnlinePredictor(result, new, new.num_frames)
    for t in range(1, new.num_frames):
        begin = time.perf_counter()
        online.observe(new.hip[t], new.left_ankle[t], new.right_ankle[t])
        predicted = online.predict()
        milliseconds.append(1000 * (time.perf_counter() - begin))
        if run == 0 and t % 5 == 0 and t + AHEAD < new.num_frames:
            error = np.linalg.norm(predicted["hip"][t + AHEAD, 0] - new.hip[t + AHEAD, 0])
            print(f"{t / new.fps:5.2f} s {1000 * error:5.1f} mm {'#' * int(round(1000 * error))}")
counts, edges = np.histogram(milliseconds, bins=10, range=(0, np.percentile(milliseconds, 99)))
for count, low, high in zip(counts, edges, edges[1:]):
    print(f"{low:6.3f} to {high:6.3f} ms {'#' * int(60 * count / counts.max())}")
print(f"median {np.median(milliseconds):.3f} ms, 99 % {np.percentile(milliseconds, 99):.3f} ms; a frame is {1000 / new.fps:.1f} ms")
