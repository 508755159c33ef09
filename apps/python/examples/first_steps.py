"""From three arrays to identified parameters, a report page and a prediction.

    PYTHONPATH=build/release/python python3 apps/python/examples/first_steps.py

The arrays come from synthetic people here; put your own in their place: hip, left and right ankle in m, z up and x forward,
and the force of the push in N.
"""
import numpy as np
import pushid

made, truth = pushid.simulate(people=4, recordings_per_person=6, push_kind="external", seed=3)
recordings = []
for r in made:
    hip, left, right = r.hip[:, 0], r.left_ankle[:, 0], r.right_ankle[:, 0]  # (frames, 3)
    force = r.push[:, 0]  # (frames, 4); a sensor's (frames,) or (frames, 3) will do
    recordings.append(pushid.Recording(hip, left, right, mass=r.mass[0], fps=r.fps, push=force, id=r.id,
                                       subjects=r.subjects[0]))
result = pushid.fit(recordings)
print(result)
for name, true in truth.items():  # every number says how sure it is, and how much of it the data decided
    if name in result.names and not result[name].fixed:
        p = result[name]
        print(f"{name:10} {p.value:8.4g}  {p.interval[0]:8.4g} to {p.interval[1]:8.4g} {p.unit:10} "
              f"(truth {true:g}; data {p.shares['data']:.0%})")
result.report("report.html")

alone = result.predict(recordings[0])["hip"]  # from the first frame and the push
print("mean error of the hip:", np.linalg.norm(alone - recordings[0].hip, axis=2)[1:].mean(), "m")
less = result.predict(recordings[0], set={"mu": 0.0})["hip"]
print("without drag it would go", less[-1, 0, 0] - alone[-1, 0, 0], "m farther")
