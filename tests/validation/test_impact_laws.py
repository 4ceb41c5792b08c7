"""Impact laws by momentum: a worked example, masses one by one, losses, gains, decay, and the limit of rigid blocks.

The worked example was computed from Lagrange's equations, independently of the package. Everything else is by masses:
m_i at (x, h_i) above the old pivot, displaced by u_i, with velocities h_i θ' + u'_i across and (x - u_i) θ' down.
"""

import math

import numpy as np
import pytest
from scipy.linalg import eigh

import rockflex as rf
from rockflex.models import housner

A, B, VVEL = rf.AngularMomentum(), rf.PivotImpulse(), rf.VVELSimplified()


def shear_column(n=3, mass=40e3, base_mass=40e3, rotary=9e5, half_width=2.0, stiffness=3e7, **more):
    """A uniform shear column of lumped masses: its properties, and heights, masses and shapes of the modes."""
    heights = 3.0 * np.arange(1.0, n + 1.0)
    masses = np.broadcast_to(mass, n).astype(float)
    chain = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    chain[-1, -1] = 1.0
    squares, shapes = eigh(stiffness * chain, np.diag(masses))
    shares = shapes.T @ masses  # Γ, with M-orthonormal shapes
    shapes = shapes * shares
    total = masses.sum() + base_mass
    translational = float(masses @ heights**2)
    properties = rf.RockingProperties(
        omega=np.sqrt(squares),
        effective_mass=shares**2,
        effective_height=(shapes.T @ (masses * heights)) / shares**2,
        top_ordinate=shapes[-1],
        i_theta=translational + rotary + total * half_width**2,
        l0r=float(masses @ heights),
        m_tot=total,
        half_width=half_width,
        zeta=0.02,
        translational_inertia=translational,
        **more,
    )
    return properties, heights, masses, shapes


COLUMN, *_ = shear_column()
BENT, MOVING, TURNING = np.array([0.05, -0.004, 0.001]), np.array([0.30, -0.05, 0.02]), -0.1


def energy(p, side, displacement, velocity, spin):
    """½ J θ'² + θ' Σ m* h* D' + ½ Σ m* D'² about the pivot of a side."""
    lean, square = p.effective_mass @ displacement, p.effective_mass @ displacement**2
    inertia = p.pivot(side).i_theta - 2.0 * side * p.pivot(side).arm * lean + square
    mixed = (p.effective_mass * p.effective_height) @ velocity
    return 0.5 * inertia * spin**2 + spin * mixed + 0.5 * p.effective_mass @ velocity**2


EXAMPLE = [
    (A, 3, False, -0.0805471125, MOVING, 7218.03072),
    (A, 3, True, -0.0802819617, MOVING, 7120.454088),
    (B, 3, False, -0.0168831169, [-0.26028582, 0.14996370, -0.11837917], 7480.519481),
    (B, 3, True, -0.0166621044, [-0.26177566, 0.15049541, -0.11874713], 7375.538685),
    (VVEL, 3, False, 0.0, [-0.37409388, 0.19058132, -0.14648744], 7700.0),
    (VVEL, 3, True, 0.0, [-0.37409388, 0.19058132, -0.14648744], 7592.37462),
    (A, 1, False, -0.0805471125, MOVING[:1], 7239.914571),
    (A, 1, True, -0.0802802776, MOVING[:1], 7142.016506),
    (B, 1, False, -0.0197833776, [-0.24073534], 7666.136170),
    (B, 1, True, -0.0195287199, [-0.24245198], 7561.569496),
]


@pytest.mark.parametrize(("law", "n", "complete", "spin", "velocity", "lost"), EXAMPLE)
def test_the_worked_example(law, n, complete, spin, velocity, lost):
    p, bent, moving = COLUMN.truncated(n), BENT[:n] * complete, MOVING[:n]
    found, turned = law.after(p, moving, TURNING, bent)
    assert turned == pytest.approx(spin, abs=0.6e-10)
    np.testing.assert_allclose(found, velocity, atol=0.6e-8)
    loss = energy(p, 1, bent, moving, TURNING) - energy(p, -1, bent, found, turned)
    assert loss == pytest.approx(lost, abs=0.6e-5)


def test_the_worked_example_says_what_it_is():
    assert (COLUMN.i_theta, COLUMN.effective_mass @ COLUMN.effective_height**2) == pytest.approx((6.58e6, 5.04e6))
    assert energy(COLUMN, 1, 0.0 * BENT, MOVING, TURNING) == pytest.approx(15552.715024, abs=0.6e-5)
    assert energy(COLUMN, 1, BENT, MOVING, TURNING) == pytest.approx(15445.089644, abs=0.6e-5)


def test_where_momentum_would_gain_energy_the_simplified_law_acts():
    """With D'_b = (1.2, 0, 0) the example would "lose" -5705.39 J; the bound is P/θ'_b = -S."""
    fast = np.array([1.2, 0.0, 0.0])
    share = 1.0 - 2.0 * COLUMN.m_tot * COLUMN.half_width**2 / COLUMN.i_theta
    zero = 0.0 * fast
    loss = energy(COLUMN, 1, zero, fast, TURNING) - energy(COLUMN, -1, zero, fast, share * TURNING)
    assert loss == pytest.approx(-5705.39, abs=0.005)
    for one, other in zip(A.after(COLUMN, fast, TURNING), VVEL.after(COLUMN, fast, TURNING), strict=True):
        np.testing.assert_array_equal(one, other)
    lever = COLUMN.effective_mass[0] * COLUMN.effective_height[0]
    bound = -(COLUMN.i_theta - COLUMN.m_tot * COLUMN.half_width**2) * TURNING / lever
    for factor, stops in ((1.0 + 1e-9, True), (1.0 - 1e-9, False)):
        _, spin = A.after(COLUMN, np.array([factor * bound, 0.0, 0.0]), TURNING)
        assert (spin == 0.0) == stops
        e = 0.3
        bound_of_e = -0.5 * (1.0 + e) * COLUMN.i_theta * TURNING / lever
        _, spin = rf.AngularMomentum(e).after(COLUMN, np.array([factor * bound_of_e, 0.0, 0.0]), TURNING)
        assert (spin == 0.0) == stops


def drawn(seed):
    """A random column, perhaps on an eccentric base, and a state at an impact, with masses at their places."""
    rng = np.random.default_rng(seed)
    n, b = int(rng.integers(1, 6)), float(rng.uniform(0.5, 3.0))
    shift = float(rng.uniform(-0.4, 0.4)) * b * (seed % 2)
    values = {"mass": rng.uniform(1e4, 8e4, n), "base_mass": rng.uniform(1e4, 2e5), "rotary": rng.uniform(0.0, 3e6)}
    p, heights, masses, shapes = shear_column(n, half_width=b, eccentricity=shift, **values)
    side = int(rng.choice([-1, 1]))
    return (
        p,
        side,
        rng.normal(0.0, 0.05, n),
        rng.normal(0.0, 0.5, n),
        -side * float(rng.uniform(0.01, 1.0)),
        (heights, masses, shapes, float(values["base_mass"]), float(values["rotary"])),
    )


def momenta(side, about, spin, displacement, velocity, masses_of):
    """Σ over the masses: angular momentum about a pivot while rocking on a side, and momenta of the modes."""
    (arm, to), (heights, masses, shapes, base_mass, rotary) = about, masses_of
    u, across = shapes @ displacement, heights * spin + shapes @ velocity
    down = u - side * arm  # lever of each mass from the pivot about which the base rotates
    lever = u - to  # and from that about which momentum is taken
    total = masses @ (heights * across + lever * down * spin) + base_mass * (-to) * (-side * arm) * spin + rotary * spin
    return total, shapes.T @ (masses * across)


@pytest.mark.parametrize("seed", range(60))
def test_momentum_of_the_masses(seed):
    """About the new pivot it is conserved; the modes keep their velocities, or no impulse acts on them."""
    p, side, bent, moving, spin, masses_of = drawn(seed)
    old, new = p.pivot(side).arm, p.pivot(-side).arm
    before, _ = momenta(side, (old, -side * new), spin, bent, moving, masses_of)
    velocity, turned = A.after(p, moving, spin, bent)
    if turned != 0.0:
        after, _ = momenta(-side, (new, -side * new), turned, bent, velocity, masses_of)
        assert after == pytest.approx(before, rel=1e-10, abs=1e-10 * p.i_theta * abs(spin))
        np.testing.assert_array_equal(velocity, moving)
    velocity, turned = B.after(p, moving, spin, bent)
    _, before_modes = momenta(side, (old, -side * new), spin, bent, moving, masses_of)
    after, after_modes = momenta(-side, (new, -side * new), turned, bent, velocity, masses_of)
    size = p.effective_mass * (abs(spin) * np.abs(p.effective_height) + np.abs(moving))
    np.testing.assert_array_less(np.abs(after_modes - before_modes), 1e-11 * size + 1e-9)
    if turned != 0.0:
        assert turned * spin > 0.0
        assert after == pytest.approx(before, rel=1e-10, abs=1e-10 * p.i_theta * abs(spin))
    else:  # about the old edge, which is pressed down as well: momentum about the new one would turn back
        still, _ = momenta(-side, (new, -side * new), 0.0, bent, moving + p.effective_height * spin, masses_of)
        assert (before - still) * spin <= 1e-12 * p.i_theta * spin**2


@pytest.mark.parametrize("seed", range(60))
def test_the_formulas_of_the_losses(seed):
    """Of A and B on a centred base, by the closed forms; on any base none gains."""
    p, side, bent, moving, spin, _ = drawn(seed)
    mass, height = p.effective_mass, p.effective_height
    lean, square, modal = float(mass @ bent), float(mass @ bent**2), float(mass @ height**2)
    before = energy(p, side, bent, moving, spin)
    for law in (A, rf.AngularMomentum(0.8), B, VVEL):
        velocity, turned = law.after(p, moving, spin, bent)
        loss = before - energy(p, -side, bent, velocity, turned)
        assert loss >= -1e-11 * before
        if p.eccentricity != 0.0 or turned == 0.0 or law is VVEL:
            continue
        b, m = p.half_width, p.m_tot
        rest, after = p.i_theta - m * b**2, p.i_theta + 2.0 * side * b * lean + square
        if law is B:
            expected = 2.0 * b**2 * spin**2 * (m * (rest - modal) + m * square - lean**2) / (after - modal)
        elif law is A:
            flow = spin * float((mass * height) @ moving)
            expected = spin**2 * b * (m * (rest + square) - lean**2) + (m * b + side * lean) * flow
            expected *= 2.0 * b / after
        else:
            continue
        assert loss == pytest.approx(expected, rel=1e-10, abs=1e-11 * before)


FRAMES = {f"{ratio:g} h/B {aspect:g}": (ratio, aspect) for ratio in (0.0, math.inf) for aspect in (5.0, 10.0)}


def frame(ratio, aspect, period=0.5, damping=0.02):
    return rf.Frame(5, 3.0, 40e3, 40e3, ratio, period=period, aspect_ratio=aspect, damping_ratio=damping)


def landings(run):
    """The states just before and after each impact: side, D, D', θ' and D', θ'."""
    spin, rotation, side, time = run.rotation_velocity, run.rotation, run.side, run.time
    for k in np.flatnonzero(run.history.model.impacts(run.history.states)):
        assert rotation[k] == rotation[k + 1] == 0.0
        assert time[k] == time[k + 1]
        after = run.modal_velocity[k + 1], spin[k + 1]
        yield int(side[k]), run.modal_displacement[k], run.modal_velocity[k], spin[k], *after


@pytest.mark.parametrize("name", FRAMES)
@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-S", "MDOF-C", "2DOF-C"])
def test_the_impacts_of_runs(name, model):
    """At every impact what the law says, and the loss; the share of guarded ones is that of runs, too."""
    structure, suite = frame(*FRAMES[name]), rf.load_suite("fema-p695-far-field")
    for law in (A, rf.AngularMomentum(0.9), B):
        run = rf.simulate(structure, suite[4].scaled(2.0), model, impact=law)
        p, guarded, n, lost = run.history.model.properties, 0, 0, []
        for side, displacement, velocity, spin, velocity_after, spin_after in landings(run):
            bent = displacement * ("-C" in model)
            expected, turned = law.after(p, velocity, spin, bent)
            before = energy(p, side, bent, velocity, spin)
            simplified = VVEL.after(p, velocity, spin)[0]
            too_short = turned != 0.0 and spin_after == 0.0  # contact begins, as by the simplified law
            np.testing.assert_allclose(velocity_after, simplified if too_short else expected, rtol=1e-9, atol=1e-12)
            assert spin_after == pytest.approx(0.0 if too_short else turned, rel=1e-11, abs=1e-15)
            loss = before - energy(p, -side, bent, velocity_after, spin_after)
            assert loss > -1e-12 * before
            guarded, n = guarded + (law is not B and turned == 0.0), n + 1
            lost.append(loss)
        assert n == run.n_impacts > 5
        assert run.guarded_impacts == pytest.approx(guarded / n)
        assert np.sum(lost) == pytest.approx(run.energy.lost[-1], rel=1e-9)
        assert run.energy.closing_error < 1e-9
        peaks = rf.simulate(structure, suite[4].scaled(2.0), model, impact=law, output="peaks")
        assert (peaks.guarded_impacts, peaks.max_rotation) == (run.guarded_impacts, run.max_rotation)


@pytest.mark.parametrize("seed", range(40))
def test_no_random_run_gains(seed):
    """Complete or not, eccentric or not, sliding, with elements: a gain would be a `SolverError`."""
    rng = np.random.default_rng(seed)
    suite = rf.load_suite("fema-p695-near-field-pulse")
    structure = rf.Frame(
        int(rng.integers(1, 7)),
        3.0,
        40e3,
        40e3,
        float(rng.choice([0.0, 0.2, math.inf])),
        period=float(rng.uniform(0.05, 1.5)),
        aspect_ratio=float(rng.uniform(2.0, 12.0)),
        damping_ratio=float(rng.choice([0.0, 0.02, 0.05])),
    )
    if seed % 4 == 1:
        structure = rf.Restrained(structure, [rf.Tendon(1e5, 2e6), rf.YieldingDissipator(5e6, 5e4, position=0.1)])
    if seed % 3 == 1:
        structure = rf.Eccentric(structure, float(rng.uniform(-0.3, 0.3)) * structure.rocking().half_width)
    ground = rf.Ground(friction=0.4) if seed % 5 == 2 else None
    motion = suite[int(rng.integers(len(suite)))].scaled(float(rng.uniform(0.5, 2.5)))
    models = ["MDOF-S", "MDOF-C", "2DOF-S", "2DOF-C-SI"]  # what modes leave out slides along, and is pushed
    model = str(rng.choice(models if ground is None else models[:2]))
    for law in (A, rf.AngularMomentum(float(rng.uniform(0.0, 1.0))), B):
        run = rf.simulate(structure, motion, model, impact=law, ground=ground)
        assert run.energy.closing_error < 1e-8
        assert (np.diff(run.energy.lost) >= -1e-9 * max(run.energy.input.max(), 1.0)).all()


def test_a_stack_of_many_structures_is_as_each_by_itself():
    many = [frame(ratio, aspect, period) for ratio, aspect in FRAMES.values() for period in (0.3, 0.8)]
    motion = rf.load_suite("fema-p695-far-field")[2].scaled(2.0)
    for law in (A, B):
        table = rf.simulate_many(many, motion, "MDOF-S", impact=law)
        for structure, row in zip(many, table.itertuples(), strict=True):
            one = rf.simulate(structure, motion, "MDOF-S", impact=law, output="peaks")
            assert (row.max_rotation, row.guarded_impacts) == (one.max_rotation, one.guarded_impacts)


STIFF = rf.Frame(5, 3.0, 40e3, 40e3, math.inf, period=0.02, aspect_ratio=5.0, damping_ratio=0.05)
DECAY = [
    (VVEL, 0.9488),
    (rf.Restitution(0.5), 0.9744),
    (rf.Restitution(0.9), 0.9949),
    (A, 0.8977),
    (rf.AngularMomentum(0.5), 0.4999),
    (B, 0.9488),
]


def let_go(structure, law, model="MDOF-S", share=0.3):
    """The rotation at which a structure is let go over α, and the next peak on the other side."""
    limit = structure.rocking().pivot(1).balance_rotation
    start = rf.InitialState(rotation=share * limit)
    run = rf.simulate(structure, rf.quiet_motion(6.0, 0.005), model, impact=law, initial=start)
    return share, float(run.rotation[run.side < 0.0].min()) / limit


@pytest.mark.parametrize(("law", "expected"), DECAY)
def test_free_decay_is_the_effective_restitution(law, expected):
    first, second = let_go(STIFF, law)
    measured = math.sqrt((1.0 - (1.0 + second) ** 2) / (1.0 - (1.0 - first) ** 2))
    assert measured == pytest.approx(expected, abs=1.1e-4)
    assert law.effective_restitution(STIFF.rocking()) == pytest.approx(measured, abs=2e-4)


def test_effective_restitutions_by_their_formulas():
    p, _, _, _ = shear_column()
    modal, inertia = float(p.effective_mass @ p.effective_height**2), p.i_theta
    eta = 1.0 - 2.0 * p.m_tot * p.half_width**2 / inertia
    expected = {
        VVEL: modal / inertia,
        rf.VVELComplete(): modal / inertia,  # all modes: no mass is left out
        rf.Restitution(0.3): 1.0 - 0.7 * (inertia - modal) / inertia,
        A: eta,
        rf.AngularMomentum(0.3): 0.3,
        B: eta,  # C > 0
        housner(p.truncated(0)): eta,
    }
    for law, value in expected.items():
        q = p.truncated(0) if law == housner(p.truncated(0)) else p
        assert law.effective_restitution(q) == pytest.approx(value, rel=1e-13)
    slender, *_ = shear_column(rotary=0.0)
    assert B.effective_restitution(slender) == pytest.approx(modal / slender.i_theta, rel=1e-13)  # C < 0
    aside, *_ = shear_column(eccentricity=0.5)
    sides = [1.0 - 2.0 * aside.m_tot * 2.0 * arm / aside.pivot(-s).i_theta for s, arm in ((1, 2.5), (-1, 1.5))]
    assert A.effective_restitution(aside) == pytest.approx(math.sqrt(sides[0] * sides[1]), rel=1e-12)


def test_stiff_structures_tend_to_the_rigid_block():
    """A gives Housner's block as the period falls; the default law tends to another one, 1 - m_tot B²/I_θ."""
    motion = rf.load_suite("fema-p695-far-field")[0].scaled(2.0)
    p = frame(math.inf, 5.0, 1.0, 0.05).rocking()
    block = rf.simulate(p, motion, "rigid", output="peaks").max_rotation
    softer = rf.Restitution(1.0 - p.m_tot * p.half_width**2 / p.i_theta)
    other = rf.simulate(p, motion, "rigid", impact=softer, output="peaks").max_rotation
    found = [rf.simulate(frame(math.inf, 5.0, t, 0.05), motion, output="peaks").max_rotation for t in (0.03, 0.01)]
    np.testing.assert_allclose(found, other, rtol=1e-3)
    assert abs(block / other - 1.0) > 0.2
    by_momentum = rf.simulate(frame(math.inf, 5.0, 0.003, 0.05), motion, impact=A, output="peaks")
    assert by_momentum.max_rotation == pytest.approx(block, rel=1e-2)


@pytest.mark.parametrize("law", [rf.AngularMomentum(0.85), rf.Restitution(0.85)])
def test_a_restitution_from_the_decay_of_a_block(law):
    """The energies of a rigid block by its own weight, at every peak of a run of large rotations."""
    block = rf.rigid_block(slenderness=0.3, half_diagonal=2.0)
    start = rf.InitialState(rotation=0.2)
    run = rf.simulate(block, rf.quiet_motion(8.0), "rigid-C", impact=law, initial=start)
    spin = run.rotation_velocity
    turns = np.flatnonzero((spin[:-1] * spin[1:] < 0.0) & (run.rotation[1:] != 0.0))
    times = [
        float(run.time[k] - spin[k] * (run.time[k + 1] - run.time[k]) / (spin[k + 1] - spin[k])) for k in turns[:5]
    ]
    peaks = [0.2, *run.at(times).rotation]
    assert len(peaks) == 6
    assert rf.restitution_from_decay(peaks, block) == pytest.approx(0.85, rel=1e-5)
    assert rf.restitution_from_decay(np.abs(peaks), block) == rf.restitution_from_decay(peaks, block)


def test_a_restitution_from_the_decay_on_an_eccentric_base():
    aside, *_ = shear_column(eccentricity=0.4)
    p = aside.truncated(0)
    start = rf.InitialState(rotation=0.05)
    run = rf.simulate(p, rf.quiet_motion(1.9), "rigid", impact=rf.AngularMomentum(0.7), initial=start)
    second = float(run.rotation.min())
    assert rf.restitution_from_decay([0.05, second], p) == pytest.approx(0.7, rel=3e-3)  # small rotations
    with pytest.raises(rf.InputError, match="signs") as caught:
        rf.restitution_from_decay([0.05, -second], p)
    assert caught.value.field == "peaks"


@pytest.mark.parametrize(
    ("peaks", "words"),
    [([0.1], "Two peaks"), ([0.1, 0.0], "above 0"), ([0.35, 0.1], "below"), ([0.1, 0.12], "must fall"), (3.0, "peaks")],
)
def test_peaks_that_tell_no_restitution(peaks, words):
    block = rf.rigid_block(slenderness=0.3, half_diagonal=2.0)
    with pytest.raises(rf.InputError, match=words):
        rf.restitution_from_decay(peaks, block)
    held = rf.Restrained(frame(0.0, 5.0), [rf.Tendon(1e5, 2e6)]).rocking()
    with pytest.raises(rf.InputError, match="elements") as caught:
        rf.restitution_from_decay([0.1, 0.05], held)
    assert caught.value.field == "properties"
