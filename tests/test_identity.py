import dataclasses
import functools

import equinox as eqx
import jax
import numpy as np
import pytest

from brdffit import MODELS, identity as module
from brdffit.fit.loss import huber
from brdffit.fit.residual import RESIDUALS, Residual
from brdffit.fit.transforms import Layout
from brdffit.identity import NamelessError, identity
from brdffit.models import GGX
from brdffit.numerics import sqrt
from brdffit.scene.nearest import Meeting

X = np.zeros((3, 2))


def name(function=sqrt, arguments=(X,), named=None, fixed=None):
    return identity(function, arguments, named or {}, fixed or {})


class Foreign(eqx.Module):
    x: np.ndarray


def test_values_of_arrays_do_not_count_but_shapes_and_types_do():
    assert name() == name(arguments=(X + 1,))
    met = Meeting(X, X, X, X)
    others = [
        (met,),
        ((X, X, X, X),),
        (X[:2],),
        (X.astype(np.float32),),
        ([X],),
        (X, X),
        ({"x": X},),
        (),
    ]
    names = {name(arguments=arguments) for arguments in others}
    assert len(names | {name()}) == 1 + len(others)


def test_models_count_by_kind_options_and_channels():
    brdf = GGX()
    assert name(arguments=(brdf,)) == name(arguments=(GGX(alpha=0.7),))
    others = [GGX(separable=True), GGX(diffuse=[0.5]), MODELS["beckmann"]()]
    names = {name(arguments=(other,)) for other in others}
    assert len(names | {name(arguments=(brdf,))}) == 4


def test_what_is_compiled_in_counts_with_its_value():
    layout = Layout.of(GGX())
    fixed = [
        {"rtol": 1e-10},
        {"rtol": 1e-9},
        {"rtol": np.float64(1e-9)},
        {"layout": layout},
        {"layout": dataclasses.replace(layout, separate=True)},
        {"loss": huber},
        *({"residual": residual} for residual in RESIDUALS.values()),
    ]
    assert len({name(fixed=each) for each in fixed}) == len(fixed)
    assert name(fixed={"layout": layout}) == name(fixed={"layout": Layout.of(GGX())})


@pytest.mark.parametrize(
    "options",
    [
        {"function": lambda x: x},
        {"function": functools.partial(sqrt)},
        {"function": np.sqrt},
        {"arguments": (Foreign(X),)},
        {"fixed": {"x": X}},
        {"fixed": {"residual": Residual("mine", lambda f, *_: f, lambda f, *_: f)}},
        {"fixed": {"names": {"a", "b"}}},
    ],
    ids=["lambda", "partial", "numpy", "foreign", "array", "residual", "set"],
)
def test_what_another_process_could_not_name_is_refused(options):
    with pytest.raises(NamelessError):
        name(**options)


def test_settings_of_jax_count():
    with jax.enable_x64(True):
        double = name()
    assert double != name()


def test_flags_processor_and_libraries_count(monkeypatch):
    def fresh():
        module._surroundings.cache_clear()
        return name()

    try:
        names = {fresh()}
        monkeypatch.setenv("XLA_FLAGS", "--xla_cpu_enable_fast_math=false")
        names.add(fresh())
        monkeypatch.setattr(module, "version", lambda _: "99")
        names.add(fresh())
        monkeypatch.setattr(module, "_processor", lambda: "another")
        names.add(fresh())
        assert len(names) == 4
    finally:
        module._surroundings.cache_clear()


def test_sources_are_told_by_size_and_time(tmp_path):
    file = tmp_path / "models" / "new.py"
    file.parent.mkdir()
    file.write_text("one")
    before = module._sources(tmp_path)
    assert module._sources(tmp_path) == before
    file.write_text("three")
    changed = module._sources(tmp_path)
    assert changed != before
    (tmp_path / "models" / "notes.txt").touch()
    assert module._sources(tmp_path) == changed
