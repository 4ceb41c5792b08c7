"""The tolerances of a surrogate model with few modes."""

from dataclasses import dataclass, fields

from rockflex._checks import positive


@dataclass(frozen=True)
class AdequacyTolerance:
    """What a surrogate model may leave out, as fractions; infinity disables a criterion.

    The defaults separate the models that Silva & Stojadinović 2024 consider sufficient from those that they do not.

    Attributes
    ----------
    base_moment : float
        Fraction of the base moment L_0^r left out. Sufficient: 0.11 (one mode of 15 stories in flexure, Section 3.4)
        and 0.06 (two of the chimney, Section 4.1.1). Insufficient: 0.13 (one of specimen S1, Section 3.1) and 0.18 (one
        of the chimney).
    first_frequency : float
        Relative error by which the first uplifted frequency is too high. Sufficient: 0.166 (2DOF-S, 15 stories in
        flexure, h*_1/B = 10: "quite good", Section 3.4). Insufficient: 1.15 (the same in shear: "poor"). The paper also
        finds 2DOF-S likely satisfactory in shear below h*_1/B = 5, where the error reaches 0.44; use 0.45 to agree.
    second_frequency : float
        The same for the second frequency, with two modes or more. Sufficient: 0.20 (3DOF-S, chimney) and 0.03 (15
        stories in flexure). Insufficient: 0.79 (15 stories in shear: "quite inaccurate").
    base_shear : float
        Fraction of the mass left out. Sufficient: 0.08 (specimen 2Hz-Long Base). Insufficient: 0.29 (two modes of the
        chimney, with 19 % of the base shear missing). EN 1998-1:2004, 4.3.3.3.1, also requires 0.1.

    Raises
    ------
    InputError
        If a value is negative or not a number.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> strict = rf.AdequacyTolerance(first_frequency=0.02, second_frequency=0.02)
    >>> rf.adequacy(frame.rocking(), strict).model
    '4DOF-S'
    """

    base_moment: float = 0.12
    first_frequency: float = 0.17
    second_frequency: float = 0.25
    base_shear: float = 0.10

    def __post_init__(self) -> None:
        for each in fields(self):
            value = positive(each.name, getattr(self, each.name), "fractions (5 % is 0.05)", zero=True, infinite=True)
            vars(self)[each.name] = value
