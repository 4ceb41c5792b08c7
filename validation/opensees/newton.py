"""The first excursion by Newton's law for each mass, in large rotations: the effect omitted by MDOF-C but not OpenSees.

A column that cannot stretch lowers its floor as it leans, z_i = Σ (L² − Δ_j²)^½ above the base with the drifts Δ_j, so
floors also move vertically. In the complete model (Silva & Stojadinović 2024, Eq. 3) floors move parallel to the base.
"""

import numpy as np
from frames import BASE_MASS, GRAVITY, HEIGHTS, N_STORIES, STORY_HEIGHT, STORY_MASS, Prototype
from numpy.typing import NDArray
from references import Reference
from scipy.integrate import solve_ivp

import rockflex as rf

Float = NDArray[np.float64]

MASSES = np.concatenate([[BASE_MASS], np.full(N_STORIES, STORY_MASS)])
DRIFTS = np.eye(N_STORIES) - np.eye(N_STORIES, k=-1)


def by_newton(prototype: Prototype, shaking: rf.GroundMotion, *, shortening: bool) -> Reference:
    """First excursion without damping, with columns that shorten as they lean, or as in MDOF-C.

    Without shortening the columns are softened by their P/L, as MDOF-C's are in the comparison.
    """
    structure = prototype.structure(second_order=not shortening)
    stiffness, width = np.array(structure.stiffness), structure.half_width
    sampled = np.arange(shaking.acceleration.size) * shaking.dt
    n = N_STORIES

    def rates(t: float, y: Float, side: float, *, held: bool) -> Float:
        u, rate, theta, spin = y[:n], y[n : 2 * n], y[-2], y[-1]
        # In the frame of the base, pivot at the origin: x along the base, z across it; one row per mass, base first.
        x = np.concatenate([[0.0], u]) - side * width
        along = np.concatenate([np.zeros((1, n)), np.eye(n)])
        z, across, bent = np.concatenate([[0.0], HEIGHTS]), np.zeros((n + 1, n)), np.zeros(n + 1)
        if shortening:
            drift, drift_rate = DRIFTS @ u, DRIFTS @ rate
            chord = np.sqrt(STORY_HEIGHT**2 - drift**2)
            z[1:] = np.cumsum(chord)
            across[1:] = np.cumsum(-(drift / chord)[:, None] * DRIFTS, axis=0)
            bent[1:] = np.cumsum(-(STORY_HEIGHT**2) / chord**3 * drift_rate**2)
        moving = (along @ rate, across @ rate)
        ground = float(np.interp(t, sampled, shaking.acceleration))
        cosine, sine = np.cos(theta), np.sin(theta)
        pull = (
            -ground * cosine + GRAVITY * sine - 2.0 * spin * moving[1] + spin**2 * x,
            -ground * sine - GRAVITY * cosine - bent + 2.0 * spin * moving[0] + spin**2 * z,
        )
        jacobian = (np.column_stack([along, z]), np.column_stack([across, -x]))
        mass = sum(part.T @ (MASSES[:, None] * part) for part in jacobian)
        force = sum(part.T @ (MASSES * acting) for part, acting in zip(jacobian, pull, strict=True))
        force[:n] -= stiffness @ u
        if held:
            return np.concatenate([rate, np.linalg.solve(mass[:n, :n], force[:n]), [0.0, 0.0]])
        found = np.linalg.solve(mass, force)
        return np.concatenate([rate, found[:n], [spin, found[n]]])

    def upward(t: float, y: Float, side: float) -> float:
        return side * float(rates(t, y, side, held=False)[-1])

    def lifts(t: float, y: Float) -> float:
        # The base uplifts when, if released, it would rotate upwards about one of its corners.
        return max(upward(t, y, 1.0), upward(t, y, -1.0))

    given = {"method": "DOP853", "rtol": 1e-9, "atol": 1e-12, "max_step": shaking.dt}
    lifts.terminal = True
    contact = solve_ivp(
        lambda t, y: rates(t, y, 0.0, held=True), (0.0, sampled[-1]), np.zeros(2 * n + 2), events=lifts, **given
    )
    lift, state = float(contact.t[-1]), contact.y[:, -1]
    side = 1.0 if upward(lift, state, 1.0) > upward(lift, state, -1.0) else -1.0

    def lands(t: float, y: Float) -> float:
        return side * y[-2] if t > lift + 0.01 else 1.0

    lands.terminal = True
    rocking = solve_ivp(
        lambda t, y: rates(t, y, side, held=False), (lift, sampled[-1]), state, events=lands, dense_output=True, **given
    )

    def motion(at: Float) -> tuple[Float, Float]:
        y = rocking.sol(at)
        return y[-2], y[n - 1]

    return Reference(lift, float(rocking.t[-1]), motion)
