"""The intensity measures. A measure added here is available everywhere: in files, commands, figures and the page."""

import math

from rockflex._checks import one_of
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._measure import Measure

_ALL = (
    Measure(name="pga", label="PGA", unit="m/s²", words="peak ground acceleration", of=lambda s: s.motion.pga),
    Measure(name="pgv", label="PGV", unit="m/s", words="peak ground velocity", of=lambda s: s.motion.pgv),
    Measure(name="pgd", label="PGD", unit="m", words="peak ground displacement", of=lambda s: s.motion.pgd),
    Measure(
        name="arias",
        label="Arias intensity",
        unit="m/s",
        words="Arias intensity",
        of=lambda s: s.motion.arias,
        power=2,
        short="Arias",
        symbol="$I_a$",
    ),
    Measure(name="cav", label="CAV", unit="m/s", words="cumulative absolute velocity", of=lambda s: s.motion.cav),
    Measure(
        name="d5_95",
        label="D₅₋₉₅",
        unit="s",
        words="duration between 5 % and 95 % of Arias",
        of=lambda s: s.motion.d5_95,
        power=0,
        symbol="$D_{5–95}$",
    ),
    Measure(
        name="pva",
        label="PVA",
        unit="m/s²",
        words="peak vertical acceleration",
        of=lambda s: s.motion.pva,
        of_what="vertical",
    ),
    Measure(
        name="pva_pga",
        label="PVA/PGA",
        unit="",
        of=lambda s: s.motion.pva / s.motion.pga if s.motion.pga else math.nan,
        of_what="vertical",
        power=0,
    ),
    Measure(
        name="sd_t1",
        label="Sd(T₁, ζ₁)",
        unit="m",
        words="spectral displacement at the structure's damping",
        of=lambda s: s.sd,
        of_what="mode",
        symbol="$S_d(T_1,ζ_1)$",
    ),
    Measure(
        name="sa_t1",
        label="Sa(T₁, ζ₁)",
        unit="m/s²",
        words="spectral acceleration at the structure's damping",
        of=lambda s: s.omega**2 * s.sd,
        of_what="mode",
        symbol="$S_a(T_1,ζ_1)$",
    ),
    Measure(
        name="sa_t1_5",
        label="Sa(T₁, 5 %)",
        unit="m/s²",
        words="spectral acceleration at 5 % damping, as in hazard curves",
        of=lambda s: s.omega**2 * s.sd_at(0.05),
        of_what="mode",
        symbol=r"$S_a(T_1,5\,\%)$",
    ),
    Measure(
        name="relative_pga",
        label="PGA/(g tan α)",
        unit="",
        of=lambda s: s.motion.pga / s.lifting,
        of_what="base",
        symbol=r"PGA/($g\,\tan α$)",
    ),
    Measure(
        name="relative_pgv",
        label="p PGV/(g tan α)",
        unit="",
        of=lambda s: s.rate * s.motion.pgv / s.lifting,
        of_what="base",
        symbol=r"$p$ PGV/($g\,\tan α$)",
    ),
)

MEASURES: dict[str, Measure] = {each.name: each for each in _ALL}
"""Every measure by its name, in the order of table columns."""


def intensities() -> list[Measure]:
    """Return the measures that a motion can be scaled to."""
    return [each for each in MEASURES.values() if each.power]


def record_measures() -> list[Measure]:
    """Return the measures that depend only on the horizontal motion, not on a structure."""
    return [each for each in MEASURES.values() if each.of_what == "motion"]


def vertical_measures() -> list[Measure]:
    """Return the measures of the vertical motion; they are NaN without one."""
    return [each for each in MEASURES.values() if each.of_what == "vertical"]


def intensity(name: str) -> Measure:
    """Return the measure of this name that a motion can be scaled to.

    Raises
    ------
    InputError
        If there is no such measure.
    """
    names = [each.name for each in intensities()]
    if not one_of(name, names):
        raise InputError(f"measure must be one of {', '.join(names)}, but {shown(name)} was given.")
    return MEASURES[name]
