"""Results of fits that were never made, for tests of what is done with results."""

import dataclasses

import numpy as np

from brdffit.fit import RESIDUALS, FitResult
from brdffit.fit.select import Comparison, Entry
from brdffit.fit.transforms import Layout
from brdffit.parameters import parameters, registry_name, values

CHANNELS = {1: ("650nm",), 2: ("a", "b"), 3: ("R", "G", "B")}


def result_of(brdf, residual="log", **changes):
    """A fit that ended in ``brdf``, with errors of 0.01 in every number."""
    layout = Layout.of(brdf)
    found = {
        name: np.asarray(value, float)
        if parameters(brdf)[name].spectral
        else float(value)
        for name, value in values(brdf).items()
    }
    result = FitResult(
        brdf=brdf,
        model=registry_name(brdf),
        parameters=found,
        standard_errors={name: 0.01 + 0 * value for name, value in found.items()},
        held=(),
        labels=layout.labels,
        correlation=np.eye(len(layout.labels)),
        at_bound={},
        undetermined={},
        residual=residual,
        loss=None,
        explained=0.9,
        cost=0.5,
        costs=dict.fromkeys(RESIDUALS, 0.5),
        rms=dict.fromkeys(RESIDUALS, 0.125),
        count=100,
        masked=0,
        chi_square=None,
        p_value=None,
        aicc=-10.0,
        bic=-8.0,
        converged=True,
        status="The fit converged after 3 steps.",
        steps=3,
        starts=16,
        basins=1,
        agreement=1.0,
        path="as it came",
        seconds=0.25,
        data="nothing",
        channels=CHANNELS.get(brdf.channels, ()),
    )
    return dataclasses.replace(result, **changes)


def comparison_of(*brdfs, tied=(), residual="log"):
    """A ranking in the order given; held-out errors are 0.1, 0.2, and so on."""
    entries = [
        Entry(result_of(brdf, residual), held_out=0.1 * place, tied=place - 1 in tied)
        for place, brdf in enumerate(brdfs, start=1)
    ]
    return Comparison(tuple(entries), residual, held_out_count=20, seed=0, data="dust")
