"""Table 2: the formulas of the eight parameters, computed term by term from masses, heights and stiffness."""

import math

import numpy as np

import rockflex as rf
from rockflex._arrays import Array
from rockflex.papers.silva_stojadinovic_2024._number import check
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import frame_of
from rockflex.report import Result

TITLE = "Formulas of the eight parameters of 2DOF-S"
GRAVITY = 9.81


def reproduce(_: Records) -> Result:
    """Compare the sums of the table with the parameters of structure #1, and some with those of the chimney."""
    frame = frame_of("#1")
    p, damping = frame.rocking(), 0.02
    omega, shape = _first_mode(frame)
    height = frame.story_height * np.arange(1, frame.n_stories + 1)
    mass, b = np.full(frame.n_stories, frame.story_mass), p.half_width
    first, total = float(mass @ shape), float(mass @ shape**2)
    formulas = {
        "m*_1": (first**2 / total, p.effective_mass[0], "(Σ m_i φ_i1)²/Σ m_i φ_i1²"),
        "h*_1": (float(height @ (mass * shape)) / first, p.effective_height[0], "Σ h_i m_i φ_i1/Σ m_i φ_i1"),
        "Γ_1 φ_top,1": (first / total * shape[-1], p.top_ordinate[0], "Σ m_i φ_i1/Σ m_i φ_i1² times φ_N1"),
        "ω_1": (omega, p.omega[0], "det(k_s − ω² m_s) = 0"),
        "I_θ": (
            float(mass @ (height**2 + b**2)) + frame.base_mass * b**2, p.i_theta, "Σ m_i (h_i² + B²), i from 0",
        ),
        "L_0^r": (float(mass @ height), p.l0r, "Σ m_i h_i"),
        "M_r": ((float(mass.sum()) + frame.base_mass) * GRAVITY * b, p.resisting_moment, "m_tot g B"),
        "ζ": (damping, float(p.zeta[0]), "given"),
    }  # fmt: skip
    checks = [
        check(
            f"#1: {name}, formula over ours, less 1", "Table 2", formula, 1e9 * abs(value / ours - 1.0), "< 1", "10⁻⁹"
        )
        for name, (value, ours, formula) in formulas.items()
    ]
    note = (
        "The table has formulas and no numbers: that our parameters follow them is a check of the library, and nothing "
        "of the paper's is reproduced by it."
    )
    return Result("table-2", TITLE, note=note, checks=checks)


def _first_mode(frame: rf.Frame) -> tuple[float, Array]:
    """Return first frequency and shape of the shear building in closed form, sin((2i − 1)…); T_1 is given."""
    n = frame.n_stories
    turn = math.pi / (2 * n + 1)
    stiffness = frame.story_mass * (math.pi / (frame.period * math.sin(0.5 * turn))) ** 2
    omega = 2.0 * math.sqrt(stiffness / frame.story_mass) * math.sin(0.5 * turn)
    return omega, np.sin(turn * np.arange(1, n + 1))
