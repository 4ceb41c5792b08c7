"""A key of a file: its meaning, its unit, and how it appears as a flag and in a form."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, get_args, get_type_hints

NUMBER, WHOLE, PLAIN = "{}, a number{unit}", "{}, a whole number", "{}"


@dataclass(frozen=True)
class Key:
    """The metadata of a field, inside ``Annotated``; its name, type and default are those of the field.

    Attributes
    ----------
    description
        Completes the sentence "it must be ...".
    unit
        SI unit, or empty.
    form
        How the value is written, with the description in place of ``{}`` and " in <unit>" in place of ``{unit}``.
    label
        The name in a form, where it is not the key itself.
    low, high
        The smallest and the largest number that the page accepts; None for any of a reasonable size.
    flag, metavar
        The option and its placeholder on the command line, where they are not the key and its unit.
    page
        What the page says in place of `expected`, where a file may hold what a form cannot.
    hint
        What the help of the option says besides the description, the unit and the default.
    """

    description: str
    unit: str = ""
    form: str = NUMBER
    label: str = ""
    low: float | None = None
    high: float | None = None
    flag: str = ""
    metavar: str = ""
    hint: str = ""
    page: str = ""

    @property
    def expected(self) -> str:
        """What the value must be, and how it is written."""
        return self.form.format(self.description, unit=self.unit and f" in {self.unit}")


def each(what: str) -> str:
    """Return the form of a number, or of one for each of many."""
    return f"{{}}, a number or one for each {what}"


def keys_of(table: type) -> Iterator[tuple[str, Any, Key]]:
    """Yield the name, the type and the key of each field of a class whose annotations hold keys."""
    for name, annotation in get_type_hints(table, include_extras=True).items():
        kind, key = get_args(annotation)
        yield name, kind, key


def flag_of(name: str, key: Key) -> str:
    """Return the option that gives a key on the command line, such as ``--story-height``."""
    return "--" + (key.flag or name).replace("_", "-")
