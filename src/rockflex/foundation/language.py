"""The language of reports, figures and the page: English texts are the keys of a catalogue for each other language."""

import json
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from pathlib import Path
from typing import Any, Literal, get_args

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.units import Decimal, with_decimal_commas

Language = Literal["en", "de", "it", "fr", "es"]
CATALOGUES = Path(__file__).parent / "languages"
_CHOSEN: ContextVar[tuple[Language, Decimal]] = ContextVar("language", default=("en", "."))


@cache
def catalogue(name: Language) -> Mapping[str, str]:
    """Return the texts of a language by the English ones; none for English."""
    return {} if name == "en" else json.loads((CATALOGUES / f"{name}.json").read_text("utf-8"))


@contextmanager
def use_language(name: Language | None = None, decimal: Decimal | None = None) -> Generator[None]:
    """Translate the texts of a block, and write its numbers with a decimal sign.

    Without a `name` the language stays; without a sign it is that of the language `name`: a comma in all but English.

    Raises
    ------
    InputError
        If there is no such language or sign.
    """
    for field, given, known in (("language", name, get_args(Language)), ("decimal", decimal, get_args(Decimal))):
        if given is not None and given not in known:
            words = ", ".join(map(repr, known))
            raise InputError(f"{field} must be one of {words}, but {shown(given)} was given.", field=field)
    now, sign = _CHOSEN.get()
    usual: Decimal = sign if name is None else "." if name == "en" else ","
    token = _CHOSEN.set((name or now, decimal or usual))
    try:
        yield
    finally:
        _CHOSEN.reset(token)


def chosen_language() -> tuple[Language, Decimal]:
    """Return the language and the decimal sign of the innermost block."""
    return _CHOSEN.get()


def translated(text: str, **values: Any) -> str:
    """Return a text in the chosen language and decimal sign, with values for the names in its braces: "{n} records".

    A text of a user, which is in no catalogue, is returned as it is. Write a plural as two texts:
    ``translated("{n} record" if n == 1 else "{n} records", n=n)``.
    """
    name, decimal = _CHOSEN.get()
    found = catalogue(name).get(text, text)
    if not values:
        return found
    return with_decimal_commas(found.format(**values)) if decimal == "," else found.format(**values)
