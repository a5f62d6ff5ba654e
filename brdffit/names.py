"""Names given by users, looked up once, with the nearest right one suggested."""

import difflib
from collections.abc import Mapping
from typing import TypeVar

Value = TypeVar("Value")


def look_up(known: Mapping[str, Value], name: str, kind: str) -> Value:
    """``known[name]``.

    Raises:
        ValueError: There is no such name; the sentence suggests the nearest one.
    """
    if name in known:
        return known[name]
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f" Did you mean `{near[0]}`?" if near else ""
    raise ValueError(f"{kind} `{name}` must be one of {', '.join(known)}.{hint}")
