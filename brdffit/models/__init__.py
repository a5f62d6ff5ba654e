"""Reflectance models, one per file.

To add a model, write ``models/<name>.py`` and add its line below; the registry, the
command line and the property tests find it by themselves.
"""

from brdffit.models.base import AbstractBRDF as AbstractBRDF
from brdffit.models.ggx import GGX as GGX
from brdffit.models.lambert import Lambert as Lambert
from brdffit.parameters import registry_name

MODELS: dict[str, type[AbstractBRDF]] = {
    registry_name(model): model
    for model in sorted(AbstractBRDF.__subclasses__(), key=registry_name)
}
