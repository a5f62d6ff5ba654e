"""brdffit: differentiable BRDF models, fitted to reflectance in JAX.

The package reads from top to bottom; a module imports only from lines above its own:

    types, numerics        shapes; functions with finite gradients
    files, names           files whole or absent; names looked up once
    processor              how many cores there are
    download               a download that goes on where it stopped
    identity, executables  what a program depends on; whole programs, kept on disk
    compiled, cache        compiler options; compiled programs for later processes
    geometry, parameters   directions; bounds, units and symbols
    half_difference        the grid of angles of MERL files
    microfacet             Fresnel, ndf, masking-shadowing
    models                 one BRDF per file
    per_channel            a model whose channels share no value
    catalogue              models by name and in numbers
    optics, albedo         refractive indices of materials; integrals of a BRDF
    samples, images        weighted directions with values; linear images
    spectrum, subset       spectral data in RGB; a share that stands for all samples
    scene                  camera, shapes, lights, surface detail
    effects                one effect per file: when a scene calls for it, what it adds
    render                 geometry pass, shading, images
    readers, writers       one file format per file
    survey, conversion     what a file holds; a measurement in another format
    databases              public databases, fetched by name
    fit                    residual -> solver -> result
    exports                a BRDF as a material of a renderer, with its error
    plots                  one kind of figure per file
    report                 a fit or a comparison as one HTML file
    batch                  the same fits, many times: folders, textures, clusters
    cli                    the command line, one command per file

Names are loaded when first used, so that ``import brdffit`` costs nothing.
"""

import importlib
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from brdffit.albedo import directional_albedo as directional_albedo
    from brdffit.batch.folder import Batch as Batch, batch as batch
    from brdffit.batch.svbrdf import Svbrdf as Svbrdf, svbrdf as svbrdf
    from brdffit.batch.texture import fit_texture as fit_texture
    from brdffit.cache import enable_compilation_cache as enable_compilation_cache
    from brdffit.databases import fetch as fetch
    from brdffit.effects import Plan as Plan, plan as plan
    from brdffit.exports import export as export
    from brdffit.fit import FitResult as FitResult, fit as fit
    from brdffit.fit.bootstrap import bootstrap as bootstrap
    from brdffit.fit.least_squares import least_squares as least_squares
    from brdffit.fit.profile import profile as profile
    from brdffit.fit.result import load_result as load_result
    from brdffit.fit.select import Comparison as Comparison, compare as compare
    from brdffit.models import MODELS as MODELS, AbstractBRDF as AbstractBRDF
    from brdffit.readers import load as load
    from brdffit.render import (
        Noise as Noise,
        render as render,
        render_texture as render_texture,
        simulate_image as simulate_image,
        simulate_measurement as simulate_measurement,
    )
    from brdffit.report import report as report
    from brdffit.samples import Measurement as Measurement, Samples as Samples
    from brdffit.scene import (
        Goniometer as Goniometer,
        Scene as Scene,
        lit_sphere as lit_sphere,
        load_scene as load_scene,
    )

_HOME = {
    "MODELS": "models",
    "AbstractBRDF": "models",
    "Batch": "batch.folder",
    "Comparison": "fit.select",
    "FitResult": "fit",
    "Goniometer": "scene",
    "Measurement": "samples",
    "Noise": "render",
    "Plan": "effects",
    "Samples": "samples",
    "Scene": "scene",
    "Svbrdf": "batch.svbrdf",
    "batch": "batch.folder",
    "bootstrap": "fit.bootstrap",
    "compare": "fit.select",
    "directional_albedo": "albedo",
    "enable_compilation_cache": "cache",
    "export": "exports",
    "fetch": "databases",
    "fit": "fit",
    "fit_texture": "batch.texture",
    "least_squares": "fit.least_squares",
    "lit_sphere": "scene",
    "load": "readers",
    "load_result": "fit.result",
    "load_scene": "scene",
    "plan": "effects",
    "profile": "fit.profile",
    "render": "render",
    "render_texture": "render",
    "report": "report",
    "simulate_image": "render",
    "simulate_measurement": "render",
    "svbrdf": "batch.svbrdf",
}


def __getattr__(name: str) -> Any:
    """Load a public name from the module that defines it, or a module itself."""
    if name in _HOME:
        return getattr(importlib.import_module(f"brdffit.{_HOME[name]}"), name)
    try:
        return importlib.import_module(f"brdffit.{name}")
    except ModuleNotFoundError:
        message = f"module 'brdffit' has no attribute {name!r}"
        raise AttributeError(message) from None


def __dir__() -> list[str]:
    """Public names, so that completion finds them before they are loaded."""
    return sorted(_HOME)


class _Package(ModuleType):
    """A package whose functions are not hidden by subpackages of the same name.

    Importing ``brdffit.render`` would bind the folder to the name of the function
    ``render``, and so would ``brdffit.fit``. Both stay importable: ``from
    brdffit.render import trace``.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name in _HOME and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
