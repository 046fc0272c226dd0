#!/bin/sh
# The gate of the Python package: builds it as `pip install .` does, into an environment of its own, and tests it there.
#
#     src/python/check.sh [FOLDER]
#
# FOLDER takes the environment and is kept; without it a temporary one is made and taken away. HYSTERON (the program) and HYSTERON_RUN (a finished run)
# are what the tests of `run` and `load` need: those are skipped, and say so, where they are not set.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
if [ $# -gt 0 ]; then
    folder=$1
else
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    trap 'exit 130' INT TERM
fi
# Beside the program's own builds, and never below src: what lies there would count as changed sources.
CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$root/target}
PYTHONDONTWRITEBYTECODE=1
export CARGO_TARGET_DIR PYTHONDONTWRITEBYTECODE
cargo fmt --check --manifest-path "$root/src/python/Cargo.toml"
python3 -m venv --clear "$folder/venv"
python="$folder/venv/bin/python"
# The wheel holds the program that the tests run, or the one of an earlier build; without HYSTERON it is built.
if [ -n "${HYSTERON:-}" ]; then
    HYSTERON_PROGRAM=$HYSTERON
    export HYSTERON_PROGRAM
fi
"$python" -m pip install -q "$root"
"$folder/venv/bin/hysteron" --version
test -f "$folder/venv/share/man/man1/hysteron.1"
test -f "$folder/venv/share/bash-completion/completions/hysteron"
"$python" -m pip install -q -r "$root/tests/python/package/requirements.txt"
cd "$root"
"$python" -m ruff check --no-cache src/python/package tests/python/package
"$python" -m mypy --cache-dir "$folder/mypy" src/python/package/hysteron
# From elsewhere, so that what was installed is tested and not what lies in the clone.
cd "$folder"
"$python" -m pytest -q -rs -p no:cacheprovider -c "$root/pyproject.toml" --rootdir "$root" "$root/tests/python/package"
