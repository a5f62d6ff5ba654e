"""Measured materials, cut to one size, so that many models are compiled for them once.

They need the data folder that `BRDFFIT_DATA` names; see `merl_standins`.
"""

import dataclasses

import numpy as np

import brdffit
from brdffit.samples import Measurement
from brdffit.subset import subset
from experiments.merl_ranking import STEEPEST, up_to
from experiments.merl_standins import DATA, stand_in

COUNT = 1800  # samples of each
SEED = 0
FILES = {
    "black anodised aluminium": "ualoft/AnoBlackEC1onAlum.txt",
    "black anodised Invar": "ualoft/AnoBlackNiTEonINVAR.txt",
    "sintered PTFE": "nist_ptfe/ptfe_regular_532nm.csv",
    "white paper": "rgl/paper_white_rgb.bsdf",
    "golden yellow": "rgl/vch_golden_yellow_rgb.bsdf",
    "photographed ball": "sphere_photos/diligent_ball",
}
STAND_INS = ("blue-metallic-paint", "nickel", "pink-felt")


def present():
    """Names of the materials whose files are here."""
    files = [name for name, path in FILES.items() if (DATA / path).exists()]
    networks = (DATA / "merl_standins" / "nbrdf_weights.npz").exists()
    return files + [f"{name} (stand-in)" for name in STAND_INS if networks]


def grey(name, count=COUNT):
    """One channel of a material, green where there are colours, at most so many."""
    if name.endswith("(stand-in)"):
        data = up_to(stand_in(name.partition(" ")[0]), STEEPEST)
    else:
        data = brdffit.load(DATA / FILES[name])
    data = one_channel(subset(data, count, SEED))
    # a share that is not weighted by solid angle weighs evenly, and compiles the same
    even = np.ones(len(data)) if data.solid_angle is None else data.solid_angle
    return dataclasses.replace(data, solid_angle=even, name=name)


def one_channel(data):
    """The middle channel alone."""
    names = ("f_r",) if isinstance(data, Measurement) else ("value",)
    middle = getattr(data, names[0]).shape[1] // 2
    here = np.s_[..., middle : middle + 1]
    parts = {
        part: getattr(data, part)[here]
        for part in (*names, "sigma", "mask", "weight", "ambient")
        if getattr(data, part, None) is not None and part in vars(data)
    }
    return dataclasses.replace(data, **parts, channels=("green",))
