"""Profile: how the misfit rises when one parameter is held away from its best value."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from brdffit.fit.profile import CHI_SQUARE_95, Profile
from brdffit.plots.style import COLOURS, DATA, MUTED, entitle, new_figure, styled


@styled
def profile_figure(profile: Profile) -> Figure:
    """The profile beside the parabola that a standard error stands for."""
    figure = new_figure(5.5, 3.8)
    axes = figure.subplots()
    plot_profile(axes, profile)
    low, high = profile.interval
    entitle(
        figure,
        f"{profile.result.model}: {profile.name} lies between {low:.4g} and "
        f"{high:.4g} with 95 % confidence",
    )
    return figure


def plot_profile(axes: Axes, profile: Profile) -> None:
    """Draw twice the rise of the cost in units of the noise, over the parameter."""
    best = float(profile.result.parameters[profile.name])
    error = float(profile.result.standard_errors[profile.name])
    fine = np.linspace(profile.values.min(), profile.values.max(), 200)
    axes.plot(
        profile.values,
        profile.rise,
        "o-",
        color=COLOURS[0],
        markersize=3.5,
        label="profile: all others refitted",
    )
    if np.isfinite(error) and error > 0:
        parabola = ((fine - best) / error) ** 2
        axes.plot(fine, parabola, "--", color=COLOURS[1], label="standard error")
    axes.axhline(CHI_SQUARE_95, color=MUTED, linewidth=0.8, linestyle=":")
    axes.annotate(
        "95 %",
        (fine[0], CHI_SQUARE_95),
        textcoords="offset points",
        xytext=(2, 3),
        color=MUTED,
    )
    axes.axvline(best, color=DATA, linewidth=0.8)
    axes.set_ylim(0, max(2.5 * CHI_SQUARE_95, float(np.max(profile.rise))) * 1.05)
    axes.set_xlabel(profile.name)
    axes.set_ylabel("twice the rise of the cost / noise variance")
    axes.legend(loc="upper center")
