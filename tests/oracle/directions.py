"""Angles of directions, in mpmath numbers."""

from mpmath import acos, atan2, mpf, sqrt


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def normalize(w):
    length = sqrt(dot(w, w))
    return tuple(x / length for x in w)


def half(wi, wo):
    return normalize(tuple(a + b for a, b in zip(wi, wo, strict=True)))


def mirror(w):
    return -w[0], -w[1], w[2]


def angle(cosine):
    """``acos`` of a number that rounding may have put a hair outside [-1, 1]."""
    return acos(max(mpf(-1), min(mpf(1), cosine)))


def polar(w):
    """Polar angle and azimuth."""
    return angle(w[2]), atan2(w[1], w[0])


def difference(wi, wo):
    """Angle between either direction and the half vector."""
    return angle(dot(wi, half(wi, wo)))
