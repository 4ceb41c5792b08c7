"""What every structure offers, and structures that are assembled as another one."""

from abc import ABC, abstractmethod
from typing import Protocol, SupportsIndex

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


def is_structure(given: object) -> bool:
    """Tell whether something has modes and can rock; a class of structures does not."""
    return not isinstance(given, type) and hasattr(given, "rocking") and hasattr(given, "modal")
