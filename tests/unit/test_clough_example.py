"""The example of a frame on a shaking table: its stiffness by another assembly, and its table on a synthetic motion."""

import importlib.util
import math
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest


@pytest.fixture(scope="module")
def example() -> ModuleType:
    path = Path(__file__).parents[2] / "examples" / "clough_huckelbridge.py"
    spec = importlib.util.spec_from_file_location("clough_huckelbridge", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def table(tmp_path: Path) -> Path:
    time = np.arange(0.0, 3.0, 0.01)
    acceleration = 0.5 * np.sin(2.0 * np.pi * time / 0.4) * (time < 1.2)
    path = tmp_path / "table.csv"
    lines = (f"{t:.6f},{a:.8f}" for t, a in zip(time, acceleration, strict=True))
    path.write_text("\n".join(["time_s,acceleration_g", *lines, ""]), "utf-8")
    return path


def test_stiffness_is_that_of_joints_that_turn_one_by_one(example: ModuleType) -> None:
    """Minus the flexibility of cantilever fields: each column alone, by its end moments, and girders by theirs."""
    n, width = 3, example.WIDTH
    column, girder = (example.E * example.area_and_inertia(each)[1] for each in (example.COLUMN, example.GIRDER))

    def energy(u: np.ndarray, left: np.ndarray, right: np.ndarray) -> float:
        total = 0.0
        for turns in (left, right):
            for k, h in enumerate(example.STORIES):
                sway = (u[k + 1] - u[k]) / h
                a, b = turns[k] - sway, turns[k + 1] - sway  # rotations from the chord; the sign of u is that of turns
                total += 2.0 * 2.0 * column / h * (a * a + a * b + b * b)
        for k in range(1, n + 1):
            total += 2.0 * 2.0 * girder / width * (left[k] ** 2 + left[k] * right[k] + right[k] ** 2)
        return total + 0.5 * example.BRACES * 48.0 * column / example.STORIES[0] ** 3 * u[1] ** 2

    size = 3 * n + 2
    basis = np.eye(size)

    def whole(x: np.ndarray) -> float:
        return energy(np.append(0.0, x[:n]), x[n : 2 * n + 1], x[2 * n + 1 :])

    stiffness = np.array([[whole(p + q) - whole(p) - whole(q) for q in basis] for p in basis])
    schur = stiffness[:n, :n] - stiffness[:n, n:] @ np.linalg.solve(stiffness[n:, n:], stiffness[n:, :n])
    np.testing.assert_allclose(example.lateral_stiffness(1.0, 1.0), schur, rtol=1e-9)


def test_table_says_what_is_numerical_and_what_the_inputs_leave_open(example: ModuleType, table: Path) -> None:
    found = example.validation_table(table, {"uplift": 1.0})
    assert (found["S"] > 0.0).all()
    assert (found["u_num"] < 1e-6 * found["S"]).all()
    assert ((found["u_input"] > 1e-3 * found["S"]) & (found["u_input"] < found["S"])).all()
    lift = found.loc["uplift"]
    assert lift["E"] == lift["S"] - 1.0
    assert lift["u_val"] == pytest.approx(math.hypot(lift["u_num"], lift["u_input"]))
    assert found.loc["base moment", ["D", "E"]].isna().all()


def test_specimen_weighs_what_its_parts_do(example: ModuleType) -> None:
    structure, ground = example.specimen({})
    weight = structure.rocking().m_tot * example.G / example.KIP
    assert 24.0 < weight < 27.0  # three times 8 kip, and steel
    assert ground.springs.stiffness.sum() == pytest.approx(160.0 * example.KIP / example.INCH)


def test_what_is_no_motion_and_no_quantity_is_refused(example: ModuleType, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.csv"
    wrong.write_text("time_s,acceleration_g\n0.0,0.1\n0.0,0.2\n", "utf-8")
    with pytest.raises(SystemExit, match="must be times in s that increase"):
        example.table_motion(wrong)
    with pytest.raises(SystemExit, match="'lift' is not known"):
        example.measured_values("lift=3")
