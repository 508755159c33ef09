"""The programs' JSON against apps/schemas, by jsonschema of Debian (python3-jsonschema).

  schemas.py BIN    what the programs write is valid, and no entry stands in a file that its schema lacks

A model's schema is what `pushid schema` prints. Networks and what is made with them are left out where the training programs
are not built.

Exit code 77, which ctest counts as skipped, where jsonschema is not installed.
"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "apps" / "schemas"
PLAN = """[data]
recordings = "people/manifest.json"
[jobs]
group_by = "subject"
folds = 2
bootstrap = 1
[[variant]]
name = "usual"
flags = []
[output]
dir = "out"
"""


def schemas(binaries):
    """By the name of the format."""
    result = {file.name.split("-")[1]: json.loads(file.read_text()) for file in sorted(FOLDER.glob("*.json"))}
    printed = subprocess.run([binaries / "pushid", "schema"], capture_output=True, text=True, check=True).stdout
    return {**result, "model": json.loads(printed)}


def strict(schema):
    """The schema with no further entries where it says nothing of them: programs write what is described alone."""
    if isinstance(schema, list):
        return [strict(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    result = {key: strict(value) for key, value in schema.items()}
    if result.get("type") == "object" and "properties" in result:
        result.setdefault("additionalProperties", False)
    return result


def check(jsonschema, schema, content, file):
    """Complaints about one file."""
    validator = jsonschema.Draft202012Validator(strict(schema))
    return [f"{file}: /{'/'.join(map(str, error.absolute_path))}: {error.message[:300]}"
            for error in validator.iter_errors(content)]


def written(folder, binaries):
    """(name of the schema, file) of what the programs write."""
    def run(program, *flags):
        done = subprocess.run([f"{binaries}/{program}", *flags], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{program} {' '.join(flags)}: {done.stderr}")

    data, model = "--recordings=people/manifest.json", "--model=model.json"
    run("pushid-simulate", "--out=people", "--people=2", "--seed=1")
    run("pushid-simulate", "--out=rows", "--people=2", "--group_size=2", "--seed=1")
    run("pushid-fit", data, "--model_out=model.json")
    run("pushid-fit", data, "--model_out=learned.json", "--self_force=mlp:2")
    run("pushid-check", model, data, "--prior_check", "--push_check", "--horizon_check", "--profile=mu", "--bootstrap=3")
    run("pushid-evaluate", model, data, "--json_out=evaluation.json")
    run("pushid-crossvalidate", data, "--folds=2", "--compare=pd: --preset=ldp", "--json_out=folds.json")
    run("pushid-fit", "--recordings=rows/manifest.json", "--preset=group", "--model_out=group.json")
    run("pushid-formation", "--model=group.json", "--formation=line", "--push=40", "--agents_out=agents.json")
    (folder / "plan.toml").write_text(PLAN)
    run("pushid-batch", "--plan=plan.toml", "--jobs=2")
    run("pushid-simulate", "--laboratory=2", "--out=lab", "--seed=1")
    run("pushid-inspect", "lab/manifest.json", "people/manifest.json", "--json_out=inspection.json")
    first = json.loads((folder / "people/manifest.json").read_text())["recordings"][0]["id"]
    run("pushid-fit", data, "--model_out=noisy.json", "--process_noise=diagonal")
    run("pushid-path", "--model=noisy.json", "--from=xd=0.5", "--to=x=0.4,xd=0; x=0.8,xd=0", "--json_out=paths.json")
    run("pushid-path", "--model=noisy.json", data, f"--id={first}", "--json_out=smoothed.json")
    files = [("manifest", "people/manifest.json"), ("manifest", "rows/manifest.json"), ("manifest", "lab/manifest.json"),
             ("truth", "lab/truth.json"), ("model", "model.json"), ("model", "learned.json"), ("model", "noisy.json"),
             ("scores", "evaluation.json"), ("scores", "folds.json"), ("summary", "out/summary.json"), ("agents", "agents.json"),
             ("inspection", "inspection.json"), ("path", "paths.json"), ("path", "smoothed.json")]
    files += [("job", str(file.relative_to(folder))) for file in sorted(folder.glob("out/jobs/*/status.json"))[:1]]
    return files + (of_networks(run, data, model, first) if (binaries / "pushid-train-generator").exists() else [])


def of_networks(run, data, model, first):
    """Hardly trained ones."""
    quick = ("--effort=0.02",)
    run("pushid-train-restoration", model, data, *quick, "--out=restoration")
    run("pushid-train-restoration", model, data, *quick, "--crossvalidate=2", "--json_out=chain.json")
    run("pushid-evaluate", model, data, "--restoration=restoration", "--json_out=bodies.json")
    run("pushid-predict", model, data, "--restoration=restoration", f"--id={first}", "--out=motion.bvh", "--json_out=joints.json")
    run("pushid-simulate", "--out=short", "--people=2", "--recordings_per_person=2", "--frames=40", "--seed=1")
    data = "--recordings=short/manifest.json"
    quick = (data, "--kind=diffusion", "--steps=2", "--batch=2", "--seeds=1")
    run("pushid-train-generator", *quick, "--accuracy=best", "--out=groups")
    run("pushid-train-generator", *quick, "--crossvalidate=2", "--json_out=crossvalidated.json")
    run("pushid-generate", "--model=groups", data, "--samples=19", "--averaged=1", "--sampling_steps=2",
        "--json_out=generated.json")
    run("pushid-simulate", "--clips=2", "--frames=220", "--out=clips")
    run("pushid-train-generator", "--folder=clips", "--out=clips_generator", "--seeds=1", "--steps=2", "--noise_steps=2",
        "--simlpe_steps=2", "--batch=8")
    run("pushid-generate", "--model=clips_generator", "--folder=clips", "--samples=19", "--json_out=clips.json")
    return [("network", "restoration/restoration.json"), ("scores", "chain.json"), ("scores", "bodies.json"),
            ("joints", "joints.json"), ("network", "groups/generator.json"), ("candidates", "groups/candidates.json"),
            ("scores", "crossvalidated.json"), ("scores", "generated.json"), ("network", "clips_generator/generator.json"),
            ("forecasts", "clips.json")]


def main():
    binaries = pathlib.Path(sys.argv[1]).resolve()
    try:
        import jsonschema
    except ImportError:
        print("jsonschema is not installed (python3-jsonschema)")
        sys.exit(77)
    known = schemas(binaries)
    for schema in known.values():
        jsonschema.Draft202012Validator.check_schema(schema)
    faults = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        files = written(folder, binaries)
        for kind, file in files:
            content = json.loads((folder / file).read_text())
            faults += check(jsonschema, known[kind], content, file)
            damaged = copy.deepcopy(content)  # the check can fail
            for one in damaged if kind == "inspection" else [damaged]:
                if one.get("schema") != f"pushid-{kind}/1":
                    faults.append(f"{file}: schema is {one.get('schema')}")
                one.pop("recordings" if kind == "manifest" else "schema")
            if not check(jsonschema, known[kind], damaged, file):
                faults.append(f"{file}: nothing is said of an entry that is missing")
        plan = tomllib.loads((folder / "plan.toml").read_text())
        faults += check(jsonschema, known["plan"], plan, "plan.toml")
        if not check(jsonschema, known["plan"], {**plan, "jobs": {"folds": 1}}, "plan.toml"):
            faults.append("plan.toml: folds = 1 is taken")
    print("\n".join(faults) or f"{len(files) + 1} files are valid")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
