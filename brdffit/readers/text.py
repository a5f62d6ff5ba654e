"""Text files of numbers, line by line, in bounded memory.

A line that cannot be read is named by its number.
"""

from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

LONGEST_LINE = 1_000_000
TAIL = 2000  # bytes


class Line(NamedTuple):
    """One line of a file, without the white space around it."""

    path: Path
    number: int
    text: str

    def error(self, sentence: str) -> ValueError:
        """An error that says which line of which file is wrong, and what it reads."""
        start = self.text[:60] + (" ..." if len(self.text) > 60 else "")
        return ValueError(
            f"Line {self.number} of `{self.path}` reads `{start}`: {sentence}"
        )

    def numbers(self, separator: str | None = None) -> list[float]:
        """The line as numbers.

        Raises:
            ValueError: Something on the line is not a number.
        """
        return [self.number_from(token) for token in self.text.split(separator)]

    def number_from(self, token: str) -> float:
        """One word of the line as a number; NaN and infinity are numbers here."""
        try:
            if "_" in token:  # Python would read 1_5 as 15
                raise ValueError
            return float(token)
        except ValueError:
            raise self.error(f"`{token.strip()[:40]}` is not a number.") from None


def lines(path: Path | str) -> Iterator[Line]:
    """The lines of a text file that are not empty.

    Bytes that are not UTF-8 are replaced, so that a foreign comment does no harm.

    Raises:
        ValueError: A line is longer than a million characters, or the last is cut off.
        OSError: The file cannot be read.
    """
    path = Path(path)
    if not path.is_file():  # a device has no end, a pipe waits for a writer
        raise OSError(f"`{path}` is not a file that can be read.")
    refuse_cut_number(path)
    with path.open(encoding="utf-8-sig", errors="replace") as stream:
        number = 0
        while text := stream.readline(LONGEST_LINE):
            number += 1
            if len(text) == LONGEST_LINE:
                raise ValueError(
                    f"Line {number} of `{path}` is longer than {LONGEST_LINE} "
                    f"characters, so this is not a table of numbers."
                )
            if stripped := text.strip():
                yield Line(path, number, stripped)


def table(path: Path, rows: Iterator[Line], width: int) -> np.ndarray:
    """The rest of a file as rows of ``width`` numbers, between commas or spaces.

    Raises:
        ValueError: A line has another number of numbers, or there is none.
    """
    numbers = array("d")
    for row in rows:
        found = row.numbers("," if "," in row.text else None)
        if len(found) != width:
            raise row.error(f"it must have {width} numbers, but has {len(found)}.")
        numbers.extend(found)
    if not numbers:
        raise ValueError(f"File `{path}` ends before its numbers; it is cut off.")
    return np.frombuffer(numbers).reshape(-1, width)


def refuse_cut_number(path: Path) -> None:
    """Refuse a file that ends within a number, which would be read as another number.

    It does when there is no line break at the end, the last rows before it all have
    equally many decimals, and the very last has fewer.
    """
    with path.open("rb") as stream:
        stream.seek(max(0, path.stat().st_size - TAIL))
        *rows, last = stream.read(TAIL).split(b"\n")
    alike = [row for row in rows if len(row.split()) == len(last.split())][-20:]
    decimals = {len(row.rstrip().rpartition(b".")[2]) for row in alike}
    short = len(decimals) == 1 and len(last.rpartition(b".")[2]) < min(decimals)
    if len(alike) > 8 and short:
        end = last.decode(errors="replace")
        raise ValueError(f"File `{path}` is cut off within its last number, `{end}`.")


class Words:
    """The words of a text file one after another, across lines and without comments.

    For formats in which a label says how many numbers follow. Nothing is set aside for
    numbers that a label promises: memory grows with what the file holds.
    """

    def __init__(self, path: Path | str, comment: str = "#"):
        """Begin at the start of ``path``."""
        self.path = Path(path)
        self.line = Line(self.path, 0, "")
        self._stream = self._words(comment)

    def _words(self, comment: str) -> Iterator[str]:
        for line in lines(self.path):
            self.line = line
            if not line.text.startswith(comment):
                yield from line.text.split()

    def word(self, expected: str) -> str:
        """The next word.

        Raises:
            ValueError: The file ends.
        """
        word = next(self._stream, None)
        if word is None:
            raise ValueError(
                f"File `{self.path}` ends after line {self.line.number}, where "
                f"{expected} should follow; it is cut off."
            )
        return word

    def number(self, expected: str) -> float:
        """The next word as a number."""
        word = self.word(expected)
        return self.line.number_from(word)

    def numbers(self, expected: str, count: int | None = None) -> np.ndarray:
        """So many numbers; as many as the next word says when ``count`` is None."""
        if count is None:
            promised = self.number(f"the number of {expected}")
            if not (promised >= 1 and promised.is_integer()):
                raise self.line.error(f"the number of {expected} must be 1 or more.")
            count = int(promised)
        found = array("d")
        while len(found) < count:
            found.append(self.number(f"number {len(found) + 1} of {expected}"))
        return np.frombuffer(found)
