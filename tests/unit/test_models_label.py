import numpy as np
import pytest

from rockflex import Frame, InputError
from rockflex.models import Model, parse_model

FRAME = Frame(
    n_stories=3,
    story_height=3.0,
    story_mass=40e3,
    base_mass=40e3,
    stiffness_ratio=np.inf,
    period=0.5,
    aspect_ratio=8.0,
    damping_ratio=0.02,
)


@pytest.mark.parametrize(
    ("label", "n_modes", "lifts"),
    [
        ("2DOF-S", 1, True),
        ("3DOF-S", 2, True),
        ("16DOF-S", 15, True),
        ("MDOF-S", None, True),
        ("fixed", None, False),
        ("1DOF-fixed", 1, False),
        ("5DOF-fixed", 5, False),
    ],
)
def test_labels(label, n_modes, lifts):
    model = parse_model(label)
    assert (model.n_modes, model.lifts, model.label) == (n_modes, lifts, label)
    assert parse_model(model) is model
    assert parse_model(model.label) == model


@pytest.mark.parametrize(
    "label",
    [
        "", "S", "DOF-S", "1DOF-S", "0DOF-S", "0DOF-fixed", "-2DOF-S", "2.5DOF-S", "2dof-s", "2DOF-s", "2DOF",
        "2DOF-X", "02DOF-S", "²DOF-S", "٣DOF-S", "9999999DOF-S", " 2DOF-S", "2DOF-S ", "2DOF-S\n", "MDOF",
        "MDOF-fixed", "Fixed", "fixed base", None, 2, b"2DOF-S",
    ],
)  # fmt: skip
def test_other_words_are_refused(label):
    with pytest.raises(InputError) as caught:
        parse_model(label)
    assert str(caught.value).startswith(f"Unknown model {label!r}. Expected ")
    for known in ('"2DOF-S"', '"MDOF-S" (all modes)', '"fixed"', '"5DOF-fixed"', "or a Model"):
        assert known in str(caught.value)


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


@pytest.mark.parametrize(
    ("model", "text"),
    [
        (Model(4), "Model 5DOF-S needs 4 modes, but the structure has 3. Give more modes, or use MDOF-S for all"),
        (Model(4, lifts=False), "Model 4DOF-fixed needs 4 modes, but the structure has 3.*use fixed for all"),
    ],
)
def test_modes_that_a_structure_does_not_have(model, text):
    with pytest.raises(InputError, match=text):
        model.of(FRAME.rocking())


@pytest.mark.parametrize("n_modes", [0, -1, "a", "2DOF-S", 2.5, 2.0, True, [2], np.array([1, 2])])
def test_modes_are_counted_in_whole_numbers(n_modes):
    with pytest.raises(InputError) as caught:
        Model(n_modes)
    assert str(caught.value) == f"n_modes must be a whole number of at least 1, but {n_modes!r} was given."


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
