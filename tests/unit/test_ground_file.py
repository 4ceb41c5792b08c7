"""The ground in files: structure files, studies, and random populations."""

import math
import pickle
import tomllib

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import _label
from rockflex.models._rocking_model import RockingModel
from rockflex.structure.file._toml_table import TomlTable, parse_toml_table
from rockflex.studies._ground_tables import GroundTable

FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=8.0)
PROPERTIES = FRAME.rocking()
B, MASS = PROPERTIES.half_width, PROPERTIES.m_tot


class Holder(TomlTable):
    ground: GroundTable


def under(text, properties=PROPERTIES):
    return parse_toml_table(Holder, tomllib.loads(text)).ground.under(properties)


def test_friction_alone():
    assert under("ground = { friction = 0.4 }") == rf.Ground(0.4)
    assert under("[ground]\nfriction = inf") == rf.Ground(math.inf)


def test_springs_are_at_the_edges_unless_positions_are_given():
    ground = under("[ground]\nbase_inertia = 3e4\n[ground.springs]\nstiffness = 4e8\ndamping = 2e6")
    assert ground == rf.Ground(springs=rf.Springs([-B, B], 4e8, 2e6), base_inertia=3e4)
    aside = rf.Eccentric(FRAME, 0.1).rocking()
    ground = under("[ground]\nbase_inertia = 3e4\nsprings = { stiffness = [4e8, 5e8] }", aside)
    assert ground.springs == rf.Springs([-B - 0.1, B - 0.1], [4e8, 5e8])
    ground = under(
        "[ground]\nbase_inertia = 3e4\nfriction = [0.3, 0.4, inf]\n[ground.springs]\npositions = [-0.5, 0, 0.5]\n"
        "stiffness = 4e8\ndamping = [1e6, 0.0, 1e6]"
    )
    springs = rf.Springs([-0.5, 0.0, 0.5], 4e8, [1e6, 0.0, 1e6])
    assert ground == rf.Ground([0.3, 0.4, math.inf], springs, 3e4)


def test_a_bed_has_the_width_of_the_structure():
    text = "[ground]\nmat_mass = 4e4\n[ground.bed]\nbreadth = 3.0\nsubgrade_modulus = 4e7\ndamping = 3e6\nn = 8\n"
    aside = rf.Eccentric(FRAME, 0.1).rocking()
    for properties in (PROPERTIES, PROPERTIES.with_half_width(1.4 * B), aside):
        width, e = properties.half_width, properties.eccentricity
        ground = under(text, properties)
        assert ground.springs == rf.winkler_bed(width, 3.0, 4e7, damping=3e6, n=8, eccentricity=e)
        assert ground.base_inertia == pytest.approx(4e4 * (2.0 * width) ** 2 / 12.0, rel=1e-15)
    ground = under(text + "end_zone = 0.2\nend_ratio = 3.0")
    assert ground.springs == rf.winkler_bed(B, 3.0, 4e7, damping=3e6, n=8, end_zone=0.2, end_ratio=3.0)


def test_a_bed_with_the_ends_of_asce_41():
    text = "[ground]\nbase_inertia = 3e4\n[ground.bed]\nbreadth = 3.0\nshear_modulus = 2e7\npoisson_ratio = 0.35"
    assert under(text).springs == rf.asce41_bed(B, 3.0, 2e7, 0.35)
    assert under(text + "\nheave_damping_ratio = 0.3").springs == rf.asce41_bed(B, 3.0, 2e7, 0.35).damped(0.3, MASS)


def test_a_bed_with_the_stiffness_of_gazetas():
    text = "[ground]\nbase_inertia = 3e4\n[ground.bed]\nbreadth = 3.0\nshear_modulus = 2e7\npoisson_ratio = 0.35\n"
    aside = rf.Eccentric(FRAME, 0.1).rocking()
    for properties in (PROPERTIES, aside):
        soil, e = (properties.half_width, 3.0, 2e7, 0.35), properties.eccentricity
        bed = under(text + 'method = "gazetas"', properties).springs
        assert bed == rf.gazetas_bed(*soil, eccentricity=e)
        two = under(text + 'method = "gazetas"\nn = 2\ndensity = 1.9e3', properties).springs
        assert two == rf.gazetas_bed(*soil, n=2, density=1.9e3, eccentricity=e)
    zone = under(text + 'method = "gazetas"\nend_zone = 0.2\nheave_damping_ratio = 0.3').springs
    assert zone == rf.gazetas_bed(B, 3.0, 2e7, 0.35, end_zone=0.2).damped(0.3, MASS)
    assert under(text + 'method = "asce41"').springs == rf.asce41_bed(B, 3.0, 2e7, 0.35)


BED = "[ground]\nbase_inertia = 3e4\n[ground.bed]\nbreadth = 3.0\n"
GAZETAS = BED + 'shear_modulus = 2e7\npoisson_ratio = 0.3\nmethod = "gazetas"\n'
SPRINGS = "[ground]\nbase_inertia = 3e4\n[ground.springs]\nstiffness = 4e8\n"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "message", "field"),
    [
        ("[ground]", "[ground]: Ground needs friction, springs or both: Ground(friction=0.4)", "ground.friction"),
        ("[ground]\nfriction = -0.4", "[ground]: friction must be a positive Coulomb coefficient", "ground.friction"),
        ("[ground]\nfriction = 'rough'", "[ground] friction must be the Coulomb coefficient between base", None),
        ("[ground]\nfrction = 0.4", "[ground] frction is not known; there are friction, base_inertia", None),
        ("[ground]\nsprings = { damping = 1e6 }", "[ground.springs] stiffness is missing: the stiffness", None),
        ("[ground]\nbed = { n = 3.5 }", "[ground.bed] breadth is missing: the dimension of the base", None),
        (SPRINGS + "damping = -1.0", "[ground.springs]: damping must be zero or positive", "ground.springs.damping"),
        (SPRINGS.replace("base_inertia = 3e4", ""), "[ground]: A base without rotary inertia", "ground.base_inertia"),
        (SPRINGS.replace("base", "mat_mass = 4e4\nbase"), "[ground]: mat_mass was given besides", "ground.mat_mass"),
        ("[ground]\nmat_mass = 4e4\nfriction = 0.3", "[ground]: base_inertia belongs", "ground.base_inertia"),
        (SPRINGS + "positions = []", "[ground.springs]: positions must have 2 to 200", "ground.springs.positions"),
        (SPRINGS + "damping = 1e6\nheave_damping_ratio = 0.1", "[ground.springs]: heave_damping_ratio was given "
         "besides the damping. Leave one of them out.", "ground.springs.heave_damping_ratio"),
        (SPRINGS + "heave_damping_ratio = -0.1", "[ground.springs]: heave_damping_ratio must be a zero or positive, "
         "finite number in fractions of critical damping, but -0.1 was given.", "ground.springs.heave_damping_ratio"),
        (SPRINGS + "[ground.bed]\nbreadth = 3.0\nsubgrade_modulus = 4e7", "[ground]: The ground has springs and a bed. "
         "Give one of the two tables.", "ground.bed"),
        (BED, "[ground.bed]: A bed needs its stiffness. Give subgrade_modulus", "ground.bed.subgrade_modulus"),
        (BED + "shear_modulus = 2e7", "[ground.bed]: A bed needs its stiffness.", "ground.bed.subgrade_modulus"),
        (BED + "subgrade_modulus = 4e7\npoisson_ratio = 0.3", "[ground.bed]: subgrade_modulus was given besides the "
         "shear_modulus and poisson_ratio. Leave one of them out.", "ground.bed.subgrade_modulus"),
        (BED + "shear_modulus = 2e7\npoisson_ratio = 0.3\nend_ratio = 2.0", "[ground.bed]: end_ratio was given besides "
         "the shear_modulus, whose end zones are those of ASCE 41. Leave one of them out.", "ground.bed.end_ratio"),
        (GAZETAS.replace("gazetas", "asce41") + "density = 2e3", "[ground.bed]: density is for", "ground.bed.density"),
        (GAZETAS + "end_ratio = 2.0", "[ground.bed]: end_ratio was given besides", "ground.bed.end_ratio"),
        (GAZETAS + "damping = 1e6", "[ground.bed]: damping was given besides", "ground.bed.damping"),
        (GAZETAS + "density = 2e3\nheave_damping_ratio = 0.1", "[ground.bed]: density was", "ground.bed.density"),
        (BED + "subgrade_modulus = 4e7\nmethod = 'gazetas'", "[ground.bed]: method was given", "ground.bed.method"),
        (BED + "subgrade_modulus = -4e7", "[ground.bed]: subgrade_modulus", "ground.bed.subgrade_modulus"),
    ],
)  # fmt: skip
def test_messages(text, message, field):
    with pytest.raises(rf.InputError) as raised:
        under(text)
    assert str(raised.value).startswith(message)
    assert raised.value.field == field


def test_a_structure_file_may_hold_the_ground_of_rockflex_run(tmp_path):
    path = tmp_path / "block.toml"
    path.write_text("block = { slenderness = 0.2, half_diagonal = 2.5 }\nground = { friction = 0.4 }\n")
    assert rf.read_structure(path) == rf.rigid_block(0.2, 2.5)


STUDY = """
name = "on its ground"
structures = [{ name = "block", block = { slenderness = 0.2, half_diagonal = 2.5, mass = 5e3 } }]
models = ["rigid"]
records = { suites = ["el-centro-1940"] }
[ground]
friction = 0.15
"""
KINDS = {
    "cloud": "",
    "incremental": "smallest_scale = 0.5\nlargest_scale = 4.0\ngrowth = 2.0\ntolerance = 0.1\n",
    "stripes": 'measure = "pga"\nlevels = [1.0, 2.0]\n',
    "design": "half_widths = [0.4, 0.6]\nscales = [1.0]\nlevel = 0.5\n",
}


@pytest.fixture
def made(monkeypatch):
    """Return the grounds that reach a model, which is then built without them."""
    grounds = []

    def grounded(label, kept, ground, law, missing_mass, **_kind):
        grounds.append(ground)
        return RockingModel(label, kept, True, law or rf.VVELSimplified(), missing_mass)

    monkeypatch.setattr(_label, "model_on_ground", grounded)
    return grounds


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_study_takes_the_ground(made, tmp_path, kind):
    path = tmp_path / "study.toml"
    path.write_text(f'study = "{kind}"\n{KINDS[kind]}{STUDY}')
    study = rf.load_study(path)
    assert study.document()["ground"] == {"friction": 0.15}
    rf.run_study(study, tmp_path / "out", workers=1)
    assert made
    assert all(ground == rf.Ground(0.15) for ground in made)


def test_a_bed_follows_the_width_of_each_design(made, tmp_path):
    path = tmp_path / "study.toml"
    bed = "base_inertia = 1e4\nbed = { breadth = 2.0, subgrade_modulus = 5e8 }"
    path.write_text(f'study = "design"\n{KINDS["design"]}{STUDY.replace("friction = 0.15", bed)}')
    rf.run_study(rf.load_study(path), tmp_path / "out", workers=1)
    assert {round(ground.springs.area.sum() / 4.0, 9) for ground in made} == {0.4, 0.6}


def test_a_plan_takes_its_ground_to_other_processes(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(f'study = "cloud"\n{STUDY}')
    plan = rf.load_study(path).plan()
    matrix = pickle.loads(pickle.dumps(plan)).matrix
    assert matrix.options.ground(PROPERTIES) == rf.Ground(0.15)


def test_friction_that_prevents_sliding_is_resumed(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(f'study = "cloud"\n{STUDY.replace("0.15", "inf")}')
    first, again = (rf.run_study(rf.load_study(path), tmp_path / "out", workers=1) for _ in range(2))
    assert first.equals(again)
    path.write_text(f'study = "cloud"\n{STUDY.replace("0.15", "inf").partition("[ground]")[0]}')
    rigid = rf.run_study(rf.load_study(path), workers=1)
    assert first["max_rotation"].tolist() == rigid["max_rotation"].tolist()


def test_a_ground_that_no_structure_can_have_stops_a_study(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(f'study = "cloud"\n{STUDY.replace("0.15", "[0.1, 0.2]")}')
    with pytest.raises(rf.InputError, match=r"^\[ground\]: friction must be .* Several coefficients need springs"):
        rf.load_study(path).plan()


def random_study(**ground):
    return rf.MonteCarloStudy(
        count=3,
        records={"suites": ["el-centro-1940"]},
        models=["2DOF-S"],
        records_per_structure=1,
        variables={"mu": {"uniform": [0.2, 0.6]}, "modulus": {"lognormal": [4e8, 0.3]}, "width": {"uniform": [2, 3]}},
        structure={
            "wall_frame": {
                "height": 12.0, "mass": 2e5, "stiffness_parameter": 0.0, "base_mass": 4e4, "period": 0.4,
                "aspect_ratio": "= width", "damping_ratio": 0.03, "n_modes": 2},
        },
        ground=ground,
    )  # fmt: skip


BEDS = {"breadth": "= half_width", "subgrade_modulus": "= modulus", "heave_damping_ratio": 0.2}


def test_friction_and_stiffness_are_random(made):
    study = random_study(friction="= mu", bed=BEDS, mat_mass="= 0.1 * weight / 9.81")
    plan = study.plan()
    drawn = [study.population().variables.draw(study.seed, number) for number in range(3)]
    grounds = [study.ground_of(number) for number in range(3)]
    for number, (values, ground) in enumerate(zip(drawn, grounds, strict=True)):
        p = study.structure_of(number)
        bed = rf.winkler_bed(p.half_width, p.half_width, values["modulus"]).damped(0.2, p.m_tot)
        assert ground.springs == bed
        np.testing.assert_array_equal(ground.friction, values["mu"])
        assert ground.base_inertia == pytest.approx(0.1 * p.m_tot * (2.0 * p.half_width) ** 2 / 12.0, rel=1e-14)
    for unit in range(plan.n_units):
        assert set(plan.results([unit])["error"]) == {None}
    assert made == grounds
    assert len(set(grounds)) == 3


def test_a_ground_that_cannot_be_built_is_a_message_in_its_rows(made):
    plan = random_study(bed=BEDS | {"subgrade_modulus": "= 5e8 * (mu - 0.4)"}, base_inertia=1e4).plan()
    errors = list(filter(None, plan.results(range(plan.n_units))["error"]))
    assert errors
    assert len(made) == 3 - len(errors)
    assert all(error.startswith("[ground.bed]: subgrade_modulus must be a positive") for error in errors)


@pytest.mark.parametrize(
    ("ground", "message"),
    [
        ({"friction": "= muu"}, "[ground] friction: "),
        ({"frction": "= mu"}, "[ground] frction is not known; there are friction,"),
        ({"friction": "= 1 / (mu - mu)"}, "[ground] friction: The formula '= 1 / (mu - mu)' has no value"),
        ({"friction": -0.1}, "[ground]: friction must be a positive"),
    ],
)
def test_wrong_grounds_of_random_structures(ground, message):
    with pytest.raises(rf.InputError) as raised:
        random_study(**ground).plan()
    assert message in str(raised.value)


def test_without_a_ground_a_study_has_none():
    study = random_study(friction=0.3)
    assert study.ground_of(0) == rf.Ground(0.3)
    assert rf.MonteCarloStudy(**study.document() | {"ground": None}).ground_of(0) is None
