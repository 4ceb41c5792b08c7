"""Lagrange's equations of lumped masses on a rocking base, by SymPy, from the coordinates of the masses.

Source: Silva & Stojadinović 2024, Eqs. 3-10. All numbers are exact, so identities can be shown and not just sampled.
"""

from dataclasses import dataclass
from functools import cache

import sympy as sp

GROUND, GRAVITY = sp.symbols("a g")


def orthogonal(vectors: list[list[sp.Expr]], masses: sp.Matrix) -> sp.Matrix:
    """Columns made orthogonal with respect to the masses (Gram-Schmidt): any such columns are modes of some k_s."""
    diagonal, columns = sp.diag(*masses), []
    for vector in vectors:
        column = sp.Matrix(vector)
        for other in columns:
            column -= (other.T * diagonal * column)[0] / (other.T * diagonal * other)[0] * other
        columns.append(column.applyfunc(sp.cancel))
    return sp.Matrix.hstack(*columns)


@dataclass(frozen=True)
class Lumped:
    """N masses above a base; M_n, L_n^h, L_n^θ and Γ_n are those defined under Eq. 12."""

    masses: sp.Matrix
    heights: sp.Matrix
    shapes: sp.Matrix
    omega: tuple[sp.Rational, ...]
    base_mass: sp.Rational
    half_width: sp.Rational
    zeta: sp.Rational

    @property
    def n(self) -> int:
        return len(self.omega)

    @property
    def modal_mass(self) -> list[sp.Rational]:
        return list((self.shapes.T * sp.diag(*self.masses) * self.shapes).diagonal())

    @property
    def excitation(self) -> list[sp.Rational]:
        return list(self.shapes.T * self.masses)

    @property
    def tilt(self) -> list[sp.Rational]:
        return list(self.shapes.T * sp.diag(*self.masses) * self.heights)

    @property
    def participation(self) -> list[sp.Rational]:
        return [first / norm for first, norm in zip(self.excitation, self.modal_mass, strict=True)]

    def properties(self) -> dict[str, sp.Rational | list[sp.Rational]]:
        """The parameters of Table 2, by name."""
        gamma, first = self.participation, self.excitation
        m_tot = sum(self.masses) + self.base_mass
        horizontal = (self.heights.T * sp.diag(*self.masses) * self.heights)[0]
        return {
            "omega": list(self.omega),
            "effective_mass": [gamma[n] * first[n] for n in range(self.n)],
            "effective_height": [self.tilt[n] / first[n] for n in range(self.n)],
            "top_ordinate": [gamma[n] * self.shapes[self.n - 1, n] for n in range(self.n)],
            "i_theta": horizontal + m_tot * self.half_width**2,
            "l0r": (self.masses.T * self.heights)[0],
            "m_tot": m_tot,
            "half_width": self.half_width,
            "zeta": [self.zeta] * self.n,
            "translational_inertia": horizontal,
        }


@cache
def lumped(count: int) -> Lumped:
    """Two or three unequal masses, with modes that are nothing in particular."""
    masses = sp.Matrix([30, 20, 25][:count])
    rows = [[1, 3, 5], [2, -1, -1], [1, -2, 1]] if count == 3 else [[2, 5], [3, -1]]
    return Lumped(
        masses=masses,
        heights=sp.Matrix([3, 5, 9][:count]),
        shapes=orthogonal(rows, masses),
        omega=tuple(sp.Rational(x) for x in (4, 15, 31)[:count]),
        base_mass=sp.Rational(18),
        half_width=sp.Rational(7, 5),
        zeta=sp.Rational(3, 50),
    )


@dataclass(frozen=True)
class Motion:
    """Symbols of (θ, q_1, ..), of their rates and accelerations, and what follows from them.

    ``equations`` are zero in motion; ``forces`` are those of the ground on the base, across and upward.
    """

    x: list[sp.Symbol]
    rates: list[sp.Symbol]
    accelerations: list[sp.Symbol]
    equations: list[sp.Expr]
    forces: tuple[sp.Expr, sp.Expr]

    def numbers(self, expression: sp.Matrix):
        """A function of (x, rates, accelerations, a, g)."""
        return sp.lambdify([self.x, self.rates, self.accelerations, GROUND, GRAVITY], expression, modules="numpy")


@cache
def derived(count: int, side: int) -> Motion:
    """Write Lagrange's equations, and the sums of mass times acceleration."""
    s = lumped(count)
    x = list(sp.symbols(f"theta q1:{count + 1}"))
    rates = list(sp.symbols(f"theta_t q_t1:{count + 1}"))
    accelerations = list(sp.symbols(f"theta_tt q_tt1:{count + 1}"))

    def rate(f: sp.Expr) -> sp.Expr:
        return sum(sp.diff(f, p) * v + sp.diff(f, v) * w for p, v, w in zip(x, rates, accelerations, strict=True))

    sin, cos, shift = sp.sin(x[0]), sp.cos(x[0]), side * s.half_width
    u = [sp.Integer(0), *(s.shapes * sp.Matrix(x[1:]))]  # the base mass comes first, and has none
    masses, heights = [s.base_mass, *s.masses], [sp.Integer(0), *s.heights]
    across = [-shift * cos + h * sin + ui * cos for h, ui in zip(heights, u, strict=True)]  # Eq. 3
    upward = [shift * sin + h * cos - ui * sin for h, ui in zip(heights, u, strict=True)]

    diagonal, flexure = sp.diag(*s.masses), sp.Matrix(u[1:])
    weights = sp.diag(*(w**2 / m for w, m in zip(s.omega, s.modal_mass, strict=True)))
    stiffness = diagonal * s.shapes * weights * s.shapes.T * diagonal
    kinetic = sum(m * (rate(r) ** 2 + rate(z) ** 2) for m, r, z in zip(masses, across, upward, strict=True)) / 2
    potential = sum(m * (GRAVITY * z + GROUND * r) for m, r, z in zip(masses, across, upward, strict=True))
    lagrangian = sp.expand(kinetic - potential - (flexure.T * stiffness * flexure)[0] / 2)
    equations = [sp.diff(lagrangian, p) - rate(sp.diff(lagrangian, v)) for p, v in zip(x, rates, strict=True)]
    for n in range(count):  # Rayleigh's dissipation opposes the velocity: Eq. 10 is misprinted, Eq. 12 is not
        equations[1 + n] -= 2 * s.zeta * s.omega[n] * s.modal_mass[n] * rates[1 + n]
    forces = (
        sum(m * (GROUND + rate(rate(r))) for m, r in zip(masses, across, strict=True)),
        sum(m * (GRAVITY + rate(rate(z))) for m, z in zip(masses, upward, strict=True)),
    )
    return Motion(x, rates, accelerations, equations, forces)
