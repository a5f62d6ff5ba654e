"""Damage to a file: cut off, bits flipped, numbers that cannot be.

Every kind lists its damages as ``(start, stop, new)``: what stands between two places
becomes something else.
"""

import re
import struct

HEADER = 512  # bytes, where damage decides most
KILOBYTE = 1024
BITS = (0x01, 0x80, 0xFF)
NUMBERS = (b"-1", b"0", b"nan", b"inf", b"-1e400", b"99999999999", b"1_0", b"", b"\0")
WORDS = (
    b"\xff\xff\xff\xff",  # -1, or the largest count
    b"\xff\xff\xff\x7f",  # the largest positive number
    b"\x00\x00\x00\x80",  # the most negative
    b"\x00\x00\x00\x00",
    struct.pack("<f", float("nan")),
)
NUMBER = re.compile(rb"(?<![\w.])[-+]?\d[\d.]*(?:e[-+]?\d+)?(?![\w.])")


def cuts(content):
    """The file up to each kilobyte, and without its last bytes."""
    size = len(content)
    ends = {*range(0, size, KILOBYTE), *range(max(size - 8, 0), size)}
    return [(end, size, b"") for end in sorted(ends)]


def flips(content):
    """One byte of the header with one bit, or all, turned over."""
    return [
        (place, place + 1, bytes([content[place] ^ bits]))
        for place in range(min(HEADER, len(content)))
        for bits in BITS
    ]


def words(content):
    """Four bytes of the header as counts and sizes that cannot be."""
    places = range(0, min(HEADER, len(content)) - 4, 2)
    return [(place, place + 4, word) for place in places for word in WORDS]


def numbers(content):
    """One number of a text as one that cannot be, near its start and its end."""
    if b"\0" in content:  # no text
        return []
    found = [match.span() for match in NUMBER.finditer(content)]
    places = found[:60] + found[60:][-20:]
    return [(*place, number) for place in places for number in NUMBERS]


def damaged(content, damage):
    """A copy of the content with one damage."""
    start, stop, new = damage
    return content[:start] + new + content[stop:]


KINDS = {"cuts": cuts, "flips": flips, "words": words, "numbers": numbers}
