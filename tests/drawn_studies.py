"""Small studies to draw, and what is read from their figures."""

import numpy as np

import rockflex as rf
from builders import make_frame
from rockflex.plot._figures import BLACK, RED

SUITE = rf.load_suite("fema-p695-far-field")
FRAMES = {
    "#1": make_frame(),
    "#5": make_frame(aspect_ratio=5.0),
    "a$b": make_frame(stiffness_ratio=0.0, aspect_ratio=5.0),
}
MODELS = ["MDOF-S", "2DOF-S"]
COLORS = {"MDOF-S": BLACK, "2DOF-S": RED}


def lines(axes, label):
    return [line for line in axes.get_lines() if line.get_label() == label]


def points(lines):
    found = np.concatenate([np.column_stack(line.get_data()) for line in lines])
    return found[np.lexsort(found.T)]


def of(table, structure, model):
    return table[(table["structure"] == structure) & (table["model"] == model)]
