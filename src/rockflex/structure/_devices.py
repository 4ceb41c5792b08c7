"""Tendons and fuses from their geometry: strands and steel bars by their standards, U-shaped flexural plates."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, SupportsIndex, TypedDict, TypeVar, Unpack

from rockflex.foundation.checks import checked_in_range, checked_positive, is_one_of
from rockflex.foundation.descriptions import PLAIN, Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._attachment import Between, Cosine, Position, TieHeight
from rockflex.structure._elements import PostYieldRatio, Tendon, TendonYieldRatio, YieldingDissipator

_MOST = 10_000  # strands, bars or plates of an element
T = TypeVar("T")


class Place(TypedDict, total=False):
    """Where an element acts: the arguments of the same names of `Attachment`, and its position."""

    position: Position
    between: Between
    cosine: Cosine
    height: TieHeight


def _check_ultimate_strain(strain: float, yields: float) -> None:
    if not yields < strain < 1.0:
        raise InputError(
            f"ultimate_strain must be beyond the strain at yield, {yields:.4g}, and below 1, but {strain:g} was "
            "given. 5 % is 0.05.",
            field="ultimate_strain",
        )


@dataclass(frozen=True)
class Strand:
    """A seven-wire prestressing strand, by the values that its standard guarantees.

    Attributes
    ----------
    area : float
        Nominal area of the steel in m².
    breaking_force : float
        Characteristic or specified breaking force F_pk in N.
    yield_force : float
        Force in N at 0.1 % of permanent elongation, F_p0,1k (EN), or at 1 % of extension (ASTM).
    modulus : float
        E in N/m²: of EN 1992-1-1, 3.3.6(3), or AASHTO LRFD 5.4.4.2.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> from rockflex.structure import STRANDS
    >>> STRANDS["Y1860S7-15.7"] == rf.Strand(150e-6, breaking_force=279e3,
    ...     yield_force=246e3, modulus=195e9)
    True
    """

    area: float
    breaking_force: float
    yield_force: float
    modulus: float

    def __post_init__(self) -> None:
        for name, unit in (("area", "m²"), ("breaking_force", "N"), ("yield_force", "N"), ("modulus", "N/m²")):
            vars(self)[name] = checked_positive(name, getattr(self, name), unit)
        if self.yield_force > self.breaking_force:
            raise InputError(
                f"yield_force must not exceed breaking_force, {self.breaking_force:g} N, but {self.yield_force:g} N "
                "was given.",
                field="yield_force",
            )


STRANDS: dict[str, Strand] = {
    "Y1860S7-12.5": Strand(93e-6, 173e3, 152e3, 195e9),
    "Y1860S7-12.9": Strand(100e-6, 186e3, 164e3, 195e9),
    "Y1860S7-15.3": Strand(140e-6, 260e3, 229e3, 195e9),
    "Y1860S7-15.7": Strand(150e-6, 279e3, 246e3, 195e9),
    "A416-270-0.5in": Strand(98.7e-6, 183.7e3, 165.3e3, 196.5e9),
    "A416-270-0.6in": Strand(140e-6, 260.7e3, 234.6e3, 196.5e9),
}
"""Strands by name: prEN 10138-3 (2006), nominal diameter in mm; ASTM A416/A416M, low relaxation, Grade 270 [1860].

Compared with data sheets of makers of post-tensioning systems, which quote these standards, not with the standards.
"""


@dataclass(frozen=True)
class Steel:
    """A steel that yields, by the least values of its standard.

    Attributes
    ----------
    yield_strength, tensile_strength : float
        f_y and f_u in N/m².
    ultimate_strain : float
        ε_u, at which f_u is reached and a fuse is taken to break.
    modulus : float
        E in N/m².

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> tested = rf.Steel(330e6, tensile_strength=460e6, ultimate_strain=0.2,
    ...     modulus=205e9)
    >>> round(rf.bar_fuse(1, diameter=0.02, length=0.5, steel=tested).yield_force)
    103673
    """

    yield_strength: float
    tensile_strength: float
    ultimate_strain: float
    modulus: float

    def __post_init__(self) -> None:
        for name in ("yield_strength", "tensile_strength", "modulus"):
            vars(self)[name] = checked_positive(name, getattr(self, name), "N/m²")
        yields = self.yield_strength / self.modulus
        vars(self)["ultimate_strain"] = checked_positive("ultimate_strain", self.ultimate_strain, "")
        _check_ultimate_strain(self.ultimate_strain, yields)
        if not 0.0 <= self.post_yield_ratio < 1.0:
            raise InputError(
                f"tensile_strength must be from yield_strength, {self.yield_strength:g} N/m², to below the elastic "
                f"line, but {self.tensile_strength:g} N/m² was given.",
                field="tensile_strength",
            )

    @property
    def post_yield_ratio(self) -> float:
        """Slope from (f_y/E, f_y) to (ε_u, f_u) over E."""
        plastic = self.ultimate_strain - self.yield_strength / self.modulus
        return (self.tensile_strength - self.yield_strength) / (plastic * self.modulus)


def _structural_steel(yield_strength: float, tensile_strength: float) -> Steel:
    return Steel(yield_strength, tensile_strength, 0.6 * (1.0 - yield_strength / tensile_strength), 210e9)


STEELS: dict[str, Steel] = {
    "B500B": Steel(500e6, 540e6, 0.05, 200e9),
    "B500C": Steel(500e6, 575e6, 0.075, 200e9),
    "300E": Steel(300e6, 345e6, 0.15, 200e9),
    "500E": Steel(500e6, 575e6, 0.10, 200e9),
    "A706-60": Steel(414e6, 552e6, 0.09, 200e9),
    "S235": _structural_steel(235e6, 360e6),
    "S275": _structural_steel(275e6, 430e6),
    "S355": _structural_steel(355e6, 490e6),
}
"""Steels by name.

B500B, B500C: EN 1992-1-1, Table C.1. 300E, 500E: AS/NZS 4671, Table 2. A706-60: ASTM A706 Grade 60, with the reduced
ultimate strain of Caltrans' Seismic Design Criteria for bars up to No. 10. S235 to S355: EN 1993-1-1, Table 3.1, up to
40 mm, with ε_u = 0.6 (1 - f_y/f_u) (Yun & Gardner 2017, doi 10.1016/j.jcsr.2017.01.024). Not checked against the texts
of these standards.
"""


def _names(catalogue: Mapping[str, Any]) -> str:
    return ", ".join(f'"{name}"' for name in catalogue)


SteelOrName = Annotated[
    str | Steel,
    Described(
        f"a steel: {_names(STEELS)}",
        form=PLAIN,
        in_file=Literal[tuple(STEELS)],
        note="A name in `STEELS`, or a `Steel`, with mean values for instance.",
    ),
]


@described(title="Tendon of strands")
def strand_tendon(
    n: Annotated[SupportsIndex, Described("the number of strands", rule="whole", within=(1, _MOST), low=1, high=_MOST)],
    strand: Annotated[
        str | Strand,
        Described(
            f"a strand: {_names(STRANDS)}",
            form=PLAIN,
            in_file=Literal[tuple(STRANDS)],
            note="A name in `STRANDS`, or a `Strand`.",
        ),
    ],
    length: Annotated[float, Described("the free length", "m", rule="positive", note="L, between the anchorages.")],
    prestress: Annotated[
        float,
        Described(
            "the force at rest over the breaking force",
            low=0.0,
            high=0.9,
            note="p, after all losses; from 0 to F_p0,1k/F_pk.",
        ),
    ],
    *,
    post_yield_ratio: TendonYieldRatio = None,
    ultimate_strain: Annotated[
        float | None,
        Described(
            "the strain at which a tendon that yields breaks",
            rule="positive",
            note="With that of the prestress. Strands alone reach 3.5 % (EN 10138-3, ASTM A416), in wedges less. "
            "Default: it never breaks.",
        ),
    ] = None,
    **place: Unpack[Place],
) -> Tendon:
    """Return a tendon of seven-wire strands: k = n E A/L, F_0 = n p F_pk, F_y = n F_p0,1k.

    Raises
    ------
    InputError
        If a value is outside its range, or the strand is not known.

    Examples
    --------
    >>> import rockflex as rf
    >>> tendon = rf.strand_tendon(12, "Y1860S7-15.7", length=15.0, prestress=0.5)
    >>> tendon.initial_force, round(tendon.stiffness), tendon.yield_force
    (1674000.0, 23400000, 2952000.0)
    """
    count, one, L = int(n), _named("strand", strand, Strand, STRANDS), length
    most = one.yield_force / one.breaking_force
    p = checked_in_range(
        "prestress", prestress, 0.0, most, closed=True, hint="It is a share of F_pk; the end is F_p0,1k/F_pk."
    )
    rupture, axial = None, one.area * one.modulus
    if ultimate_strain is not None:
        if post_yield_ratio is None:
            raise InputError(
                "ultimate_strain is for a tendon that yields. Give post_yield_ratio as well, or leave it out.",
                field="ultimate_strain",
            )
        _check_ultimate_strain(ultimate_strain, one.yield_force / axial)
        rupture = (ultimate_strain - p * one.breaking_force / axial) * L
    return Tendon(
        p * count * one.breaking_force,
        count * one.modulus * one.area / L,
        yield_force=count * one.yield_force,
        post_yield_ratio=post_yield_ratio,
        rupture_elongation=rupture,
        **dict[str, Any](place),
    )


@described(title="Fuse of steel bars")
def bar_fuse(
    n: Annotated[SupportsIndex, Described("the number of bars", rule="whole", within=(1, _MOST), low=1, high=_MOST)],
    diameter: Annotated[
        float, Described("the diameter of a bar where it yields", "m", rule="positive", note="d, below the length.")
    ],
    length: Annotated[
        float, Described("the length that yields", "m", rule="positive", note="L, turned down or unbonded.")
    ],
    steel: SteelOrName,
    *,
    tension_only: Annotated[
        bool,
        Described(
            "whether the bars cannot push",
            rule="flag",
            note="They buckle, or are unhooked. Default: they are restrained, as in a grouted tube.",
        ),
    ] = False,
    ultimate_strain: Annotated[
        float | None,
        Described(
            "the strain at which the bars break (default: that of the steel)",
            rule="positive",
            note="Many cycles break them earlier.",
        ),
    ] = None,
    **place: Unpack[Place],
) -> YieldingDissipator:
    """Return a fuse of round bars of mild steel: k = n E A/L, F_y = n f_y A, with A = π d²/4.

    It hardens along the line from yielding to (ε_u, f_u), and breaks at the elongation ε_u L.

    Raises
    ------
    InputError
        If a value is outside its range, or the steel is not known.

    Examples
    --------
    >>> import rockflex as rf
    >>> fuse = rf.bar_fuse(2, diameter=0.02, length=0.5, steel="B500B",
    ...     position=0.8)
    >>> round(fuse.yield_force), round(fuse.stiffness), round(
    ...     fuse.post_yield_ratio, 4), fuse.rupture_elongation
    (314159, 251327412, 0.0042, 0.025)
    """
    count, metal, d, L = int(n), _named("steel", steel, Steel, STEELS), diameter, length
    if not d < L:
        raise InputError(
            f"diameter must be below the length, {L:g} m, but {shown(diameter)} was given. Both are in m.",
            field="diameter",
        )
    area = count * math.pi / 4.0 * d**2
    yields, breaks = metal.yield_strength / metal.modulus, metal.ultimate_strain
    if ultimate_strain is not None:
        _check_ultimate_strain(ultimate_strain, yields)
        breaks = ultimate_strain
    return YieldingDissipator(
        metal.modulus * area / L,
        metal.yield_strength * area,
        metal.post_yield_ratio,
        tension_only=tension_only,
        rupture_elongation=breaks * L,
        **dict[str, Any](place),
    )


@described(title="U-shaped flexural plates")
def u_plate_fuse(
    n: Annotated[SupportsIndex, Described("the number of plates", rule="whole", within=(1, _MOST), low=1, high=_MOST)],
    width: Annotated[float, Described("the width of a plate", "m", rule="positive", note="b.")],
    thickness: Annotated[
        float, Described("the thickness of a plate", "m", rule="positive", note="t, below the diameter.")
    ],
    diameter: Annotated[
        float,
        Described("the diameter of the bend, between the middles of the legs", "m", rule="positive", note="D."),
    ],
    steel: SteelOrName,
    *,
    post_yield_ratio: PostYieldRatio = 0.0,
    **place: Unpack[Place],
) -> YieldingDissipator:
    """Return U-shaped flexural plates, which roll between two surfaces that move along each other.

    Kelly, Skinner & Heine (1972, Bull. NZ Soc. Earthq. Eng. 5(3)); Baird, Smith, Palermo & Pampanin (2014, NZSEE
    Conference): from the plastic moment σ_y b t²/4 where the legs begin, F_y = n σ_y b t²/(2 D), and
    k = n 16 E b/(27 π) (t/D)³. The outer fibres yield first at 2/3 of F_y, with the stiffness 4 E b/(3 π) (t/D)³ of a
    thin curved beam. k is 4/9 of that: the slope from zero to the curve of an ideally plastic plate at 0.998 F_y, which
    a bilinear law has in its place. The strain of the plate, about t/D, does not grow with the stroke; how many cycles
    it bears, and where the legs end, is not modelled. The formulas are checked by mechanics, not against the text of
    the papers.

    Raises
    ------
    InputError
        If a value is outside its range, or the steel is not known.

    Examples
    --------
    >>> import rockflex as rf
    >>> fuse = rf.u_plate_fuse(4, width=0.12, thickness=0.012, diameter=0.12,
    ...     steel="S355", position=1.2)
    >>> round(fuse.yield_force), round(fuse.stiffness)
    (102240, 19013711)
    """
    count, metal = int(n), _named("steel", steel, Steel, STEELS)
    b, t, D = width, thickness, diameter
    if not t < D:
        raise InputError(
            f"thickness must be below the diameter of the bend, {D:g} m, but {t:g} m was given.", field="thickness"
        )
    return YieldingDissipator(
        count * 16.0 * metal.modulus * b / (27.0 * math.pi) * (t / D) ** 3,
        count * metal.yield_strength * b * t**2 / (2.0 * D),
        post_yield_ratio,
        **dict[str, Any](place),
    )


def _named(name: str, given: str | T, kind: type[T], catalogue: Mapping[str, T]) -> T:
    """Return an entry of a catalogue, or the object given in its place."""
    if is_one_of(given, catalogue):
        return catalogue[given]  # pyright: ignore[reportArgumentType]
    if isinstance(given, kind):
        return given
    raise InputError(
        f"{name} must be {', '.join(catalogue)}, or a {kind.__name__} with values of your own, but {shown(given)} was "
        "given.",
        field=name,
    )
