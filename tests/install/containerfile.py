"""The usual mistakes of a Containerfile, in apps/packaging/Containerfile; and that each check finds its mistake.

  containerfile.py
"""
import datetime
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
RELEASE, SINCE = "bookworm", datetime.date(2023, 6, 10)  # Debian 12, which tests/install_packages.sh lists packages of
DEBIAN = re.compile(r"docker\.io/library/debian:(\w+)-(\d{8})-slim")


def instructions(text):
    """(word, rest) of each, continued lines joined."""
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    return [(line.split(None, 1) + [""])[:2] for line in re.sub(r"\\\n\s*", "", "\n".join(lines)).splitlines()]


def fault_of_base(base):
    """Debian's official tags are RELEASE-DATE-slim; one without a date is another image every month."""
    match = DEBIAN.fullmatch(base)
    if not match:
        return f"base {base} is not docker.io/library/debian:{RELEASE}-DATE-slim"
    try:
        date = datetime.datetime.strptime(match[2], "%Y%m%d").date()
    except ValueError:
        return f"base {base} has no date"
    if match[1] != RELEASE or not SINCE <= date <= datetime.date.today():
        return f"base {base} is no image of {RELEASE}, which came out on {SINCE}"
    return None


def faults(text):
    found, said, stages = [], instructions(text), []
    bases = dict(rest.split("=", 1) for word, rest in said if word == "ARG" and "=" in rest)
    for word, rest in said:
        if word == "FROM":
            base = re.sub(r"\$\{(\w+)\}", lambda m: bases.get(m[1], ""), rest.split()[0])
            stages.append((rest.split()[2] if " AS " in rest else "", []))
            found += filter(None, [fault_of_base(base)])
        elif stages:
            stages[-1][1].append((word, rest))
        if word == "ADD":
            found.append("ADD unpacks and downloads; use COPY")
        if word == "RUN" and "sudo" in rest:
            found.append("sudo")
        if word == "RUN" and re.search(r"apt-get install|install_packages ", rest):
            if "/var/lib/apt/lists" not in rest.split("rm -rf")[-1] or "rm -rf" not in rest:
                found.append("lists of apt are left in the layer")
            if "apt-get install" in rest and "--no-install-recommends" not in rest:
                found.append("recommended packages are installed")
            if "apt-get install" in rest and "apt-get update" not in rest:
                found.append("apt-get install without apt-get update in the same layer")
            named = re.findall(r"apt-get install((?: -\S+)*)((?: [\w/.+*-]+)+)", rest)
            if any(not package.startswith("/") for _, names in named for package in names.split()):
                found.append("packages are named; their one list is tests/install_packages.sh")
        if word == "COPY" and "--from" not in rest:
            found += [f"COPY {source}: no such file" for source in rest.split()[:-1]
                      if source == "." or not (ROOT / source).exists()]
        if word == "COPY" and "--from=" in rest and re.search(r"--from=(\S+)", rest)[1] not in dict(stages):
            found.append("COPY --from names no stage")
    if len(stages) < 2:
        found.append("compilers are in the image that runs: use two stages")
    last = dict(stages[-1][1]) if stages else {}
    if last.get("USER", "root") in ("root", "0"):
        found.append("runs as root")
    if not last.get("ENTRYPOINT", "").startswith("["):
        found.append("ENTRYPOINT is missing, or of a shell, which swallows signals")
    lists = set(re.findall(r"^(\w+_packages)=", (ROOT / "tests/install_packages.sh").read_text(), re.M))
    used = set(re.findall(r"\$\{(\w+_packages)\[@\]\}", text))
    found += [f"{name} is no list of tests/install_packages.sh" for name in sorted(used - lists)]
    if "build_packages" not in used:
        found.append("does not install build_packages")
    return found


def main():
    text = (ROOT / "apps/packaging/Containerfile").read_text()
    wrong = faults(text)
    for before, after in ((":bookworm-20241016-slim", ":bookworm-slim"), (":bookworm-", ":trixie-"),
                          ("-20241016", "-20241316"), ("-20241016", "-20201016"),
                          ("docker.io/library/debian", "docker.io/library/ubuntu"), ("RUN apt-get", "RUN sudo apt-get"),
                          ("USER pushid\n", ""),
                          (" /var/lib/apt/lists/* \\\n  && useradd", " \\\n  && useradd"), (" --no-install-recommends", ""),
                          ("RUN apt-get update \\\n  && ", "RUN "), ("/tmp/pushid_*.deb \\\n  && rm", "libceres3 \\\n  && rm"),
                          ("COPY models models", "COPY . ."), ("package_packages", "other_packages"),
                          ("FROM ${BASE}\nCOPY", "COPY"),
                          ('["pushid"]', "pushid"), ("COPY ident", "ADD ident"), ("--from=build", "--from=built")):
        if before not in text or not faults(text.replace(before, after)):
            wrong.append(f"'{after}' instead of '{before}' is not found")
    print("\n".join(wrong) or "no faults")
    sys.exit(1 if wrong else 0)


main()
