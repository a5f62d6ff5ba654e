"""GGX with the energy that single scattering loses (Kulla and Conty 2017, Hill)."""

import functools

from mpmath import acos, cos, mp, mpf, pi, quad, sin, sqrt

from tests.oracle.microfacet import ggx_lobe


def azimuth_integral(mu_i, mu_o, alpha):
    """Integral over azimuth of ``D / (4 mu_o)`` times ``G``, for F = 1."""
    si, so = sqrt(1 - mu_i**2), sqrt(1 - mu_o**2)
    total = mu_i + mu_o
    c = (1 - alpha**2) * total**2
    near = (so - si) ** 2 + alpha**2 * total**2
    far = (so + si) ** 2 + alpha**2 * total**2
    root = sqrt(near * far)
    ndf = 1 + 2 * c / root + c**2 * (near + far) / 2 / root**3

    def smith(mu, s):
        return (sqrt(1 + (alpha * s / mu) ** 2) - 1) / 2

    g = 1 / (1 + smith(mu_i, si) + smith(mu_o, so))
    return alpha**2 / (2 * mu_o) * g * ndf


@functools.cache
def albedo(mu, alpha):
    """Directional albedo of the GGX lobe with F = 1."""
    top = pi / 2
    peak = acos(mu)
    steps = [alpha * mpf(4) ** n for n in range(-2, 12)]
    cuts = {peak + sign * s for s in steps for sign in (1, -1)}
    bounds = [mpf(0), *sorted(cut for cut in cuts | {peak} if 0 < cut < top), top]
    return quad(
        lambda t: azimuth_integral(cos(t), mu, alpha) * sin(t), bounds, maxdegree=9
    )


@functools.cache
def average_albedo(alpha):
    """Albedo under diffuse light."""
    bounds = [mpf(0), *(b for n in range(8, -2, -2) if (b := mpf(2) ** -n) < 1), mpf(1)]
    with mp.workdps(22):
        return 2 * quad(lambda mu: albedo(mu, alpha) * mu, bounds, maxdegree=4)


def ggx_multiscatter(wi, wo, diffuse, f0, alpha):
    """Kulla and Conty 2017 with the colour term of Hill 2018."""
    average = average_albedo(alpha)
    lost = (1 - albedo(wi[2], alpha)) * (1 - albedo(wo[2], alpha)) / (1 - average)
    fresnel = f0 + (1 - f0) / 21
    colour = fresnel**2 * average / (1 - fresnel * (1 - average))
    return diffuse / pi + ggx_lobe(wi, wo, f0, alpha) + colour * lost / pi
