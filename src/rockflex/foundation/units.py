"""Systems of units in which tables and reports show values; inputs, results and files for programs are in SI units."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal, NamedTuple, get_args

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.number_format import rounded_number
from rockflex.foundation.shown import shown

SystemName = Literal["kN", "MN", "SI", "kip-in"]
Decimal = Literal[".", ","]

_LBF, _INCH = 4.4482216152605, 0.0254  # N, m: by definition
_SIZES: Mapping[str, float] = {
    "m": 1.0, "mm": 1e-3, "in": _INCH, "kg": 1.0, "t": 1e3, "s": 1.0, "rad": 1.0, "mrad": 1e-3, "%": 0.01, "g": GRAVITY,
    "N": 1.0, "kN": 1e3, "MN": 1e6, "kip": 1e3 * _LBF, "J": 1.0, "kJ": 1e3, "MJ": 1e6,
    "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "ksi": 1e3 * _LBF / _INCH**2,
}  # fmt: skip
_POWERS = {"²": 2, "³": 3, "⁴": 4}

QUANTITIES: Mapping[str, tuple[str, str, str, str]] = {
    "force": ("kN", "MN", "N", "kip"),
    "moment": ("kN m", "MN m", "N m", "kip in"),
    "displacement": ("mm", "mm", "m", "in"),
    "length": ("m", "m", "m", "in"),
    "rotation": ("mrad", "mrad", "rad", "rad"),
    "velocity": ("m/s", "m/s", "m/s", "in/s"),
    "acceleration": ("g", "g", "m/s²", "g"),
    "mass": ("t", "t", "kg", "kip s²/in"),
    "first moment of mass": ("t m", "t m", "kg m", "kip s²"),
    "inertia": ("t m²", "t m²", "kg m²", "kip s² in"),
    "mass per length": ("t/m", "t/m", "kg/m", "kip s²/in²"),
    "density": ("kg/m³", "kg/m³", "kg/m³", "kip s²/in⁴"),
    "stress": ("kPa", "MPa", "Pa", "ksi"),
    "elastic modulus": ("GPa", "GPa", "Pa", "ksi"),
    "shear modulus": ("MPa", "MPa", "Pa", "ksi"),
    "stiffness": ("MN/m", "MN/m", "N/m", "kip/in"),
    "rotational stiffness": ("MN m/rad", "MN m/rad", "N m/rad", "kip in/rad"),
    "subgrade modulus": ("MN/m³", "MN/m³", "N/m³", "kip/in³"),
    "damping": ("kN s/m", "MN s/m", "N s/m", "kip s/in"),
    "area": ("m²", "m²", "m²", "in²"),
    "second moment of area": ("m⁴", "m⁴", "m⁴", "in⁴"),
    "bending stiffness": ("MN m²", "MN m²", "N m²", "kip in²"),
    "energy": ("kJ", "MJ", "J", "kip in"),
    "time": ("s", "s", "s", "s"),
    "share": ("%", "%", "%", "%"),
    "ratio": ("", "", "", ""),
}
"""The kinds of quantities, each with its unit in every system."""


class Unit(NamedTuple):
    """A unit: its size in SI units, by which values are divided, and its name."""

    size: float
    name: str

    def heading(self, symbol: str) -> str:
        """Return the heading of a column: "M_b [kN m]"."""
        return f"{symbol} [{self.name}]" if self.name else symbol


@cache
def named_unit(name: str) -> Unit:
    """Return the unit of a name such as "kip s²/in": factors, and after "/" divisors."""
    above, _, below = name.partition("/")
    return Unit(_product_of_sizes(above) / _product_of_sizes(below), name)


def _product_of_sizes(factors: str) -> float:
    return math.prod(_SIZES[factor.rstrip("²³⁴")] ** _POWERS.get(factor[-1], 1) for factor in factors.split())


@dataclass(frozen=True)
class UnitSystem:
    """A system of units: "kN" (kN, mm and m, t, g), "MN" (MN, mm and m, t, g), "SI" (N, m, kg, m/s²) or "kip-in"."""

    name: SystemName = "kN"

    def of(self, quantity: str, usual: str = "", *, largest: float = 0.0) -> Unit:
        """Return the unit of a kind of quantity.

        Where a table of the system "kN" has another unit for it, that is `usual`; moments of which the `largest` in N m
        has more than 10 MN m are in MN m there.
        """
        if self.name != "kN":
            return named_unit(QUANTITIES[quantity][get_args(SystemName).index(self.name)])
        if quantity == "moment" and largest >= 1e7:
            return named_unit("MN m")
        return named_unit(usual or QUANTITIES[quantity][0])

    def text(self, value: float, quantity: str, usual: str = "") -> str:
        """Return a value in SI units with three digits, and its unit."""
        size, name = self.of(quantity, usual)
        return f"{rounded_number(value / size)} {name}"


KN = UnitSystem()


def checked_unit_system(name: object, field: str = "units") -> UnitSystem:
    """Return the system of units of a name.

    Raises
    ------
    InputError
        If there is no such system.
    """
    if not isinstance(name, str) or name not in get_args(SystemName):
        words = ", ".join(map(repr, get_args(SystemName)))
        raise InputError(f"{field} must be one of {words}, but {shown(name)} was given.", field=field)
    return UnitSystem(name)  # pyright: ignore[reportArgumentType]


# Not in names and versions such as 2.1.3 or RSN6_1.5, nor in references to sections and equations in any language.
_REFERENCES = "".join(f"(?<!{word} )" for word in (r"Eq\.", "[Ss]ection", "Abschnitt", "Sezione", "sección"))
_DECIMAL_POINT = re.compile(rf"(?<![\w.]){_REFERENCES}(\d[\d\u202f]*)\.(?=\d+(?:e[+\-−]?\d+)?(?!\.?\w))")


def with_decimal_commas(text: str) -> str:
    """Write the numbers in a text with decimal commas."""
    return _DECIMAL_POINT.sub(r"\1,", text)
