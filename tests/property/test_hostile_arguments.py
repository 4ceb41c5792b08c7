"""Whatever an argument is, what comes out is an answer or an error in words, short and about that argument."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hostile
import rockflex as rf

# Of these it shows only beside the other arguments that they cannot be meant, so a message may name another.
IN_PLACE = ("largest", "smallest", "empty", "long list", "no rows", "no columns")
# Of these a message names another field, into which the argument goes, or the thing that it belongs to.
NAMED = {
    "masses": "mass",
    "motions": "motion",
    "models": "model",
    "structures": "structure",
    "im_levels": "im",
    "path": "file",
    "paths": "directory",
}
FUNCTIONS = ("fragility", "pulse", "curve", "fit_function")  # the user's own errors are the user's


def refused(call: Any, arguments: dict[str, Any]) -> str | None:
    """The message with which a call is refused; None where it is not."""
    try:
        made = call(**arguments)
        if isinstance(made, rf.Frame | rf.Beam | rf.TaperedTower | rf.WallFrame | rf.FishBone | rf.LumpedStructure):
            made.rocking()
            made.modal()
    except (rf.InputError, rf.SolverError) as error:
        return str(error)
    return None


@pytest.mark.slow
@pytest.mark.parametrize("group", [hostile.structures, hostile.motions, hostile.fits, hostile.studies])
def test_every_argument_is_judged(group: Any) -> None:
    never = dict.fromkeys(
        ("complex", "complex array", "in itself", "bytes", "object", "dates", "date", "masked", "masked rows")
    )
    for name, argument, what, call, arguments in hostile.cases(group()):
        if argument in FUNCTIONS and what in ("function", "class"):
            continue
        message = refused(call, arguments)
        where = f"{name}({argument}={what})"
        assert message is not None or what not in never, f"{where} was taken"
        assert message is None or (len(message) < 2000 and " at 0x" not in message), where
        if message is not None and what not in IN_PLACE and argument not in ("units", "dt", "path", "paths"):
            assert NAMED.get(argument, argument).lower() in message.lower(), f"{where}: {message}"


FIELDS = ("n_stories", "story_height", "story_mass", "base_mass", "stiffness_ratio", "period", "aspect_ratio")
ANYTHING = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=9), st.complex_numbers(), st.binary(),
    st.integers(300, 5000).map(lambda power: 10**power), st.floats(allow_nan=True).map(abs),
    st.recursive(st.floats(), lambda inner: st.lists(inner, max_size=3), max_leaves=6),
)  # fmt: skip


@settings(max_examples=150, deadline=None)
@given(st.dictionaries(st.sampled_from(FIELDS), ANYTHING, min_size=1, max_size=4))
def test_frames_of_anything(changes: dict[str, Any]) -> None:
    if changes.get("n_stories", 0) in range(50, 2001):
        changes["n_stories"] = 50
    message = refused(rf.Frame, hostile.FRAME | changes)
    assert message is None or len(message) < 2000


@settings(max_examples=150, deadline=None)
@given(st.dictionaries(st.sampled_from(sorted(hostile.PROPERTIES)), ANYTHING, min_size=1, max_size=4))
def test_properties_of_anything(changes: dict[str, Any]) -> None:
    message = refused(rf.RockingProperties, hostile.PROPERTIES | changes)
    assert message is None or len(message) < 2000
