"""pushid: identifies friction, balance gains and push propagation from recordings of pushed people.

    import pushid
    recordings = pushid.read("manifest.json", setting="single")
    result = pushid.fit(recordings)
    print(result["mu"].value, result["mu"].interval)
    result.report("report.html")

World: z up, x forward (the direction of the push), y left; m, s, N, rad. Returned arrays are read-only.
"""
try:
    from ._pushid import DataError, FitError, UsageError
    from ._pushid import version as __version__
    from ._options import options
    from ._predictions import OnlinePredictor, Restoration, simulate_formation
    from ._recordings import Recording, Recordings, estimate_push, findings, read, simulate
    from ._results import Design, Parameter, Result, Table, crossvalidate, fit, load
except ImportError as missing:  # pushid.ldp needs neither the compiled module nor NumPy
    _missing = str(missing)

    def __getattr__(name):
        if name not in [*__all__, "__version__"]:
            raise AttributeError(f"module 'pushid' has no attribute {name!r}")
        raise ImportError(f"pushid.{name} needs the compiled module and NumPy, and here is no such: {_missing}. Build "
                          "it, see apps/python/README.md; only python3 -m pushid.ldp runs without it")

__all__ = ["DataError", "FitError", "UsageError", "Design", "OnlinePredictor", "Parameter", "Recording", "Recordings",
           "Restoration", "Result", "Table", "crossvalidate", "estimate_push", "findings", "fit", "load",
           "options", "read", "simulate", "simulate_formation"]
