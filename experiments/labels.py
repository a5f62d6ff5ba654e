"""Names beside points, where they cover neither each other, nor points, nor lines."""

import itertools

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.transforms import Bbox

SIZE = 7  # of letters
POINT = 4.5  # half the width of a marker, with its margin
DISTANCES = (7, 12, 18, 26, 36, 48, 62, 78, 96, 120)  # from a point, in points of print
ANGLES = np.radians(
    [45, -45, 135, -135, 90, -90, 0, 180, 20, -20, 160, -160, 65, -65, 115, -115]
)
MARGIN = 2  # points of print between names beside each other
LEADER = 13  # distance from which on a line leads to the point
LINE = {"arrowstyle": "-", "color": "#6b6b6b", "linewidth": 0.5, "shrinkB": 3}


def label_points(axes, points, names, obstacles=()):
    """Write a name beside each point of a finished panel.

    Every name takes the nearest place that is free, in the order given; if possible the
    line that leads to it crosses no other name or point.

    Args:
        axes: The panel; its limits and its place in the figure must not change later.
        points: Positions ``(N, 2)`` in the units of the axes.
        names: One for each; those that are empty are left out.
        obstacles: Further positions that no name may cover, as those along a line.

    Returns:
        The names for which there was no free place, which is none in a good figure.
    """
    canvas = FigureCanvasAgg(axes.figure)
    scale = axes.figure.dpi / 72
    places = axes.transData.transform(np.reshape(points, (-1, 2)))
    marks = [around(place, POINT * scale) for place in places]
    taken = list(marks)
    if len(obstacles):
        taken += [around(p, 1) for p in axes.transData.transform(obstacles)]
    written, crowded = [], []
    for place, xy, name in zip(places, points, names, strict=True):
        if not name:
            continue
        text = axes.annotate(
            name, xy, xytext=(0, 0), textcoords="offset points", size=SIZE
        )
        bare = text.get_window_extent(canvas.get_renderer())
        text.remove()
        size = np.array([bare.width, bare.height])
        solid = [m for m in marks if not m.contains(*place)] + written
        options = place, size, scale, taken, axes.get_window_extent()
        box = _free(*options, solid) or _free(*options)
        if box is None:
            crowded.append(name)
            box = Bbox([place, place + size])
        leader = along(place, box)
        far = len(leader) > 1 and np.hypot(*(leader[-1] - place)) > LEADER * scale
        axes.annotate(
            name,
            xy,
            xytext=(box.min - place) / scale,
            textcoords="offset points",
            size=SIZE,
            va="bottom",
            arrowprops=LINE if far else None,
            zorder=6,
        ).set_in_layout(False)
        written.append(box)
        taken += [box.padded(MARGIN * scale, 0), *(around(p, 1) for p in leader if far)]
    return crowded


def around(place, half):
    """A square about a place on the page."""
    return Bbox([place - half, place + half])


def along(place, box):
    """Places on the way from a point to the nearest of a box."""
    end = np.clip(place, box.min, box.max)
    share = np.linspace(0, 1, max(int(np.hypot(*(end - place)) // 3), 1))
    return place + share[:, None] * (end - place)


def _free(place, size, scale, taken, frame, solid=()):
    """The nearest free box for a text, None without any.

    It must not cover what is taken, and the line to it must not cross what is solid.
    """
    for distance, angle in itertools.product(DISTANCES, ANGLES):
        towards = np.array([np.cos(angle), np.sin(angle)])
        centre = place + towards * (distance * scale + np.abs(towards) * size / 2)
        box = Bbox([centre - size / 2, centre + size / 2])
        inside = np.all(box.min >= frame.min) and np.all(box.max <= frame.max)
        if not inside or any(box.overlaps(other) for other in taken):
            continue
        leader = along(place, box)
        if not any(other.contains(*p) for other in solid for p in leader):
            return box
    return None
