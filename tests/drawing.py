"""What the tests of figures share: draw one strictly, and read bars and texts back from it."""

from itertools import pairwise

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg


def drawn(figure):
    """Draw, with every warning an error; texts must stay inside the figure and the legend off the panels."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw(renderer)
    panels = [axes.get_window_extent() for axes in figure.axes]
    for legend in figure.legends:
        box = legend.get_window_extent(renderer)
        assert not any(box.overlaps(panel) for panel in panels)
        assert box.x1 <= figure.bbox.x1 + 1.0
    titles = [axes.title.get_window_extent(renderer) for axes in figure.axes if axes.title.get_text()]
    for i, title in enumerate(titles):
        assert figure.bbox.x0 - 1.0 <= title.x0 < title.x1 <= figure.bbox.x1 + 1.0
        assert not any(title.overlaps(other) for other in titles[i + 1 :])
    return figure


def spans(collection):
    """Start and end of the bars of a collection."""
    boxes = [path.get_extents() for path in collection.get_paths()]
    return np.array([(box.x0, box.x1) for box in boxes])


def uplift_intervals(response):
    """Start and end of every stretch of the history with the base off the ground, found node by node."""
    found, start = [], None
    nodes = list(zip(response.time, response.side, strict=True))
    for (t, s), (_, after) in pairwise(nodes):
        if s == 0 and after != 0:
            start = t
        if s != 0 and after == 0:
            found.append((start if start is not None else nodes[0][0], t))
            start = None
    if nodes[-1][1] != 0:
        found.append((start if start is not None else nodes[0][0], nodes[-1][0]))
    return np.array(found)


def notes(axes):
    """What is written in and beside a panel."""
    return [text.get_text() for text in axes.texts]


def legend(figure):
    """The entries of the legend of a figure."""
    return [text.get_text() for text in figure.legends[0].get_texts()]
