"""GGX with the energy that single scattering loses."""

import functools

from mpmath import acos, cos, legendre, mp, mpf, pi, sin, sqrt

from tests.oracle.microfacet import ggx_lobe

NODES = 24


@functools.cache
def gauss_legendre(digits):
    """Nodes and weights on [-1, 1], by Newton's method."""
    rule = []
    with mp.workdps(digits + 10):
        for n in range(NODES):
            x = cos(pi * (n + mpf(3) / 4) / (NODES + mpf(1) / 2))
            for _ in range(9):
                high, low = legendre(NODES, x), legendre(NODES - 1, x)
                slope = NODES * (x * high - low) / (x * x - 1)
                x -= high / slope
            rule.append((x, 2 / ((1 - x * x) * slope**2)))
    return rule


def integral(f, cuts):
    """Sum of Gauss-Legendre rules between the cuts.

    A fixed rule, whose small error is smooth in all that the cuts depend on: the
    derivatives of the integral are as good as its value.
    """
    total = mpf(0)
    for low, high in zip(cuts[:-1], cuts[1:], strict=True):
        middle, reach = (low + high) / 2, (high - low) / 2
        rule = gauss_legendre(mp.dps)
        total += reach * sum(w * f(middle + reach * x) for x, w in rule)
    return total


def graded(low, high, *scales):
    """Cuts at distances of 1, 4, 16, ... times a scale from each point."""
    cuts = {low, high}
    for point, scale in scales:
        for n in range(20):
            cuts |= {point - scale * mpf(4) ** n, point, point + scale * mpf(4) ** n}
    return sorted(cut for cut in cuts if low <= cut <= high)


def azimuth_integral(mu_i, mu_o, alpha):
    """Integral over azimuth of the lobe for F = 1, times the cosine of ``wi``.

    The squared denominator of the ndf is ``a + b cos(phi)`` over the squared half
    vector; integrals of its inverse powers are in every table.
    """
    si, so = sqrt(1 - mu_i**2), sqrt(1 - mu_o**2)
    c = (1 - alpha**2) * (mu_i + mu_o) ** 2
    a, b = 2 + 2 * mu_i * mu_o - c, 2 * si * so
    root = sqrt(a**2 - b**2)
    ndf = 2 * pi * (1 + 2 * c / root + c**2 * a / root**3)

    def smith(mu, s):
        return (sqrt(1 + (alpha * s / mu) ** 2) - 1) / 2

    g = 1 / (1 + smith(mu_i, si) + smith(mu_o, so))
    return alpha**2 / pi * ndf * g / (4 * mu_o)


@functools.cache
def albedo(mu, alpha):
    """Directional albedo of the GGX lobe with F = 1."""
    top = pi / 2
    cuts = graded(mpf(0), top, (acos(mu), alpha), (top, mu), (top, alpha))
    return integral(lambda t: azimuth_integral(cos(t), mu, alpha) * sin(t), cuts)


@functools.cache
def average_albedo(alpha):
    """Albedo under diffuse light."""
    steps = (alpha * mpf(4) ** n for n in range(-20, 20))
    cuts = [mpf(0), *(mu for mu in steps if mpf("1e-6") < mu < 1), mpf(1)]
    with mp.workdps(60):
        return integral(lambda mu: 2 * albedo(mu, alpha) * mu, cuts)


def ggx_multiscatter(wi, wo, diffuse, f0, alpha):
    """Kulla and Conty 2017 with the colour term of Hill 2018."""
    average = average_albedo(alpha)
    lost = (1 - albedo(wi[2], alpha)) * (1 - albedo(wo[2], alpha)) / (1 - average)
    fresnel = f0 + (1 - f0) / 21
    colour = fresnel**2 * average / (1 - fresnel * (1 - average))
    return diffuse / pi + ggx_lobe(wi, wo, f0, alpha) + colour * lost / pi
