"""What the tests need of the outside: a finished run and the program, by environment variables, so that the rest passes without."""

import os
from pathlib import Path

import pytest

import hysteron

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def root():
    """The repository."""
    return ROOT


@pytest.fixture(scope="session")
def campaign():
    """A finished run."""
    folder = os.environ.get("HYSTERON_RUN")
    if not folder:
        pytest.skip("HYSTERON_RUN names no finished run: `hysteron run pipelines/quickstart.toml --out DIR` makes one")
    return hysteron.load(folder)


@pytest.fixture(scope="session")
def program():
    """The program."""
    path = os.environ.get("HYSTERON")
    if not path:
        pytest.skip("HYSTERON does not name the program: `cargo build --release` makes target/release/hysteron")
    return Path(path)


def table(name):
    """The rows of a table of tests/reference, as dicts of floats."""
    lines = (ROOT / "tests" / "reference" / name).read_text(encoding="utf-8").splitlines()
    names, *rows = [line.split(",") for line in lines if not line.startswith("#")]
    return [{column: float(value) for column, value in zip(names, row, strict=True)} for row in rows]
