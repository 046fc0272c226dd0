"""Interface to the program `hysteron`: location, arguments and output."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _notebook, _toml
from ._arrays import real

if TYPE_CHECKING:
    import numpy.typing as npt

_FAILED_CASES = 3
_INTERRUPTED = 130


class Failed(Exception):
    """Error of the program, with its message and exit code: 1 error, 2 bad spec or usage, negative for a signal."""

    def __init__(self, words: str, exit_code: int) -> None:
        super().__init__(words)
        #: The exit code.
        self.exit_code = exit_code


class Interrupted(KeyboardInterrupt):
    """The run was interrupted. Finished tasks are kept; the same call resumes.

    It is a `KeyboardInterrupt`, so it also ends loops that continue after errors.
    """


class FailedCases(UserWarning):
    """Some cases failed; all others are finished."""


def find() -> Path:
    """Path of the program.

    In this order: environment variable HYSTERON, `hysteron` on PATH, the program of the installed package, target/release/hysteron in the working
    directory or above.
    """
    named = os.environ.get("HYSTERON")
    if named:
        path = Path(named).absolute()
        if not os.access(path, os.X_OK) or path.is_dir():
            raise FileNotFoundError(f"cannot start {path}: not an executable file\nhelp: set HYSTERON to the path of the program hysteron")
        return path
    found = shutil.which("hysteron")
    if found:
        return Path(found).absolute()
    name = "hysteron.exe" if os.name == "nt" else "hysteron"
    # An environment that is not activated is not on PATH.
    own = Path(sysconfig.get_path("scripts")) / name
    if own.is_file():
        return own
    here = Path.cwd()
    for folder in (here, *here.parents):
        path = folder / "target" / "release" / name
        if path.is_file():
            return path
    raise FileNotFoundError(
        "cannot find the program hysteron: HYSTERON is not set, and it is neither on PATH nor in target/release above the working directory\n"
        "help: run `cargo install --path .` in a clone of the repository"
    )


def take(
    file: str | os.PathLike[str] | npt.NDArray[Any],
    out: str | os.PathLike[str] | None = None,
    *,
    dataset: str | None = None,
    pixel_m: float | None = None,
    size: float | str | None = None,
    unit: str | None = None,
    skip_lines: int | None = None,
    width: int | None = None,
    transpose: bool = False,
    fill: bool = False,
    detrend: str | None = None,
    periodic: bool = False,
    points: int | None = None,
    filter: str | None = None,
    outliers: bool = False,
    align_rows: bool = False,
    fast_axis: str | None = None,
    tip_radius_m: float | None = None,
    force: bool = False,
) -> dict[str, Any]:
    """Imports a measured surface, as `hysteron import`, and returns its moments, spectrum and self-affine fit.

    Parameters
    ----------
    file : path or array
        Path of HDF5, NetCDF, X3P, .npy or text; or an array of real heights, in which masked values and NaN are missing points.
        As in .npy, a line array[i] is a scan line along x, and i is the index along y.
    out : path, optional
        The surface is written there, for use as `surface.file` in a spec. Default: no file is written.
    dataset : str, optional
        Field of an HDF5 file.
    pixel_m : float, optional
        Pixel size [m], for files without it.
    size : float or str, optional
        Size of the scan along x [m], or with units as "5um" or "5um x 3um" (x by y); instead of `pixel_m`.
    unit : str, optional
        Unit of the heights, for files without it.
    skip_lines : int, optional
        Lines at the beginning of a text that are skipped.
    width : int, optional
        Points per scan line of a text with one column.
    transpose : bool
        Exchanges x and y: for arrays with x as the first index.
    fill : bool
        Interpolates missing points (harmonic in-fill).
    detrend : str, optional
        Levelling: mean, plane (default) or quadratic; mean only for a periodic surface.
    periodic : bool
        True for a periodic surface.
    points : int, optional
        S-filter cut-off in pixels; default 8.
    filter : str, optional
        S-filter: gaussian (default, ISO 16610-61) or sharp.
    outliers : bool
        Replaces isolated outliers by their surroundings.
    align_rows : bool
        Removes the offsets of scan lines.
    fast_axis : str, optional
        Direction of the scan lines: rows, columns or auto (default).
    tip_radius_m : float, optional
        Tip radius [m]; removes wavelengths that such a tip cannot trace.
    force : bool
        Replaces an existing file `out`; without it that is an error.

    Returns
    -------
    dict
        Output of `hysteron import --json`.
    """
    options = {"dataset": dataset, "pixel-m": pixel_m, "size": size, "unit": unit, "skip-lines": skip_lines, "width": width}
    options |= {"detrend": detrend, "filter": filter, "points": points}
    command = [str(find()), "import", "--json"]
    command += ["--dry-run"] if out is None else [f"--out={os.fspath(out)}"]
    options |= {"fast-axis": fast_axis, "tip-radius": tip_radius_m}
    command += [f"--{name}={value}" for name, value in options.items() if value is not None]
    flags = {"transpose": transpose, "fill": fill, "periodic": periodic, "force": force, "outliers": outliers, "align-rows": align_rows}
    command += [f"--{name}" for name, asked in flags.items() if asked]
    with _scan(file) as (path, temporary):
        return _answered([*command, "--", path], {path: "the array"} if temporary else {})


def status(dir: Path) -> dict[str, Any]:
    """Output of `hysteron status DIR --json`."""
    return _answered([str(find()), "status", "--json", "--", str(dir)])


def _answered(command: list[str], names: Mapping[str, str] | None = None) -> dict[str, Any]:
    """JSON output of a command; `names` are words for paths in its messages."""
    try:
        answer = subprocess.run(command, check=False, capture_output=True, encoding="utf-8", errors="replace")
    except OSError as error:
        raise _unstartable(command[0], error) from None
    if answer.returncode not in (0, _FAILED_CASES):
        words = _worded(_words(answer.stderr), names or {})
        raise Failed(_named(words, everywhere=True) or f"{command[0]} ended with exit code {answer.returncode} without a message", answer.returncode)
    return _json(answer.stdout, command[0], answer.returncode)


def _json(said: str, program: str | Path, code: int) -> dict[str, Any]:
    """JSON output of the program."""
    try:
        told = json.loads(said)
    except ValueError:
        told = None
    if not isinstance(told, dict):
        raise _another(program, code)
    return told


def _another(program: str | Path, code: int) -> Failed:
    """The error of a program that does not answer as hysteron does."""
    return Failed(f"error: {program} is not the program hysteron: its output is not the expected JSON\nhelp: set HYSTERON to the path of hysteron", code)


def _unstartable(program: str, error: OSError) -> OSError:
    """The error of a file that is no program."""
    return OSError(error.errno, f"cannot start {program}: {error.strerror}\nhelp: set HYSTERON to the path of the program hysteron")


#: Options of the command line with the same name in Python, and those of them without a value.
_OPTIONS = ("dataset", "pixel-m", "unit", "fill", "detrend", "periodic", "points", "filter", "out", "force", "jobs", "until")
_FLAGS = ("fill", "periodic", "force")
_OPTION = re.compile(rf"--({'|'.join(_OPTIONS)})\b(?: (\d\S*)(?=\)))?")
_OTHER = re.compile(r"--([a-z]+(?:-[a-z]+)*)(?: (?=\d)|=)?")


def _named(words: str, everywhere: bool = False) -> str:
    """A message with the arguments of Python in place of the options, in parentheses or everywhere."""

    def keyword(found: re.Match[str]) -> str:
        return f"{found[1].replace('-', '_')}="

    def argument(found: re.Match[str]) -> str:
        return f"{found[1].replace('-', '_')}={'True' if found[1] in _FLAGS else found[2] or ''}"

    if everywhere:
        words = words.replace("(--fill; fill=True in Python)", "(fill=True)").replace("on the command line", "in Python")
        # Commands stay as they are.
        parts = re.split(r"(`hysteron [^`]*`)", words)
        return "".join(part if part.startswith("`hysteron ") else _OTHER.sub(keyword, _OPTION.sub(argument, part)) for part in parts)
    return re.sub(r"\(--[^()]*\)", lambda found: _OPTION.sub(argument, found[0]), words)


def _worded(text: str, names: Mapping[str, str]) -> str:
    """A text with words in place of paths of temporary files."""
    for path, word in names.items():
        text = text.replace(path, word)
    return text


@contextmanager
def _scan(file: str | os.PathLike[str] | npt.NDArray[Any]) -> Iterator[tuple[str, bool]]:
    """A scan as a file, and whether the file is temporary."""
    if isinstance(file, (str, os.PathLike)):
        yield os.fspath(file), False
        return
    heights = real(file, "fiuO")
    with tempfile.TemporaryDirectory(prefix="hysteron-") as folder:
        path = Path(folder) / "array.npy"
        np.save(path, heights)
        yield str(path), True


@contextmanager
def _file(spec: str | os.PathLike[str] | Mapping[str, Any]) -> Iterator[tuple[str, bool]]:
    """The spec as a file, and whether the file is temporary."""
    if isinstance(spec, Mapping):
        surface = spec.get("surface")
        if isinstance(surface, Mapping) and surface.get("file", "") is None:
            raise ValueError("cannot write the spec: surface.file is None\nhelp: give a file, for example from `take` with `out`, or remove the key")
        text = _toml.dumps(spec)
    elif isinstance(spec, str) and ("\n" in spec or ("=" in spec and not os.path.isfile(spec))):
        text = spec
    else:
        yield os.fspath(spec), False
        return
    with tempfile.TemporaryDirectory(prefix="hysteron-") as folder:
        path = Path(folder) / "spec.toml"
        path.write_text(text, encoding="utf-8")
        yield str(path), True


def _watched(command: list[str], names: Mapping[str, str]) -> tuple[int, str, str]:
    """Runs a command and forwards its standard error line by line, with words for paths; returns exit code, output and standard error."""
    told: list[str] = []
    bar = _notebook.bar()
    try:
        started = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", errors="replace")
    except OSError as error:
        raise _unstartable(command[0], error) from None
    with started as process:
        assert process.stdout is not None and process.stderr is not None
        interrupted = False
        while True:
            try:
                # The answer is a few hundred bytes at the end: it waits in its pipe.
                for raw in process.stderr:
                    line = _worded(raw, names)
                    told.append(line)
                    if bar is None or not bar.line(line):
                        sys.stderr.write(line)
                        sys.stderr.flush()
                said = process.stdout.read()
                code = process.wait()
                break
            except KeyboardInterrupt:
                # A terminal interrupts the program too, a notebook does not. Wait for its end after the first interrupt only.
                process.send_signal(signal.SIGINT)
                if interrupted:
                    raise
                interrupted = True
    return code, said, "".join(told)


def _words(told: str) -> str:
    """Error message of the program, from the first line of the error."""
    lines = told.strip().splitlines()
    for k, line in enumerate(lines):
        if line.startswith(("error", "interrupted")):
            return "\n".join(lines[k:])
    return "\n".join(lines[-20:])
