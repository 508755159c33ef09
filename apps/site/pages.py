"""The site's pages in build/site/docs: the READMEs at their places, sections of them as tutorials, and references made of
what the programs, the Python module and the studies' blocks say. Nothing is written twice.

  pages.py BIN    BIN: the folder of the programs
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import python_reference
import tutorials

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCS = ROOT / "build" / "site" / "docs"
BIN = pathlib.Path(sys.argv[1]).resolve()
ROOMS = ("apps", "datasets", "ident", "models", "residuals", "tests")
LINK = re.compile(r"(\]\()([^)#\s]*)(#[^)\s]*)?(\))")
BLOCK = re.compile(r"<!-- (tests/studies/\S+ \w+) -->\n(.*?)<!-- end -->", re.S)


def sources():
    pages = [ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")]
    for room in ROOMS:
        pages += sorted((ROOT / room).rglob("README.md"))
    return pages


def output_of(*command):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def place(text, origin, target):
    """The text of `origin` as it stands in `target`, both relative to the top: links lead where they led. Files that are
    no pages are copied beside the pages; a link to a folder leads to its README, or to a list
    of its files."""
    def link(match):
        path, anchor = match[2], match[3] or ""
        if "://" in path or path.startswith("mailto:"):
            return match[0]
        found = (ROOT / origin).parent / path if path else ROOT / origin
        if found.is_dir():
            found = found / "README.md"
            if not found.exists():
                return f"{match[1]}{os.path.relpath(DOCS / listed(found.parent), (DOCS / target).parent)}{match[4]}"
        if not found.is_file():
            sys.exit(f"{origin}: no {path}")
        name = pathlib.Path(os.path.relpath(found.resolve(), ROOT))
        copied = DOCS / name
        if found.suffix != ".md" and not copied.exists():
            copied.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(found, copied)
        return f"{match[1]}{os.path.relpath(DOCS / name, (DOCS / target).parent)}{anchor}{match[4]}"
    parts = re.split(r"(```.*?```)", text, flags=re.S)  # commands are left alone
    return "".join(part if part.startswith("```") else LINK.sub(link, part) for part in parts)


def listed(folder):
    """A page of the files of a folder that has no README."""
    name = folder.resolve().relative_to(ROOT)
    files = sorted(path for path in folder.iterdir() if path.is_file())
    for path in files:
        (DOCS / name).mkdir(parents=True, exist_ok=True)
        shutil.copy(path, DOCS / name / path.name)
    write(name / "README.md", f"# {name}\n\n" + "\n".join(f"- [{path.name}]({path.name})" for path in files) + "\n")
    return name / "README.md"


def write(target, text):
    path = DOCS / target
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def tutorial_pages():
    """With what the commands print, run now. Python's, where the module is not built, without."""
    able = tutorials.available(BIN)
    for name, (title, introduction, readme, _, _) in tutorials.TUTORIALS.items():
        target = f"tutorials/{name}.md"
        text = tutorials.with_outputs(name, BIN) if name in able else tutorials.text_of(name)
        text = re.sub(r"\A# .*\n+", "", text)  # a README's own title names its folder
        write(target, f"# {title}\n\n{introduction}\n\n" + place(text, readme, target))


def flags():
    lines = ["# Flags of every program\n", "As `--helpfull` prints them.\n"]
    for program in sorted(BIN.glob("pushid-*")):
        if program.name.endswith(("-study", "-benchmarks")):
            continue
        lines.append(f"## {program.name}\n\n```\n{output_of(program, '--helpfull').strip()}\n```\n")
    write("reference/flags.md", "\n".join(lines))


def door():
    """C++: what ident/fit.h and the headers that it opens say, as they say it."""
    text = (ROOT / "ident/fit.h").read_text()
    example = re.sub(r"^// ?", "", text.partition("#pragma once")[0], flags=re.M)
    lines = [f"# C++\n\n`#include \"ident/fit.h\"`, `find_package(pushid)` and `pushid::ident` "
             f"([how to install](../apps/README.md#installing)).\n\n```text\n{example.strip()}\n```\n"]
    for header in re.findall(r'#include "(.*)"', text):
        code = re.sub(r'^#(?:pragma|include).*\n', "", (ROOT / header).read_text(), flags=re.M)
        code = re.sub(r"\n{3,}", "\n\n", code)
        lines.append(f"## {header}\n\n```cpp\n{code.strip()}\n```\n")
    write("reference/cpp.md", "\n".join(lines))


def validation():
    version = re.search(r"project\(pushid VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    lines = ["# All study tables\n", f"pushid {version}. Each block is printed by the command in its heading; the date is "
             "that of the page's last change.\n"]
    for page in sources():
        name = page.relative_to(ROOT)
        date = subprocess.run(["git", "log", "-1", "--format=%cs", "--", str(name)], cwd=ROOT, capture_output=True,
                              text=True).stdout.strip() or "unknown date"
        for block, text in BLOCK.findall(page.read_text()):
            body = place(text, name, "reference/validation.md")
            lines.append(f"## `python3 {block}`\n\nFrom [{name}](../{name}), {date}.\n\n{body}")
    write("reference/validation.md", "\n".join(lines))


def main():
    for page in sources():
        name = page.relative_to(ROOT)
        write(name, place(page.read_text(), name, name))
    for page in sorted((ROOT / "apps/site/pages").glob("*.md")):
        name = page.relative_to(ROOT)
        write(f"guides/{page.name}", place(page.read_text(), name, f"guides/{page.name}"))
    tutorial_pages()
    flags()
    door()
    write("reference/parameters.md", "# Parameters\n\n" + output_of(BIN / "pushid-fit", "--list_parameters"))
    sys.path.insert(0, str(BIN.parent / "python"))
    for name, made in python_reference.pages():
        write(f"reference/{name}.md", made)
    validation()


main()
