"""Progress bar in a notebook."""

from __future__ import annotations

import html
import re
from typing import Any

_STAGES = "generate|extract|cycle|aggregate|report"
_TASKS = re.compile(rf"^({_STAGES}): (\d+)/(\d+)\b")
_BEGIN = re.compile(rf"^({_STAGES}): (\d+) tasks?, (\d+) done before$")
_PAGE = re.compile(r"^progress page: ")


def bar() -> Bar | None:
    """A progress bar where the code runs in a notebook; otherwise None."""
    try:
        from IPython import get_ipython
        from IPython.display import display
    except ImportError:
        return None
    shell = get_ipython()
    if shell is None or not hasattr(shell, "kernel"):
        return None
    return Bar(display(_html("", 0, 1), display_id=True))


def _html(stage: str, done: int, all: int) -> Any:
    from IPython.display import HTML

    return HTML(f'<label>{html.escape(stage)} <progress value="{done}" max="{max(all, 1)}"></progress> {done}/{all}</label>')


class Bar:
    """A progress bar that follows the lines of the program."""

    def __init__(self, handle: Any) -> None:
        self._handle = handle

    def line(self, line: str) -> bool:
        """Shows a line of progress; false for any other line."""
        found, begin = _TASKS.match(line), _BEGIN.match(line)
        if found is not None:
            self._handle.update(_html(found[1], int(found[2]), int(found[3])))
        elif begin is not None:
            self._handle.update(_html(begin[1], int(begin[3]), int(begin[2])))
        # The bar replaces the page of progress.
        return found is not None or begin is not None or _PAGE.match(line) is not None
