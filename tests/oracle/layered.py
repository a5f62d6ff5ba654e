"""Models with a base under a coat."""

from mpmath import cos, log, mp, mpf, pi

from tests.oracle.directions import half, polar
from tests.oracle.microfacet import (
    cos_d,
    dielectric,
    facets,
    ggx_facets,
    ggx_lobe,
    lambda_ggx,
    schlick,
    smith,
)


def internal_reflectance(n):
    """Share of diffuse light that a smooth interface sends back into the base.

    From the closed form of the reflectance outside (Walsh 1926; Duntley 1942).
    """
    if n == 1:
        return mpf(0)
    with mp.workdps(3 * mp.dps):  # terms of 1 / (n - 1)^2 cancel
        return _internal_reflectance(n)


def _internal_reflectance(n):
    square, fourth = n**2, n**4
    outside = mpf(1) / 2 + (n - 1) * (3 * n + 1) / (6 * (n + 1) ** 2)
    ratio = abs(n - 1) / (n + 1)
    outside += square * (square - 1) ** 2 / (square + 1) ** 3 * log(ratio)
    outside -= 2 * n**3 * (square + 2 * n - 1) / ((square + 1) * (fourth - 1))
    outside += 8 * fourth * (fourth + 1) / ((square + 1) * (fourth - 1) ** 2) * log(n)
    return 1 - (1 - outside) / square


def plastic_ggx(wi, wo, diffuse, alpha, eta, separable=False):
    """Walter et al. 2007 over a base, as in Mitsuba's roughplastic."""
    through = 1 - dielectric(cos(polar(wi)[0]), eta)
    through *= 1 - dielectric(cos(polar(wo)[0]), eta)
    base = diffuse / pi * through / eta**2
    base /= 1 - diffuse * internal_reflectance(eta)
    f = dielectric(cos_d(wi, wo), eta)
    return base + ggx_facets(wi, wo, f, alpha, alpha, separable)


def gtr1(h, alpha):
    """Burley 2012, appendix B.2."""
    cosine = cos(polar(h)[0])
    if alpha == 1:
        return 1 / pi
    spread = 1 + (alpha**2 - 1) * cosine**2
    return (alpha**2 - 1) / (pi * log(alpha**2) * spread)


def principled(
    wi,
    wo,
    base,
    metallic,
    roughness,
    specular,
    sheen,
    clearcoat,
    clearcoat_gloss,
    separable=False,
):
    """Burley 2012, section 5 and appendix B, without tints, anisotropy, subsurface."""
    cosine = cos_d(wi, wo)
    f90 = mpf(1) / 2 + 2 * roughness * cosine**2
    diffuse = base / pi
    for w in (wi, wo):
        diffuse *= 1 + (f90 - 1) * (1 - cos(polar(w)[0])) ** 5
    diffuse += sheen * (1 - cosine) ** 5
    f0 = (1 - metallic) * mpf("0.08") * specular + metallic * base
    alpha = max(mpf("0.001"), roughness**2)
    gloss = (1 - clearcoat_gloss) * mpf("0.1") + clearcoat_gloss * mpf("0.001")
    quarter = mpf(1) / 4
    lambdas = lambda_ggx(wi, quarter, quarter), lambda_ggx(wo, quarter, quarter)
    coat = facets(
        wi,
        wo,
        gtr1(half(wi, wo), gloss),
        schlick(cosine, mpf("0.04")),
        smith(*lambdas, separable),
    )
    return (
        (1 - metallic) * diffuse
        + ggx_lobe(wi, wo, f0, alpha, separable)
        + clearcoat / 4 * coat
    )
