"""The manifests that programs write against apps/schemas, by jsonschema of Debian (python3-jsonschema).

  schemas.py BIN    what is written is valid, and no entry stands in a file that the schema lacks

Exit code 77, which ctest counts as skipped, where jsonschema is not installed.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "apps/schemas/pushid-manifest-1.schema.json"


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


def main():
    try:
        import jsonschema
    except ImportError:
        print("jsonschema is not installed (python3-jsonschema)")
        sys.exit(77)
    schema = json.loads(SCHEMA.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(strict(schema))
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for name, flags in {"people": ["pushid-simulate", "--people=2"], "rows": ["pushid-simulate", "--people=2", "--group_size=2"],
                            "lab": ["simulate-others", "--laboratory=2"]}.items():
            subprocess.run([f"{sys.argv[1]}/{flags[0]}", f"--out={folder}/{name}", "--seed=1", *flags[1:]],
                           stdout=subprocess.DEVNULL, check=True)
            content = json.loads(pathlib.Path(folder, name, "manifest.json").read_text())
            faults += [f"{name}: /{'/'.join(map(str, error.absolute_path))}: {error.message[:300]}"
                       for error in validator.iter_errors(content)]
            if content.get("schema") != "pushid-manifest/1":
                faults.append(f"{name}: schema is {content.get('schema')}")
            del content["recordings"]  # the check can fail
            if validator.is_valid(content):
                faults.append(f"{name}: nothing is said of recordings that are missing")
    print("\n".join(faults) or "three manifests are valid")
    sys.exit(1 if faults else 0)


main()
