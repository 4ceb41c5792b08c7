"""The error for quantities that a run did not store."""

from rockflex._errors import InputError


class MissingQuantityError(InputError, AttributeError):
    """A quantity that this run did not store; also an AttributeError, so that `hasattr` returns False."""
