"""What is said where the numbers of a model overflow."""

from contextlib import AbstractContextManager

from rockflex._computable import computable
from rockflex.models import RockingModel


def preparing(model: RockingModel) -> AbstractContextManager[None]:
    """Report arithmetic failures during the preparation of an engine in terms of the parameters of the model."""
    return computable(lambda: _described(model))


def _described(model: RockingModel) -> str:
    p = model.properties
    modes = f"omega from {p.omega.min():.3g} to {p.omega.max():.3g} rad/s, " if p.n_modes else ""
    return (
        f"The motion of {model.label} with {modes}i_theta = {p.i_theta:.3g} kg m², l0r = {p.l0r:.3g} kg m, "
        f"m_tot = {p.m_tot:.3g} kg and half_width = {p.half_width:.3g} m"
    )
