"""Elements between floors, ties and stories that yield: against an integration in floor displacements, and limits."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

import rockflex as rf
from rockflex import InputError

G = 9.81
FLOORS = np.array([3.0, 6.5, 10.0])
MASS = np.array([50e3, 45e3, 40e3])
STORIES = np.array([5e7, 4e7, 3e7])
DRIFTS = np.eye(3) - np.eye(3, k=-1)
STIFFNESS = DRIFTS.T @ np.diag(STORIES) @ DRIFTS
BASE, WIDTH, ZETA = 30e3, 1.2, 0.03


def tower() -> rf.LumpedStructure:
    return rf.LumpedStructure(MASS, STIFFNESS, FLOORS, base_mass=BASE, half_width=WIDTH, damping_ratio=ZETA)


def shaking() -> rf.GroundMotion:
    t = np.arange(251) * 0.02
    return rf.GroundMotion(4.0 * np.sin(5.0 * t) * np.exp(-((t - 1.8) ** 2)) + 1.5 * np.sin(17.0 * t) * (t < 3.0), 0.02)


def bar(row, turn, stiffness, strength, ratio, story=False):
    return {"row": np.append(row, turn), "k": stiffness, "fy": strength, "alpha": ratio, "story": story}


def damper(row, turn, coefficient):
    return {"row": np.append(row, turn), "c": coefficient}


def rotations(motion, elements, lifts=True):
    """θ and u of the top at the samples, the uplifts, and the plastic stretches, in the displacements of the floors."""
    n, weight = FLOORS.size, (MASS.sum() + BASE) * G
    omega2, shapes = eigh(STIFFNESS, np.diag(MASS))
    damping = np.diag(MASS) @ shapes @ np.diag(2.0 * ZETA * np.sqrt(omega2)) @ shapes.T @ np.diag(MASS)
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n], whole[:n, n], whole[n, :n] = np.diag(MASS), MASS * FLOORS, MASS * FLOORS
    whole[n, n] = MASS @ FLOORS**2 + WIDTH**2 * (MASS.sum() + BASE)
    bars = [each for each in elements if "k" in each]

    def forces(y, plastic, branch):
        """Generalised forces of the elements on u and θ."""
        q, rate, found = y[: n + 1], y[n + 1 :], np.zeros(n + 1)
        for each in elements:
            if "c" in each:
                found -= each["row"] * each["c"] * (each["row"] @ rate)
        for each, p, way in zip(bars, plastic, branch, strict=True):
            delta = each["row"] @ q
            z = way * each["fy"] if way else each["k"] * (delta - p)
            force = each["alpha"] * each["k"] * delta + (1.0 - each["alpha"]) * z
            found -= each["row"] * (force - (each["k"] * delta if each["story"] else 0.0))
        return found

    def rates(y, a, side, plastic, branch):
        u, theta, v, spin = y[:n], y[n], y[n + 1 : 2 * n + 1], y[-1]
        held = forces(y, plastic, branch)
        force = -STIFFNESS @ u - damping @ v - MASS * a + held[:n]
        if side == 0:
            return np.concatenate((v, [0.0], force / MASS, [0.0]))
        moment = -(MASS @ FLOORS) * a - side * weight * WIDTH + G * (MASS @ FLOORS) * theta + held[n]
        return np.concatenate((v, [spin], np.linalg.solve(whole, np.append(force, moment))))

    def overturning(y, a, plastic, branch):
        return (
            -(MASS * FLOORS) @ (rates(y, a, 0, plastic, branch)[n + 1 : 2 * n + 1] + a) + forces(y, plastic, branch)[n]
        )

    y, side, uplifts = np.zeros(2 * n + 2), 0, 0
    plastic, branch, found = np.zeros(len(bars)), [0] * len(bars), [(0.0, 0.0)]
    samples, dt = motion.acceleration, motion.dt
    for first, last in pairwise(samples):
        t = 0.0
        while t < dt:

            def ground(s, first=first, last=last):
                return first + (last - first) * s / dt

            conditions = []
            if side:
                conditions.append(lambda s, y, side=side: side * y[n])
            elif lifts:
                conditions.append(
                    lambda s, y, branch=tuple(branch), plastic=tuple(plastic), ground=ground: (
                        weight * WIDTH - abs(overturning(y, ground(s), plastic, branch))
                    )
                )
            for k, each in enumerate(bars):
                if branch[k]:
                    conditions.append(lambda s, y, each=each, way=branch[k]: way * (each["row"] @ y[n + 1 :]))
                else:
                    reach = each["fy"] / each["k"]
                    conditions.append(
                        lambda s, y, each=each, p=plastic[k], reach=reach: reach - abs(each["row"] @ y[: n + 1] - p)
                    )
            first_bar = len(conditions) - len(bars)
            for each in conditions:
                each.terminal, each.direction = True, -1
            done = solve_ivp(
                lambda s, y, side=side, plastic=tuple(plastic), branch=tuple(branch), ground=ground: rates(
                    y, ground(s), side, plastic, branch
                ),
                (t, dt),
                y,
                "DOP853",
                events=conditions,
                max_step=dt / 8.0,
                rtol=1e-11,
                atol=1e-13,
            )
            y, t = done.y[:, -1].copy(), float(done.t[-1])
            if done.status != 1:
                continue
            which = next(k for k, times in enumerate(done.t_events) if times.size)
            if which >= first_bar:
                k = which - first_bar
                delta = bars[k]["row"] @ y[: n + 1]
                if branch[k]:
                    plastic[k], branch[k] = delta - branch[k] * bars[k]["fy"] / bars[k]["k"] * (1.0 - 1e-15), 0
                else:
                    branch[k] = int(np.sign(delta - plastic[k]))
            elif side == 0:
                side, uplifts = int(np.sign(overturning(y, ground(t), plastic, branch))), uplifts + 1
                y[n] = side * 1e-17
            else:
                y[n + 1 : 2 * n + 1] += FLOORS * y[-1]
                y[n], y[-1], side = 0.0, 0.0, 0
                for k, each in enumerate(bars):  # the impact may turn an elongation back
                    if branch[k] and branch[k] * (each["row"] @ y[n + 1 :]) < 0.0:
                        plastic[k] = each["row"] @ y[: n + 1] - branch[k] * each["fy"] / each["k"] * (1.0 - 1e-15)
                        branch[k] = 0
                moment = overturning(y, ground(t), plastic, branch)
                if abs(moment) > weight * WIDTH:  # it does not stay closed
                    side, uplifts = int(np.sign(moment)), uplifts + 1
                    y[n] = side * 1e-17
        found.append((y[n], y[n - 1]))
    for k, each in enumerate(bars):
        if branch[k]:
            plastic[k] = each["row"] @ y[: n + 1] - branch[k] * each["fy"] / each["k"]
    return np.array(found), uplifts, plastic


def fuse(strength=200e3, ratio=0.05, **where):
    return rf.YieldingDissipator(stiffness=2e7, yield_force=strength, post_yield_ratio=ratio, **where)


CASES = {
    "tie": (
        lambda: rf.Restrained(tower(), fuse(80e3, height=6.5)),
        lambda: [bar([0.0, 1.0, 0.0], 6.5, 2e7, 80e3, 0.05)],
    ),
    "tie between floors": (
        lambda: rf.Restrained(tower(), fuse(80e3, height=4.75, cosine=-0.9)),
        lambda: [bar([-0.45, -0.45, 0.0], -0.9 * 4.75, 2e7, 80e3, 0.05)],
    ),
    "brace and dampers": (
        lambda: rf.Restrained(
            tower(),
            [
                fuse(150e3, between=(0, 2), cosine=0.8),
                rf.ViscousDamper(3e5, between=(3, 1), cosine=0.6),
                rf.ViscousDamper(1e5, height=10.0),
            ],
        ),
        lambda: [
            bar([0.0, 0.8, 0.0], 0.0, 2e7, 150e3, 0.05),
            damper([0.6, 0.0, -0.6], 0.0, 3e5),
            damper([0.0, 0.0, 1.0], 10.0, 1e5),
        ],
    ),
    "stories": (
        lambda: rf.YieldingStories(tower(), [260e3, 230e3, 130e3], [0.05, 0.0, 0.1]),
        lambda: [
            bar(row, 0.0, k, strength, ratio, story=True)
            for row, k, strength, ratio in zip(DRIFTS, STORIES, [260e3, 230e3, 130e3], [0.05, 0.0, 0.1], strict=True)
        ],
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("model", ["MDOF-S", "fixed"])
@pytest.mark.parametrize("name", CASES)
def test_the_motion_is_that_of_an_integration_in_the_displacements_of_the_floors(name, model):
    structure, elements = CASES[name][0](), CASES[name][1]()
    expected, uplifts, plastic = rotations(shaking(), elements, lifts=model == "MDOF-S")
    response = rf.simulate(structure, shaking(), model, output="history", free_vibration=0.0)
    at = np.searchsorted(response.time, np.arange(len(expected)) * 0.02 - 1e-9)
    assert response.n_uplifts == uplifts
    assert (uplifts > 1) == (model == "MDOF-S")
    for found, wanted in ((response.rotation, expected[:, 0]), (response.top_displacement, expected[:, 1])):
        np.testing.assert_allclose(found[at], wanted, rtol=0.0, atol=1e-7 * max(np.abs(wanted).max(), 1e-3))
    assert response.energy.closing_error < 1e-10
    if name == "stories":
        alpha = np.array([0.05, 0.0, 0.1])
        np.testing.assert_allclose(response.residual_drift, (1.0 - alpha) * plastic, rtol=0.0, atol=1e-9)
        assert response.ductility.max() > 1.5
    else:
        assert response.element_yielded.any()


@pytest.mark.parametrize(
    "ground",
    [
        None,
        rf.Ground(friction=0.3),
        rf.Ground(springs=rf.winkler_bed(WIDTH, 2.0, 2e8, damping=1e6, n=5), base_inertia=2e5),
        rf.Ground(0.3, rf.winkler_bed(WIDTH, 2.0, 2e8, damping=1e6, n=5), 2e5),
    ],
    ids=["rigid", "sliding", "springs", "sliding on springs"],
)
@pytest.mark.parametrize("vertical", [0.0, 0.4])
def test_energy_is_balanced_on_any_ground(ground, vertical):
    motion = shaking()
    motion = rf.GroundMotion(motion.acceleration, motion.dt, vertical=vertical * motion.acceleration[::-1])
    held = rf.Restrained(
        rf.YieldingStories(tower(), [320e3, 260e3, 160e3], 0.05),
        [
            *(fuse(150e3, between=(0, 2), cosine=0.8), rf.ViscousDamper(1e5, height=10.0)),
            *(rf.Tendon(50e3, 4e6, height=6.5, cosine=c, yield_force=90e3, post_yield_ratio=0.02) for c in (-1.0, 1.0)),
            *(rf.Tendon(100e3, 4e6, position=0.2), rf.FlagShapedBar(2e7, 80e3, 0.02, 0.5, height=3.0)),
        ],
    )
    response = rf.simulate(held, motion, "MDOF-S", ground=ground, output="history", free_vibration=1.0)
    assert response.max_rotation > 1e-3
    assert response.energy.closing_error < 1e-10
    assert response.energy.yielded[-1] > 0.0
    # The largest values are those between the samples, too.
    assert (response.max_element_elongation >= np.abs(response.element_elongation).max(axis=0) * (1 - 1e-9)).all()
    assert (response.max_element_force >= np.abs(response.element_force).max(axis=0) * (1 - 1e-9)).all()


def test_ground_reaction_and_ties_move_the_mass():
    response = rf.simulate(
        rf.Restrained(tower(), [fuse(80e3, height=6.5), rf.ViscousDamper(1e5, height=10.0, cosine=0.5)]),
        shaking(),
        "MDOF-S",
        output="history",
        free_vibration=0.0,
    )
    ground = np.interp(response.time, np.arange(251) * 0.02, shaking().acceleration)
    inertia = response.floor_acceleration @ MASS + BASE * ground
    pulls = response.element_force @ [1.0, 0.5]
    reaction = response.horizontal_reaction
    np.testing.assert_allclose(reaction - pulls, inertia, rtol=0.0, atol=1e-9 * np.abs(inertia).max())
    assert response.max_horizontal_reaction >= np.abs(reaction).max() * (1.0 - 1e-9)


def test_strong_stories_and_soft_braces_change_nothing():
    alone = rf.simulate(tower(), shaking(), "MDOF-S")
    strong = rf.simulate(rf.YieldingStories(tower(), 1e9, 0.0), shaking(), "MDOF-S")
    infinite = rf.simulate(rf.YieldingStories(tower(), np.inf, 0.0), shaking(), "MDOF-S")
    soft = rf.simulate(rf.Restrained(tower(), rf.ViscousDamper(0.0, between=(0, 3))), shaking(), "MDOF-S")
    for each in (strong, infinite, soft):
        assert each.max_rotation == pytest.approx(alone.max_rotation, rel=1e-11)
        assert each.max_base_moment == pytest.approx(alone.max_base_moment, rel=1e-11)
    assert infinite.ductility.size == 0
    np.testing.assert_allclose(strong.residual_drift, 0.0, atol=1e-12)


def test_a_stiff_story_of_one_is_a_bilinear_oscillator():
    """The static drift at constant acceleration beyond yield: u = u_y + (m a - F_y)/(α k)."""
    one = rf.LumpedStructure([50e3], [[5e7]], [3.0], base_mass=BASE, half_width=5.0, damping_ratio=0.3)
    steady = rf.GroundMotion(np.concatenate((np.linspace(0.0, -4.0, 4000), np.full(12000, -4.0))), 0.01)
    response = rf.simulate(rf.YieldingStories(one, 150e3, 0.1), steady, "fixed", output="history", free_vibration=0.0)
    expected = 150e3 / 5e7 + (50e3 * 4.0 - 150e3) / (0.1 * 5e7)
    # A small vibration at the end of the ramp leaves a story that yielded a little more.
    assert response.top_displacement[-1] == pytest.approx(expected, rel=1e-5)
    assert response.ductility[0] == pytest.approx(expected / 3e-3, rel=1e-3)
    assert response.max_base_shear == pytest.approx(200e3, rel=1e-3)


def test_an_unbalanced_tie_starts_in_equilibrium():
    still = rf.GroundMotion(np.zeros(300), 0.01)
    held = rf.Restrained(tower(), rf.Tendon(initial_force=30e3, stiffness=4e6, height=6.5))
    response = rf.simulate(held, still, "MDOF-S", output="history", free_vibration=0.0)
    flexibility = np.linalg.inv(STIFFNESS)[1]
    force = 30e3 / (1.0 + 4e6 * flexibility[1])
    np.testing.assert_allclose(response.top_displacement, -force * flexibility[2], rtol=1e-9)
    np.testing.assert_allclose(response.element_force[:, 0], force, rtol=1e-9)


def test_a_saved_response_has_its_elements_and_stories(tmp_path):
    held = rf.Restrained(rf.YieldingStories(tower(), 200e3, 0.05), fuse(height=6.5, cosine=-1.0))
    response = rf.simulate(held, shaking(), "2DOF-S", output="history")
    again = rf.Response.load(response.save(tmp_path / "run.npz"))
    assert again.history.model == response.history.model
    np.testing.assert_array_equal(again.ductility, response.ductility)
    assert again.energy.closing_error == response.energy.closing_error < 1e-9


@pytest.mark.parametrize(
    ("where", "field"),
    [
        ({"between": (1, 1)}, "between"),
        ({"between": (0, 4)}, "between"),
        ({"between": (0, 1), "height": 3.0}, "between"),
        ({"between": (0, 1), "position": 0.5}, "between"),
        ({"height": 10.5}, "height"),
        ({"height": -1.0}, "height"),
        ({"height": 3.0, "cosine": 0.0}, "cosine"),
        ({"cosine": 0.5}, "cosine"),
    ],
)
def test_a_place_that_is_none_is_refused(where, field):
    with pytest.raises(InputError) as caught:
        rf.Restrained(tower(), fuse(**where))
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("structure", "given", "field"),
    [
        (tower, {"strengths": [1e5, 1e5]}, "strengths"),
        (tower, {"strengths": -1e5}, "strengths"),
        (tower, {"strengths": "strong"}, "strengths"),
        (tower, {"post_yield_ratio": 1.0}, "post_yield_ratio"),
        (lambda: rf.Frame(3, 3.0, 4e4, 4e4, 0.125, period=0.5, aspect_ratio=6.0, damping_ratio=0.02), {}, "structure"),
        (lambda: rf.Restrained(tower(), rf.Tendon(1e5, 1e6)), {}, "structure"),
    ],
)
def test_stories_that_are_none_are_refused(structure, given, field):
    with pytest.raises(InputError) as caught:
        rf.YieldingStories(structure(), **({"strengths": 1e5, "post_yield_ratio": 0.0} | given))
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("elements", "run"),
    [
        ([fuse(height=3.0)], {"model": "MDOF-C"}),
        ([fuse(height=3.0)], {"model": "2DOF-S", "bouc_wen": rf.BoucWen(0.05)}),
        ([rf.FrictionDamper(1e4, between=(0, 1))], {}),
        ([rf.Tendon(1e4, 1e6, height=3.0)], {"ground": rf.Ground(springs=rf.winkler_bed(WIDTH, 2.0, 2e8, n=5),
                                                                  base_inertia=2e5)}),
    ],
)  # fmt: skip
def test_what_cannot_be_combined_is_refused(elements, run):
    with pytest.raises(InputError) as caught:
        rf.simulate(rf.Restrained(tower(), elements), shaking(), **({"model": "MDOF-S"} | run))
    assert caught.value.field == "elements"


def test_a_report_has_stories_and_places(tmp_path):
    held = rf.Restrained(rf.YieldingStories(tower(), 200e3, 0.05), fuse(height=6.5))
    response = rf.simulate(held, shaking(), "MDOF-S", output="history")
    text = rf.write_report(response, tmp_path / "run.html", structure=held).read_text("utf-8")
    assert "z = 6.5 m" in text
    assert f"μ = {response.ductility[1]:.2f}" in text
