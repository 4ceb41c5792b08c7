"""Impact laws in runs: the user's own, those that fail, and where rocking passes straight into rocking."""

import re

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=0.125, period=0.5, aspect_ratio=6.0, damping_ratio=0.03)
TIME = 0.02 * np.arange(251)
MOTION = rf.GroundMotion(4.5 * np.sin(0.6 * TIME) * (np.sin(9.0 * TIME + 0.4) + 0.6 * np.sin(27.0 * TIME)), 0.02)
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")
MODELS = ["MDOF-S", "2DOF-S", "MDOF-C", "2DOF-C"]


class Copy:
    """Says of itself what a law of the library says, and does the same."""

    keeps, loses = "what it copies", "the rest"

    def __init__(self, law):
        self.law = law

    def after(self, properties, modal_velocity, rotation_velocity, modal_displacement):
        velocity, spin = self.law.after(properties, modal_velocity, rotation_velocity, modal_displacement)
        return velocity.tolist(), spin


def assert_alike(one, other, rtol):
    assert (one.n_uplifts, one.n_impacts, one.status) == (other.n_uplifts, other.n_impacts, other.status)
    for name in PEAKS:
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=rtol), name


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    "law",
    [
        rf.VVELSimplified(),
        rf.VVELComplete(),
        rf.Restitution(0.7),
        rf.AngularMomentum(),
        rf.AngularMomentum(0.9),
        rf.PivotImpulse(),
    ],
    ids=repr,
)
def test_a_copy_of_a_law_is_that_law(model, law):
    one, other = (rf.simulate(FRAME, MOTION, model, impact=each) for each in (law, Copy(law)))
    assert one.n_impacts >= 4
    assert_alike(one, other, 1e-10)
    assert other.history.model.law.law is law


def test_a_law_of_ones_own_in_threads():
    law = Copy(rf.Restitution(0.6))
    scales = [0.6 + 0.02 * k for k in range(40)]
    table = rf.simulate_many(FRAME, MOTION, MODELS, scales=scales, impact=law, workers=2)
    assert table["error"].isna().all()
    assert (table["n_impacts"] > 0).sum() > 100
    for row in table.iloc[::13].itertuples():
        one = rf.simulate(FRAME, MOTION.scaled(row.scale), row.model, output="peaks", impact=law)
        assert [getattr(row, name) for name in PEAKS] == [getattr(one, name) for name in PEAKS]


class Law:
    keeps, loses = "", ""

    def __init__(self, after):
        self._after = after

    def __repr__(self):
        return "Law()"

    def after(self, properties, modal_velocity, rotation_velocity):
        return self._after(modal_velocity, rotation_velocity)


def raising(velocity, spin):
    message = "no idea"
    raise ArithmeticError(message)


@pytest.mark.parametrize("model", ["MDOF-S", "MDOF-C"])
def test_a_law_that_returns_energy(model):
    for after in (lambda v, s: (v, 1.001 * s), lambda v, s: (10.0 + v, 0.0), lambda v, s: (v, -1.001 * s)):
        with pytest.raises(rf.SolverError) as caught:
            rf.simulate(FRAME, MOTION, model, impact=Law(after))
        first = rf.simulate(FRAME, MOTION, model).impact_times[0]
        until = 0.02 * np.ceil(first / 0.02)
        start = f"The impact law Law() returns energy in the sample before {until:.6g} s. The state there is D = ["
        assert str(caught.value).startswith(start)
        assert str(caught.value).endswith(
            ". A law can only lose energy: correct its `after`, or lower its restitution."
        )


def test_a_restitution_may_return_energy_in_a_complete_model():
    """Bent towards the old pivot, a structure lies farther from the new one (docs/design/0005-complete-models.md)."""
    start = rf.InitialState(1e-4, [0.12], rotation_velocity=-1.0)
    text = (
        r"The impact law Restitution\(e=1\.0, shortest_excursion=0\.0001\) returns energy .* or lower its restitution\."
    )
    with pytest.raises(rf.SolverError, match=text):
        rf.simulate(FRAME, rf.quiet_motion(0.02), "2DOF-C", impact=rf.Restitution(1.0), initial=start)
    assert rf.simulate(FRAME, rf.quiet_motion(0.02), "2DOF-S", impact=rf.Restitution(1.0), initial=start).n_impacts > 0
    bent = rf.InitialState(1e-4, [-0.12], rotation_velocity=-1.0)
    assert rf.simulate(FRAME, rf.quiet_motion(0.02), "2DOF-C", impact=rf.Restitution(1.0), initial=bent).n_impacts > 0


@pytest.mark.parametrize("model", ["MDOF-S", "MDOF-C"])
@pytest.mark.parametrize(
    ("after", "text"),
    [
        (raising, "The impact law Law() failed: no idea"),
        (lambda v, s: 0.0, "The impact law Law() failed: after must return the modal velocities in m/s and the"),
        (lambda v, s: (v[:1], 0.0), "The impact law Law() failed: The modal velocity after an impact must have 3"),
        (lambda v, s: (v * np.nan, 0.0), "The impact law Law() failed: the modal velocity after an impact must be"),
        (lambda v, s: (v, np.nan), "The impact law Law() failed: the rotation velocity after an impact must be a"),
    ],
)
def test_a_law_that_fails(model, after, text):
    with pytest.raises(rf.InputError, match=re.escape(text)) as caught:
        rf.simulate(FRAME, MOTION, model, impact=Law(after))
    assert isinstance(caught.value.__cause__, Exception)
    table = rf.simulate_many(FRAME, MOTION, [model, "fixed"], scales=[0.01, 1.0], impact=Law(after), workers=2)
    assert table["error"].isna().tolist() == [True, False, True, True]
    assert table["error"][1].startswith(text)


@pytest.mark.parametrize(
    ("impact", "given_"),
    [
        (rf.Restitution, "the class Restitution"),
        (rf.VVELComplete, "the class VVELComplete"),
        ("VVEL", "str"),
        (0.5, "float"),
        (lambda: None, "function"),
    ],
)
def test_what_is_no_law(impact, given_):
    text = (
        f"impact must be an impact law, but {given_} was given. Give VVELSimplified(), VVELComplete(), Restitution(e), "
        "AngularMomentum(), PivotImpulse(), or an object with `keeps`, `loses` and `after(properties, modal_velocity, "
        "rotation_velocity, modal_displacement)`."
    )
    for run in (rf.simulate, rf.simulate_many):
        with pytest.raises(rf.InputError) as caught:
            run(FRAME, MOTION, impact=impact)
        assert str(caught.value) == text


@pytest.mark.parametrize("model", MODELS)
def test_no_restitution_is_the_simplified_law(model):
    one, other = (rf.simulate(FRAME, MOTION, model, impact=law) for law in (rf.Restitution(0.0), rf.VVELSimplified()))
    assert one.n_impacts >= 4
    assert one.peaks() == other.peaks()
    assert np.array_equal(one.history.states, other.history.states)


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-C", "rigid", "rigid-C"])
@pytest.mark.parametrize("e", [0.5, 0.9])
def test_rocking_passes_to_the_other_side(model, e):
    """At every impact both nodes rock, on opposite sides, the rotation is zero and its velocity falls to a share."""
    start = rf.InitialState(0.05)
    run = rf.simulate(FRAME, rf.quiet_motion(8.0), model, impact=rf.Restitution(e), initial=start)
    first = np.flatnonzero(np.diff(run.time) == 0.0)
    impacts = first[run.side[first] != 0.0]
    assert impacts.size == run.n_impacts == run.impact_times.size
    assert np.array_equal(run.time[impacts], run.impact_times)
    passing = impacts[run.side[impacts + 1] != 0.0]
    assert passing.size >= 4
    assert np.array_equal(run.side[passing + 1], -run.side[passing])
    spin = run.rotation_velocity
    np.testing.assert_allclose(spin[passing + 1], e * spin[passing], rtol=1e-12)
    assert not run.rotation[impacts].any()
    assert not run.rotation[impacts + 1].any()
    assert np.array_equal(run.modal_displacement[impacts], run.modal_displacement[impacts + 1])
    np.testing.assert_array_equal(np.sign(run.rotation[run.rotation != 0.0]), run.side[run.rotation != 0.0])
    # From contact the base lifts; passing is no uplift.
    lifted = first[(run.side[first] == 0.0) & (run.side[first + 1] != 0.0)]
    assert run.n_uplifts == lifted.size == run.uplift_times.size
    assert np.array_equal(run.time[lifted], run.uplift_times)


@pytest.mark.parametrize("model", ["2DOF-S", "2DOF-C", "rigid", "rigid-C"])
def test_impacts_accumulate_and_end_in_contact(model):
    """Excursions shrink by e or so each, until one would be shorter than what is stated."""
    shortest = 1e-3
    law = rf.Restitution(0.6, shortest)
    run = rf.simulate(FRAME, rf.quiet_motion(8.0), model, impact=law, initial=rf.InitialState(0.01))
    assert run.side[-1] == 0.0
    assert run.n_impacts >= 5
    contact = run.time[np.flatnonzero(run.side == 0.0)[0]]
    passed = run.impact_times[run.impact_times <= contact]
    excursions = np.diff(passed)
    assert np.all(excursions > 0.5 * shortest)
    if model.startswith("rigid"):  # small excursions last 2 θ'/θ'', so they shrink by e, and end in time
        assert run.n_impacts == passed.size
        np.testing.assert_allclose(excursions[-3:] / excursions[-4:-1], 0.6, rtol=0.02)
        assert excursions[-1] >= shortest * (1.0 - 1e-3) > 0.6 * excursions[-1] * (1.0 - 0.02)
        assert np.all(run.rotation_velocity[run.time > contact] == 0.0)


def test_a_longer_shortest_excursion_sticks_earlier():
    counts = [
        rf.simulate(
            FRAME,
            rf.quiet_motion(8.0),
            "rigid",
            output="peaks",
            impact=rf.Restitution(0.8, s),
            initial=rf.InitialState(0.02),
        ).n_impacts
        for s in (1e-5, 1e-3, 1e-1)
    ]
    assert counts[0] > counts[1] > counts[2] >= 1
    # Excursions shrink by e each: a hundredth is reached in log(100)/log(1/e) more of them.
    assert counts[0] - counts[1] == pytest.approx(np.log(100.0) / np.log(1.0 / 0.8), abs=1.0)


def test_a_law_may_throw_the_base_back():
    """A law that reverses the rotation keeps it on its side: an impact all the same."""
    for model in ("rigid", "rigid-C", "2DOF-S", "2DOF-C"):
        run = rf.simulate(
            FRAME, rf.quiet_motion(2.0), model, impact=Law(lambda v, s: (v, -0.5 * s)), initial=rf.InitialState(0.02)
        )
        assert run.n_impacts >= 2
        assert run.impact_times.size == run.n_impacts
        assert run.energy.impact_losses.size == run.n_impacts
        assert np.all(run.energy.impact_losses > 0.0)
        if model.startswith("rigid"):
            assert run.rotation.min() >= 0.0
            k = np.flatnonzero(np.diff(run.time) == 0.0)[0]
            assert run.rotation_velocity[k + 1] == pytest.approx(-0.5 * run.rotation_velocity[k])
        assert run.energy.closing_error < 1e-9


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-S", "MDOF-C", "2DOF-C", "2DOF-C-SI"])
@pytest.mark.parametrize("law", [None, rf.VVELSimplified(), rf.VVELComplete(), rf.Restitution(0.6)], ids=repr)
def test_the_ledger_of_a_run_has_the_laws_losses(model, law):
    """Per impact, with the inertia about the pivot as the masses stand (docs/design/0005-complete-models.md)."""
    run = rf.simulate(FRAME, MOTION, model, impact=law)
    p, energy = run.history.model.properties, run.energy
    k = np.flatnonzero(np.isin(run.time, run.impact_times) & (np.diff(run.time, append=np.inf) == 0.0))
    k = k[run.side[k] != 0.0]
    assert k.size == run.n_impacts >= 4

    def inertia(side, d):
        if "-C" not in model:
            return np.full(side.size, p.i_theta)
        return p.i_theta + (d**2 - 2.0 * (side * p.half_width)[:, None] * d) @ p.effective_mass

    d, before, after = run.modal_displacement[k], run.rotation_velocity[k], run.rotation_velocity[k + 1]
    kept = p.effective_mass @ p.effective_height**2
    if isinstance(run.history.model.law, rf.VVELComplete):
        kept = p.translational_inertia
    loss = 0.5 * before**2 * (inertia(run.side[k], d) - kept) - 0.5 * after**2 * (inertia(run.side[k + 1], d) - kept)
    np.testing.assert_allclose(energy.impact_losses, loss, rtol=1e-9, atol=1e-12 * np.abs(energy.input).max())
    assert energy.closing_error < 1e-9
