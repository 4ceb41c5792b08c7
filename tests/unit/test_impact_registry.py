"""Every law of the package is known wherever a law can be named, and says what its restitution means."""

import json

import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli._app import app
from rockflex.foundation import schema
from rockflex.models._impact import LAW_CLASSES, LAWS, law_of_name
from rockflex.models._landing import rule_of_law
from rockflex.studies._case_keys import RunOptionKeys, impact_law_name
from rockflex.web._forms import forms_of_structures

FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=6.0)
MOTION = rf.one_sine_pulse(amplitude=3.0, period=0.8)
CHOICES = [(name, e) for name, law in LAWS.items() for e in (None, 0.8) if (e is None) or law.restitution_name()]
CHOICES.remove(("restitution", None))
by_choice = pytest.mark.parametrize(("name", "e"), CHOICES)


def test_flags_know_the_names_of_the_registry():
    assert tuple(LAWS) == schema.LAWS


@by_choice
def test_files_flags_and_saved_responses(name, e, tmp_path):
    given = {"impact": name} | ({} if e is None else {"restitution": e})
    law = RunOptionKeys(**given).law()
    assert law == law_of_name(name, e)
    assert (impact_law_name(law), law.given_restitution) == (name, e)
    assert type(law) is LAW_CLASSES[type(law).__name__]
    assert law.in_words()
    run = rf.simulate(FRAME, MOTION, "2DOF-S", impact=law)
    assert rf.Response.load(run.save(tmp_path / "run")).history.model.law == law
    file = tmp_path / "frame.toml"
    rows = "\n".join(f"{key} = {json.dumps(value)}" for key, value in given.items())
    file.write_text(
        f"{rows}\n[frame]\nn_stories = 2\nstory_height = 3.0\nstory_mass = 40e3\nbase_mass = 40e3\n"
        "stiffness_ratio = inf\nperiod = 0.5\naspect_ratio = 6.0\ndamping_ratio = 0.02\n",
        "utf-8",
    )
    result = CliRunner().invoke(app, ["run", str(file), "el-centro-1940", "--model", "2DOF-S", "--json"])
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)["options"]["impact"]
    assert told["law"] == name
    assert told.get(law.restitution_name()) == e


@by_choice
def test_projects_keep_them(name, e, tmp_path):
    project = rf.Project({"a": FRAME}, [MOTION], impact=law_of_name(name, e))
    assert rf.read_project(project.save(tmp_path / "a.rockflex")).impact["a"] == law_of_name(name, e)


def test_the_form_has_a_choice_for_each():
    listed = forms_of_structures()["laws"]
    assert {each["name"] for each in listed} == set(LAWS)
    for each in listed:
        assert each["title"]
        assert each["help"]
        law_of_name(each["name"], 0.8 if each["restitution"] else None)


def test_a_restitution_that_is_missing_or_of_no_use():
    with pytest.raises(rf.InputError, match="needs its coefficient") as caught:
        law_of_name("restitution", None)
    assert caught.value.field == "restitution"
    with pytest.raises(rf.InputError, match='"restitution" or "angular-momentum"') as caught:
        law_of_name("pivot-impulse", 0.5)
    assert caught.value.field == "restitution"
    for e in (-0.1, 1.1, float("nan")):
        with pytest.raises(rf.InputError, match=r"0, 1|finite"):
            rf.AngularMomentum(e)


def test_a_subclass_with_a_formula_of_its_own_is_a_users_law():
    class Own(rf.Restitution):
        def after(self, properties, modal_velocity, rotation_velocity, modal_displacement=None):
            return modal_velocity, 0.0

    class Same(rf.Restitution):
        pass

    assert rule_of_law(Own(0.5), 1) is None
    assert rule_of_law(Same(0.5), 1) == rule_of_law(rf.Restitution(0.5), 1)


def test_a_restitution_that_hardly_lets_rocking_decay_says_so():
    run = rf.simulate(FRAME, MOTION, "MDOF-S", impact=rf.Restitution(0.5))
    left = rf.Restitution(0.5).effective_restitution(FRAME.rocking())
    (text,) = (each for each in run.warnings if "restitution" in each)
    assert f"{left:.4g}" in text
    assert "AngularMomentum(0.5)" in text
    assert f"{left:.4g}" in repr(run)
    for law in (None, rf.Restitution(0.0), rf.Restitution(1.0), rf.AngularMomentum(0.5), rf.PivotImpulse()):
        other = rf.simulate(FRAME, MOTION, "MDOF-S", impact=law)
        assert not any("restitution" in each for each in other.warnings)
        assert isinstance(law, rf.Restitution) or "effective" not in repr(other)
    block = rf.simulate(FRAME, MOTION, "rigid", impact=rf.Restitution(0.5))
    assert not any("restitution" in each for each in block.warnings)
