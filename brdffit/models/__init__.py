"""Reflectance models, one per file.

To add a model, write ``models/<name>.py`` and add its line below; the registry, the
command line and the property tests find it by themselves.
"""

from brdffit.models.ashikhmin_shirley import AshikhminShirley as AshikhminShirley
from brdffit.models.banks import Banks as Banks
from brdffit.models.base import AbstractBRDF as AbstractBRDF
from brdffit.models.beckmann import Beckmann as Beckmann
from brdffit.models.blinn_phong import BlinnPhong as BlinnPhong
from brdffit.models.blinn_phong_original import BlinnPhongOriginal as BlinnPhongOriginal
from brdffit.models.conductor_beckmann import ConductorBeckmann as ConductorBeckmann
from brdffit.models.conductor_ggx import ConductorGGX as ConductorGGX
from brdffit.models.cook_torrance import CookTorrance as CookTorrance
from brdffit.models.dielectric_beckmann import DielectricBeckmann as DielectricBeckmann
from brdffit.models.dielectric_ggx import DielectricGGX as DielectricGGX
from brdffit.models.eon import Eon as Eon
from brdffit.models.ggx import GGX as GGX
from brdffit.models.ggx_anisotropic import GGXAnisotropic as GGXAnisotropic
from brdffit.models.ggx_lobe import GGXLobe as GGXLobe
from brdffit.models.ggx_multiscatter import GGXMultiscatter as GGXMultiscatter
from brdffit.models.he import He as He
from brdffit.models.lafortune import Lafortune as Lafortune
from brdffit.models.lambert import Lambert as Lambert
from brdffit.models.oren_nayar import OrenNayar as OrenNayar
from brdffit.models.oren_nayar_full import OrenNayarFull as OrenNayarFull
from brdffit.models.phong import Phong as Phong
from brdffit.models.phong_original import PhongOriginal as PhongOriginal
from brdffit.models.plastic_ggx import PlasticGGX as PlasticGGX
from brdffit.models.principled import Principled as Principled
from brdffit.models.student_t import StudentT as StudentT
from brdffit.models.sum import Sum as Sum
from brdffit.models.ward import Ward as Ward
from brdffit.models.ward_bounded import WardBounded as WardBounded
from brdffit.models.ward_duer import WardDuer as WardDuer
from brdffit.parameters import registry_name

MODELS: dict[str, type[AbstractBRDF]] = {
    registry_name(model): model
    for model in sorted(AbstractBRDF.__subclasses__(), key=registry_name)
}
