"""One description of an argument: its check, its entry of the docstring, its key in a file."""

import copy
import inspect
import pickle
from dataclasses import dataclass, replace
from typing import Annotated

import pytest

import rockflex as rf
from rockflex.foundation.descriptions import Described, described, described_arguments
from rockflex.structure.file._toml_table import TomlTable, table_of

Length = Annotated[float, Described("the length", "m", rule="positive", note="Measured along the axis.")]


@described
@dataclass(frozen=True)
class Bar:
    """A bar.

    Raises
    ------
    InputError
        If it is none.
    """

    length: Length
    count: Annotated[int, Described("how many there are", rule="whole", within=(1, 9))] = 1
    area: Annotated[float | None, Described("the area", "m²", rule="positive")] = None

    def __post_init__(self) -> None:
        vars(self)["checked_first"] = type(self.length) is float


@dataclass(frozen=True)
class LongBar(Bar):
    factor: float = 2.0


@described(title="Two bars")
def both(first: Length, /, second: Length = 2.0, *, name: str = "") -> tuple[float, float, str]:
    """Return two lengths."""
    return first, second, name


def test_a_value_is_checked_converted_and_kept():
    bar = Bar(2)
    assert bar == Bar(2.0)
    assert type(bar.length) is float
    assert vars(bar)["checked_first"]
    assert repr(bar) == "Bar(length=2.0, count=1, area=None)"
    assert replace(bar, length=3).length == 3.0
    assert hash(bar) == hash(Bar(2.0))
    with pytest.raises(AttributeError):
        bar.length = 3.0
    with pytest.raises(rf.InputError, match="area must be a positive, finite number in m², but 0 was given"):
        replace(bar, area=0)
    for again in (copy.deepcopy(bar), pickle.loads(pickle.dumps(bar))):
        assert again == bar


def test_a_class_derived_from_it_checks_too():
    assert LongBar(1, factor=3.0).length == 1.0
    assert list(inspect.signature(LongBar).parameters) == ["length", "count", "area", "factor"]
    with pytest.raises(rf.InputError) as caught:
        LongBar(-1)
    assert caught.value.field == "length"


def test_arguments_of_a_function_are_checked_wherever_they_stand():
    assert both(1, 3) == both(1, second=3) == (1.0, 3.0, "")
    assert all(type(each) is float for each in both(1, second=3)[:2])
    assert both(1, name="a") == (1.0, 2.0, "a")
    for call in (lambda: both(1, -1), lambda: both(1, second=-1)):
        with pytest.raises(rf.InputError) as caught:
            call()
        assert caught.value.field == "second"
    for wrong in (lambda: both(), lambda: both(1, 2, second=3), lambda: both(1, 2, 3), lambda: both(1, other=2)):
        with pytest.raises(TypeError):
            wrong()


def test_the_docstring_has_an_entry_before_the_next_section():
    lines = Bar.__doc__.splitlines()
    assert lines.index("Attributes") < lines.index("length : float") < lines.index("Raises")
    assert "    The length, in m, positive. Measured along the axis." in lines
    assert "    How many there are, from 1 to 9." in lines
    assert "area : float or None" in lines
    assert "Parameters\n----------\nfirst\n    The length, in m, positive." in both.__doc__


def test_help_shows_types_and_not_descriptions():
    for made in (Bar, both, rf.Tendon, rf.Frame, rf.FishBone, rf.bar_fuse):
        assert "Described" not in str(inspect.signature(made))


def test_a_class_without_a_place_for_checks_is_told_so():
    with pytest.raises(TypeError, match="needs a __post_init__"):

        @described
        @dataclass(frozen=True)
        class Bare:
            length: Length


def test_a_table_has_the_keys_of_a_class_and_of_a_function():
    table = table_of(Bar, TomlTable, __name__)
    assert list(table.model_fields) == list(described_arguments(Bar)) == ["length", "count", "area"]
    assert table.model_fields["length"].is_required()
    assert table.model_validate({"length": 1.0}) == pickle.loads(pickle.dumps(table.model_validate({"length": 1.0})))
    assert list(table_of(both, TomlTable, __name__).model_fields) == ["first", "second"]
    assert both.title == "Two bars"


@pytest.mark.parametrize("kind", [rf.Tendon, rf.ViscousDamper, rf.FlagShapedBar, rf.Frame, rf.Beam, rf.strand_tendon])
def test_every_argument_of_the_signature_has_its_entry(kind):
    names = [name for name, each in inspect.signature(kind).parameters.items() if each.kind != each.VAR_KEYWORD]
    assert set(names) <= set(described_arguments(kind))
    entries = [line.split(" : ")[0] for line in kind.__doc__.splitlines()]
    assert all(name in entries for name in names)
