"""Rough and smooth diffuse models."""

from mpmath import cos, mpf, pi, sin, tan

from tests.oracle.directions import dot, polar


def lambert(wi, wo, albedo):  # noqa: ARG001
    return albedo / pi


def oren_nayar(wi, wo, albedo, sigma):
    """Oren and Nayar 1994, eq. 30."""
    (theta_i, phi_i), (theta_o, phi_o) = polar(wi), polar(wo)
    alpha, beta = max(theta_i, theta_o), min(theta_i, theta_o)
    a = 1 - sigma**2 / (2 * (sigma**2 + mpf("0.33")))
    b = mpf("0.45") * sigma**2 / (sigma**2 + mpf("0.09"))
    forward = max(mpf(0), cos(phi_i - phi_o))
    return albedo / pi * (a + b * forward * sin(alpha) * tan(beta))


def oren_nayar_full(wi, wo, albedo, sigma):
    """Oren and Nayar 1994, eq. 27 to 29."""
    (theta_i, phi_i), (theta_o, phi_o) = polar(wi), polar(wo)
    alpha, beta = max(theta_i, theta_o), min(theta_i, theta_o)
    azimuth = cos(phi_i - phi_o)
    c1 = 1 - sigma**2 / (2 * (sigma**2 + mpf("0.33")))
    c2 = mpf("0.45") * sigma**2 / (sigma**2 + mpf("0.09"))
    c2 *= sin(alpha) - ((2 * beta / pi) ** 3 if azimuth < 0 else 0)
    c3 = mpf("0.125") * sigma**2 / (sigma**2 + mpf("0.09"))
    c3 *= (4 * alpha * beta / pi**2) ** 2
    single = c1 + azimuth * c2 * tan(beta)
    single += (1 - abs(azimuth)) * c3 * tan((alpha + beta) / 2)
    twice = mpf("0.17") * sigma**2 / (sigma**2 + mpf("0.13"))
    twice *= 1 - azimuth * (2 * beta / pi) ** 2
    return albedo / pi * single + albedo**2 / pi * twice


def eon(wi, wo, albedo, roughness):
    """Portsmouth, Kutz and Hill 2024, with the exact albedo."""
    c1 = mpf(1) / 2 - 2 / (3 * pi)
    c2 = mpf(2) / 3 - 28 / (15 * pi)
    a = 1 / (1 + c1 * roughness)
    s = dot(wi, wo) - wi[2] * wo[2]
    t = max(wi[2], wo[2]) if s > 0 else 1
    single = albedo / pi * a * (1 + roughness * s / t)
    if roughness == 0:
        return single

    def fujii(w):
        theta, _ = polar(w)
        g = sin(theta) * (theta - sin(theta) * cos(theta))
        g += mpf(2) / 3 * (tan(theta) * (1 - sin(theta) ** 3) - sin(theta))
        return a * (1 + roughness * g / pi)

    average = a * (1 + c2 * roughness)
    multiple = albedo**2 * average / (1 - albedo * (1 - average))
    lost = (1 - fujii(wi)) * (1 - fujii(wo)) / (1 - average)
    return single + multiple / pi * lost
