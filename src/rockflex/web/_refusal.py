"""The answer of the server when an input cannot be used."""

from collections.abc import Generator, Mapping
from contextlib import contextmanager

from rockflex._errors import InputError, SolverError


class Refusal(Exception):  # noqa: N818 - an answer, not a failure
    """Messages by the dotted path of the field at fault, such as ``structure.frame.period``; empty for none of them.

    Every function of this layer that uses what a visitor sent may raise it.
    """

    def __init__(self, errors: Mapping[str, str] | str, status: int = 422) -> None:
        self.errors = {"": errors} if isinstance(errors, str) else dict(errors)
        self.status = status
        super().__init__("; ".join(f"{path}: {text}" if path else text for path, text in self.errors.items()))


@contextmanager
def errors_as_refusals(path: str, before: str = "") -> Generator[None]:
    """Turn an error about the field at a path into a refusal, whose message begins with `before`."""
    try:
        yield
    except (InputError, SolverError) as error:
        raise Refusal({path: f"{before}{error}"}) from error
