"""Feet that hold and step (--stance=threshold) against feet that slide.

single    errors on held-out recordings of single people, every scheme (models/README.md); 6 minutes
groups    the same of groups, with who moves and who steps (ident/prediction/README.md); 10 minutes
steps     who steps: AUC, Brier score, calibration (ident/prediction/README.md); with what the others ran
sways     80 kg pushed for 0.7 s with so many N s: where the person ends (models/README.md); seconds
values    what the fit of single people says of the feet (ident/README.md); seconds

Times are those of one core.
"""
import studies
from studies import number, with_error

STANCE = "--stance=threshold"
SCHEMES = [("5 x 4 folds", "stratified", ("--repeats=5",)), ("one person at a time", "subject", ()),
           ("strong pushes", "strong", ())]


def compared(setting, scheme, *arguments):
    """Cross-validation of both, by name: slide, threshold."""
    out = studies.on_recordings("pushid-crossvalidate", setting, f"--scheme={scheme}", "--yardsticks=false",
                                *arguments, f"--compare=threshold: {STANCE}").json
    first, second = out["predictors"]
    difference = out["differences"][0]
    return {"slide": first, "threshold": second}, difference


def error_cells(p):
    mean = p["mean"]
    return [with_error(mean["hipADE_m"], mean["hipADE_standard_error_m"]),
            with_error(mean["hipFDE_m"], mean["hipFDE_standard_error_m"]),
            f"{p['fits_that_settle']} of {p['fits']}"]
