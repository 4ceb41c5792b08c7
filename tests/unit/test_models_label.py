"""Labels of models, read and written."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from builders import make_frame
from rockflex import InputError
from rockflex.models import Model, parse_model

FRAME = make_frame(n_stories=3, period=0.5, aspect_ratio=8.0)


@pytest.mark.parametrize(
    ("label", "model"),
    [
        ("2DOF-S", Model(1)),
        ("3DOF-S", Model(2)),
        ("16DOF-S", Model(15)),
        ("MDOF-S", Model()),
        ("fixed", Model(lifts=False)),
        ("1DOF-fixed", Model(1, lifts=False)),
        ("5DOF-fixed", Model(5, lifts=False)),
        ("2DOF-C", Model(1, complete=True)),
        ("MDOF-C", Model(complete=True)),
        ("2DOF-C-SI", Model(1, complete=True, closure="SI")),
        ("3DOF-C-E", Model(2, complete=True, closure="E")),
        ("MDOF-C-SI", Model(complete=True, closure="SI")),
        ("rigid", Model(0)),
        ("rigid-C", Model(0, complete=True)),
        ("2DOF-S-BW", Model(1, yields=True)),
        ("MDOF-S-BW", Model(yields=True)),
        ("fixed-BW", Model(lifts=False, yields=True)),
        ("1DOF-fixed-BW", Model(1, lifts=False, yields=True)),
        ("2DOF-C-BW", Model(1, complete=True, yields=True)),
        ("2DOF-C-SI-BW", Model(1, complete=True, closure="SI", yields=True)),
    ],
)
def test_labels(label, model):
    assert parse_model(label) == model
    assert model.label == label
    assert parse_model(model) is model


@st.composite
def models(draw):
    """Every combination that makes a model."""
    lifts = draw(st.booleans())
    complete = lifts and draw(st.booleans())
    yields = draw(st.booleans())
    closures = [None, "SI", "E"] if complete else [None]
    closure = draw(st.sampled_from(closures))
    if yields:
        counts = st.sampled_from([None, 1])
    elif complete and closure is None:
        counts = st.sampled_from([None, 0, 1])
    else:
        least = 1 if closure or not lifts else 0
        counts = st.one_of(st.none(), st.integers(least, 999_998))
    return Model(draw(counts), lifts, complete, closure, yields)


@given(models())
def test_a_label_and_its_model_are_one(model):
    assert parse_model(model.label) == model


WORDS = st.from_regex(r"(([0-9]{0,3}|M)DOF-?)?(S|C|fixed|rigid)(-(SI|E|C|S|BW))*", fullmatch=True)


@pytest.mark.slow
@given(WORDS)
def test_what_is_read_is_written_the_same(label):
    try:
        model = parse_model(label)
    except InputError:
        return
    assert model.label == label


@pytest.mark.parametrize(
    "label",
    [
        "", "S", "DOF-S", "1DOF-S", "0DOF-S", "0DOF-fixed", "-2DOF-S", "2.5DOF-S", "2dof-s", "2DOF-s", "2DOF",
        "2DOF-X", "02DOF-S", "²DOF-S", "٣DOF-S", "9999999DOF-S", " 2DOF-S", "2DOF-S ", "2DOF-S\n", "MDOF",
        "MDOF-fixed", "Fixed", "fixed base", None, 2, b"2DOF-S", "2DOF-S-SI", "2DOF-S-E", "1DOF-fixed-SI", "1DOF-C",
        "rigid-S", "Rigid", "rigid-C-SI", "2DOF-C-X", "2DOF-C-E-SI", "2DOF-BW", "2DOF-BW-C", "2DOF-C-bw", "rigid-BW",
        "1DOF-C-SI",
    ],
)  # fmt: skip
def test_other_words_are_refused(label):
    with pytest.raises(InputError) as caught:
        parse_model(label)
    assert str(caught.value).startswith(f"Unknown model {label!r}. Expected ")
    for known in ('"2DOF-S"', '"MDOF-S" (all modes)', '"fixed"', '"5DOF-fixed"', '"2DOF-S-BW"', "or a Model"):
        assert known in str(caught.value)


NO_LAW = (
    "3DOF-C has no impact law of its own: Eq. 19 is one equation for 2 velocities. Use 3DOF-C-SI (Eq. 25), 3DOF-C-E "
    "(Eq. 25 scaled to satisfy Eq. 19), or MDOF-C with all modes."
)
NO_CLOSURE = 'The closures "SI" and "E" belong to complete models with modes. Leave closure out.'


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"n_modes": 2, "complete": True}, NO_LAW),
        ({"n_modes": 1, "closure": "SI"}, NO_CLOSURE),
        ({"n_modes": 0, "complete": True, "closure": "E"}, NO_CLOSURE),
        ({"complete": True, "closure": "SI", "lifts": False}, NO_CLOSURE),
        ({"complete": True, "lifts": False}, "A fixed base has no complete model: its rotation is zero. Leave"),
        ({"n_modes": 0, "lifts": False}, "A rigid block on a fixed base does not move. Keep a mode, or let the base"),
        ({"n_modes": 3, "yields": True}, "A Bouc-Wen superstructure has one mode, but 3 were requested. Use"),
        ({"n_modes": 0, "yields": True}, "A Bouc-Wen superstructure has one mode, but 0 were requested. Use"),
        ({"closure": "IS", "complete": True}, 'closure must be "SI", "E" or None, but \'IS\' was given.'),
        ({"closure": True, "complete": True}, 'closure must be "SI", "E" or None, but True was given.'),
        ({"complete": "yes"}, "complete must be True (Eqs. 13 and 14) or False (Eq. 23), but 'yes' was given."),
        ({"complete": None}, "complete must be True (Eqs. 13 and 14) or False (Eq. 23), but None was given."),
        ({"yields": 1}, "yields must be True (the label has -BW) or False, but 1 was given."),
    ],
)
def test_combinations_that_make_no_model(arguments, text):
    with pytest.raises(InputError) as caught:
        Model(**arguments)
    assert str(caught.value).startswith(text)


@pytest.mark.parametrize(("label", "text"), [("3DOF-C", NO_LAW), ("4DOF-S-BW", "A Bouc-Wen superstructure has one")])
def test_labels_of_no_model(label, text):
    with pytest.raises(InputError, match=re.escape(text)):
        parse_model(label)


@pytest.mark.parametrize("n_modes", [-1, "a", "2DOF-S", 2.5, 2.0, True, [2], np.array([1, 2])])
def test_modes_are_counted_in_whole_numbers(n_modes):
    with pytest.raises(InputError) as caught:
        Model(n_modes)
    assert str(caught.value) == f"n_modes must be a whole number of at least 0, but {n_modes!r} was given."


@pytest.mark.parametrize("lifts", ["no", 0, 1, None, np.array([True])])
def test_a_base_lifts_or_does_not(lifts):
    with pytest.raises(InputError) as caught:
        Model(lifts=lifts)
    assert (
        str(caught.value) == f"lifts must be True (the base can lift) or False (it is fixed), but {lifts!r} was given."
    )


def test_numbers_of_numpy_do():
    model = Model(np.int64(2), np.bool_(False))
    assert model == Model(2, lifts=False)
    assert (type(model.n_modes), type(model.lifts)) == (int, bool)
    assert type(Model(complete=np.bool_(True)).complete) is bool


def test_a_model_takes_as_many_modes_as_it_names():
    properties = FRAME.rocking()
    for n_modes in (1, 2, 3):
        tied = Model(n_modes).of(properties)
        assert tied.label == f"{n_modes + 1}DOF-S"
        assert np.array_equal(tied.properties.omega, properties.omega[:n_modes])
        assert tied.properties.i_theta == properties.i_theta
        assert tied.properties.floors.n_modes == n_modes
    assert Model().of(properties).properties is properties
    assert not Model(2, lifts=False).of(properties).lifts
