"""pushid: identifies friction, balance gains and push propagation from recordings of pushed people.

    import pushid
    recordings = pushid.read("manifest.json", setting="single")
    result = pushid.fit(recordings)
    print(result["mu"].value, result["mu"].interval)
    result.report("report.html")

World: z up, x forward (the direction of the push), y left; m, s, N, rad. Returned arrays are read-only.
"""
from ._pushid import DataError, FitError, UsageError
from ._pushid import version as __version__
from ._options import options
from ._predictions import Formation, OnlinePredictor, Restoration, simulate_formation
from ._recordings import Recording, Recordings, estimate_push, findings, read, simulate
from ._results import Design, Parameter, Result, Table, crossvalidate, fit, load

__all__ = ["DataError", "FitError", "UsageError", "Design", "Formation", "OnlinePredictor", "Parameter", "Recording",
           "Recordings", "Restoration", "Result", "Table", "crossvalidate", "estimate_push", "findings", "fit", "load",
           "options", "read", "simulate", "simulate_formation"]
