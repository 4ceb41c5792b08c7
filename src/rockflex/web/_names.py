"""Names that a link may hold."""

from collections.abc import Callable, Container

from pydantic import AfterValidator
from pydantic_core import PydanticCustomError


def among(known: Callable[[], Container[str]]) -> AfterValidator:
    """Return the check that a text is one of some names."""

    def checked(name: str) -> str:
        if name not in known():
            raise PydanticCustomError("unknown_name", "unknown name")
        return name

    return AfterValidator(checked)
