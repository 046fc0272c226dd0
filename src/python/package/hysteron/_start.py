"""Start of a run with the program."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from typing import Any

from ._program import (
    _FAILED_CASES,
    _INTERRUPTED,
    Failed,
    FailedCases,
    Interrupted,
    _another,
    _file,
    _json,
    _named,
    _watched,
    _words,
    find,
)
from ._run import Run, load


def run(
    spec: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    until: str | None = None,
) -> Run:
    """Runs all pending tasks of a spec, as `hysteron run`, and opens the output directory. The same call resumes the run.

    Progress is written to `sys.stderr`, in a notebook as a progress bar.

    Parameters
    ----------
    spec : path, str or mapping
        Path of a spec, the text of one (a text of more than one line, or with a `=`), or a nested dict of the same keys, such as
        `{"name": "mine", "surface": {"magnification": 32}, "sweep": [{"surface": {"hurst": [0.7, 0.8]}}]}`.
    out : path, optional
        Output directory. Default: `data/runs/<name of the spec>` below the working directory, as on the command line.
    jobs : int, optional
        Number of threads. Default: number of cores.
    until : str, optional
        Last stage: generate, extract, cycle, aggregate or report.

    Returns
    -------
    Run

    Raises
    ------
    HysteronError
        With the message of the program after an error.
    Interrupted
        After an interrupt.

    Warns
    -----
    FailedCasesWarning
        If some cases failed.
    """
    program = find()
    with _file(spec) as (path, temporary):
        command = [str(program), "run", "--json"]
        if out is not None:
            command.append(f"--out={os.fspath(out)}")
        if jobs is not None:
            command.append(f"--jobs={jobs}")
        if until is not None:
            command.append(f"--until={until}")
        # "--": file names are not options.
        code, said, told = _watched([*command, "--", path], {path: "spec.toml"} if temporary else {})
    if code == _INTERRUPTED:
        raise Interrupted(_words(told))
    if code not in (0, _FAILED_CASES):
        raise Failed(_named(_words(told)) or f"{program} ended with exit code {code} without a message", code)
    answer = _json(said, program, code)
    if not {"dir", "stages"} <= answer.keys():
        raise _another(program, code)
    result = load(answer["dir"])
    if code == _FAILED_CASES:
        # The cycles of a failed surface fail too.
        failed = max(stage["failed_count"] for stage in answer["stages"])
        cases = "1 case" if failed == 1 else f"{failed} cases"
        text = f"{cases} failed; reasons: {result.dir}/cycles/*/failed.json. Change the spec: without a change, a cycle fails again."
        if failed == 0:
            text = f"Some loads were not reached; reasons: {result.dir}/cycles/*/not_reached.json. Change the spec or omit these loads."
        warnings.warn(text, FailedCases, stacklevel=2)
    return result
