"""Build backend of the wheel: maturin, with the program, its manual pages and its shell completions in the wheel.

The program is built with `cargo build --release`. HYSTERON_PROGRAM names a program that is packed instead; HYSTERON_PROGRAM=none leaves it out.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import maturin
from maturin import (
    build_sdist,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_wheel",
]

ROOT = Path(__file__).resolve().parents[3]
#: Files of the wheel besides the package, as `data` of [tool.maturin] names the folder.
DATA = ROOT / "target" / "wheel-data"
EXE = "hysteron.exe" if os.name == "nt" else "hysteron"
COMPLETIONS = {
    "bash": "bash-completion/completions/hysteron",
    "fish": "fish/vendor_completions.d/hysteron.fish",
    "zsh": "zsh/site-functions/_hysteron",
}


def _program() -> Path | None:
    """The program to be packed."""
    named = os.environ.get("HYSTERON_PROGRAM")
    if named is not None:
        return Path(named).resolve() if named != "none" else None
    build = ["cargo", "build", "--locked", "--release", "--features", "raster,sse", "--bin", "hysteron", "--message-format=json-render-diagnostics"]
    # No debug information: the wheel is a third as large.
    environment = {**os.environ, "CARGO_PROFILE_RELEASE_DEBUG": "false", "CARGO_PROFILE_RELEASE_STRIP": "symbols"}
    output = subprocess.run(build, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE, encoding="utf-8").stdout
    artefacts = [json.loads(line) for line in output.splitlines() if line.startswith("{")]
    return next(Path(of["executable"]) for of in artefacts if of.get("executable") and of["target"]["name"] == "hysteron")


def _pack() -> None:
    """Fills the folder of the files besides the package."""
    shutil.rmtree(DATA, ignore_errors=True)
    scripts, share = DATA / "scripts", DATA / "data" / "share"
    scripts.mkdir(parents=True)
    program = _program()
    if program is None:
        return
    shutil.copy2(program, scripts / EXE)
    if os.name == "posix" and shutil.which("strip"):
        subprocess.run(["strip", str(scripts / EXE)], check=False)
    manual = share / "man" / "man1"
    manual.mkdir(parents=True)
    subprocess.run([str(program), "man", "--dir", str(manual)], check=True, stdout=subprocess.DEVNULL)
    for shell, path in COMPLETIONS.items():
        script = subprocess.run([str(program), "completions", shell], check=True, stdout=subprocess.PIPE).stdout
        (share / path).parent.mkdir(parents=True, exist_ok=True)
        (share / path).write_bytes(script)


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: dict | None = None) -> str:
    """Writes the metadata; maturin refuses a folder of files that is not there."""
    DATA.mkdir(parents=True, exist_ok=True)
    return maturin.prepare_metadata_for_build_wheel(metadata_directory, config_settings)


def build_wheel(wheel_directory: str, config_settings: dict | None = None, metadata_directory: str | None = None) -> str:
    """Builds the wheel with the program."""
    _pack()
    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory: str, config_settings: dict | None = None, metadata_directory: str | None = None) -> str:
    """Builds an editable wheel with the program."""
    _pack()
    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)
