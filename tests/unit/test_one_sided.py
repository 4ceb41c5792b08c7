"""What opens to one side: façades on transverse walls, walls in front of stiffer ones."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rockflex as rf

WALL = rf.rigid_block(width=0.6, height=6.0, mass=7e3)
FRAME = rf.Frame(3, 3.0, 40e3, 40e3, 0.0, period=0.5, aspect_ratio=6.0, damping_ratio=0.03)
RECORD = rf.load_suite("el-centro-1940")[0].scaled(1.5)


def integrated(wall: rf.RockingProperties, motion: rf.GroundMotion, e: float, *, large: bool) -> tuple[float, int]:
    """Largest rotation and number of impacts of a wall that opens to the right, by DOP853 from sample to sample.

    I θ'' = -m_tot g B cos θ + L g sin θ - a (L cos θ + m_tot B sin θ), or its linear part; θ' → -e θ' at θ = 0, and
    contact once 2 θ'/|θ''| is below 0.1 ms.
    """
    g, dt, a = 9.81, motion.dt, motion.acceleration
    m, b, i, l0 = wall.m_tot, wall.half_width, wall.i_theta, wall.l0r

    def turn(theta: float, ground: float) -> float:
        if large:
            c, s = math.cos(theta), math.sin(theta)
            return (-m * g * b * c + l0 * g * s - ground * (l0 * c + m * b * s)) / i
        return (-m * g * b + l0 * g * theta - ground * l0) / i

    state, rocks, largest, impacts = np.zeros(2), False, 0.0, 0
    limit = -g * m * b / l0  # it lifts to the right when the ground accelerates to the left
    for k in range(a.size - 1):
        time, end, slope = 0.0, dt, (a[k + 1] - a[k]) / dt
        while time < end:
            if not rocks:
                if a[k] + slope * time > limit and a[k + 1] > limit:
                    break
                time = max(time, (limit - a[k]) / slope if slope < 0.0 else time)
                state, rocks = np.zeros(2), True
                continue

            def rates(t: float, y: Any, first: float = a[k], more: float = slope) -> list[float]:
                return [y[1], turn(y[0], first + more * t)]

            def lands(t: float, y: Any, start: float = time) -> float:
                return y[0] + (1.0 if t <= start else 0.0) * 1e-300

            def peaks(_: float, y: Any) -> float:
                return y[1]

            lands.terminal, lands.direction = True, -1  # pyright: ignore[reportFunctionMemberAccess]
            found = solve_ivp(rates, (time, end), state, "DOP853", events=(lands, peaks), rtol=1e-13, atol=1e-16)
            largest = max([largest, found.y[0].max(), *(each[0] for each in found.y_events[1])])
            time, state = float(found.t[-1]), found.y[:, -1]
            if found.status == 1:
                impacts += 1
                state = np.array([0.0, -e * state[1]])
                back = -turn(0.0, a[k] + slope * time)
                rocks = 2.0 * state[1] >= 1e-4 * back
    return largest, impacts


@pytest.mark.parametrize("e", [0.0, 0.46])
@pytest.mark.parametrize("model", ["rigid", "rigid-C"])
def test_a_facade_rocks_as_an_own_integration_has_it(e: float, model: str) -> None:
    motion = rf.GroundMotion(RECORD.acceleration[:400], RECORD.dt, "start")
    run = rf.simulate(rf.OneSided(WALL, e), motion, model)
    largest, impacts = integrated(WALL, motion, e, large=model == "rigid-C")
    assert largest > 1e-3
    assert run.max_rotation == pytest.approx(largest, rel=1e-8)
    assert run.n_impacts == impacts
    assert run.rotation.min() >= 0.0


@pytest.mark.parametrize(
    ("frame", "e", "suite", "name", "scale", "rotation", "top", "uplifts"),
    [
        ((6, 3.0, 40e3, 40e3, 0.0, 0.734, 7.46, 0.02), 0.0, "far-field", "FF-2-b", 0.75,
         0.00800915829830566, 0.0993343814122797, 14),
        ((4, 3.0, 40e3, 80e3, 0.0, 0.903, 7.84, 0.05), 0.3, "far-field", "FF-21-a", 2.0,
         0.007618275203873738, 0.11411785759808223, 4),
        ((6, 3.0, 40e3, 60e3, 0.125, 0.482, 8.15, 0.03), 0.6, "near-field-pulse", "NFP-6-b", 1.5,
         0.024708728109347086, 0.10447831746345097, 13),
    ],
)  # fmt: skip
def test_a_flexible_wall_rocks_as_floor_coordinates_have_it(
    frame: Any, e: float, suite: str, name: str, scale: float, rotation: float, top: float, uplifts: int
) -> None:
    """Values of Runge-Kutta steps of 8 microseconds on the displacements of the floors, without modes."""
    wall = rf.OneSided(rf.Frame(*frame), e)
    run = rf.simulate(wall, rf.load_suite(f"fema-p695-{suite}")[name].scaled(scale), "MDOF-S")
    assert run.max_rotation == pytest.approx(rotation, rel=1e-8)
    assert run.max_top_displacement == pytest.approx(top, rel=1e-8)
    assert run.n_uplifts == uplifts


@pytest.mark.parametrize("model", ["rigid", "rigid-C", "MDOF-S", "MDOF-C-SI", "2DOF-S"])
@pytest.mark.parametrize("side", ["right", "left"])
def test_energy_is_lost_at_the_wall_alone(model: str, side: Any) -> None:
    held = [rf.Tendon(20e3, 4e5), rf.YieldingDissipator(2e7, 20e3, 0.05, position=0.1)]
    wall = rf.OneSided(WALL if "rigid" in model else FRAME, 0.5, side)
    for each in (wall, rf.Restrained(wall, held)):
        run = rf.simulate(each, RECORD, model)
        assert run.history is not None
        assert run.n_impacts > 2
        assert (run.history.rotation * (1.0 if side == "right" else -1.0)).min() >= -1e-15
        assert np.abs(run.energy.residual).max() < 1e-9 * run.energy.input.max()


def test_the_mirrored_wall_under_the_mirrored_ground_is_the_mirror_image() -> None:
    for model, structure in (("rigid", WALL), ("rigid-C", WALL), ("MDOF-S", FRAME)):
        right = rf.simulate(rf.OneSided(structure, 0.4), RECORD, model)
        left = rf.simulate(rf.OneSided(structure, 0.4, "left"), RECORD.scaled(-1.0), model)
        assert left.max_rotation == pytest.approx(right.max_rotation, rel=1e-12)
        assert left.n_impacts == right.n_impacts
        np.testing.assert_allclose(left.rotation, -right.rotation, rtol=1e-9, atol=1e-12)


def test_bounces_at_rest_are_a_geometric_series() -> None:
    """From |θ'| = w the wall returns after 2 artanh(w p/(p² α))/p, and every bounce leaves e of w (small rotations)."""
    e, start = 0.7, 0.05
    free = rf.simulate(rf.OneSided(WALL, e), rf.quiet_motion(6.0), "rigid", initial=rf.InitialState(rotation=start))
    assert free.history is not None
    p, alpha = math.sqrt(WALL.l0r * 9.81 / WALL.i_theta), WALL.pivot(1).balance_rotation
    times, w = [math.acosh(alpha / (alpha - start)) / p], 0.0
    w = p * math.sqrt(alpha**2 - (alpha - start) ** 2)
    for _ in range(4):
        w *= e
        times.append(times[-1] + 2.0 * math.atanh(w / (p * alpha)) / p)
    closed = np.flatnonzero((free.history.rotation == 0.0) & (free.history.time > 0.0))
    found = np.unique(free.history.time[closed])[: len(times)]
    np.testing.assert_allclose(found, times, rtol=1e-9)
    assert free.rotation[-1] == 0.0


def test_an_elastic_wall_gives_all_energy_back() -> None:
    run = rf.simulate(rf.OneSided(WALL, 1.0), rf.quiet_motion(6.0), "rigid", initial=rf.InitialState(rotation=0.02))
    assert run.n_impacts > 2
    assert run.history is not None
    assert run.history.rotation.max() == pytest.approx(0.02, rel=1e-12)
    turns = run.history.rotation[1:-1][np.diff(np.sign(np.diff(run.history.rotation))) < 0.0]
    assert turns.min() > 0.99 * 0.02


def test_published_restitutions() -> None:
    sine, cosine = 0.09 / 9.09, 9.0 / 9.09  # of tan α = 0.1
    on_base, on_wall = 1.0 - 1.5 * sine, 1.0 - 1.5 * cosine
    assert rf.OneSided(WALL, "sorrentino").rocking().restitution == pytest.approx(-(on_base**2) * on_wall, rel=1e-12)
    assert rf.OneSided(WALL, "housner").rocking().restitution == pytest.approx(on_base, rel=1e-12)
    squat = rf.OneSided(rf.rigid_block(width=3.0, height=2.0), "sorrentino")
    assert squat.rocking().restitution == 0.0


@pytest.mark.parametrize(
    ("call", "field", "word"),
    [
        (lambda: rf.OneSided(3.0), "structure", "structure"),  # pyright: ignore[reportArgumentType]
        (lambda: rf.OneSided(WALL, 1.2), "restitution", r"\[0, 1\]"),
        (lambda: rf.OneSided(WALL, "makris"), "restitution", "sorrentino"),  # pyright: ignore[reportArgumentType]
        (lambda: rf.OneSided(WALL, side="top"), "side", "right"),  # pyright: ignore[reportArgumentType]
        (lambda: rf.simulate(rf.OneSided(WALL), RECORD, "rigid", impact=rf.Restitution(0.9)), "impact", "OneSided"),
        (lambda: rf.simulate(rf.OneSided(FRAME), RECORD, ground=rf.Ground(friction=0.5)), "ground", "wall"),
        (lambda: rf.simulate(rf.OneSided(WALL), RECORD, "rigid", initial=rf.InitialState(rotation=-0.01)),
         "initial", "right"),
        (lambda: rf.moment_rotation(rf.OneSided(WALL), [0.01, -0.01]), "rotations", "right"),
    ],
)  # fmt: skip
def test_what_it_cannot_be_is_refused(call: Any, field: str, word: str) -> None:
    with pytest.raises(rf.InputError, match=word) as caught:
        call()
    assert caught.value.field == field


def test_a_facade_in_a_file_with_its_drawing_and_report(tmp_path: Any) -> None:
    (tmp_path / "wall.toml").write_text(
        'block = { width = 0.6, height = 6.0, mass = 7e3 }\n[one_sided]\nrestitution = "sorrentino"\nside = "left"\n'
    )
    built = rf.read_structure(tmp_path / "wall.toml")
    assert built == rf.OneSided(WALL, "sorrentino", "left")
    run = rf.simulate(built, RECORD, "rigid")
    page = rf.write_report(run, tmp_path / "wall.html", structure=built).read_text("utf-8")
    assert "one sided" in page
    (tmp_path / "wrong.toml").write_text("block = { width = 0.6, height = 6.0 }\none_sided = { restitution = 2.0 }\n")
    with pytest.raises(rf.InputError, match=r"\[one_sided\].*restitution"):
        rf.read_structure(tmp_path / "wrong.toml")


def test_a_wall_behind_holds_what_is_pushed_towards_it() -> None:
    free, held = (rf.pushover(rf.OneSided(FRAME, side=side), 0.2, lifts=True) for side in ("right", "left"))  # pyright: ignore[reportArgumentType]
    assert free.rotation[-1] > 0.0
    assert np.abs(held.rotation).max() == 0.0


def test_off_the_middle_the_edge_to_which_it_opens_counts() -> None:
    moved = rf.Eccentric(WALL, 0.1)
    for side, place in (("right", 1), ("left", -1)):
        p = rf.OneSided(moved, "sorrentino", side).rocking()  # pyright: ignore[reportArgumentType]
        assert p.weaker_pivot == p.pivot(place)
        assert p.uplift_acceleration == pytest.approx(9.81 * (0.3 - place * 0.1) / 3.0, rel=1e-14)
        assert len(p.pivots) == 2
        run = rf.simulate(rf.OneSided(moved, 0.5, side), RECORD.scaled(0.7), "rigid")  # pyright: ignore[reportArgumentType]
        assert (place * run.rotation).min() >= 0.0
        assert np.abs(run.energy.residual).max() < 1e-9 * run.energy.input.max()


def test_the_command_line_says_to_which_side_it_opens(tmp_path: Any) -> None:
    from typer.testing import CliRunner

    from rockflex.cli._app import app

    file = tmp_path / "wall.toml"
    file.write_text("block = { width = 0.6, height = 6.0 }\n[one_sided]\nrestitution = 0.3\nside = 'left'\n")
    printed = CliRunner().invoke(app, ["modes", str(file)]).stdout
    assert "Opens to the left alone" in printed
    assert "0.3" in printed


@pytest.mark.parametrize(
    "tie",
    [
        rf.YieldingDissipator(1e6, 6e4, 0.02, height=9.0, tension_only=True),
        rf.Tendon(2e4, 1e6, yield_force=7e4, post_yield_ratio=0.02, height=9.0),
    ],
    ids=["loose", "prestressed"],
)
@pytest.mark.parametrize("e", [0.0, 0.4])
def test_a_flexible_facade_with_a_tie_balances_its_energy(tie: rf.Tendon, e: float) -> None:
    """It opens to one side, its floors keep their velocities at impacts, and the tie yields and never pushes."""
    facade = rf.Restrained(rf.OneSided(FRAME, e), tie)
    run = rf.simulate(facade, RECORD.scaled(1.5), output="history", free_vibration=2.0)
    assert run.energy.closing_error < 1e-10
    assert run.rotation.min() >= 0.0
    assert run.rotation.max() > 1e-4
    assert run.element_force.min() > -1e-5  # it goes slack a picometre late
    assert run.energy.impact_losses.min() >= 0.0
    free = FRAME.rocking()
    struck = np.flatnonzero((np.diff(run.time) == 0.0) & (np.diff(run.rotation_velocity) != 0.0))
    assert struck.size
    total = run.modal_velocity + np.outer(run.rotation_velocity, free.effective_height)
    np.testing.assert_allclose(total[struck + 1], total[struck], rtol=1e-9, atol=1e-9)


def test_a_tie_that_never_yields_is_elastic() -> None:
    held = [rf.Restrained(rf.OneSided(FRAME, 0.3), each) for each in (
        rf.YieldingDissipator(1e6, 1e9, 0.02, height=9.0),
        rf.YieldingDissipator(1e6, 1e7, 0.5, height=9.0),
    )]  # fmt: skip
    first, second = (rf.simulate(each, RECORD) for each in held)
    np.testing.assert_allclose(first.max_rotation, second.max_rotation, rtol=1e-10)
