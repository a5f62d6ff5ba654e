"""Names given by users, looked up once, with the nearest right one suggested."""

import difflib
from collections.abc import Iterable, Mapping
from typing import TypeVar

Value = TypeVar("Value")


def look_up(known: Mapping[str, Value], name: str, kind: str) -> Value:
    """``known[name]``.

    Raises:
        ValueError: There is no such name; the sentence suggests the nearest one.
    """
    if name in known:
        return known[name]
    raise ValueError(
        f"{kind} `{name}` must be one of {', '.join(known)}.{nearest(known, name)}"
    )


def nearest(known: Iterable[str], name: str) -> str:
    """A question whether the nearest of these names was meant, or nothing."""
    plain = {other.lower(): other for other in known}
    near = difflib.get_close_matches(name.lower(), plain, n=1, cutoff=0.5)
    return f" Did you mean `{plain[near[0]]}`?" if near else ""
