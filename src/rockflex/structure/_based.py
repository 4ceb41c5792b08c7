"""What every structure offers, and structures that are assembled as another one."""

from abc import ABC, abstractmethod
from dataclasses import replace
from typing import Any, Protocol, SupportsIndex

from rockflex.modal import ModalProperties, RockingProperties


class Based(Protocol):
    """Any structure on a base that can rock."""

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties: ...

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties: ...


class Assembled(ABC):
    """A structure whose description is turned into another one, which has its modes and rocking properties."""

    @property
    @abstractmethod
    def assembled(self) -> Based:
        """The structure that this one assembles."""

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base, or all that the structure has.

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the number that the structure has.
        """
        return self.assembled.modal(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes, or with all.

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the number that the structure has.
        """
        return self.assembled.rocking(n_modes)


class Modified:
    """A structure that has the modes of another one, and some other properties."""

    structure: Based

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base (default: all)."""
        return self.structure.modal(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes (default: all)."""
        base = self.structure.rocking(n_modes)
        if n_modes is not None:
            return replace(base, **self._changes())
        known = vars(self).get("_known")
        if known is None or known[0] is not base:  # the same object each time, so that runs can share what they prepare
            known = vars(self)["_known"] = base, replace(base, **self._changes())
        return known[1]

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_known"}

    def _changes(self) -> dict[str, Any]:
        """Return the properties that differ."""
        raise NotImplementedError


def is_structure(given: object) -> bool:
    """Tell whether something has modes and can rock; a class of structures does not."""
    return not isinstance(given, type) and hasattr(given, "rocking") and hasattr(given, "modal")
