"""What an error carries beside its text: the argument at fault."""

import pickle
from collections.abc import Callable

import pytest

import rockflex as rf
from rockflex import InputError
from rockflex.foundation.checks import (
    checked_damping_ratios,
    checked_finite,
    checked_finite_vector,
    checked_positive,
    checked_whole_number,
)
from rockflex.structure.file._structure_entry import StructureEntry


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: checked_positive("period", -1.0, "s"), "period"),
        (lambda: checked_finite("eccentricity", float("nan"), "m"), "eccentricity"),
        (lambda: checked_finite_vector("mass, heights", ["a"], "m", field="mass"), "mass"),
        (lambda: checked_whole_number("rotations, index", 2.5, 0, field="rotations"), "rotations"),
        (lambda: checked_damping_ratios("zeta", [0.02, 2.0], 2), "zeta"),
        (lambda: rf.LumpedStructure([0.0], [[1.0]], [3.0], base_mass=1.0, half_width=1.0, damping_ratio=0.0), "masses"),
        (lambda: rf.BoucWen(0.05, gamma=-1.0), "gamma"),
    ],
)
def test_an_error_knows_its_argument(call: Callable[[], object], field: str) -> None:
    with pytest.raises(InputError) as caught:
        call()
    assert caught.value.field == field
    assert caught.value.said == str(caught.value)


def test_an_error_of_no_argument_has_no_field() -> None:
    assert InputError("The records do not go together.").field is None


def test_a_place_stands_before_the_text_and_not_in_it() -> None:
    entry = StructureEntry.model_validate({"block": {"slenderness": -0.1, "half_diagonal": 1.0}})
    with pytest.raises(InputError, match=r"^\[block\]: slenderness must be above 0") as caught:
        entry.build()
    assert caught.value.field == "slenderness"
    assert caught.value.said.startswith("slenderness must be above 0")


def test_errors_go_to_other_processes_whole() -> None:
    error = InputError("wall must be thin.", field="wall", place="[tapered_tower]")
    copy = pickle.loads(pickle.dumps(error))
    assert (str(copy), copy.field, copy.said) == ("[tapered_tower]: wall must be thin.", "wall", "wall must be thin.")
