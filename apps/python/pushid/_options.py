"""Options of a fit, named as the flags of pushid-fit, and command lines converted to Python calls."""
import difflib
import numbers
import shlex

import numpy as np

from . import _pushid


def options():
    """The options of a fit: {name: (meaning, default)}; a default of None is set by the preset."""
    return {name: (_pushid.in_python(meaning), default) for name, meaning, default in _pushid.options()}


def _word(value):
    """One value in command-line form; NumPy numbers as Python numbers."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    return repr(float(value)) if isinstance(value, numbers.Real) else str(value)


def text_of(name, value):
    """A list, or a dict of parameters, in command-line form."""
    if isinstance(value, dict):
        if name == "prior":  # {name: (mean, sigma)}
            return ",".join(f"{key}:{_word(mean)}:{_word(sigma)}" for key, (mean, sigma) in value.items())
        return ",".join(key if item is None else f"{key}={_word(item)}" for key, item in value.items())
    return ",".join(map(_word, value)) if isinstance(value, (list, tuple)) else _word(value)


def given(asked):
    """Keyword arguments as (name, text), with checked names; None counts as not given."""
    known = [name for name, _, _ in _pushid.options()]
    for name in asked:
        if name in known:
            continue
        near = difflib.get_close_matches(name, known, 1)
        raise _pushid.UsageError(f"there is no option '{name}'" + (f"; is '{near[0]}' meant?" if near else
                                                                   "; pushid.options() lists them"))
    return [(name, text_of(name, value)) for name, value in asked.items() if value is not None]


_CHECKS = ("horizon_check", "learn_forecasts")


def _words(command):
    program, *flags = shlex.split(command)
    return program, dict(flag[2:].split("=", 1) for flag in flags if flag.startswith("--") and "=" in flag)


def as_call(command):
    """"pushid-check --recordings=M/manifest.json --design=mu" -> "result.design('mu')"."""
    program, flags = _words(command)
    for name in _CHECKS:
        if name in flags:
            return f"result.{name}()"
    if "design" in flags:
        return f"result.design({flags['design']!r})"
    if "profile" in flags:
        names = [] if flags["profile"] == "all" else flags["profile"].split(",")
        return f"result.profile({', '.join(map(repr, names))})"
    if "bootstrap" in flags:
        return f"result.bootstrap({flags['bootstrap']})"
    candidate = flags.pop("compare", None)
    left_out = flags.pop("leave_out", "")
    known = [name for name, _, _ in _pushid.options()]
    words = [f"[r for r in recordings if r.id not in {left_out.split(',')!r}]" if left_out else "recordings"]
    if candidate:
        name, _, more = candidate.partition(": ")
        words.append(f"{{{name!r}: {_words('pushid-fit ' + more)[1]!r}}}")
    words += [f"{flag}={value!r}" for flag, value in flags.items() if flag in known]
    return f"pushid.{'crossvalidate' if program == 'pushid-crossvalidate' else 'fit'}({', '.join(words)})"
