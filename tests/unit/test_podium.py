"""Buildings on columns that rock together: coordinates of floors and slab, limits, momentum, energies, files."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rockflex as rf

BUILDING = rf.Frame(3, 3.0, 40e3, 120e3, 1.0, period=0.4, aspect_ratio=3.0, damping_ratio=0.03)
COLUMNS: dict[str, Any] = {"n_columns": 4, "column_width": 0.8, "column_height": 5.0, "column_mass": 8e3}
PODIUM = rf.Podium(BUILDING, **COLUMNS, column_spacing=4.0)
RECORD = rf.load_suite("fema-p695-near-field-pulse")[3].scaled(1.5)


def test_free_rocking_is_that_of_slab_floors_and_columns() -> None:
    """Floors by their masses and stiffness, slab and columns by their energies, over three impacts."""
    lumped, b, h, n = BUILDING.assembled, 0.4, 2.5, 4
    m, K, columns, slab = lumped.masses, lumped.stiffness, n * 8e3, 120e3
    omega2, shapes = np.linalg.eigh(K / np.sqrt(np.outer(m, m)))
    root = np.sqrt(np.outer(m, m))
    C, height, r2 = root * (shapes * 0.06 * np.sqrt(omega2) @ shapes.T), 2.0 * h, b**2 + h**2
    inertia = columns * 4.0 / 3.0 * r2 + slab * 4.0 * r2 + m.sum() * 4.0 * r2
    M = np.block([[np.diag(m), height * m[:, None]], [height * m[None], np.array([[inertia]])]])
    weight, lean = 9.81 * b * (columns + 2.0 * (slab + m.sum())), 9.81 * (columns * h + (slab + m.sum()) * height)

    def rates(_: float, y: Any, s: float) -> Any:
        q, v = y[:4], y[4:]
        forces = np.append(-K @ q[:3] - C @ v[:3], lean * q[3] - s * weight)
        return np.append(v, np.linalg.solve(M, forces))

    def lands(_: float, y: Any, s: float) -> float:
        return s * y[3]

    lands.terminal, lands.direction = True, -1  # pyright: ignore[reportFunctionMemberAccess]
    y, t, s, e = np.zeros(8), 0.0, 1.0, PODIUM.rocking().restitution
    assert e is not None
    y[3] = 0.04
    for _ in range(3):
        found = solve_ivp(rates, (t, 10.0), y, "DOP853", events=lands, args=(s,), rtol=1e-12, atol=1e-15)
        y, t, s = found.y[:, -1].copy(), float(found.t[-1]), -s
        y[4:7] += height * (1.0 - e) * y[7]  # every floor keeps its velocity
        y[3], y[7] = 0.0, e * y[7]
    quiet = rf.quiet_motion(6.0)
    run = rf.simulate(PODIUM, quiet, initial=rf.InitialState(rotation=0.04), output="history")
    np.testing.assert_allclose(run.impact_times[2], t, rtol=1e-9)
    after = np.flatnonzero(run.time == run.impact_times[2])[-1]
    assert run.history is not None
    np.testing.assert_allclose(run.history.rotation_velocity[after], y[7], rtol=1e-8)


def test_a_slab_alone_is_a_rocking_frame() -> None:
    alone = rf.Podium(None, **COLUMNS, slab_mass=90e3)
    frame = rf.rocking_frame(4, 0.8, 5.0, 8e3, cap_mass=90e3)
    assert alone.rocking() == frame
    light = rf.LumpedStructure([1e-6], [[1e3]], [3.0], base_mass=90e3, half_width=1.0, damping_ratio=0.02)
    podium = rf.Podium(light, **COLUMNS).rocking()
    for name in ("restitution", "i_theta", "l0r", "m_tot", "half_width"):
        np.testing.assert_allclose(getattr(podium, name), getattr(frame, name), rtol=1e-9)


def test_momentum_about_the_new_pivots_gives_the_restitution() -> None:
    """Columns and slab as bodies, floors that only rise: the moment of momentum before is that after the impact."""
    b, h, m_c, slab, building = 0.4, 2.5, 8e3, 120e3, 120e3
    of_column = m_c * ((b**2 + h**2) / 3.0 + h**2 - b**2)  # about the other edge: the centre moves along the old circle
    before = 4 * of_column + slab * (2 * h) ** 2 - (slab + building) * (2 * b) ** 2
    after = 4 * m_c * 4.0 / 3.0 * (b**2 + h**2) + slab * ((2 * h) ** 2 + (2 * b) ** 2) + building * (2 * b) ** 2
    np.testing.assert_allclose(PODIUM.rocking().restitution, before / after, rtol=1e-12)


def test_energy_closes_and_mirror_images_are_alike() -> None:
    there, back = (rf.simulate(PODIUM, RECORD.scaled(sign), output="history") for sign in (1.0, -1.0))
    assert there.energy.closing_error < 1e-10
    assert there.energy.impact_losses.min() > 0.0
    np.testing.assert_allclose(there.rotation, -back.rotation, rtol=1e-9, atol=1e-12)


def test_floors_move_alike_with_the_rotation() -> None:
    run = rf.simulate(PODIUM, RECORD, output="history")
    drifts = np.cumsum(run.story_drift, axis=1)
    moved = drifts + 5.0 * run.rotation[:, None]
    np.testing.assert_allclose(run.total_floor_displacement, moved, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(run.total_top_displacement, moved[:, -1], rtol=1e-9, atol=1e-12)
    forces = drifts @ BUILDING.assembled.stiffness
    np.testing.assert_allclose(np.abs(run.base_moment), np.abs(forces @ [3.0, 6.0, 9.0]), rtol=1e-8, atol=1.0)


def test_a_column_that_is_pulled_is_told() -> None:
    narrow = rf.Podium(BUILDING, **COLUMNS, column_spacing=0.9)
    run = rf.simulate(narrow, RECORD)
    pull = 240e3 * 9.81 * 0.9 * 5 / 6
    np.testing.assert_allclose(run.column_pull, run.max_base_moment / pull, rtol=1e-12)
    assert any("column" in text for text in run.warnings) == (run.column_pull > 1.0)
    assert rf.simulate(rf.Podium(BUILDING, **COLUMNS), RECORD).column_pull == 0.0


def test_files_and_saved_responses_keep_it(tmp_path: Path) -> None:
    run = rf.simulate(PODIUM, RECORD, output="history")
    read = rf.Response.load(run.save(tmp_path / "run.npz"))
    np.testing.assert_array_equal(read.total_floor_displacement, run.total_floor_displacement)
    case = rf.Case(structures={"podium": PODIUM}, records={"suites": ["el-centro-1940"]}, models=["MDOF-S"])
    written = case.write(tmp_path / "case.toml")
    assert "podium" in written.read_text()
    assert rf.read_case(written).run().equals(case.run())  # pyright: ignore[reportAttributeAccessIssue]


@pytest.mark.parametrize(
    ("model", "more", "field"),
    [("MDOF-C", {}, "columns"), ("rigid", {}, "columns"), ("MDOF-S", {"ground": rf.Ground(friction=0.5)}, "ground")],
)
def test_models_that_podiums_have_not_are_refused(model: str, more: dict[str, Any], field: str) -> None:
    with pytest.raises(rf.InputError) as caught:
        rf.simulate(PODIUM, RECORD, model, **more)
    assert caught.value.field == field


def test_what_is_no_building_is_refused() -> None:
    for building in (rf.rigid_block(width=1.0, height=4.0), rf.Eccentric(BUILDING, 0.2)):
        with pytest.raises(rf.InputError) as caught:
            rf.Podium(building, **COLUMNS)
        assert caught.value.field == "structure"
    with pytest.raises(rf.InputError) as caught:
        rf.Podium(BUILDING, 4, 6.0, 4.0, 8e3)
    assert caught.value.field == "column_width"


def test_the_drawing_stands_on_its_columns() -> None:
    figure = rf.plot_structure(PODIUM)
    drawn = [each for axes in figure.axes for each in (*axes.lines, *axes.patches)]
    assert len(drawn) > 4
    rf.plot_structure(rf.Jointed(BUILDING, rf.Joint(3.0, 1.0)))
