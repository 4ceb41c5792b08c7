"""The ground on its way to a model: what is refused, and that every run and study passes it on."""

import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import _label
from rockflex.models._rocking_model import RockingModel

FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=8.0)
PROPERTIES = FRAME.rocking()
B = PROPERTIES.half_width
SPRINGS = rf.Springs([-B, B], 1e9, 1e6)
ON_SPRINGS = rf.Ground(springs=SPRINGS, base_inertia=2e4)
SLIDES = rf.Ground(friction=0.3)
PULSE = rf.one_sine_pulse(amplitude=3.0, period=0.8)
YIELDING = rf.BoucWen(yield_displacement=0.05)


@pytest.fixture
def made(monkeypatch):
    """Return the grounds, labels and laws that reach a model, whose ground is then left out."""
    calls = []

    def grounded(label, kept, ground, law, missing_mass, **_kind):
        calls.append((label, ground, law))
        return RockingModel(label, kept, True, law or rf.VVELSimplified(), missing_mass)

    monkeypatch.setattr(_label, "model_on_ground", grounded)
    return calls


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S", "rigid", "2DOF-S-R", "MDOF-C", "3DOF-C-SI", "rigid-C"])
def test_models_that_lift_take_a_ground(made, model):
    tied = _label.parse_model(model)
    tied.of(PROPERTIES, ground=ON_SPRINGS)
    tied.of(PROPERTIES, rf.Restitution(0.9), ground=SLIDES)
    tied.of(PROPERTIES, ground=SLIDES)
    (on, slides, own) = made
    assert on == (model, ON_SPRINGS, None)
    assert slides == (model, SLIDES, rf.Restitution(0.9))
    assert own[2] == tied.of(PROPERTIES).law


def test_friction_that_prevents_sliding_is_rigid_ground():
    model = rf.Model(1)
    assert model.of(PROPERTIES, ground=rf.Ground(math.inf)) == model.of(PROPERTIES)
    fixed = rf.Model(1, lifts=False)
    assert fixed.of(PROPERTIES, ground=rf.Ground(math.inf)) == fixed.of(PROPERTIES)


@pytest.mark.parametrize(
    ("model", "instead"),
    [("fixed", "MDOF-S"), ("1DOF-fixed", "2DOF-S"), ("1DOF-fixed-BW-R", "2DOF-S-BW-R")],
)
@pytest.mark.parametrize(("ground", "needs"), [(ON_SPRINGS, "Springs need"), (SLIDES, "Friction needs")])
def test_other_models_do_not(model, instead, ground, needs):
    with pytest.raises(rf.InputError) as raised:
        rf.simulate(FRAME, PULSE, model, bouc_wen=YIELDING if "BW" in model else None, ground=ground)
    assert str(raised.value) == (
        f"{needs} a model whose base can lift, but {model} was given. Use {instead}, or leave the ground out."
    )
    assert raised.value.field == "ground"


def test_no_impact_law_acts_on_springs():
    with pytest.raises(rf.InputError) as raised:
        rf.simulate(FRAME, PULSE, impact=rf.Restitution(0.5), ground=ON_SPRINGS)
    assert str(raised.value).startswith("No impact law acts on springs: what a landing dissipates, their dashpots")
    assert raised.value.field == "impact"


@pytest.mark.parametrize(("ground", "does"), [(ON_SPRINGS, "stands on springs"), (SLIDES, "slides")])
def test_no_model_has_friction_dampers_as_well(ground, does):
    held = rf.Restrained(FRAME, rf.FrictionDamper(1e4))
    with pytest.raises(rf.InputError) as raised:
        rf.simulate(held, PULSE, ground=ground)
    assert str(raised.value) == (
        f"No model has friction dampers under a base that {does}. Use a YieldingDissipator with yield_force = F_0 and "
        "a stiffness far above that of the structure, or leave the ground out."
    )


def test_springs_are_under_the_base(made):
    rounded = rf.Springs([-B * (1.0 + 1e-12), B * (1.0 + 1e-12)], 1e9)
    rf.simulate(FRAME, PULSE, "2DOF-S", ground=rf.Ground(springs=rounded, base_inertia=2e4))
    aside = rf.Eccentric(FRAME, 0.2 * B)
    shifted = rf.Springs([-1.2 * B, 0.8 * B], 1e9)
    rf.simulate(aside, PULSE, "2DOF-S", ground=rf.Ground(springs=shifted, base_inertia=2e4))
    assert len(made) == 2
    with pytest.raises(rf.InputError) as raised:
        rf.simulate(aside, PULSE, "2DOF-S", ground=ON_SPRINGS)
    left, right = -1.2 * B, 0.8 * B
    assert str(raised.value) == (
        f"The springs must be under the base, which reaches from {left:.6g} to {right:.6g} m from the axis of the "
        f"masses, but their positions reach from {-B:.6g} to {B:.6g} m. Move them, or use winkler_bed with the "
        "half_width and the eccentricity of the structure."
    )
    assert raised.value.field == "positions"


def test_soft_springs_let_the_structure_fall(made):
    needed = PROPERTIES.l0r * 9.81
    stiff = needed / (2.0 * B**2)
    rf.simulate(FRAME, PULSE, ground=rf.Ground(springs=rf.Springs([-B, B], 1.001 * stiff), base_inertia=2e4))
    assert made
    with pytest.raises(rf.InputError) as raised:
        rf.simulate(FRAME, PULSE, ground=rf.Ground(springs=rf.Springs([-B, B], 0.5 * stiff), base_inertia=2e4))
    assert str(raised.value) == (
        "The springs are too soft: the structure falls over under its own weight. Their stiffness against tilting is "
        f"{0.5 * needed:.4g} N m/rad, and must exceed L_0^r g = {needed:.4g} N m/rad. Check the unit, N/m, and "
        "multiply the stiffness by more than 2."
    )


@pytest.mark.parametrize(
    ("given", "described"), [(0.4, "float"), (rf.Ground, "the class Ground"), (SPRINGS, "Springs")]
)
def test_the_ground_is_a_ground(given, described):
    with pytest.raises(rf.InputError) as raised:
        rf.simulate(FRAME, PULSE, ground=given)
    assert str(raised.value) == (
        "ground must be a Ground, a function of RockingProperties that returns one, or None, but "
        f"{described} was given. Write Ground(friction=0.4), for example."
    )


def test_a_function_returns_a_ground():
    with pytest.raises(rf.InputError) as raised:
        rf.simulate(FRAME, PULSE, ground=lambda properties: properties.half_width)
    assert str(raised.value) == "ground must return a Ground for the properties of a structure, but it returned float."


def bed(properties):
    return rf.Ground(springs=rf.winkler_bed(properties.half_width, 3.0, 4e8), base_inertia=2e4)


def test_every_structure_of_a_table_stands_on_its_own_ground(made):
    wide = PROPERTIES.with_half_width(2.0 * B)
    table = rf.simulate_many([FRAME, wide], PULSE, ["2DOF-S", "fixed"], ground=bed)
    assert {ground.springs.positions[-1] for _, ground, _ in made} == {
        bed(PROPERTIES).springs.positions[-1], bed(wide).springs.positions[-1]
    }  # fmt: skip
    on_fixed = table[table["model"] == "fixed"]
    assert table["error"].notna().tolist() == [False, True, False, True]
    assert on_fixed["error"].str.startswith("Springs need").all()


def run_design(**ground):
    rf.run_design(FRAME, PULSE, [B, 1.5 * B], models="2DOF-S", **ground)


def search_design(**ground):
    search, cost = rf.DesignSearch([B, 1.5 * B], refinements=0), rf.DesignCost(1.0)
    targets = [rf.Requirement(0.02, 0.2, 0.5)]
    rf.search_design(FRAME, PULSE, search, targets, cost, "2DOF-S", scales=[0.5, 1.0], **ground)


RUNS = {
    "simulate": lambda **ground: rf.simulate(FRAME, PULSE, **ground),
    "simulate_many": lambda **ground: rf.simulate_many(FRAME, PULSE, "MDOF-S", **ground),
    "run_cloud": lambda **ground: rf.run_cloud(FRAME, PULSE, **ground),
    "run_incremental": lambda **ground: rf.run_incremental(FRAME, PULSE, "2DOF-S", growth=2.0, tolerance=0.1, **ground),
    "run_design": run_design,
    "search_design": search_design,
    "overturning_scales": lambda **ground: rf.overturning_scales(FRAME, PULSE, (0.5, 20.0), tolerance=0.05, **ground),
    "overturning_spectrum": lambda **ground: rf.overturning_spectrum(
        FRAME, rf.one_sine_pulse, [3.0], relative_amplitudes=(1.0, 10.0), tolerance=0.05, **ground
    ),
    "rocking_spectrum": lambda **ground: rf.rocking_spectrum(PULSE, [0.2], [4.0], **ground),
}


@pytest.mark.parametrize("run", RUNS.values(), ids=RUNS)
def test_every_run_passes_the_ground_on(made, run):
    run(ground=SLIDES)
    assert made
    assert all(ground is SLIDES for _, ground, _ in made)
    run(ground=lambda properties: rf.Ground(0.5 * properties.half_width))
    assert {type(ground.friction) for _, ground, _ in made} == {float}
    assert np.unique([ground.friction for _, ground, _ in made]).size > 1


@pytest.mark.parametrize("run", RUNS.values(), ids=RUNS)
def test_every_run_checks_the_ground(run):
    with pytest.raises(rf.InputError, match=r"^ground must be a Ground"):
        run(ground=0.4)
