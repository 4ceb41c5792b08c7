"""What another structure can be made from: anything on a base that can rock."""

from typing import Protocol, SupportsIndex

from rockflex.modal import ModalProperties, RockingProperties


class Based(Protocol):
    """Any structure."""

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties: ...

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties: ...


def is_structure(given: object) -> bool:
    """Tell whether something has modes and can rock; a class of structures does not."""
    return not isinstance(given, type) and hasattr(given, "rocking") and hasattr(given, "modal")
