"""He, Torrance, Sillion and Greenberg 1991, for unpolarised light."""

import functools

from mpmath import (
    cos,
    cot,
    erfc,
    exp,
    inf,
    lambertw,
    log,
    loggamma,
    mp,
    mpf,
    pi,
    sqrt,
    tan,
)

from tests.oracle.directions import difference, dot, mirror, polar
from tests.oracle.microfacet import conductor


def cross(a, b):
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def polarisation(k):
    """Unit vectors ``s`` and ``p`` of a ray; any pair will do along the normal."""
    s = cross(k, (0, 0, 1))
    length = sqrt(dot(s, s))
    s = tuple(x / length for x in s) if length else (mpf(1), mpf(0), mpf(0))
    return s, cross(s, k)


def geometry(wi, wo):
    """The factor G, eq. 76; its limit where the rays are parallel."""
    ki, kr = tuple(-x for x in wi), wo
    v = tuple(r - i for r, i in zip(kr, ki, strict=True))
    common = (dot(v, v) / v[2]) ** 2
    turned = cross(kr, ki)
    sine = dot(turned, turned)
    if sine == 0:
        return common
    (si, p_i), (sr, pr) = polarisation(ki), polarisation(kr)
    into = dot(sr, ki) ** 2 + dot(pr, ki) ** 2
    out = dot(si, kr) ** 2 + dot(p_i, kr) ** 2
    return common * into * out / sine**2


def shadowing(w, sigma0, tau):
    """One factor of S, eq. 24 and 25, with the exponential of the errata."""
    theta, _ = polar(w)
    if theta == 0:
        return mpf(1)
    x = tau * cot(theta) / (2 * sigma0)
    if x > 1000:
        return mpf(1)
    lam = (exp(-(x**2)) / (sqrt(pi) * x) - erfc(x)) / 2
    return (1 - erfc(x) / 2) / (1 + lam)


def effective_sigma(wi, wo, sigma0, tau):
    """Roughness that is lit and seen, eq. 80 to 83."""

    def rise(w):
        theta, _ = polar(w)
        x = tau * cot(theta) / (2 * sigma0) if theta else inf
        return tan(theta) * erfc(x) if x < 1000 else mpf(0)

    f = (rise(wi) + rise(wo)) / sqrt(8 * pi)
    return sigma0 / sqrt(1 + lambertw(f**2).real)


@functools.cache
def log_factorial(m):
    return loggamma(m + 1)


def series(g, c):
    """Sum over m of ``g^m e^-g / (m! m) exp(-c / m)``, eq. 78.

    Where the terms are as smooth as a Gaussian of a width of many orders, one order in
    a quarter of that width is enough for a hundred digits (Poisson's summation formula:
    the error is ``exp(-2 pi^2 16)``).
    """

    log_g = log(g)

    def summand(m):
        return exp(m * log_g - g - log_factorial(m) - c / m) / m

    peak = max(1, int(g * exp(lambertw(2 * c / g**2).real / 2)))
    width = sqrt(peak / (1 + 2 * mpf(c) / peak**2))
    step = max(1, int(width / 4))
    total, tiny = mpf(0), summand(peak) * mpf(10) ** (-mp.dps - 3)
    for direction in (1, -1):
        m = peak if direction > 0 else peak - step
        while m >= 1 and (term := summand(m)) > tiny:
            total += step * term
            m += direction * step
    return total


def phase(wi, wo, sigma0, tau, wavelength):
    """The apparent roughness g, eq. 79."""
    sigma = effective_sigma(wi, wo, sigma0, tau)
    cosines = cos(polar(wi)[0]) + cos(polar(wo)[0])
    return (2 * pi * sigma / wavelength * cosines) ** 2


def he(wi, wo, sigma0, tau, eta, k, diffuse, wavelengths):
    """Directional diffuse and uniform diffuse reflection."""
    h = tuple(a + b for a, b in zip(wi, wo, strict=True))
    g = phase(wi, wo, sigma0, tau, wavelengths)
    c = (pi * tau / wavelengths) ** 2 * (h[0] ** 2 + h[1] ** 2)
    d = (pi * tau / wavelengths) ** 2 / 4 * series(g, c)
    f = conductor(cos(difference(wi, wo)), eta, k)
    s = shadowing(wi, sigma0, tau) * shadowing(wo, sigma0, tau)
    (theta_i, _), (theta_o, _) = polar(wi), polar(wo)
    lobe = f * geometry(wi, wo) * s * d / (pi * cos(theta_i) * cos(theta_o))
    return lobe + diffuse / pi


def specular_reflectance(wi, sigma0, tau, eta, k, wavelengths):
    """Strength of the ideal reflection."""
    g = phase(wi, mirror(wi), sigma0, tau, wavelengths)
    s = shadowing(wi, sigma0, tau) ** 2
    return conductor(cos(polar(wi)[0]), eta, k) * exp(-g) * s
