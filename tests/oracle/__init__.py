"""Every model a second time: textbook formulas with angles, in many digits.

Written from the papers and independent of the package: no code is shared, no
trigonometry is avoided, nothing is rearranged. A hundred digits make that safe; in
single precision these forms lose their values where `tests/models/test_oracle.py`
looks.

    directions      angles, half vectors
    diffuse         Lambert, Oren-Nayar, EON
    phong           cosine lobes, Ward, Banks
    microfacet      D, F, G and the models made of them
    layered         plastic, principled
    multiscatter    GGX with the energy of multiple scattering
    wave            He and Torrance
    derivatives     values and derivatives of any of them

A model is a function of ``wi``, ``wo`` and its parameters, one channel at a time.
"""

from tests.oracle.diffuse import eon, lambert, oren_nayar, oren_nayar_full
from tests.oracle.layered import plastic_ggx, principled
from tests.oracle.microfacet import (
    beckmann,
    conductor_beckmann,
    conductor_ggx,
    cook_torrance,
    dielectric_beckmann,
    dielectric_ggx,
    ggx,
    ggx_anisotropic,
    ggx_lobe,
    student_t,
)
from tests.oracle.multiscatter import ggx_multiscatter
from tests.oracle.phong import (
    ashikhmin_shirley,
    banks,
    blinn_phong,
    blinn_phong_original,
    lafortune,
    phong,
    phong_original,
    ward,
    ward_bounded,
    ward_duer,
)
from tests.oracle.wave import he

ORACLE = {
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
        ggx_multiscatter,
        he,
        lafortune,
        lambert,
        oren_nayar,
        oren_nayar_full,
        phong,
        phong_original,
        plastic_ggx,
        principled,
        student_t,
        ward,
        ward_bounded,
        ward_duer,
    )
}
