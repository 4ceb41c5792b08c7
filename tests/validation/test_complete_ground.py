"""Complete and yielding models that slide or stand on springs, shaken both ways, against an independent integration."""

from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import parse_model
from rockflex.studies._prepared_case import PreparedCase
from twins.grounded_complete import Bar, Dashpot, Phase, Twin

FRAME = make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)
P = FRAME.rocking()
B, WEIGHT, DT = P.half_width, P.m_tot * 9.81, 0.01
INERTIA = 60e3
TIME = DT * np.arange(180)
SHAKING = 9.0 * np.sin(6.0 * TIME) * np.exp(-0.2 * TIME) * np.minimum(1.0, TIME / 0.3)
UPWARDS = 3.0 * np.sin(11.0 * TIME)
MODES = {"MDOF-C": None, "3DOF-C-SI": 2, "2DOF-C-SI": 1}
EDGES = rf.Springs([-B, B], 3e8, 3e6)
BARE = rf.Springs([-B, B], 3e8)
BED = rf.Springs([-B, -0.4 * B, 0.4 * B, B], 1e8, 1e6)
GROUNDS = {
    "slides": rf.Ground(friction=0.25),
    "springs": rf.Ground(springs=EDGES, base_inertia=INERTIA),
    "both": rf.Ground(springs=EDGES, base_inertia=INERTIA, friction=0.3),
}
ELEMENTS = [
    rf.Tendon(0.1 * WEIGHT, 2e7),
    rf.YieldingDissipator(5e7, 0.1 * WEIGHT, 0.03, 0.7 * B),
    rf.ViscousDamper(1e6, -0.5 * B),
]


def of_twin():
    """The elements as the twin knows them."""
    bars = [Bar(2e7, initial=0.1 * WEIGHT), Bar(5e7, 0.1 * WEIGHT, 0.03, 0.7 * B)]
    return {"bars": bars, "dashpots": [Dashpot(1e6, -0.5 * B)]}


def both(model, ground, *, scale=1.0, vertical=None, elements=(), shift=0.0):
    """The run of a model, and the twin's."""
    bare = rf.Eccentric(FRAME, shift * B) if shift else FRAME
    springs, more = ground.springs, of_twin() if elements else {}
    if springs is not None:
        parts = (springs.positions, springs.stiffness, springs.damping)
        more |= dict(zip(("places", "k", "c"), map(np.array, parts), strict=True)) | {"base_inertia": INERTIA}
    friction = None if ground.friction is None else float(np.max(ground.friction))
    twin = Twin(bare.rocking(MODES[model]), friction=friction, **more)
    y, _ = twin.run(scale * SHAKING, DT, vertical)
    structure = rf.Restrained(bare, list(elements)) if elements else bare
    motion = rf.GroundMotion(scale * SHAKING, DT, vertical=vertical)
    return rf.simulate(structure, motion, model, ground=ground), twin, y


def check(run, twin, y, rel):
    assert run.max_rotation == pytest.approx(twin.peaks[0], rel=rel)
    assert (run.n_uplifts, run.n_impacts) == (twin.counts["uplift"], twin.counts["impact"])
    assert run.rotation[-1] == pytest.approx(y[twin.n], abs=10.0 * rel * run.max_rotation)
    assert run.history.modal_displacement[-1] == pytest.approx(y[: twin.n], abs=10.0 * rel * twin.peaks[1])
    if twin.friction is not None:
        assert run.max_slip == pytest.approx(twin.peaks[2], rel=rel)
        assert run.residual_slip == pytest.approx(y[twin.n + 1], abs=rel * run.max_slip)
        assert run.energy.friction[-1] > 0.0
    assert run.energy.closing_error < 1e-10


SLIDING = {
    "all modes": ("MDOF-C", 0.17, {}),
    "shaken": ("3DOF-C-SI", 0.22, {"vertical": UPWARDS}),
    "rough and strong": ("2DOF-C-SI", 0.4, {"scale": 2.0}),
    "with elements": ("2DOF-C-SI", 0.3, {"scale": 1.6, "vertical": UPWARDS, "elements": ELEMENTS}),
    "eccentric": ("2DOF-C-SI", 0.25, {"shift": 0.15}),
    "without pressure": ("2DOF-C-SI", 0.3, {"scale": 1.5, "vertical": 4.5 * UPWARDS}),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SLIDING)
def test_a_base_that_slides(name):
    model, friction, options = SLIDING[name]
    run, twin, y = both(model, rf.Ground(friction=friction), **options)
    check(run, twin, y, 1e-7)
    kinds = {kind for _, kind in twin.track}
    assert {"slip", "stick", "impact"} <= kinds
    if name == "without pressure":
        assert "pressure" in kinds
        assert run.min_vertical_reaction < 0.0
    elif run.min_vertical_reaction > 0.0:  # it never demands more than Coulomb's law allows
        assert run.required_friction == pytest.approx(friction, rel=1e-9)
    if name == "with elements":
        assert {"yield", "back"} <= kinds


ON_SPRINGS = {
    "all modes": ("MDOF-C", {"springs": EDGES}, {}),
    "shaken": ("3DOF-C-SI", {"springs": EDGES}, {"vertical": UPWARDS}),
    "without dashpots": ("2DOF-C-SI", {"springs": BARE}, {}),
    "a bed that slides": ("2DOF-C-SI", {"springs": BED, "friction": 0.3}, {"scale": 2.0, "vertical": UPWARDS}),
    "slippery": ("MDOF-C", {"springs": EDGES, "friction": 0.15}, {}),
    "with elements": ("2DOF-C-SI", {"springs": EDGES}, {"elements": ELEMENTS, "vertical": UPWARDS}),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ON_SPRINGS)
def test_a_base_on_springs(name):
    model, ground, options = ON_SPRINGS[name]
    run, twin, y = both(model, rf.Ground(**ground, base_inertia=INERTIA), **options)
    check(run, twin, y, 1e-7 if "friction" in ground else 1e-8)
    assert run.heave[-1] == pytest.approx(y[twin.n + 2], abs=1e-7 * run.max_edge_uplift)
    if name == "with elements":
        assert {"yield", "back"} <= {kind for _, kind in twin.track}
        assert (run.energy.elements[-1, 1:] > 0.0).all()


@pytest.mark.slow
@pytest.mark.parametrize("ground", GROUNDS)
def test_reactions_are_those_of_newton(ground):
    """At every state that lies within a phase: what the twin's constraints and springs carry."""
    run, twin, _ = both("2DOF-C-SI", GROUNDS[ground], vertical=UPWARDS)
    n, model = twin.n, run.history.model
    alone = np.flatnonzero((np.diff(run.time, prepend=-1.0) > 0.0) & (np.diff(run.time, append=99.0) > 0.0))
    branches = model.branches_at(run.side, run.rotation, run.history.states).astype(int)
    seen = set()
    for place in alone[:: max(alone.size // 40, 1)]:
        key = branches[place].tolist()
        slip = key[1 + len(EDGES.positions)] if model.springs is not None else key[-1]
        loaded = tuple(each == 0 for each in key[1:3]) if model.springs is not None else ()
        phase = Phase(side=int(run.side[place]), slip=slip, loaded=loaded)
        q, v = np.zeros(n + 3), np.zeros(n + 3)
        q[:n], v[:n] = run.history.modal_displacement[place], run.history.modal_velocity[place]
        q[n], v[n] = run.rotation[place], run.rotation_velocity[place]
        q[n + 1], v[n + 1] = run.slip[place], run.history.slip_velocity[place]
        shaking = run.history.ground_acceleration[place], run.history.vertical_ground_acceleration[place]
        if model.springs is not None:
            layout = model.layout
            q[n + 2], v[n + 2] = run.heave[place], layout.of(run.history.states, layout.heave + 1)[place]
        found, (_, across, upwards), grip = twin.solve(q, v, *shaking, phase)
        if model.springs is not None:
            pushes = np.where(loaded, twin.push(q, v), 0.0)
            np.testing.assert_allclose(run.spring_force[place], pushes, atol=1e-9 * WEIGHT)
            upwards = pushes.sum()
            across = across if slip == 0 else -slip * grip
        elif slip:
            across = -slip * twin.friction * upwards
        assert run.vertical_reaction[place] == pytest.approx(upwards, abs=1e-9 * WEIGHT)
        assert run.horizontal_reaction[place] == pytest.approx(across, abs=1e-9 * WEIGHT)
        assert run.history.rotation_acceleration[place] == pytest.approx(found[n], rel=1e-9, abs=1e-9)
        seen.add((int(run.side[place]) != 0, slip != 0, loaded))
    assert len(seen) >= 3


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("model", ["2DOF-C", "2DOF-S"])
def test_a_yielding_structure_that_never_yields_is_an_elastic_one(ground, model):
    motion = rf.GroundMotion(SHAKING, DT, vertical=UPWARDS)
    elastic = rf.simulate(FRAME, motion, model, ground=GROUNDS[ground])
    yielding = rf.simulate(FRAME, motion, model, ground=GROUNDS[ground], bouc_wen=rf.BoucWen(1e3))
    assert yielding.model == f"{model}-BW"
    assert (yielding.n_uplifts, yielding.n_impacts) == (elastic.n_uplifts, elastic.n_impacts)
    for name in ("max_rotation", "max_slip", "max_base_moment", "max_edge_uplift", "min_vertical_reaction"):
        expected = getattr(elastic, name)
        assert getattr(yielding, name) == pytest.approx(expected, rel=1e-7, abs=1e-9), name
    weak = rf.simulate(FRAME, motion, model, ground=GROUNDS[ground], bouc_wen=rf.BoucWen(0.02))
    assert weak.energy.yielded[-1] > 0.0
    assert max(weak.energy.closing_error, yielding.energy.closing_error) < 1e-9


@pytest.mark.parametrize("ground", GROUNDS)
def test_a_constant_vertical_acceleration_is_another_gravity(ground):
    tied = parse_model("2DOF-C").of(P, ground=GROUNDS[ground])
    run = PreparedCase(tied).run(rf.GroundMotion(SHAKING, DT, vertical=np.full(TIME.size, 2.0)))
    other = PreparedCase(replace(tied, gravity=tied.gravity + 2.0)).run(rf.GroundMotion(SHAKING, DT))
    for name in ("max_rotation", "max_top_displacement", "max_base_moment", "max_slip", "min_vertical_reaction"):
        assert getattr(run, name) == pytest.approx(getattr(other, name), rel=1e-9), name


def test_friction_that_always_suffices_changes_nothing():
    motion = rf.GroundMotion(SHAKING, DT, vertical=UPWARDS)
    free = rf.simulate(FRAME, motion, "MDOF-C")
    held = rf.simulate(FRAME, motion, "MDOF-C", ground=rf.Ground(friction=2.0 * free.required_friction))
    assert held.max_slip == 0.0
    assert (held.n_uplifts, held.n_impacts) == (free.n_uplifts, free.n_impacts)
    for name in ("max_rotation", "max_top_displacement", "min_vertical_reaction", "max_horizontal_reaction"):
        assert getattr(held, name) == pytest.approx(getattr(free, name), rel=1e-8), name


def test_stiff_springs_hold_a_rocking_base_like_rigid_ground():
    """Released from a rotation it falls as about the edge; what is left is that the axis does not move sideways."""
    start = {"initial": rf.InitialState(rotation=0.005)}
    motion = rf.quiet_motion(0.07, dt=0.01)
    rigid = rf.simulate(FRAME, motion, "2DOF-C-SI", **start)
    apart = []
    for stiffness in (1e10, 1e11, 1e12):
        springs = rf.Springs([-B, B], stiffness, 0.3 * np.sqrt(stiffness * P.m_tot))
        ground = rf.Ground(springs=springs, base_inertia=10.0)
        run = rf.simulate(FRAME, motion, "2DOF-C-SI", ground=ground, **start)
        apart.append(abs(run.rotation[-1] - rigid.rotation[-1]) / 0.005)
    assert apart[0] > 3.0 * apart[1] > 9.0 * apart[2]
    assert apart[2] < 2e-3


@pytest.mark.parametrize("ground", ["slides", "springs"])
def test_small_rotations_are_those_of_the_simplified_model(ground):
    """Released from a rotation on slippery ground, or on springs that sink by as much: the difference falls like it.

    The fall lasts as long as the root of the rotation, and bends the structure in proportion to the rotation.
    """
    apart = []
    for size in (1e-3, 1e-4):
        under = rf.Ground(friction=0.05)
        if ground == "springs":
            under = rf.Ground(springs=rf.Springs([-B, B], WEIGHT / (B * size)), base_inertia=3e6)
        start = {"initial": rf.InitialState(rotation=size), "ground": under}
        motion = rf.quiet_motion(0.7 * np.sqrt(size), dt=0.01 * np.sqrt(size))
        one, other = (rf.simulate(FRAME, motion, model, **start) for model in ("MDOF-C", "MDOF-S"))
        times = np.linspace(0.0, 0.7 * np.sqrt(size), 50)
        turned = [run.history.at(times).rotation for run in (one, other)]
        apart.append(np.abs(turned[0] - turned[1]).max() / size)
        if ground == "slides":
            assert one.max_slip > 0.0
    assert 1e-5 < apart[0] < 0.01
    assert apart[1] == pytest.approx(0.1 * apart[0], rel=0.2)


def test_a_base_tilted_by_its_eccentricity_stands():
    """Its springs differ, so that it leans, and the structure bends under its weight."""
    ground = rf.Ground(springs=rf.Springs([-B, 0.9 * B], 2e8, 3e6), base_inertia=INERTIA)
    run = rf.simulate(rf.Eccentric(FRAME, 0.1 * B), rf.quiet_motion(2.0), "MDOF-C", ground=ground)
    assert abs(run.rotation[0]) > 1e-4
    assert np.abs(run.top_displacement[0]) > 0.0
    np.testing.assert_allclose(run.rotation, run.rotation[0], rtol=1e-10)
    np.testing.assert_allclose(run.top_displacement, run.top_displacement[0], rtol=1e-8)
    np.testing.assert_allclose(run.vertical_reaction, WEIGHT, rtol=1e-10)


@pytest.mark.parametrize("ground", GROUNDS)
def test_runs_settle_where_they_stood(ground):
    run = rf.simulate(FRAME, rf.GroundMotion(SHAKING, DT), "2DOF-C", ground=GROUNDS[ground], free_vibration="settle")
    assert run.settled
    assert run.residual_rotation == pytest.approx(0.0, abs=1e-9)
    assert run.residual_slip == run.slip[-1]


def test_a_block_slides_on_through_its_impacts():
    block = rf.rigid_block(slenderness=0.25, half_diagonal=4.0, mass=1e5)
    options = {"ground": rf.Ground(friction=0.3), "impact": rf.Restitution(0.9)}
    run = rf.simulate(block, rf.GroundMotion(SHAKING, DT), "rigid-C", free_vibration=3.0, **options)
    assert run.n_impacts >= 2
    assert run.max_slip > 1e-3
    assert run.energy.closing_error < 1e-12
    slender = rf.rigid_block(slenderness=0.1, half_diagonal=3.0)
    motion = rf.GroundMotion(np.concatenate((np.full(20, -40.0), np.full(100, 900.0))), DT)
    with pytest.raises(rf.InputError, match=r"The base of rigid-C jams: with so large a friction coefficient, no "):
        rf.simulate(slender, motion, "rigid-C", ground=rf.Ground(friction=40.0))


@pytest.mark.parametrize("ground", GROUNDS)
def test_a_saved_response_knows_its_ground(ground, tmp_path):
    motion = rf.GroundMotion(SHAKING, DT, vertical=UPWARDS)
    for more in ({}, {"bouc_wen": rf.BoucWen(0.02)}):
        run = rf.simulate(FRAME, motion, "2DOF-C", ground=GROUNDS[ground], **more)
        back = rf.Response.load(run.save(tmp_path / "run"))
        assert back.history.model == run.history.model
        for name in ("slip", "heave", "edge_uplift", "spring_force", "vertical_reaction", "base_moment"):
            np.testing.assert_array_equal(getattr(back, name), getattr(run, name))
        assert back.energy.closing_error < 1e-9
        fine = run.history.resample(0.0025)
        assert np.abs(fine.rotation).max() == pytest.approx(run.max_rotation, rel=1e-3)
        assert np.abs(fine.slip).max() <= run.max_slip * (1.0 + 1e-6)


def test_tables_have_both_kinds_of_models():
    motions = [rf.GroundMotion(SHAKING, DT, name="level"), rf.GroundMotion(0.5 * SHAKING, DT, name="weak")]
    table = rf.simulate_many(FRAME, motions, ["MDOF-S", "MDOF-C"], ground=GROUNDS["both"])
    assert table["error"].isna().all()
    one = rf.simulate(FRAME, motions[0], "MDOF-C", ground=GROUNDS["both"], output="peaks")
    row = table[(table["model"] == "MDOF-C") & (table["motion"] == "level")].iloc[0]
    assert row["max_rotation"] == one.max_rotation
    assert row["max_slip"] == one.max_slip
