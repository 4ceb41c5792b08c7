"""What a run did not keep."""

from rockflex._errors import InputError


class MissingQuantityError(InputError, AttributeError):
    """A quantity that this run did not keep; an AttributeError too, so that `hasattr` answers False."""
