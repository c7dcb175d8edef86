"""Names that are not there, in messages."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def nearest(name: str, known: Iterable[str], listed: bool = False) -> str:
    """What else there is, for a message: the nearest name first. All of them where none is near, or if `listed`."""
    names = list(known)
    close = difflib.get_close_matches(name, names, 1)
    meant = f"; did you mean '{close[0]}'?" if close else ""
    if not names or (close and not listed):
        return meant
    return f"{meant} There are: {', '.join(names)}" if close else f"; there are: {', '.join(names)}"
