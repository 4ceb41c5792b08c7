"""Values that are tiny, huge or far apart: a result that does not depend on the units, or an error that names them."""

import math

import numpy as np
import pytest

import rockflex as rf
from rockflex import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.structure import _finite_elements

CANTILEVER = {
    "height": 12.0,
    "tip_mass": 50e3,
    "bending_stiffness": 2e9,
    "base_mass": 10e3,
    "half_width": 1.2,
    "damping_ratio": 0.03,
    "mass_per_length": 500.0,
}
TWO = {"base_mass": 1e3, "half_width": 1.0, "damping_ratio": 0.02}


@pytest.fixture(autouse=True)
def no_modes_are_kept():
    """Of beams that other tests have solved."""
    _finite_elements.finite_element_modes.cache_clear()


def cantilever(**changes):
    return rf.CantileverWithTipMass(**(CANTILEVER | changes))


@pytest.mark.parametrize("length", [1e-40, 1e-9, 1e12])
@pytest.mark.parametrize("mass", [1e-60, 1e30])
@pytest.mark.parametrize("rate", [1e-20, 1e25])
def test_a_beam_has_the_same_modes_in_any_units(length, mass, rate):
    """Lengths times `length`, masses times `mass`, frequencies times `rate`: dimensions alone give the rest."""
    one = cantilever(tip_inertia=9e4).rocking()
    other = cantilever(
        height=12.0 * length,
        tip_mass=50e3 * mass,
        bending_stiffness=2e9 * mass * length**3 * rate**2,
        base_mass=10e3 * mass,
        half_width=1.2 * length,
        mass_per_length=500.0 * mass / length,
        tip_inertia=9e4 * mass * length**2,
    ).rocking()
    np.testing.assert_allclose(other.omega, one.omega * rate, rtol=1e-11)
    np.testing.assert_allclose(other.effective_mass, one.effective_mass * mass, rtol=1e-9)
    np.testing.assert_allclose(other.effective_height, one.effective_height * length, rtol=1e-9)
    np.testing.assert_allclose(other.i_theta, one.i_theta * mass * length**2, rtol=1e-12)


@pytest.mark.parametrize("height", [3.0, 12.0, 70.0])
@pytest.mark.parametrize("column", [1e-10, 1e-20, 1e-30, 1e-34])
def test_a_tip_far_heavier_than_its_column(column, height):
    """The tip stands still in all modes but the first: a column clamped at one end and pinned at the other."""
    modes = cantilever(mass_per_length=column, height=height).modal()
    assert modes.omega[0] == pytest.approx(math.sqrt(3.0 * 2e9 / height**3 / 50e3), rel=1e-8)
    pinned = rf.pinned_beam("flexure", n_modes=3).roots[1:]
    np.testing.assert_allclose(modes.omega[1:4], pinned**2 * math.sqrt(2e9 / column) / height**2, rtol=1e-9)


@pytest.mark.parametrize("rotary", [0.0, 5e5])
def test_several_bodies_far_heavier_than_their_beam(rotary):
    """Those above their number are modes of the beam between bodies that stand still, and go by its mass alone."""

    def omega(share):
        bodies = rf.LumpedMasses([5.0, 12.0, 20.0], [8e3, 5e3, 9e3], [rotary, 2.0 * rotary, rotary])
        beam = {"height": 20.0, "bending_stiffness": 1e9, "half_width": 1.5, "damping_ratio": 0.02}
        return rf.Beam(mass=500.0 * share, lumped_masses=bodies, n_elements=200, n_modes=8, **beam).modal().omega

    heavy = 3 if rotary == 0.0 else 6
    light, lighter = omega(1e-14), omega(1e-32)
    np.testing.assert_allclose(lighter[:heavy], light[:heavy], rtol=1e-9)
    np.testing.assert_allclose(lighter[heavy:], 1e9 * light[heavy:], rtol=1e-9)


BEAM = r"^The modes of a beam with height = {} m, and mass = {} kg/m and EI = {} N m² at its base cannot be computed: "


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: cantilever(height=1e-200).modal(), BEAM.format("1e-200", "500", r"2e\+09")),
        (lambda: cantilever(height=1e200).modal(), BEAM.format(r"1e\+200", "500", r"2e\+09")),
        (lambda: cantilever(bending_stiffness=5e-324).modal(), BEAM.format("12", "500", "4.94066e-324")),
        (lambda: cantilever(mass_per_length=1e-310).modal(), BEAM.format("12", "1e-310", r"2e\+09")),
        (lambda: cantilever(mass_per_length=1e-45).modal(), r"cannot hold \(a body on it has 4e\+48 times its mass, "
         r"more than 1e\+40 times\)"),
        (lambda: cantilever(mass_per_length=1.0, tip_inertia=1e50).modal(), r"a body on it has 6e\+46 times its mass"),
        (lambda: cantilever(height=1e-120, mass_per_length=0.0), "The stiffness of a column with height = 1e-120 m "),
        (lambda: cantilever(height=1e120, mass_per_length=0.0), "and EI = 2e[+]09 N m² cannot be computed: numbers "),
        (lambda: rf.Beam(height=1e200, mass=5, bending_stiffness=1e9, half_width=1, damping_ratio=0, method="ritz")
         .modal(), BEAM.format(r"1e\+200", "5", r"1e\+09")),
        (lambda: rf.Frame(3, 3.0, 4e4, 4e4, 0.0, 1e-200, 10.0, 0.02).modal(), "The stiffness of a frame with "
         "story_mass = 40000 kg and period = 1e-200 s cannot be computed"),
        (lambda: rf.Frame(3, 1e200, 4e4, 4e4, 0.0, 1.0, 10.0, 0.02).rocking(), "cannot be computed: numbers arise "),
        (lambda: rf.FishBone([1e-120], [1e3], [1e9], [0.0], **TWO).rocking(), "The stiffness of a frame with these "
         "story heights, column and beam stiffnesses cannot be computed"),
        (lambda: rf.WallFrame(1e200, 1e6, 1.0, 1e3, 1.0, 10.0, 0.02).rocking(), "cannot be computed"),
        (lambda: rf.LumpedStructure([1e3, 1e3], [[1.7e308, -1e308], [-1e308, 1e308]], [3.0, 6.0], **TWO), "Whether "
         "a matrix is positive definite cannot be computed"),
        (lambda: rf.LumpedStructure([1e3], [[1e7]], [1e200], **TWO).rocking(), "cannot be computed"),
        (lambda: rf.from_matrices([1e3], [[1e7]], [1e200], **TWO), "The modes of the given mass and stiffness matrices "
         "cannot be computed"),
        (lambda: rf.rigid_block(0.2, 1e200), "The inertia of a block with these sizes and this mass cannot be comp"),
        (lambda: rf.RockingProperties([6.0], [1e3], [1e200], [1.0], 1e9, 1e6, 1e5, 1.0, 0.02), "The inertia of the "
         "modes, from effective_mass and effective_height, cannot be computed"),
        (lambda: rf.uplifted_modes(rf.RockingProperties([1e200], [1e3], [9.0], [1.0], 1e9, 1e6, 1e5, 1.0, 0.02)), "The "
         "uplifted modes of the given properties cannot be computed"),
        (lambda: rf.equivalent_s1(0.2, 0.02, 0.2, 1e200), "The modes of the given mass and stiffness cannot be "),
        (lambda: rf.TaperedTower(1e200, 8, 4, 1, 2400, 25e9, 0.02).modal(), BEAM.format(r"1e\+200", ".*", ".*")),
    ],
)  # fmt: skip
def test_what_cannot_be_computed_is_an_input_error(build, words):
    with pytest.raises(InputError, match=words) as caught:
        build()
    if "cannot be computed" in str(caught.value):
        assert str(caught.value).endswith(
            "Check the units (kg, m, s, N, rad throughout), and whether values that belong together are many orders of "
            "magnitude apart."
        )


def test_a_mode_that_is_none_is_refused(monkeypatch):
    solve = _finite_elements.eigsh

    def disturbed(*arguments, **options):
        values, vectors = solve(*arguments, **options)
        return values, vectors + 0.01 * vectors[:, ::-1]

    monkeypatch.setattr(_finite_elements, "eigsh", disturbed)
    with pytest.raises(InputError, match=r"cannot hold \(a mode has a relative residual of \d"):
        cantilever().modal()


def test_a_solver_that_gives_up_is_told(monkeypatch):
    def gives_up(*_, **__):
        raise _finite_elements.ArpackError(-9999)

    monkeypatch.setattr(_finite_elements, "eigsh", gives_up)
    with pytest.raises(InputError, match=r"cannot hold \(ARPACK error -9999"):
        cantilever().modal()


def test_what_the_solver_found_before_it_gave_up_is_kept(monkeypatch):
    solve, calls = _finite_elements.eigsh, []
    expected = cantilever().modal().omega
    _finite_elements.finite_element_modes.cache_clear()

    def gives_up(*arguments, **options):
        calls.append(options["k"])
        found = solve(*arguments, **options)
        if len(calls) == 1:
            raise _finite_elements.ArpackNoConvergence("three are missing", found[0][:2], found[1][:, :2])
        return found

    monkeypatch.setattr(_finite_elements, "eigsh", gives_up)
    np.testing.assert_allclose(cantilever().modal().omega, expected, rtol=1e-9)
    assert calls == [5, 3]


def test_a_solver_that_finds_nothing_is_told(monkeypatch):
    def finds_nothing(*_, **__):
        raise _finite_elements.ArpackNoConvergence("none", np.empty(0), np.empty((2000, 0)))

    monkeypatch.setattr(_finite_elements, "eigsh", finds_nothing)
    with pytest.raises(InputError, match=r"cannot hold \(no mode was found\)"):
        cantilever().modal()


@pytest.mark.parametrize("method", ["fe", "ritz"])
def test_a_function_may_overflow_within(method):
    smooth = rf.Beam(height=20.0, mass=lambda z: 500.0 + 0.0 / (1.0 + np.exp(800.0 * z)), **_rest(method)).modal()
    plain = rf.Beam(height=20.0, mass=500.0, **_rest(method)).modal()
    np.testing.assert_allclose(smooth.omega, plain.omega, rtol=1e-12)


def _rest(method):
    return {"bending_stiffness": 1e9, "half_width": 1.5, "damping_ratio": 0.02, "method": method}


def test_other_errors_pass():
    with pytest.raises(KeyError), explaining_overflow("Nothing"):
        raise KeyError
    with pytest.raises(InputError, match=r"^One cannot be computed: .* \(OverflowError\)"), explaining_overflow("One"):
        raise OverflowError
