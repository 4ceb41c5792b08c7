"""The questions that an element between a base and the ground answers."""

import math
import re
from abc import ABC, abstractmethod
from typing import Any, ClassVar, Self

from rockflex.foundation.language import translated
from rockflex.structure._attachment import PLACE, Attachment, element_parameters
from rockflex.structure._branches import Element


class BaseElement(Attachment, ABC):
    """Any element between a base and the ground, or attached to floors.

    Those who hold, run, draw or report an element ask it, whatever its class is. What is not abstract has a default.
    """

    symbol: ClassVar[str] = "law"  # in a drawing, one of `SYMBOLS`
    states: ClassVar[tuple[str, str, str]] = ("elastic", "yielding", "broken")  # in a drawing, by what it does
    prestressed: ClassVar[bool] = False  # whether it is a tendon, whose prestress a run reports
    rate_dependent: ClassVar[bool] = False  # whether its force follows the velocity
    fuse: ClassVar[bool] = False  # whether it is a bar that yields over a length of its own, so that it has a strain

    @property
    def words(self) -> str:
        """Its name in a sentence: "viscous damper"; the name of the class, if that has no title."""
        name = type(self).__name__
        return (self.title or re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", name)).lower()

    @property
    def yield_words(self) -> tuple[str, str]:
        """The words of a report for one that did not yield, and for one that did."""
        return "", translated("yielded")

    @abstractmethod
    def branched(self) -> Element:
        """Return it as its branches, of which models make the phases of a run."""

    @abstractmethod
    def slow_force(self, elongation: float) -> float:
        """Return the force in N as built, stretched slowly by an elongation in m."""

    @abstractmethod
    def extremes(self, low: float, high: float, speed: float = 0.0) -> tuple[float, bool]:
        """Return the largest |F| in N, and whether it yields or slides, in a run with these extremes.

        Parameters
        ----------
        low, high
            The least and the largest elongation in m; zero is between them.
        speed
            The largest |δ'| in m/s.
        """

    @property
    def force_at_rest(self) -> float:
        """Force in N as built, while the base is in contact."""
        return 0.0

    @property
    @abstractmethod
    def dissipates(self) -> bool:
        """Whether it yields, slides or damps, so that its force does not follow from the elongation alone."""

    @property
    @abstractmethod
    def largest_stiffness(self) -> float:
        """Largest stiffness of its branches in N/m."""

    @property
    def restoring_stiffness(self) -> float:
        """Stiffness in N/m with which it adds to the slope of the moment over the rotation; of tendons only."""
        return 0.0

    @property
    def locked_force(self) -> float:
        """Largest force in N with which it can keep a base from closing."""
        return 0.0

    @property
    def recentres(self) -> bool:
        """Whether it helps to close the base, and is no dissipator that can keep it open."""
        return False

    @property
    def sticks(self) -> bool:
        """Whether it holds the base still up to a force, and then slides."""
        return False

    @property
    def breaks_at(self) -> float:
        """Elongation in m at which it breaks for good, its parameter `rupture_elongation`; infinite without one."""
        limit = getattr(self, "rupture_elongation", None)
        return math.inf if limit is None else limit

    @property
    def dissipator_force(self) -> float | None:
        """Force in N at which a dissipator yields or slides, which a search for a design varies; None for others."""
        return None

    def scaled(self, factor: float, *, size: bool) -> Self | None:
        """Return it with a factor on its size, or on its force alone; None where nothing is left of it.

        Tendons and what has a `dissipator_force` are scaled; others stay as they are.
        """
        del factor, size
        return self

    def compared_parameters(self) -> dict[str, Any]:
        """Return the parameters in which an element and its mirror image must agree, besides the place."""
        return {name: value for name, value in element_parameters(self).items() if name not in PLACE}
