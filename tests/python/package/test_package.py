"""The package as a whole: version, types, what is public and described."""

import inspect
import subprocess
import sys
from importlib import metadata, resources

import pytest

import hysteron
from hysteron import _hysteron, jkr, spectrum, theory


def test_the_version_is_that_of_the_program(root):
    tomllib = pytest.importorskip("tomllib" if sys.version_info >= (3, 11) else "tomli")
    wanted = tomllib.loads((root / "Cargo.toml").read_text(encoding="utf-8"))["package"]["version"]
    assert hysteron.__version__ == _hysteron.__version__ == metadata.version("hysteron") == wanted


def test_the_version_is_that_of_the_binary(program):
    said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    assert said.split()[-1] == hysteron.__version__


def test_types_are_shipped():
    files = resources.files(hysteron)
    assert files.joinpath("py.typed").is_file() and files.joinpath("_hysteron.pyi").is_file()


def test_the_stub_names_what_the_extension_has():
    stub = resources.files(hysteron).joinpath("_hysteron.pyi").read_text(encoding="utf-8")
    named = {line.split("(")[0].removeprefix("def ") for line in stub.splitlines() if line.startswith("def ")}
    assert named == {name for name, value in vars(_hysteron).items() if callable(value)}


@pytest.mark.parametrize("module", [jkr, theory, spectrum], ids=lambda module: module.__name__)
def test_everything_is_described_and_typed(module):
    assert module.__doc__
    for name, function in inspect.getmembers(module, inspect.isfunction):
        if function.__module__ == module.__name__ and not name.startswith("_"):
            assert function.__doc__, name
            parameters = inspect.signature(function).parameters.values()
            assert all(parameter.annotation is not parameter.empty for parameter in parameters), name


def test_every_public_function_of_an_asperity_is_there(root):
    """Those of the Rust module, but what makes an asperity and the radius that it was made of."""
    lines = (root / "src" / "physics" / "jkr.rs").read_text(encoding="utf-8").splitlines()
    public = {line.split("pub fn ")[1].split("(")[0] for line in lines if line.strip().startswith("pub fn ")}
    missing = {name for name in public if not hasattr(jkr, name)}
    assert missing == {"new", "as_printed", "radius_m"}


def test_every_theory_is_there(root):
    """Those of the Rust module; what ends in `_as_printed` is a keyword here, but for the density."""
    lines = (root / "src" / "physics" / "theory" / "mod.rs").read_text(encoding="utf-8").splitlines()
    public = {line.split("pub fn ")[1].split("(")[0] for line in lines if line.startswith("pub fn ")}
    missing = {name for name in public if not hasattr(theory, name)}
    assert missing == {"mean_loop_loss_as_printed", "deng_kesari_loss_as_printed"}
