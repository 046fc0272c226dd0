#!/bin/sh
# Reading an RO-Crate with rocrate and writing it again removes the definition of its own terms, so that their values drop out of the data.
#
# Packages: rocrate 0.16.0, PyLD 3.3.0 (PyPI).
# Behaviour: RO-Crate allows own terms, which are defined in an object beside the standard context. rocrate keeps the properties and
# their values, and does not read this object: the copy has the standard context alone. The JSON still shows the property. For every
# JSON-LD processor an undefined term does not exist, and the value is gone. rocrate prints nothing. The lists `metadata.extra_terms` and
# `metadata.extra_contexts`, which would be written, are empty after reading.
# Output seen (November 2026):
#     original: context of 2 parts, property in the JSON 0.05, as linked data 0.05
#     copy:     context of 1 part,  property in the JSON 0.05, as linked data None
# Why it matters: work of adhesion, Hurst exponent or reduced modulus have no standard term. A crate that passes through a tool based on
# rocrate (upload, merge, addition of a licence) loses exactly these numbers for search and for conversion to RDF.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet rocrate==0.16.0 PyLD==3.3.0
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import json
import os
import pathlib
import sys

import rocrate
from pyld import jsonld
from rocrate.rocrate import ROCrate

TERM = "https://example.org/terms#workOfAdhesion"
STANDARD = "https://w3id.org/ro/crate/1.1/context"
packaged = json.loads((pathlib.Path(rocrate.__file__).parent / "data" / "ro-crate.jsonld").read_text())
crate = {
    "@context": [STANDARD, {"workOfAdhesion": TERM}],
    "@graph": [
        {"@id": "ro-crate-metadata.json", "@type": "CreativeWork", "about": {"@id": "./"},
         "conformsTo": {"@id": "https://w3id.org/ro/crate/1.1"}},
        {"@id": "./", "@type": "Dataset", "name": "loops", "description": "loops", "datePublished": "2026-01-02",
         "license": "CC0-1.0", "workOfAdhesion": 0.05},
    ],
}
os.mkdir("original")
pathlib.Path("original/ro-crate-metadata.json").write_text(json.dumps(crate))
ROCrate("original").write("copy")


def state(name):
    data = json.loads(pathlib.Path(name, "ro-crate-metadata.json").read_text())
    parts = data["@context"] if isinstance(data["@context"], list) else [data["@context"]]
    plain = [entity["workOfAdhesion"] for entity in data["@graph"] if entity["@id"] == "./"][0]
    options = {"base": "https://example.org/crate/",
               "documentLoader": lambda url, _=None: {"contextUrl": None, "documentUrl": url, "document": packaged}}
    linked = [value["@value"] for node in jsonld.expand(data, options) for value in node.get(TERM, [])]
    return len(parts), plain, linked[0] if linked else None


found = {name: state(name) for name in ("original", "copy")}
for name, (parts, plain, linked) in found.items():
    size = f"{parts} part{'s,' if parts > 1 else ', '}"
    print(f"{name + ':':9s} context of {size} property in the JSON {plain}, as linked data {linked}")
sys.exit(0 if found == {"original": (2, 0.05, 0.05), "copy": (1, 0.05, None)} else "the behaviour has changed")
PY
echo "as described"
