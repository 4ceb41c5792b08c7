"""The Bouc-Wen hysteresis of a one-mode superstructure (Silva & Stojadinović 2024, Eqs. 37-38)."""

from dataclasses import dataclass

from rockflex.foundation.checks import checked_finite, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown


@dataclass(frozen=True)
class BoucWen:
    """A yielding superstructure: ω² [α D + D_y (1 - α) z] replaces ω² D.

    z' = (D' - γ |D'| z |z|^(n-1) - β D' |z|^n) / D_y, both in contact and while rocking.

    Parameters
    ----------
    yield_displacement
        Yield displacement D_y of the first modal coordinate D_1 in m, positive; Γ_1 φ_top,1 D_y at the top.
    post_yield_ratio
        α, ratio of the post-yield to the elastic stiffness, in [0, 1).
    gamma, beta
        Shape of the hysteresis, -γ < β ≤ γ: |z| stays below (γ + β)^(-1/n), and no loop generates energy.
    exponent
        n, at least 1; a larger value gives a sharper transition to yielding.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0, damping_ratio=0.02
    ... )
    >>> law = rf.BoucWen(yield_displacement=0.02)
    >>> response = rf.simulate(column, rf.one_sine_pulse(3.0, 1.0), "2DOF-S", bouc_wen=law)
    >>> response.model
    '2DOF-S-BW'
    """

    yield_displacement: float
    post_yield_ratio: float = 0.01
    gamma: float = 0.5
    beta: float = 0.5
    exponent: float = 8.0

    def __post_init__(self) -> None:
        values = {
            "yield_displacement": checked_positive("yield_displacement", self.yield_displacement, "m"),
            "post_yield_ratio": checked_finite("post_yield_ratio", self.post_yield_ratio, ""),
            "gamma": checked_finite("gamma", self.gamma, ""),
            "beta": checked_finite("beta", self.beta, ""),
            "exponent": checked_finite("exponent", self.exponent, ""),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        if not 0.0 <= self.post_yield_ratio < 1.0:
            raise InputError(
                f"post_yield_ratio must lie in [0, 1), but {shown(self.post_yield_ratio)} was given. "
                "It is the ratio of the post-yield to the elastic stiffness; for an elastic structure leave bouc_wen "
                "out.",
                field="post_yield_ratio",
            )
        if self.exponent < 1.0:
            raise InputError(
                f"exponent must be at least 1, but {shown(self.exponent)} was given. 8 gives a sharp yield, 1 a "
                "gradual one.",
                field="exponent",
            )
        if not (self.gamma > 0.0 and abs(self.beta) <= self.gamma and self.gamma + self.beta > 0.0):
            raise InputError(
                f"gamma must be positive and -gamma < beta <= gamma, but gamma={shown(self.gamma)} and "
                f"beta={shown(self.beta)} were given: the spring would return more energy than it absorbs. The "
                "paper uses 0.5 for both.",
                field="gamma",
            )
