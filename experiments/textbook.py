# ruff: noqa: D103  (the papers, whose names the functions bear, document them)
"""Formulas as they are printed, with angles, as one would type them from the papers.

Cosines are kept within [-1, 1] before an arc cosine is taken, and what is below the
horizon is set to 0 at the end: the two cares that everybody takes. Nothing else is
guarded, rearranged or cancelled. A model is a function of ``wi``, ``wo`` and its
parameters, one channel at a time.

Two models have no printed formula to evaluate: the masking of `student_t` is a fit in
the paper and an integral here, `ggx_multiscatter` reads its albedo from tables.
"""

import math

import jax.numpy as jnp
from jax.scipy.special import erf, erfc

PI = jnp.pi
ORDERS = 40  # of the series of He and Torrance
NEWTON_STEPS = 10


# directions


def polar(w):
    return jnp.arccos(jnp.clip(w[2], -1, 1)), jnp.arctan2(w[1], w[0])


def half(wi, wo):
    h = wi + wo
    return h / jnp.linalg.norm(h)


def mirror(w):
    return jnp.array([-w[0], -w[1], w[2]])


def difference(wi, wo):
    return jnp.arccos(jnp.clip(wi @ half(wi, wo), -1, 1))


# diffuse models


def lambert(wi, wo, albedo):  # noqa: ARG001
    return albedo / PI


def oren_nayar(wi, wo, albedo, sigma):
    (theta_i, phi_i), (theta_o, phi_o) = polar(wi), polar(wo)
    alpha, beta = jnp.maximum(theta_i, theta_o), jnp.minimum(theta_i, theta_o)
    a = 1 - 0.5 * sigma**2 / (sigma**2 + 0.33)
    b = 0.45 * sigma**2 / (sigma**2 + 0.09)
    forward = jnp.maximum(0, jnp.cos(phi_i - phi_o))
    return albedo / PI * (a + b * forward * jnp.sin(alpha) * jnp.tan(beta))


def oren_nayar_full(wi, wo, albedo, sigma):
    (theta_i, phi_i), (theta_o, phi_o) = polar(wi), polar(wo)
    alpha, beta = jnp.maximum(theta_i, theta_o), jnp.minimum(theta_i, theta_o)
    azimuth = jnp.cos(phi_i - phi_o)
    c1 = 1 - 0.5 * sigma**2 / (sigma**2 + 0.33)
    c2 = 0.45 * sigma**2 / (sigma**2 + 0.09)
    c2 *= jnp.sin(alpha) - jnp.where(azimuth < 0, (2 * beta / PI) ** 3, 0.0)
    c3 = 0.125 * sigma**2 / (sigma**2 + 0.09) * (4 * alpha * beta / PI**2) ** 2
    once = c1 + azimuth * c2 * jnp.tan(beta)
    once += (1 - jnp.abs(azimuth)) * c3 * jnp.tan((alpha + beta) / 2)
    twice = 0.17 * sigma**2 / (sigma**2 + 0.13)
    twice *= 1 - azimuth * (2 * beta / PI) ** 2
    return albedo / PI * once + albedo**2 / PI * twice


def eon(wi, wo, albedo, roughness):
    c1, c2 = 1 / 2 - 2 / (3 * PI), 2 / 3 - 28 / (15 * PI)
    a = 1 / (1 + c1 * roughness)
    s = wi @ wo - wi[2] * wo[2]
    t = jnp.where(s > 0, jnp.maximum(wi[2], wo[2]), 1.0)
    once = albedo / PI * a * (1 + roughness * s / t)

    def reflected(w):
        theta, _ = polar(w)
        sin, cos, tan = jnp.sin(theta), jnp.cos(theta), jnp.tan(theta)
        g = sin * (theta - sin * cos) + 2 / 3 * (tan * (1 - sin**3) - sin)
        return a + roughness * a / PI * g

    average = a * (1 + c2 * roughness)
    multiple = albedo**2 / PI * average / (1 - albedo * (1 - average))
    lost = (1 - reflected(wi)) * (1 - reflected(wo)) / (1 - average)
    return once + multiple * lost


# cosine lobes


def phong_original(wi, wo, diffuse, specular, exponent):
    lobe = jnp.maximum(0, mirror(wi) @ wo) ** exponent
    return diffuse + specular * lobe / wi[2]


def phong(wi, wo, diffuse, specular, exponent):
    lobe = jnp.maximum(0, mirror(wi) @ wo) ** exponent
    return diffuse / PI + specular * (exponent + 2) / (2 * PI) * lobe


def blinn_phong_original(wi, wo, diffuse, specular, exponent):
    return diffuse + specular * half(wi, wo)[2] ** exponent / wi[2]


def blinn_phong(wi, wo, diffuse, specular, exponent):
    peak = (exponent + 2) * (exponent + 4)
    peak /= 8 * PI * (2 ** (-exponent / 2) + exponent)
    return diffuse / PI + specular * peak * half(wi, wo)[2] ** exponent


def lafortune(wi, wo, diffuse, specular, c_x, c_y, c_z, exponent):
    base = c_x * wi[0] * wo[0] + c_y * wi[1] * wo[1] + c_z * wi[2] * wo[2]
    return diffuse / PI + specular * jnp.maximum(0, base) ** exponent


def banks(wi, wo, diffuse, specular, exponent):
    ti, to = wi[0], wo[0]
    base = jnp.sqrt(1 - ti**2) * jnp.sqrt(1 - to**2) - ti * to
    return diffuse / PI + specular * jnp.maximum(0, base) ** exponent


def ashikhmin_shirley(wi, wo, diffuse, specular, exponent_u, exponent_v):
    h = half(wi, wo)
    cos_d = wi @ h
    along = exponent_u * h[0] ** 2 + exponent_v * h[1] ** 2
    lobe = h[2] ** (along / (1 - h[2] ** 2))
    gloss = jnp.sqrt((exponent_u + 1) * (exponent_v + 1)) / (8 * PI) * lobe
    gloss /= cos_d * jnp.maximum(wi[2], wo[2])
    gloss *= specular + (1 - specular) * (1 - cos_d) ** 5
    base = 28 * diffuse / (23 * PI) * (1 - specular)
    base *= (1 - (1 - wi[2] / 2) ** 5) * (1 - (1 - wo[2] / 2) ** 5)
    return base + gloss


# Gaussian lobes


def gaussian(wi, wo, alpha_x, alpha_y):
    theta, phi = polar(half(wi, wo))
    stretch = (jnp.cos(phi) / alpha_x) ** 2 + (jnp.sin(phi) / alpha_y) ** 2
    return jnp.exp(-(jnp.tan(theta) ** 2) * stretch)


def ward(wi, wo, diffuse, specular, alpha_x, alpha_y):
    (theta_i, _), (theta_o, _) = polar(wi), polar(wo)
    gloss = gaussian(wi, wo, alpha_x, alpha_y)
    gloss /= jnp.sqrt(jnp.cos(theta_i) * jnp.cos(theta_o))
    return diffuse / PI + specular * gloss / (4 * PI * alpha_x * alpha_y)


def ward_duer(wi, wo, diffuse, specular, alpha_x, alpha_y):
    (theta_i, _), (theta_o, _) = polar(wi), polar(wo)
    gloss = gaussian(wi, wo, alpha_x, alpha_y)
    gloss /= jnp.cos(theta_i) * jnp.cos(theta_o)
    return diffuse / PI + specular * gloss / (4 * PI * alpha_x * alpha_y)


def ward_bounded(wi, wo, diffuse, specular, alpha_x, alpha_y):
    (theta_i, phi_i), (theta_o, phi_o) = polar(wi), polar(wo)
    cos_i, cos_o = jnp.cos(theta_i), jnp.cos(theta_o)
    azimuth = jnp.cos(phi_i - phi_o)
    between = cos_i * cos_o + jnp.sin(theta_i) * jnp.sin(theta_o) * azimuth
    gloss = gaussian(wi, wo, alpha_x, alpha_y) * 2 * (1 + between)
    gloss /= PI * alpha_x * alpha_y * (cos_i + cos_o) ** 4
    return diffuse / PI + specular * gloss


# microfacets


def d_beckmann(h, alpha):
    theta, _ = polar(h)
    lobe = jnp.exp(-(jnp.tan(theta) ** 2) / alpha**2)
    return lobe / (PI * alpha**2 * jnp.cos(theta) ** 4)


def d_ggx(h, alpha):
    theta, _ = polar(h)
    return alpha**2 / (PI * (jnp.cos(theta) ** 2 * (alpha**2 - 1) + 1) ** 2)


def lambda_beckmann(w, alpha):
    theta, _ = polar(w)
    a = 1 / (alpha * jnp.tan(theta))
    return (erf(a) - 1) / 2 + jnp.exp(-(a**2)) / (2 * a * jnp.sqrt(PI))


def lambda_ggx(w, alpha):
    theta, _ = polar(w)
    return (-1 + jnp.sqrt(1 + alpha**2 * jnp.tan(theta) ** 2)) / 2


def correlated(lambda_i, lambda_o):
    return 1 / (1 + lambda_i + lambda_o)


def v_cavity(wi, wo):
    h = half(wi, wo)
    common = 2 * h[2] / (wo @ h)
    return jnp.minimum(1, jnp.minimum(common * wo[2], common * wi[2]))


def schlick(cosine, f0):
    return f0 + (1 - f0) * (1 - cosine) ** 5


def dielectric(cosine, eta):
    inside = jnp.sqrt(1 - (1 - cosine**2) / eta**2)
    rs = (cosine - eta * inside) / (cosine + eta * inside)
    rp = (eta * cosine - inside) / (eta * cosine + inside)
    return (rs**2 + rp**2) / 2


def conductor(cosine, eta, k):
    sin2 = 1 - cosine**2
    t = eta**2 - k**2 - sin2
    a2b2 = jnp.sqrt(t**2 + 4 * eta**2 * k**2)
    a = jnp.sqrt((a2b2 + t) / 2)
    rs = (a2b2 + cosine**2 - 2 * cosine * a) / (a2b2 + cosine**2 + 2 * cosine * a)
    far, near = cosine**2 * a2b2 + sin2**2, 2 * cosine * a * sin2
    rp = rs * (far - near) / (far + near)
    return (rs + rp) / 2


def facets(wi, wo, d, f, g):
    return d * f * g / (4 * wi[2] * wo[2])


def ggx_facets(wi, wo, f, alpha):
    g = correlated(lambda_ggx(wi, alpha), lambda_ggx(wo, alpha))
    return facets(wi, wo, d_ggx(half(wi, wo), alpha), f, g)


def beckmann_facets(wi, wo, f, alpha):
    g = correlated(lambda_beckmann(wi, alpha), lambda_beckmann(wo, alpha))
    return facets(wi, wo, d_beckmann(half(wi, wo), alpha), f, g)


def cos_d(wi, wo):
    return wi @ half(wi, wo)


def cook_torrance(wi, wo, diffuse, specular, f0, alpha):
    d, f = d_beckmann(half(wi, wo), alpha), schlick(cos_d(wi, wo), f0)
    return diffuse / PI + specular * facets(wi, wo, d, f, v_cavity(wi, wo))


def ggx_lobe(wi, wo, f0, alpha):
    return ggx_facets(wi, wo, schlick(cos_d(wi, wo), f0), alpha)


def ggx(wi, wo, diffuse, f0, alpha):
    return diffuse / PI + ggx_lobe(wi, wo, f0, alpha)


def ggx_anisotropic(wi, wo, diffuse, f0, alpha_x, alpha_y):
    def along(w):
        _, phi = polar(w)
        return jnp.sqrt((jnp.cos(phi) * alpha_x) ** 2 + (jnp.sin(phi) * alpha_y) ** 2)

    theta, phi = polar(half(wi, wo))
    stretch = (jnp.cos(phi) / alpha_x) ** 2 + (jnp.sin(phi) / alpha_y) ** 2
    spread = (1 + jnp.tan(theta) ** 2 * stretch) ** 2
    d = 1 / (PI * alpha_x * alpha_y * jnp.cos(theta) ** 4 * spread)
    g = correlated(lambda_ggx(wi, along(wi)), lambda_ggx(wo, along(wo)))
    return diffuse / PI + facets(wi, wo, d, schlick(cos_d(wi, wo), f0), g)


def beckmann(wi, wo, diffuse, f0, alpha):
    return diffuse / PI + beckmann_facets(wi, wo, schlick(cos_d(wi, wo), f0), alpha)


def conductor_ggx(wi, wo, specular, alpha, eta, k):
    return specular * ggx_facets(wi, wo, conductor(cos_d(wi, wo), eta, k), alpha)


def conductor_beckmann(wi, wo, specular, alpha, eta, k):
    return specular * beckmann_facets(wi, wo, conductor(cos_d(wi, wo), eta, k), alpha)


def dielectric_ggx(wi, wo, specular, alpha, eta):
    return specular * ggx_facets(wi, wo, dielectric(cos_d(wi, wo), eta), alpha)


def dielectric_beckmann(wi, wo, specular, alpha, eta):
    return specular * beckmann_facets(wi, wo, dielectric(cos_d(wi, wo), eta), alpha)


# a base under a coat


def internal_reflectance(n):
    square, fourth = n**2, n**4
    outside = 1 / 2 + (n - 1) * (3 * n + 1) / (6 * (n + 1) ** 2)
    ratio = (n - 1) / (n + 1)
    outside += square * (square - 1) ** 2 / (square + 1) ** 3 * jnp.log(ratio)
    outside -= 2 * n**3 * (square + 2 * n - 1) / ((square + 1) * (fourth - 1))
    last = 8 * fourth * (fourth + 1) / ((square + 1) * (fourth - 1) ** 2)
    return 1 - (1 - (outside + last * jnp.log(n))) / square


def plastic_ggx(wi, wo, diffuse, alpha, eta):
    through = (1 - dielectric(wi[2], eta)) * (1 - dielectric(wo[2], eta))
    base = diffuse / PI * through / eta**2
    base /= 1 - diffuse * internal_reflectance(eta)
    return base + ggx_facets(wi, wo, dielectric(cos_d(wi, wo), eta), alpha)


def gtr1(h, alpha):
    spread = 1 + (alpha**2 - 1) * h[2] ** 2
    return (alpha**2 - 1) / (PI * jnp.log(alpha**2) * spread)


def principled(
    wi, wo, base, metallic, roughness, specular, sheen, clearcoat, clearcoat_gloss
):
    cosine = cos_d(wi, wo)
    f90 = 0.5 + 2 * roughness * cosine**2
    diffuse = base / PI * (1 + (f90 - 1) * (1 - wi[2]) ** 5)
    diffuse *= 1 + (f90 - 1) * (1 - wo[2]) ** 5
    diffuse += sheen * (1 - cosine) ** 5
    f0 = (1 - metallic) * 0.08 * specular + metallic * base
    gloss = ggx_lobe(wi, wo, f0, jnp.maximum(0.001, roughness**2))
    d = gtr1(half(wi, wo), (1 - clearcoat_gloss) * 0.1 + clearcoat_gloss * 0.001)
    g = correlated(lambda_ggx(wi, 0.25), lambda_ggx(wo, 0.25))
    coat = facets(wi, wo, d, schlick(cosine, 0.04), g)
    return (1 - metallic) * diffuse + gloss + clearcoat / 4 * coat


# waves


def polarisation(k):
    s = jnp.cross(k, jnp.array([0.0, 0.0, 1.0], k.dtype))
    s = s / jnp.linalg.norm(s)
    return s, jnp.cross(s, k)


def he_geometry(wi, wo):
    ki, kr = -wi, wo
    v = kr - ki
    turned = jnp.cross(kr, ki)
    (si, p_i), (sr, pr) = polarisation(ki), polarisation(kr)
    into = (sr @ ki) ** 2 + (pr @ ki) ** 2
    out = (si @ kr) ** 2 + (p_i @ kr) ** 2
    return (v @ v / v[2]) ** 2 * into * out / (turned @ turned) ** 2


def he_shadowing(w, sigma0, tau):
    theta, _ = polar(w)
    x = tau / (2 * sigma0 * jnp.tan(theta))
    lam = (jnp.exp(-(x**2)) / (jnp.sqrt(PI) * x) - erfc(x)) / 2
    return (1 - erfc(x) / 2) / (1 + lam)


def effective_sigma(wi, wo, sigma0, tau):
    def rise(w):
        theta, _ = polar(w)
        return jnp.tan(theta) * erfc(tau / (2 * sigma0 * jnp.tan(theta)))

    right = (rise(wi) + rise(wo)) / 4
    z = right
    for _ in range(NEWTON_STEPS):
        bell = jnp.exp(z**2 / 2)
        root = jnp.sqrt(PI / 2)
        z = z - (root * z * bell - right) / (root * (1 + z**2) * bell)
    return sigma0 / jnp.sqrt(1 + z**2)


def he(wi, wo, sigma0, tau, eta, k, diffuse, wavelengths):
    h = wi + wo
    sigma = effective_sigma(wi, wo, sigma0, tau)
    g = (2 * PI * sigma / wavelengths * (wi[2] + wo[2])) ** 2
    width = PI * tau / wavelengths
    c = width**2 * (h[0] ** 2 + h[1] ** 2)
    total = 0.0
    for m in range(1, ORDERS + 1):
        total += g**m * jnp.exp(-g) / (float(math.factorial(m)) * m) * jnp.exp(-c / m)
    f = conductor(cos_d(wi, wo), eta, k)
    s = he_shadowing(wi, sigma0, tau) * he_shadowing(wo, sigma0, tau)
    lobe = f * he_geometry(wi, wo) * s * width**2 / 4 * total
    return lobe / (PI * wi[2] * wo[2]) + diffuse / PI


MODELS = {
    model.__name__: model
    for model in (
        ashikhmin_shirley,
        banks,
        beckmann,
        blinn_phong,
        blinn_phong_original,
        conductor_beckmann,
        conductor_ggx,
        cook_torrance,
        dielectric_beckmann,
        dielectric_ggx,
        eon,
        ggx,
        ggx_anisotropic,
        ggx_lobe,
        he,
        lafortune,
        lambert,
        oren_nayar,
        oren_nayar_full,
        phong,
        phong_original,
        plastic_ggx,
        principled,
        ward,
        ward_bounded,
        ward_duer,
    )
}


def above_horizon(wi, wo, value):
    """``value``, and 0 where a direction is at or below the horizon."""
    return jnp.where((wi[2] > 0) & (wo[2] > 0), value, 0.0)
