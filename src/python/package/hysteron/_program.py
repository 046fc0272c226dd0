"""The program `hysteron`: where it is, and what it is told and says."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _toml

if TYPE_CHECKING:
    import numpy.typing as npt

    from ._run import Run

_FAILED_CASES = 3
_INTERRUPTED = 130


class Failed(Exception):
    """The program could not do it: its own words, and its exit code: 1 failed, 2 bad spec or usage; below 0 the signal that ended it."""

    def __init__(self, words: str, exit_code: int) -> None:
        super().__init__(words)
        #: The exit code.
        self.exit_code = exit_code


class Interrupted(KeyboardInterrupt):
    """The run was interrupted. What was finished is kept, and the same call goes on.

    A `KeyboardInterrupt`, so that it ends a loop over specs that goes on after errors.
    """


class FailedCases(UserWarning):
    """Some cases failed, and all others are done."""


def find() -> Path:
    """The program: what the environment variable HYSTERON names, or `hysteron` of PATH, or target/release/hysteron above the working directory."""
    named = os.environ.get("HYSTERON")
    if named:
        path = Path(named).absolute()
        if not os.access(path, os.X_OK) or path.is_dir():
            raise FileNotFoundError(f"cannot start {path}, which HYSTERON names: it is no program; allowed: the path of the program hysteron")
        return path
    found = shutil.which("hysteron")
    if found:
        return Path(found).absolute()
    here = Path.cwd()
    name = "hysteron.exe" if os.name == "nt" else "hysteron"
    for folder in (here, *here.parents):
        path = folder / "target" / "release" / name
        if path.is_file():
            return path
    raise FileNotFoundError(
        "cannot find the program hysteron: HYSTERON names none, there is none on PATH and no target/release/hysteron above the working directory; "
        "allowed: after `cargo install --path .` in a clone of the repository, which builds it"
    )


def run(
    spec: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    until: str | None = None,
) -> Run:
    """Computes everything of a campaign that is not done yet, as `hysteron run` does, and opens it.

    `spec` is the path of a spec, the text of one (a text of more than one line, or with a `=`), or a nested dict of the same keys, such as
    `{"name": "mine", "surface": {"magnification": 32}, "sweep": [{"surface": {"hurst": [0.7, 0.8]}}]}`. `out` is the output folder; without
    it that is `data/runs/<name of the spec>` below the working directory, as on the command line. `jobs` is how many threads work, as many as there
    are cores if it is left out, and `until` the last stage: generate, extract, cycle, aggregate or report.

    The program's progress goes to `sys.stderr`. Raises `Failed` with the program's words if it cannot do it, and `Interrupted` if it was
    interrupted; warns with `FailedCases` if some cases failed. The same call again goes on where it stopped.
    """
    program = find()
    with _file(spec) as path:
        command = [str(program), "run", "--json"]
        if out is not None:
            command.append(f"--out={os.fspath(out)}")
        if jobs is not None:
            command.append(f"--jobs={jobs}")
        if until is not None:
            command.append(f"--until={until}")
        # "--" so that no name is taken for an option.
        code, said, told = _watched([*command, "--", str(path)])
    if code == _INTERRUPTED:
        raise Interrupted(_words(told))
    if code not in (0, _FAILED_CASES):
        raise Failed(_words(told) or f"{program} ended with the exit code {code} and said nothing", code)
    answer = json.loads(said)
    from ._run import load

    result = load(answer["dir"])
    if code == _FAILED_CASES:
        # Where a surface failed, its cycles did too.
        failed = max(stage["failed_count"] for stage in answer["stages"])
        cases, them = ("1 case", "it") if failed == 1 else (f"{failed} cases", "them")
        text = f"{cases} failed; why is in {result.dir}/cycles/*/failed.json. `hysteron retry {result.dir}` tries {them} again."
        warnings.warn(text, FailedCases, stacklevel=2)
    return result


def take(
    file: str | os.PathLike[str] | npt.NDArray[Any],
    out: str | os.PathLike[str] | None = None,
    *,
    dataset: str | None = None,
    pixel_m: float | None = None,
    unit: str | None = None,
    fill: bool = False,
    detrend: str | None = None,
    periodic: bool = False,
    points: int = 8,
) -> dict[str, Any]:
    """Takes a measured surface, as `hysteron import` does, and says what it is like: its moments, its spectrum, the self-affine spectrum that fits it.

    `file` is HDF5 (`dataset` names the field), NetCDF-3, X3P, .npy or text; or an array of heights, in which what is masked or no number is missing. `pixel_m` is the distance of its points [m] and `unit` the unit of its heights, where
    the file does not tell them; `fill` continues the heights into missing points; `detrend` is mean, plane (the default) or quadratic, of a periodic surface mean alone; waves shorter than so many `points` are
    taken off. With `out` the surface is written there, over what is there, to be named in a spec as `surface.file`; without it nothing is written.
    """
    command = [str(find()), "import", "--json", f"--points={points}"]
    command += ["--dry-run"] if out is None else [f"--out={os.fspath(out)}", "--force"]
    command += [f"--{name}={value}" for name, value in (("dataset", dataset), ("pixel-m", pixel_m), ("unit", unit), ("detrend", detrend)) if value is not None]
    command += [f"--{name}" for name, asked in (("fill", fill), ("periodic", periodic)) if asked]
    with _scan(file) as path:
        return _answered([*command, "--", path])


def status(dir: Path) -> dict[str, Any]:
    """The answer of `hysteron status DIR --json`."""
    return _answered([str(find()), "status", "--json", "--", str(dir)])


def _answered(command: list[str]) -> dict[str, Any]:
    """What a command answers in JSON."""
    answer = subprocess.run(command, check=False, capture_output=True, encoding="utf-8", errors="replace")
    if answer.returncode not in (0, _FAILED_CASES):
        raise Failed(_words(answer.stderr), answer.returncode)
    told: dict[str, Any] = json.loads(answer.stdout)
    return told


@contextmanager
def _scan(file: str | os.PathLike[str] | npt.NDArray[Any]) -> Iterator[str]:
    """A scan as a file."""
    if isinstance(file, (str, os.PathLike)):
        yield os.fspath(file)
        return
    heights = np.ma.filled(np.ma.asarray(file, dtype=np.float64), np.nan)
    with tempfile.TemporaryDirectory(prefix="hysteron-") as folder:
        path = Path(folder) / "array.npy"
        np.save(path, heights)
        yield str(path)


@contextmanager
def _file(spec: str | os.PathLike[str] | Mapping[str, Any]) -> Iterator[str]:
    """The spec as a file."""
    if isinstance(spec, Mapping):
        surface = spec.get("surface")
        if isinstance(surface, Mapping) and surface.get("file", "") is None:
            raise ValueError("cannot write the spec: surface.file is None; allowed: a file, which `take` writes where it is given `out`; or no such key")
        text = _toml.dumps(spec)
    elif isinstance(spec, str) and ("\n" in spec or ("=" in spec and not os.path.isfile(spec))):
        text = spec
    else:
        yield os.fspath(spec)
        return
    with tempfile.TemporaryDirectory(prefix="hysteron-") as folder:
        path = Path(folder) / "spec.toml"
        path.write_text(text, encoding="utf-8")
        yield str(path)


def _watched(command: list[str]) -> tuple[int, str, str]:
    """Runs a command whose standard error is passed on line by line; its exit code, output and standard error."""
    told: list[str] = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", errors="replace") as process:
        assert process.stdout is not None and process.stderr is not None
        interrupted = False
        while True:
            try:
                # The answer is a few hundred bytes at the end: it waits in its pipe.
                for line in process.stderr:
                    told.append(line)
                    sys.stderr.write(line)
                    sys.stderr.flush()
                said = process.stdout.read()
                code = process.wait()
                break
            except KeyboardInterrupt:
                # A terminal tells the program too, a notebook does not. It ends between two files, which is waited for, but not twice.
                process.send_signal(signal.SIGINT)
                if interrupted:
                    raise
                interrupted = True
    return code, said, "".join(told)


def _words(told: str) -> str:
    """What the program said of an error: from its first line that says so on."""
    lines = told.strip().splitlines()
    for k, line in enumerate(lines):
        if line.startswith(("error", "interrupted")):
            return "\n".join(lines[k:])
    return "\n".join(lines[-20:])
