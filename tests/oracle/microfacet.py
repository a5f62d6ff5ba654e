"""Normal distributions, masking, Fresnel factors, and the models made of them."""

from mpmath import beta, betainc, cos, erf, exp, inf, mpf, pi, sin, sqrt, tan

from tests.oracle.directions import difference, dot, half, polar


def slope(w, alpha_x, alpha_y):
    """``tan^2 theta`` in units of the roughness along the azimuth of ``w``."""
    theta, phi = polar(w)
    return tan(theta) ** 2 * ((cos(phi) / alpha_x) ** 2 + (sin(phi) / alpha_y) ** 2)


def d_beckmann(h, alpha_x, alpha_y):
    """Walter et al. 2007, eq. 25, stretched."""
    cosine = cos(polar(h)[0])
    return exp(-slope(h, alpha_x, alpha_y)) / (pi * alpha_x * alpha_y * cosine**4)


def d_ggx(h, alpha_x, alpha_y):
    """Walter et al. 2007, eq. 33, stretched."""
    cosine = cos(polar(h)[0])
    spread = (1 + slope(h, alpha_x, alpha_y)) ** 2
    return 1 / (pi * alpha_x * alpha_y * cosine**4 * spread)


def d_student_t(h, alpha, gamma):
    """Ribardiere et al. 2017."""
    theta, _ = polar(h)
    top = (gamma - 1) ** gamma * alpha ** (2 * gamma - 2)
    bottom = pi * cos(theta) ** 4
    return top / (bottom * ((gamma - 1) * alpha**2 + tan(theta) ** 2) ** gamma)


def roughness_along(w, alpha_x, alpha_y):
    _, phi = polar(w)
    return sqrt((alpha_x * cos(phi)) ** 2 + (alpha_y * sin(phi)) ** 2)


def cotangent(w, alpha_x, alpha_y):
    """``1 / (alpha tan theta)``, infinite at the normal."""
    theta, _ = polar(w)
    bottom = roughness_along(w, alpha_x, alpha_y) * tan(theta)
    return 1 / bottom if bottom else inf


def lambda_beckmann(w, alpha_x, alpha_y):
    """Heitz 2014, eq. 66."""
    a = cotangent(w, alpha_x, alpha_y)
    if a > 1000:
        return mpf(0)
    return (erf(a) - 1) / 2 + exp(-(a**2)) / (2 * a * sqrt(pi))


def lambda_ggx(w, alpha_x, alpha_y):
    """Heitz 2014, eq. 72."""
    a = cotangent(w, alpha_x, alpha_y)
    return (-1 + sqrt(1 + 1 / a**2)) / 2


def lambda_student_t(w, alpha, gamma):
    """Heitz 2014, eq. 21: the mean slope beyond the horizon of ``w``.

    The density of slopes along one direction is Student's t with 2 gamma - 2 degrees
    of freedom; its tail is an incomplete beta function.
    """
    a = cotangent(w, alpha, alpha)
    if a == inf:
        return mpf(0)
    width = gamma - 1
    constant = 1 / (sqrt(width) * beta(gamma - 1, mpf(1) / 2))
    mean = constant * width / (2 * gamma - 3) * (1 + a**2 / width) ** (1.5 - gamma)
    share = width / (width + a**2)
    tail = betainc(gamma - 1, mpf(1) / 2, 0, share, regularized=True) / 2
    return mean / a - tail


def smith(lambda_i, lambda_o, separable):
    """Heitz 2014, eq. 98 and 99."""
    if separable:
        return 1 / ((1 + lambda_i) * (1 + lambda_o))
    return 1 / (1 + lambda_i + lambda_o)


def v_cavity(wi, wo):
    """Torrance and Sparrow 1967."""
    cos_h, cos_d = cos(polar(half(wi, wo))[0]), cos(difference(wi, wo))
    return min(1, 2 * cos_h * wi[2] / cos_d, 2 * cos_h * wo[2] / cos_d)


def schlick(cosine, f0):
    """Schlick 1994, eq. 15."""
    return f0 + (1 - f0) * (1 - cosine) ** 5


def dielectric(cosine, eta):
    """Fresnel, by Snell's law."""
    sine = sqrt(1 - cosine**2) / eta
    if sine > 1:
        return mpf(1)
    inside = sqrt(1 - sine**2)
    rs = (cosine - eta * inside) / (cosine + eta * inside)
    rp = (eta * cosine - inside) / (eta * cosine + inside)
    return (rs**2 + rp**2) / 2


def conductor(cosine, eta, k):
    """Fresnel, with a complex index."""
    n = eta + 1j * k
    inside = sqrt(1 - (1 - cosine**2) / n**2)
    rs = (cosine - n * inside) / (cosine + n * inside)
    rp = (n * cosine - inside) / (n * cosine + inside)
    return (abs(rs) ** 2 + abs(rp) ** 2) / 2


def facets(wi, wo, d, f, g):
    return d * f * g / (4 * cos(polar(wi)[0]) * cos(polar(wo)[0]))


def ggx_facets(wi, wo, f, alpha_x, alpha_y, separable):
    d = d_ggx(half(wi, wo), alpha_x, alpha_y)
    lambdas = lambda_ggx(wi, alpha_x, alpha_y), lambda_ggx(wo, alpha_x, alpha_y)
    return facets(wi, wo, d, f, smith(*lambdas, separable))


def beckmann_facets(wi, wo, f, alpha, separable):
    d = d_beckmann(half(wi, wo), alpha, alpha)
    lambdas = lambda_beckmann(wi, alpha, alpha), lambda_beckmann(wo, alpha, alpha)
    return facets(wi, wo, d, f, smith(*lambdas, separable))


def cos_d(wi, wo):
    # the last of a hundred digits may exceed 1, which has no sine
    return min(mpf(1), dot(wi, half(wi, wo)))


def cook_torrance(wi, wo, diffuse, specular, f0, alpha):
    d = d_beckmann(half(wi, wo), alpha, alpha)
    gloss = facets(wi, wo, d, schlick(cos_d(wi, wo), f0), v_cavity(wi, wo))
    return diffuse / pi + specular * gloss


def ggx_lobe(wi, wo, f0, alpha, separable=False):
    return ggx_facets(wi, wo, schlick(cos_d(wi, wo), f0), alpha, alpha, separable)


def ggx(wi, wo, diffuse, f0, alpha, separable=False):
    return diffuse / pi + ggx_lobe(wi, wo, f0, alpha, separable)


def ggx_anisotropic(wi, wo, diffuse, f0, alpha_x, alpha_y, separable=False):
    f = schlick(cos_d(wi, wo), f0)
    return diffuse / pi + ggx_facets(wi, wo, f, alpha_x, alpha_y, separable)


def beckmann(wi, wo, diffuse, f0, alpha, separable=False):
    f = schlick(cos_d(wi, wo), f0)
    return diffuse / pi + beckmann_facets(wi, wo, f, alpha, separable)


def conductor_ggx(wi, wo, specular, alpha, eta, k, separable=False):
    f = conductor(cos_d(wi, wo), eta, k)
    return specular * ggx_facets(wi, wo, f, alpha, alpha, separable)


def conductor_beckmann(wi, wo, specular, alpha, eta, k, separable=False):
    f = conductor(cos_d(wi, wo), eta, k)
    return specular * beckmann_facets(wi, wo, f, alpha, separable)


def dielectric_ggx(wi, wo, specular, alpha, eta, separable=False):
    f = dielectric(cos_d(wi, wo), eta)
    return specular * ggx_facets(wi, wo, f, alpha, alpha, separable)


def dielectric_beckmann(wi, wo, specular, alpha, eta, separable=False):
    f = dielectric(cos_d(wi, wo), eta)
    return specular * beckmann_facets(wi, wo, f, alpha, separable)


def student_t(wi, wo, diffuse, f0, alpha, gamma, separable=False):
    d = d_student_t(half(wi, wo), alpha, gamma)
    lambdas = lambda_student_t(wi, alpha, gamma), lambda_student_t(wo, alpha, gamma)
    f = schlick(cos_d(wi, wo), f0)
    return diffuse / pi + facets(wi, wo, d, f, smith(*lambdas, separable))
