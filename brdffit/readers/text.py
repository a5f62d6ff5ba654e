"""Text files of numbers, line by line, in bounded memory.

A line that cannot be read is named by its number.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

LONGEST_LINE = 1_000_000


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
        ValueError: A line is longer than a million characters.
        OSError: The file cannot be read.
    """
    path = Path(path)
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
