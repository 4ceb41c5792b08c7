"""Tables of elements, made from the arguments of their classes and functions."""

from collections.abc import Callable
from typing import Annotated, Any, ClassVar, Literal, TypeAlias, Union

from pydantic import Field, SerializerFunctionWrapHandler, model_serializer

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.registry import registered_objects
from rockflex.structure._base_element import BaseElement
from rockflex.structure._devices import bar_fuse, strand_tendon, u_plate_fuse
from rockflex.structure._elements import ELEMENTS as CLASSES
from rockflex.structure._law_bars import BARS
from rockflex.structure.file._toml_table import TomlTable, table_of

_MADE: dict[str, Callable[..., BaseElement]] = {
    **CLASSES,
    "strand_tendon": strand_tendon,
    "bar_fuse": bar_fuse,
    "u_plate_fuse": u_plate_fuse,
    **BARS,
    **registered_objects("elements"),
}
*_KINDS, _LAST = (f'"{kind}"' for kind in _MADE)
_ELEMENT_KIND = Described(f"{', '.join(_KINDS)} or {_LAST}", form=PLAIN)


class ElementTable(TomlTable):
    """A table that is an element; `title` is its name in a list, and a key `kind` is no argument."""

    makes: ClassVar[Callable[..., BaseElement]]
    title: ClassVar[str]
    tuples: ClassVar[tuple[str, ...]] = ()  # keys whose lists are tuples in the element, which sees to that itself

    def element(self) -> BaseElement:
        """Return the element.

        Raises
        ------
        InputError
            If a value is outside its range, or the values contradict each other.
        """
        values = self.model_dump(exclude={"kind"})
        return type(self).makes(**{name: value for name, value in values.items() if value is not None})

    def describe(self) -> dict[str, Any]:
        """Return the given values, and the defaults of the others."""
        return self.model_dump(exclude_none=True)

    @model_serializer(mode="wrap")
    def _serialized(self, serialize: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Return the values; an element under the base has no direction."""
        found: dict[str, Any] = serialize(self)
        if found.get("between") is None and found.get("height") is None:
            found.pop("cosine", None)
        return found


def _element_table(kind: str, made: Callable[..., BaseElement]) -> type[ElementTable]:
    """Return the table of a kind of element."""
    return table_of(made, ElementTable, __name__, kind=(Annotated[Literal[kind], _ELEMENT_KIND], ...))


ELEMENTS: dict[str, type[ElementTable]] = {kind: _element_table(kind, made) for kind, made in _MADE.items()}
"""The table of each kind of element by its name in a file."""

ELEMENT_NAMES = {table: kind for kind, table in ELEMENTS.items()}

AnyElementTable: TypeAlias = Annotated[Union[tuple(ELEMENTS.values())], Field(discriminator="kind")]  # pyright: ignore # noqa: UP007
"""The table of any element, chosen by its `kind`."""
