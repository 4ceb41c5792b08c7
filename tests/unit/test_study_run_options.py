"""The options of a run: the same from Python, from a table of a file and from a call, and who has the hysteresis."""

import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import parse_model
from rockflex.structure.file import checked
from rockflex.study._option_tables import RunOptionKeys
from rockflex.study._run_options import RunOptions, yielding

PULSE = rf.one_sine_pulse(amplitude=4.0, period=0.8)
YIELDS = rf.BoucWen(yield_displacement=0.02)
FRAME = make_frame(n_stories=2)


def test_a_table_of_a_file_gives_the_options_of_a_call():
    table = checked(
        RunOptionKeys,
        {
            "impact": "restitution",
            "restitution": 0.5,
            "ground": {"friction": 0.4},
            "bouc_wen": {"yield_displacement": 0.02},
        },
    )
    of_file = RunOptions.of(1.0, impact=table.law(), bouc_wen=table.hysteresis(), ground=table.ground_rule())
    of_call = RunOptions.of(1.0, impact=rf.Restitution(0.5), bouc_wen=YIELDS, ground=rf.Ground(friction=0.4))
    model, properties = parse_model("2DOF-S"), FRAME.rocking()
    found = [options.case(model, properties).run(PULSE).peaks() for options in (of_file, of_call)]
    direct = rf.simulate(
        FRAME,
        PULSE,
        model,
        output="peaks",
        free_vibration=1.0,
        impact=rf.Restitution(0.5),
        ground=rf.Ground(friction=0.4),
    )
    assert found[0] == found[1] == direct.peaks()


@pytest.mark.parametrize(
    ("labels", "with_hysteresis"),
    [(["2DOF-S", "2DOF-S-BW"], [False, True]), (["2DOF-S", "1DOF-fixed"], [True, True])],
)
def test_the_hysteresis_is_of_the_labelled_models_or_of_all_if_none_is(labels, with_hysteresis):
    models = list(map(parse_model, labels))
    options = RunOptions.of(bouc_wen=YIELDS).among(models)
    tied = [options.tied(model, FRAME.rocking(1)) for model in models]
    assert [model.bouc_wen is not None for model in tied] == with_hysteresis
    assert yielding(labels) == [label for label in labels if label.endswith("-BW")]


@pytest.mark.parametrize(
    ("given", "field"),
    [({"free_vibration": -1.0}, "free_vibration"), ({"work_limit": 0.0}, "work_limit"), ({"ground": 3}, "ground")],
)
def test_an_option_out_of_range_is_named(given, field):
    with pytest.raises(rf.InputError) as caught:
        RunOptions.of(**given)
    assert caught.value.field == field
