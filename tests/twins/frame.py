"""The benchmark frame of Silva & Stojadinović 2024 (Table 1), assembled from beam elements, and its modes."""

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class FrameProperties:
    """Parameters of the simplified model: N modes of a frame on a rigid base that may lift off."""

    omega: Vector
    m_eff: Vector
    h_eff: Vector
    top_ordinate: Vector
    i_theta: float
    l0r: float
    m_tot: float
    half_width: float
    zeta: float

    def kwargs(self) -> dict[str, object]:
        return asdict(self)


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
) -> FrameProperties:
    """Modal parameters (definitions under Eq. 12); k is scaled to T_1, and B = h*_1 / aspect ratio."""
    height = story_height * np.arange(1.0, n_stories + 1.0)
    mass = np.full(n_stories, float(story_mass))
    square, shape = eigh(frame_stiffness(n_stories, story_height, stiffness_ratio), np.diag(mass))
    omega = np.sqrt(square / square[0]) * 2.0 * np.pi / period
    l_h, l_theta, norm = shape.T @ mass, shape.T @ (mass * height), (shape**2).T @ mass
    gamma, h_eff = l_h / norm, l_theta / l_h
    half_width = float(h_eff[0]) / aspect_ratio
    m_tot = float(mass.sum()) + base_mass
    keep = slice(n_modes)
    return FrameProperties(
        omega=omega[keep],
        m_eff=(gamma * l_h)[keep],
        h_eff=h_eff[keep],
        top_ordinate=(gamma * shape[-1])[keep],
        i_theta=float(mass @ height**2) + m_tot * half_width**2,
        l0r=float(mass @ height),
        m_tot=m_tot,
        half_width=half_width,
        zeta=damping_ratio,
    )
