"""Check licences, bans and sources of every locked dependency against deny.toml. It needs only cargo and makes the checks of `cargo deny check licenses bans sources`.

    python tests/supply.py [MANIFEST …]          exit status 1 if deny.toml does not allow a dependency

An SPDX expression is satisfied by one alternative of OR, or by all parts of AND; the old "/" counts as OR. Duplicates are searched among the crates that are compiled for any platform with the
default features and for tests.
"""

import json
import re
import subprocess
import sys
import tomllib
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MANIFESTS = ("Cargo.toml", "tests/fuzz/Cargo.toml", "benches/rivals/ode_solvers/Cargo.toml")


def allowed(expression, licences):
    """True if an SPDX expression has an allowed alternative."""
    text = expression.replace("/", " OR ")
    tokens = re.findall(r"\(|\)|\bAND\b|\bOR\b|(?:(?!\bAND\b|\bOR\b)[^()])+", text)
    words = [token.strip() for token in tokens if token.strip()]
    code = " ".join({"AND": "and", "OR": "or", "(": "(", ")": ")"}.get(word) or str(word in licences) for word in words)
    return bool(eval(code, {"__builtins__": {}}))  # only True, False, and, or, brackets


def problems(manifest, rules):
    """The dependencies of a workspace that the rules do not allow."""
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--manifest-path", str(ROOT / manifest)]
    packages = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["packages"]
    licences, bans = set(rules["licenses"]["allow"]), rules["bans"]
    banned, skipped = ({entry["crate"] for entry in bans[name]} for name in ("deny", "skip"))
    registries = {"registry+" + url for url in rules["sources"]["allow-registry"]}
    versions = defaultdict(list)
    for package in packages:
        name = f"{package['name']} {package['version']}"
        versions[package["name"]].append(package["version"])
        if not allowed(package["license"] or "none", licences):
            yield f"{name}: licence {package['license']}"
        if package["source"] is not None and package["source"] not in registries:
            yield f"{name}: source {package['source']}"
        if package["name"] in banned:
            yield f"{name}: banned"
        for dependency in package["dependencies"]:
            if package["source"] is None and dependency["req"] == "*" and dependency.get("path") is None:
                yield f"{name}: any version of {dependency['name']}"
    if manifest == MANIFESTS[0]:
        yield from (f"{name}: {', '.join(found)}" for name, found in versions.items() if len(found) > 1 and name not in skipped)


def main():
    with open(ROOT / "tests" / "deny.toml", "rb") as file:
        rules = tomllib.load(file)
    found = [f"{manifest}: {problem}" for manifest in sys.argv[1:] or MANIFESTS for problem in problems(manifest, rules)]
    print("\n".join(found) or "licences, bans and sources: as deny.toml allows")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
