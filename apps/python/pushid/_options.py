"""Options of a fit, named as the flags of pushid-fit; flags and command lines in the words of Python."""
import difflib
import numbers
import re
import shlex

import numpy as np

from . import _pushid


def options():
    """The options of a fit: {name: (meaning, default)}; a default of None is set by the preset."""
    return {name: (in_python(meaning), default) for name, meaning, default in _pushid.options()}


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
        raise _pushid.UsageError(f"there is no option '{name}'" + (f"; did you mean '{near[0]}'?" if near else
                                                                   "; pushid.options() lists them"))
    return [(name, text_of(name, value)) for name, value in asked.items() if value is not None]


_CALLS = {"fit": "pushid.fit(recordings", "crossvalidate": "pushid.crossvalidate(recordings",
          "evaluate": "result.evaluate(recordings", "predict": "result.predict(recording", "report": "result.report(",
          "push": "pushid.estimate_push(recording", "simulate": "pushid.simulate(",
          "formation": "pushid.simulate_formation(result"}
_METHODS = ("profile", "bootstrap", "design", "horizon_check", "learn_forecasts")
_LISTS = ("fix", "free", "set", "leave_out", "ids")  # flags whose values are names
# Values end where the sentence goes on: with a space, a bracket, or a stop before one of them.
_FLAG = r"""--([a-z][a-z0-9_]*)(?:=([^\s()"';:]*[^\s()"';:.,]))?"""


def _value(text):
    if text in ("true", "false"):
        return text.title()
    return text if re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", text) else f'"{text}"'


def _option(name, value):
    """A flag as an option, or as a method of a result."""
    if name in _METHODS:
        return f"result.{name}({'' if value in ('', 'true', 'all') else ', '.join(map(_value, value.split(',')))})"
    if not value or name not in _LISTS:
        return f"{name}={_value(value)}" if value else name
    if "=" not in value:
        return f"{name}=[" + ", ".join(f'"{one}"' for one in value.split(",")) + "]"
    pairs = [part.partition("=") for part in value.split(",")]
    return f"{name}={{" + ", ".join(f'"{key}": {_value(item) if sign else None}' for key, sign, item in pairs) + "}"


def _call(match):
    """A program and its flags as a call; a program without one stays."""
    flags = [_option(*flag) for flag in re.findall(_FLAG, match[2])]
    methods = [flag for flag in flags if flag.startswith("result.")]
    if methods or match[1] not in _CALLS:
        return methods[0] if methods else match[0]
    name, _, first = _CALLS[match[1]].partition("(")
    return f"{name}({', '.join([first] * bool(first) + flags)})" if flags else name


def in_python(text):
    """What the library says for a command line: "--fix=mu=0" -> "fix={"mu": 0}", "pushid-push" -> "pushid.estimate_push"."""
    text = text.replace("pushid-fit --model_out", "result.save")
    text = text.replace('set "up" and "forward" in the manifest',
                        'set "up" and "forward" in the manifest (or turn arrays: z up, x forward)')
    text = re.sub(rf"pushid-([a-z]+)((?: {_FLAG})*)", _call, text)
    return re.sub(rf"(?<![A-Za-z0-9_-]){_FLAG}", lambda match: _option(match[1], match[2] or ""), text)


def _words(command):
    program, *flags = shlex.split(command)
    return program, {name: value if sign else "true" for name, sign, value in (
        flag[2:].partition("=") for flag in flags if flag.startswith("--"))}


def as_call(command):
    """"pushid-check --recordings=M/manifest.json --design=mu" -> "result.design("mu")"."""
    program, flags = _words(command)
    for name in _METHODS:
        if name in flags:
            return _option(name, flags[name])
    candidate = flags.pop("compare", None)
    left_out = flags.pop("leave_out", "")
    known = [name for name, _, _ in _pushid.options()]
    words = [f"[r for r in recordings if r.id not in {left_out.split(',')!r}]" if left_out else "recordings"]
    if candidate:
        name, _, more = candidate.partition(": ")
        words.append(f"{{{name!r}: {_words('pushid-fit ' + more)[1]!r}}}")
    words += [f"{flag}={value!r}" for flag, value in flags.items() if flag in known]
    return f"pushid.{'crossvalidate' if program == 'pushid-crossvalidate' else 'fit'}({', '.join(words)})"
