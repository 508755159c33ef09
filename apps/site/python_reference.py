"""The reference of `import pushid`: types of the stubs (__init__.pyi), docstrings and defaults of the built module.

  pages(): [(name of the page, its text)], which say so where the module cannot be imported. Exits where a public name
           has no docstring, or no page.
"""
import ast
import importlib
import inspect
import pathlib
import re
import sys

STUBS = ast.parse((pathlib.Path(__file__).resolve().parents[2] / "apps/python/pushid/__init__.pyi").read_text()).body
ABBREVIATIONS = {part.targets[0].id: ast.unparse(part.value) for part in STUBS if isinstance(part, ast.Assign)}
# Name of the page, its title, and the module whose public names stand there.
PAGES = [("python_recordings", "Recordings", "pushid._recordings"), ("python_fits", "Fits and results", "pushid._results"),
         ("python_predictions", "Predictions", "pushid._predictions"), ("python_options", "Options and errors", "pushid._options"),
         ("python_agents", "Agents", "pushid.agents")]


def doc(name, value):
    """Its docstring as Markdown; an attribute's is that of its property."""
    if not (value.__doc__ or "").strip():
        sys.exit(f"pushid: {name} has no docstring")
    return marked(value.__doc__)


def marked(text):
    """A docstring as Markdown: only `code`, and lines with a deeper indent, are more than text."""
    lines = []
    for line in inspect.cleandoc(text).splitlines():
        parts = re.split(r"(`[^`]*`)", line)
        lines.append(line if line.startswith("    ") else "".join(
            part if part.startswith("`") else re.sub(r"([*\[\]])", r"\\\1", part).replace("<", "&lt;") for part in parts))
    return "\n".join(lines)


def typed(node):
    """A type, with the stubs' own abbreviations written out."""
    return re.sub(r"\b_\w+", lambda match: ABBREVIATIONS.get(match[0], match[0].lstrip("_")), ast.unparse(node))


def signature(name, node, value):
    """Types of the stub with the defaults of the module: one parameter a line where they are many."""
    types = {}
    if node is not None:
        given = node.args
        rows = [*given.posonlyargs, *given.args, *given.kwonlyargs, *filter(None, [given.vararg, given.kwarg])]
        types = {row.arg: typed(row.annotation) for row in rows if row.annotation}
    parameters = []
    for parameter in inspect.signature(value).parameters.values():
        if parameter.name in ("self", "cls"):
            continue
        if parameter.kind == parameter.KEYWORD_ONLY and "*" not in parameters and not any(p.startswith("*") for p in parameters):
            parameters.append("*")
        text = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "") + parameter.name
        text += f": {types[parameter.name]}" if parameter.name in types else ""
        parameters.append(text if parameter.default is parameter.empty else f"{text} = {parameter.default!r}")
    returned = f" -> {typed(node.returns)}" if node is not None and node.returns else ""
    line = f"{name}({', '.join(parameters)}){returned}"
    if len(line) > 100:
        line = f"{name}(\n    " + ",\n    ".join(parameters) + f"){returned}"
    return f"```python\n{line}\n```\n"


def of_function(name, node, value, heading):
    return [f"{heading} {name.rpartition('.')[2]}\n", signature(name, node, value), doc(name, value) + "\n"]


def of_class(name, node, value):
    """Attributes as a table, then methods."""
    known = {getattr(part, "name", None) or part.target.id: part for part in (node.body if node else [])
             if isinstance(part, (ast.FunctionDef, ast.AnnAssign))}
    rows, methods = [], []
    for member, what in vars(value).items():
        stub = known.get(member)
        if member.startswith("_") or member.isupper():
            continue
        if callable(getattr(value, member)) and not isinstance(what, property):
            methods += of_function(f"{name}.{member}", stub, getattr(value, member), "###")
        elif isinstance(what, property):
            types = typed(stub.annotation if isinstance(stub, ast.AnnAssign) else stub.returns) if stub else ""
            types = types.replace(" | ", " or ")  # a | would end the cell
            text = doc(f"{name}.{member}", what).replace("\n", " ").replace("|", "or")
            rows.append(f"| `{member}` | {f'`{types}`' if types else ''} | {text} |")
    text = [f"## {name}\n", (doc(name, value) if name else "") + "\n"]
    if "__init__" in known:
        text.insert(1, signature(name, known["__init__"], value))
    if rows:
        text += ["| attribute | type | |\n|---|---|---|\n" + "\n".join(rows) + "\n"]
    return text + methods


def options(pushid):
    lines = ["## Options of a fit\n\nKeyword arguments of `fit`. Where the default is empty, the preset decides.\n\n"
             "| option | meaning | default |\n|---|---|---|"]
    for name, (meaning, default) in pushid.options().items():
        shown = "" if default is None else f"`{default}`" if default else "not given"
        lines.append(f"| `{name}` | {marked(meaning)} | {shown} |")
    return "\n".join(lines) + "\n"


def pages():
    try:
        pushid = importlib.import_module("pushid")
        compiled = importlib.import_module("pushid._pushid")
        importlib.import_module("pushid.agents")
    except ImportError as missing:
        return [(page, f"# {title}\n\nThe module is not built here ({missing}): `cmake --build --preset release --target _pushid`, "
                 "and build the site again.\n") for page, title, _ in PAGES]
    stubs = {node.name: node for node in STUBS if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    result, left = [], set(pushid.__all__)
    for page, title, module in PAGES:
        source = importlib.import_module(module)
        public = pushid.__all__ if module != "pushid.agents" else ["Agent", "PendulumModel", "Crowd"]
        values = {name: getattr(source, name) for name in public if getattr(getattr(source, name, None), "__module__", "") == module}
        if module == "pushid._options":
            values.update({name: getattr(compiled, name) for name in ("DataError", "UsageError", "FitError")})
        left -= values.keys()
        text = [f"# {title}\n", "[How to use it](../apps/python/README.md).\n", marked(source.__doc__) + "\n"]
        for name, value in sorted(values.items(), key=lambda item: item[0].lower()):
            make = of_class if inspect.isclass(value) else lambda *them: of_function(*them, "##")
            text += make(name, stubs.get(name), value)
        if module == "pushid._recordings":
            text += ["## Attributes of a recording\n", *of_class("", stubs["_Recording"], compiled.Recording)[2:]]
        result.append((page, "\n".join(text + ([options(pushid)] if module == "pushid._options" else []))))
    if left:
        sys.exit(f"pushid: on no page of the reference: {', '.join(sorted(left))}")
    return result


if __name__ == "__main__":
    for made, text in pages():
        print(text)
