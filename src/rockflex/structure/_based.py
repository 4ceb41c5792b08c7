"""The protocol of all structures on a base that can rock."""

from typing import Protocol, SupportsIndex

from rockflex.modal import ModalProperties, RockingProperties


class Based(Protocol):
    """Any structure that has modes and can rock."""

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties: ...

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties: ...


def is_structure(given: object) -> bool:
    """Return whether an object has modes and can rock; a class, as opposed to an instance, does not count."""
    return not isinstance(given, type) and hasattr(given, "rocking") and hasattr(given, "modal")
