"""The benchmark frame of Silva & Stojadinović 2024 (Table 1), assembled from beam elements, and its modes."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

Vector = NDArray[np.float64]


def frame_stiffness(n_stories: int, story_height: float, stiffness_ratio: float) -> Vector:
    """Lateral stiffness for EI_c = 1: two columns a story, one beam a floor, joint rotations condensed.

    Both joints of a floor turn alike, so a floor has one sway and one rotation. The beam, bent
    antisymmetrically, stores ½ (12 EI_b/L_b) φ², with EI_b/L_b = ρ · 2 EI_c/L_c.
    """
    n, L = n_stories, story_height
    sway_and_turn = np.zeros((2 * n, 2 * n))
    element = np.array(
        [[12, 6 * L, -12, 6 * L], [6 * L, 4 * L**2, -6 * L, 2 * L**2],
         [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L**2, -6 * L, 4 * L**2]]
    ) / L**3  # fmt: skip
    for story in range(n):
        # Unknowns of the element: sway and rotation below, sway and rotation above; -1 is the clamped foot.
        place = [story - 1, n + story - 1, story, n + story] if story else [-1, -1, story, n + story]
        free = [i for i, p in enumerate(place) if p >= 0]
        index = [place[i] for i in free]
        sway_and_turn[np.ix_(index, index)] += 2.0 * element[np.ix_(free, free)]
    lateral, cross, turn = sway_and_turn[:n, :n], sway_and_turn[:n, n:], sway_and_turn[n:, n:]
    if np.isinf(stiffness_ratio):
        return lateral
    turn = turn + np.eye(n) * 12.0 * stiffness_ratio * 2.0 / L
    return lateral - cross @ np.linalg.solve(turn, cross.T)


def frame_properties(
    *,
    n_stories: int,
    story_height: float,
    story_mass: float,
    base_mass: float,
    stiffness_ratio: float,
    period: float,
    aspect_ratio: float,
    damping_ratio: float,
    n_modes: int | None = None,
) -> dict[str, object]:
    """Modal parameters (definitions under Eq. 12), as the twins take them; k is scaled to T_1, B = h*_1/aspect."""
    height = story_height * np.arange(1.0, n_stories + 1.0)
    mass = np.full(n_stories, float(story_mass))
    square, shape = eigh(frame_stiffness(n_stories, story_height, stiffness_ratio), np.diag(mass))
    omega = np.sqrt(square / square[0]) * 2.0 * np.pi / period
    l_h, l_theta, norm = shape.T @ mass, shape.T @ (mass * height), (shape**2).T @ mass
    gamma, effective_height = l_h / norm, l_theta / l_h
    half_width = float(effective_height[0]) / aspect_ratio
    m_tot = float(mass.sum()) + base_mass
    keep = slice(n_modes)
    return {
        "omega": omega[keep],
        "effective_mass": (gamma * l_h)[keep],
        "effective_height": effective_height[keep],
        "top_ordinate": (gamma * shape[-1])[keep],
        "i_theta": float(mass @ height**2) + m_tot * half_width**2,
        "l0r": float(mass @ height),
        "m_tot": m_tot,
        "half_width": half_width,
        "zeta": damping_ratio,
    }
