"""Intensity measures. A measure added here is available in files, commands, figures and the page."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from rockflex.foundation.checks import is_one_of
from rockflex.foundation.errors import InputError
from rockflex.foundation.registry import Catalogue
from rockflex.foundation.shown import shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._spectra import MIN_PERIOD


@dataclass(frozen=True)
class MeasureInput:
    """The input of an intensity measure: a motion and properties of the structure; unknown properties are NaN.

    Attributes
    ----------
    motion : GroundMotion
        The motion.
    omega, damping_ratio : float
        Circular frequency in rad/s and damping ratio of the first mode on a fixed base.
    lifting : float
        Acceleration in m/s² that lifts the base of the structure if it were rigid, g tan α = M_r/L_0^r.
    rate : float
        Frequency parameter p of the rocking structure in rad/s, p² = L_0^r g/I_θ.
    """

    motion: GroundMotion
    omega: float = math.nan
    damping_ratio: float = math.nan
    lifting: float = math.nan
    rate: float = math.nan

    @cached_property
    def sd(self) -> float:
        """Spectral displacement in m of the first mode; NaN if there is no mode."""
        return self.sd_at(self.damping_ratio)

    def sd_at(self, damping_ratio: float) -> float:
        """Spectral displacement in m at the period of the first mode and another damping; NaN if there is no mode."""
        if math.isnan(self.omega):
            return math.nan
        # Such a stiff structure moves with the ground; spectra have no shorter periods.
        stiff = self.period < MIN_PERIOD
        return self.motion.pga / self.omega**2 if stiff else self.motion.sd(self.period, damping_ratio)

    @property
    def period(self) -> float:
        """Period in s of the first mode; NaN if there is no mode."""
        return 2.0 * math.pi / self.omega

    @property
    def sa_avg(self) -> float:
        """Average spectral acceleration in m/s² around the first mode, at 5 % damping; NaN if there is no mode."""
        return math.nan if math.isnan(self.omega) else self.motion.sa_avg(self.period)

    @property
    def fiv3(self) -> float:
        """Filtered incremental velocity in m/s for the first mode; NaN if there is no mode."""
        return math.nan if math.isnan(self.omega) else self.motion.fiv3(self.period)


@dataclass(frozen=True, kw_only=True)
class IntensityMeasure:
    """An intensity measure: its names, its unit, and the function that computes it.

    Attributes
    ----------
    name : str
        Name in files, on the command line and in table columns.
    label : str
        Name shown to readers, such as ``"PGV"``.
    unit : str
        SI unit; empty if it has none.
    words : str
        Description, such as ``"peak ground velocity"``; empty if the label is clear enough.
    of : callable
        Computes it from a `MeasureInput`.
    of_what : {"motion", "vertical", "mode", "base"}
        What it depends on: only the horizontal motion, also the vertical one, also the first mode, or also the base.
        Measures of the vertical motion are NaN without one.
    power : {0, 1, 2}
        The measure is proportional to this power of the acceleration. Motions cannot be scaled to a measure of power 0.
    short : str
        Name for the headers of narrow columns, if shorter than the label.
    symbol : str
        Name in figures, as Matplotlib mathtext, if different from the label.
    """

    name: str
    label: str
    unit: str
    words: str = ""
    of: Callable[[MeasureInput], float]
    of_what: Literal["motion", "vertical", "mode", "base"] = "motion"
    power: Literal[0, 1, 2] = 1
    short: str = ""
    symbol: str = ""

    @property
    def title(self) -> str:
        """Label and description, for a selection list."""
        return f"{self.label}, {self.words}" if self.words not in ("", self.label) else self.label

    @property
    def head(self) -> str:
        """Header of a narrow column."""
        return self.short or self.label

    @property
    def sign(self) -> str:
        """Symbol in a figure."""
        return self.symbol or self.label

    @property
    def axis(self) -> str:
        """Name and unit for the axis of a figure; if the label is the description, the label rather than the symbol."""
        return self.with_unit(self.label if self.words == self.label else self.sign)

    def with_unit(self, name: str) -> str:
        """Return a name with the unit in brackets, if there is one."""
        return f"{name} [{self.unit}]" if self.unit else name

    def scaled(self, value: float, factor: float) -> float:
        """Return the value after multiplying the acceleration by a factor of either sign."""
        for _ in range(self.power):
            value *= abs(factor)
        return value

    def factor(self, value: float, level: float) -> float:
        """Return the factor on the acceleration that scales a value to a level; infinite or NaN if there is none."""
        if not value > 0.0 or not self.power:
            return math.inf
        return math.sqrt(level / value) if self.power == 2 else level / value


_ALL = (
    IntensityMeasure(name="pga", label="PGA", unit="m/s²", words="peak ground acceleration", of=lambda s: s.motion.pga),
    IntensityMeasure(name="pgv", label="PGV", unit="m/s", words="peak ground velocity", of=lambda s: s.motion.pgv),
    IntensityMeasure(name="pgd", label="PGD", unit="m", words="peak ground displacement", of=lambda s: s.motion.pgd),
    IntensityMeasure(
        name="arias",
        label="Arias intensity",
        unit="m/s",
        words="Arias intensity",
        of=lambda s: s.motion.arias,
        power=2,
        short="Arias",
        symbol="$I_a$",
    ),
    IntensityMeasure(
        name="cav", label="CAV", unit="m/s", words="cumulative absolute velocity", of=lambda s: s.motion.cav
    ),
    IntensityMeasure(
        name="d5_95",
        label="D₅₋₉₅",
        unit="s",
        words="duration between 5 % and 95 % of Arias",
        of=lambda s: s.motion.d5_95,
        power=0,
        symbol="$D_{5–95}$",
    ),
    IntensityMeasure(
        name="pva",
        label="PVA",
        unit="m/s²",
        words="peak vertical acceleration",
        of=lambda s: s.motion.pva,
        of_what="vertical",
    ),
    IntensityMeasure(
        name="pva_pga",
        label="PVA/PGA",
        unit="",
        of=lambda s: s.motion.pva / s.motion.pga if s.motion.pga else math.nan,
        of_what="vertical",
        power=0,
    ),
    IntensityMeasure(
        name="sd_t1",
        label="Sd(T₁, ζ₁)",
        unit="m",
        words="spectral displacement at the structure's damping",
        of=lambda s: s.sd,
        of_what="mode",
        symbol="$S_d(T_1,ζ_1)$",
    ),
    IntensityMeasure(
        name="sa_t1",
        label="Sa(T₁, ζ₁)",
        unit="m/s²",
        words="spectral acceleration at the structure's damping",
        of=lambda s: s.omega**2 * s.sd,
        of_what="mode",
        symbol="$S_a(T_1,ζ_1)$",
    ),
    IntensityMeasure(
        name="sa_t1_5",
        label="Sa(T₁, 5 %)",
        unit="m/s²",
        words="spectral acceleration at 5 % damping, as in hazard curves",
        of=lambda s: s.omega**2 * s.sd_at(0.05),
        of_what="mode",
        symbol=r"$S_a(T_1,5\,\%)$",
    ),
    IntensityMeasure(
        name="sa_avg",
        label="Sa,avg(T₁)",
        unit="m/s²",
        words="spectral acceleration averaged from 0.2 T₁ to 3 T₁, at 5 % damping",
        of=lambda s: s.sa_avg,
        of_what="mode",
        symbol=r"$S_{a,\mathrm{avg}}(T_1)$",
    ),
    IntensityMeasure(
        name="fiv3",
        label="FIV3(T₁)",
        unit="m/s",
        words="filtered incremental velocity",
        of=lambda s: s.fiv3,
        of_what="mode",
        symbol="FIV3$(T_1)$",
    ),
    IntensityMeasure(
        name="relative_pga",
        label="PGA/(g tan α)",
        unit="",
        of=lambda s: s.motion.pga / s.lifting,
        of_what="base",
        symbol=r"PGA/($g\,\tan α$)",
    ),
    IntensityMeasure(
        name="relative_pgv",
        label="p PGV/(g tan α)",
        unit="",
        of=lambda s: s.rate * s.motion.pgv / s.lifting,
        of_what="base",
        symbol=r"$p$ PGV/($g\,\tan α$)",
    ),
)

MEASURES = Catalogue[IntensityMeasure](_ALL, "measures")
"""Every measure by its name, in the order of table columns."""


def scalable_measures() -> list[IntensityMeasure]:
    """Return the measures that a motion can be scaled to."""
    return [each for each in MEASURES.values() if each.power]


def record_measures() -> list[IntensityMeasure]:
    """Return the measures that depend only on the horizontal motion, not on a structure."""
    return [each for each in MEASURES.values() if each.of_what == "motion"]


def vertical_measures() -> list[IntensityMeasure]:
    """Return the measures of the vertical motion; they are NaN without one."""
    return [each for each in MEASURES.values() if each.of_what == "vertical"]


def scalable_measure(name: str) -> IntensityMeasure:
    """Return the measure of this name that a motion can be scaled to."""
    names = [each.name for each in scalable_measures()]
    if not is_one_of(name, names):
        raise InputError(f"measure must be one of {', '.join(names)}, but {shown(name)} was given.")
    return MEASURES[name]
