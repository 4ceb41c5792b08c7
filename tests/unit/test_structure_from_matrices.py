"""Structures from matrices and modes: the same frame by every road, maps of freedoms, files, refusals."""

import re

import numpy as np
import pytest
import scipy.io
import scipy.linalg
import scipy.sparse

import rockflex as rf
from builders import make_frame
from rockflex import InputError

SCALARS = {"base_mass": 40e3, "half_width": 1.5, "damping_ratio": 0.02}
FRAME = make_frame(stiffness_ratio=0.5, period=0.6, aspect_ratio=7.0)
HEIGHTS = FRAME.lumped.heights
MASSES, STIFFNESS = FRAME.lumped.masses, FRAME.lumped.stiffness
NUMBERS = ("omega", "effective_mass", "effective_height", "top_ordinate", "i_theta", "l0r", "m_tot", "zeta")
FLAT = {"mass": [2.0, 1.0], "stiffness": [[3.0, -1.0], [-1.0, 1.0]], "heights": [1.0, 2.0]}


def same(found, expected, rtol=1e-10):
    for name in (*NUMBERS, "translational_inertia"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=rtol)


def beam_matrices(n, length, ei, mass):
    """Uniform Hermite elements as textbooks print them, base held; freedoms (w, φ) from the bottom up."""
    h = length / n
    k_e = ei / h**3 * np.array(
        [
            [12, 6 * h, -12, 6 * h],
            [6 * h, 4 * h * h, -6 * h, 2 * h * h],
            [-12, -6 * h, 12, -6 * h],
            [6 * h, 2 * h * h, -6 * h, 4 * h * h],
        ]
    )  # fmt: skip
    m_e = mass * h / 420.0 * np.array(
        [
            [156, 22 * h, 54, -13 * h],
            [22 * h, 4 * h * h, 13 * h, -3 * h * h],
            [54, 13 * h, 156, -22 * h],
            [-13 * h, -3 * h * h, -22 * h, 4 * h * h],
        ]
    )  # fmt: skip
    k, m = np.zeros((2, 2 * n + 2, 2 * n + 2))
    for e in range(n):
        at = slice(2 * e, 2 * e + 4)
        k[at, at] += k_e
        m[at, at] += m_e
    return k[2:, 2:], m[2:, 2:]


ROADS = {
    "matrices": lambda s: rf.from_matrices(MASSES, STIFFNESS, HEIGHTS, **s),
    "full mass": lambda s: rf.from_matrices(np.diag(MASSES), STIFFNESS, HEIGHTS, **s),
    "modes": lambda s: rf.from_modes(FRAME.modal().omega, FRAME.modal().shapes, MASSES, HEIGHTS, **s),
    "modes of another norm": lambda s: rf.from_modes(
        FRAME.modal().omega, FRAME.modal().shapes * [3.0, -2.0, 1e3, 1.0, 0.1], np.diag(MASSES), HEIGHTS, **s
    ),
}


@pytest.mark.parametrize("road", ROADS)
def test_frame_by_every_road(road):
    structure = ROADS[road](SCALARS | {"half_width": FRAME.half_width})
    same(structure.rocking(), FRAME.rocking())
    np.testing.assert_allclose(structure.modal().shapes, FRAME.modal().shapes, rtol=1e-9)
    np.testing.assert_allclose(structure.rocking().floors.force, FRAME.rocking().floors.force, rtol=1e-9)
    same(structure.rocking(2), FRAME.rocking(2))
    motion = rf.load_suite("el-centro-1940")[0].scaled(2.0)
    found, expected = (rf.simulate(each, motion, "MDOF-S", output="peaks") for each in (structure, FRAME))
    assert expected.status == "rocking"
    assert found.n_impacts == expected.n_impacts > 4
    for name in ("rotation", "top_displacement", "base_moment", "base_shear"):
        assert getattr(found, f"max_{name}") == pytest.approx(getattr(expected, f"max_{name}"), rel=1e-10)


def test_rotations_move_by_one():
    n, length, ei, mass = 24, 30.0, 4e9, 800.0
    k, m = beam_matrices(n, length, ei, mass)
    z = np.arange(1, n + 1) * length / n
    heights = dict(zip(range(0, 2 * n, 2), z, strict=True))
    props = rf.from_matrices(m, k, heights, rotations=range(1, 2 * n, 2), **SCALARS).rocking(4)
    squares, phi = scipy.linalg.eigh(k, m)
    still, turned = np.tile([1.0, 0.0], n), np.column_stack([z, np.ones(n)]).ravel()
    shear, moment = (still @ m @ phi)[:4], (turned @ m @ phi)[:4]
    np.testing.assert_allclose(props.omega, np.sqrt(squares[:4]), rtol=1e-9)
    np.testing.assert_allclose(props.effective_mass, shear**2, rtol=1e-9)
    np.testing.assert_allclose(props.effective_height, moment / shear, rtol=1e-9)
    np.testing.assert_allclose(props.top_ordinate, phi[-2, :4] * shear, rtol=1e-9)
    assert props.translational_inertia == pytest.approx(turned @ m @ turned, rel=1e-12)
    assert props.l0r == pytest.approx(still @ m @ turned, rel=1e-12)
    assert props.floors is None
    beam = rf.Beam(height=length, mass=mass, bending_stiffness=ei, half_width=1.5, damping_ratio=0.02, base_mass=40e3)
    np.testing.assert_allclose(props.effective_height, beam.rocking(4).effective_height, rtol=5e-3)
    assert props.translational_inertia == pytest.approx(mass * length**3 / 3.0, rel=1e-4)


def test_all_modes_turn_as_the_rigid_body():
    k, m = beam_matrices(4, 10.0, 1e8, 500.0)
    heights = {0: 2.5, 2: 5.0, 4: 7.5, 6: 10.0}
    props = rf.from_matrices(m, k, heights, rotations=[1, 3, 5, 7], **SCALARS).rocking()
    assert props.n_modes == 8
    total = props.effective_mass @ props.effective_height**2
    assert total == pytest.approx(props.translational_inertia, rel=1e-10)


def test_order_of_the_freedoms_is_free():
    k, m = beam_matrices(4, 10.0, 1e8, 500.0)
    z = {0: 2.5, 2: 5.0, 4: 7.5, 6: 10.0}
    first = rf.from_matrices(m, k, z, rotations=[1, 3, 5, 7], **SCALARS)
    order = np.random.default_rng(3).permutation(8)
    where = np.argsort(order)  # freedom i now stands at where[i]
    mixed = rf.from_matrices(
        m[np.ix_(order, order)],
        k[np.ix_(order, order)],
        {int(where[i]): h for i, h in z.items()},
        rotations=[int(where[i]) for i in (1, 3, 5, 7)],
        **SCALARS,
    )
    same(mixed.rocking(4), first.rocking(4), 1e-9)


def test_modes_out_of_the_plane_are_left_out():
    both = scipy.linalg.block_diag(STIFFNESS, 0.7 * STIFFNESS)
    heights = dict(enumerate(HEIGHTS))
    s = SCALARS | {"half_width": FRAME.half_width}
    structure = rf.from_matrices(np.tile(MASSES, 2), both, heights, **s)
    same(structure.rocking(), FRAME.rocking())
    assert structure.modal().n_modes == 5
    assert rf.from_matrices(np.tile(MASSES, 2), both, heights, n_modes=2, **s).rocking().n_modes == 2


def test_freedoms_at_one_height_are_one_floor():
    # Each floor in two halves, tied by a stiff bar.
    tie = 1e6 * np.abs(STIFFNESS).max()
    half = np.kron(np.array([[0.5, 0.0], [0.0, 0.5]]), STIFFNESS)
    k = half + tie * np.kron(np.array([[1.0, -1.0], [-1.0, 1.0]]), np.eye(5))
    structure = rf.from_matrices(
        np.tile(MASSES / 2.0, 2), k, np.tile(HEIGHTS, 2), n_modes=5, **(SCALARS | {"half_width": FRAME.half_width})
    )
    same(structure.rocking(), FRAME.rocking(), 1e-6)
    np.testing.assert_allclose(structure.rocking().floors.force, FRAME.rocking().floors.force, rtol=1e-5)


def test_damping_of_each_mode():
    zeta = [0.01, 0.02, 0.03]
    structure = rf.from_matrices(MASSES, STIFFNESS, HEIGHTS, **(SCALARS | {"damping_ratio": zeta}), n_modes=3)
    np.testing.assert_array_equal(structure.rocking().zeta, zeta)


def written(folder, kind):
    """Paths of mass, stiffness, heights, shapes and omega."""
    arrays = {
        "mass": np.diag(MASSES),
        "stiffness": STIFFNESS,
        "heights": HEIGHTS,
        "shapes": FRAME.modal().shapes,
        "omega": FRAME.modal().omega,
    }
    paths = {name: folder / f"{name}.{kind.split()[0]}" for name in arrays}
    if kind == "npz together":
        np.savez(folder / "all.npz", **arrays)
        return dict.fromkeys(arrays, folder / "all.npz")
    for name, array in arrays.items():
        matrix = np.atleast_2d(array)
        if kind == "npz":
            np.savez(paths[name], array)
        elif kind == "npz sparse":
            scipy.sparse.save_npz(paths[name], scipy.sparse.csr_array(matrix))
        elif kind == "mtx":
            scipy.io.mmwrite(paths[name], matrix, precision=17)
        elif kind == "mtx sparse":
            scipy.io.mmwrite(paths[name], scipy.sparse.coo_array(matrix), precision=17)
        else:
            np.savetxt(paths[name], array, delimiter=",", fmt="%.17g")
    return paths


@pytest.mark.parametrize("kind", ["npz", "npz together", "npz sparse", "mtx", "mtx sparse", "csv"])
def test_files(tmp_path, kind):
    paths = written(tmp_path, kind)
    s = SCALARS | {"half_width": FRAME.half_width}
    same(rf.from_matrices(paths["mass"], str(paths["stiffness"]), paths["heights"], **s).rocking(), FRAME.rocking())
    modes = rf.from_modes(paths["omega"], paths["shapes"], paths["mass"], paths["heights"], **s)
    same(modes.rocking(), FRAME.rocking())


def test_files_of_one_freedom(tmp_path):
    (tmp_path / "k.csv").write_text("4.0\n")
    one = rf.from_matrices([1.0], tmp_path / "k.csv", [2.0], **SCALARS)
    assert one.modal().omega[0] == pytest.approx(2.0)


def test_files_refused(tmp_path):
    def read(name):
        rf.from_matrices(MASSES, tmp_path / name, HEIGHTS, **SCALARS)

    with pytest.raises(InputError, match=r"stiffness: the suffix of .*k.txt must be one of .npz, .mtx, .csv"):
        read("k.txt")
    with pytest.raises(InputError, match=r"stiffness: the file .*k.csv does not exist \(working directory: "):
        read("k.csv")
    for name in ("k.csv", "k.mtx", "k.npz"):
        (tmp_path / name).write_text("no, numbers\n")
        with pytest.raises(InputError, match=rf"no matrix of numbers can be read from .*{name}"):
            read(name)
    np.savez(tmp_path / "k.npz", a=STIFFNESS, b=STIFFNESS)
    words = re.escape("must contain an array \"stiffness\" or a single array, but it contains ['a', 'b']")
    with pytest.raises(InputError, match=words):
        read("k.npz")


@pytest.mark.parametrize(
    "heights",
    [[8.0, np.nan, 16.0, np.nan], [8.0, 8.0, 16.0, 16.0], [8.0, 0.0, 16.0, 0.0], [8.0, 16.0], {2: 16.0, 0: 8.0}],
)
def test_heights_of_translations_in_any_layout(heights, tmp_path):
    given = {"stiffness": beam_matrices(2, 16.0, 4.0e9, 1.0)[0], "rotations": [1, 3], **SCALARS}
    mass = [30e3, 0.0, 80e3, 0.0]
    p = rf.from_matrices(mass, heights=heights, **given).rocking()
    low, top = 8.0, 16.0  # the flexibility of a cantilever at its nodes, which knows no rotations
    both = low**2 * (3 * top - low) / 6
    f = np.array([[low**3 / 3, both], [both, top**3 / 3]]) / 4.0e9
    expected = np.sort(1.0 / np.sqrt(np.linalg.eigvals(f @ np.diag([30e3, 80e3]))))
    np.testing.assert_allclose(p.omega, expected, rtol=1e-10)
    assert p.l0r == pytest.approx(30e3 * low + 80e3 * top, rel=1e-12)
    if not isinstance(heights, dict):
        np.savetxt(tmp_path / "heights.csv", heights)
        same = rf.from_matrices(mass, heights=tmp_path / "heights.csv", **given).rocking()
        np.testing.assert_allclose(same.omega, p.omega, rtol=1e-14)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"stiffness": [[1.0, 1.0], [1.0, 1.0]]}, "stiffness must be positive definite, but its smallest eigenvalue"),
        ({"stiffness": [[3.0, -1.0], [-2.0, 1.0]]}, r"stiffness must be symmetric, but stiffness\[0, 1\] = -1"),
        ({"stiffness": [1.0, 2.0]}, r"stiffness must have the shape \(1, 1\)"),
        ({"mass": [[1.0, 1.0], [1.0, 1.0]]}, "mass must be positive definite, but its smallest eigenvalue is"),
        ({"mass": [1.0]}, "mass must contain one mass for each of the 2 degrees of freedom, but 1 were given"),
        ({"mass": [1.0, -1.0]}, "mass must not be negative, but it is -1 at degree of freedom 1"),
        ({"mass": [0.0, 0.0]}, "mass must be assigned to at least one degree of freedom that translates"),
        ({"mass": [0.0, 1.0], "heights": {0: 1.0}}, "mass must be assigned to at least one degree of freedom"),
        ({"heights": [1.0]}, "heights must contain one height for each of the 2 degrees of freedom, but 1 were"),
        ({"heights": {}}, "heights must contain at least one height in m above the base, all positive, but none was"),
        ({"heights": {0: -1.0}}, "all positive, but -1 m was given. A mass at the base belongs to base_mass"),
        ({"heights": {2: 1.0}}, "heights, index must be a whole number from 0 to 1, but 2 was given"),
        ({"heights": {0: 1.0, 1: 2.0}, "rotations": [1]}, "rotations must list each degree of freedom once, and none"),
        ({"heights": {0: 1.0}, "rotations": [1, 1]}, "but 1 is listed twice"),
        ({"heights": {0: 1.0}, "rotations": [5]}, "rotations, index must be a whole number from 0 to 1, but 5 was"),
        ({"n_modes": 3}, "n_modes must be a whole number from 1 to 2, but 3 was given"),
        ({"half_width": -1.0}, "half_width must be a positive, finite number in m"),
        ({"base_mass": -1.0}, "base_mass must be a zero or positive, finite number in kg"),
        ({"damping_ratio": [0.1]}, "damping_ratio must be one number, or one for each of the 2 modes, but 1 were"),
    ],
)
def test_matrices_refused(changes, words):
    with pytest.raises(InputError, match=words):
        rf.from_matrices(**(FLAT | SCALARS | changes))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"shapes": [[1.0, 1.0], [2.0, -1.1]]}, r"The mode shapes must be orthogonal with respect to the mass"),
        ({"shapes": [[1.0, 0.0], [2.0, 0.0]]}, r"Mode shape 2 moves no mass \(φ\^T M φ = 0\). Check that both"),
        ({"omega": [3.0, 2.0]}, "omega must contain positive frequencies in rad/s in ascending order, but"),
        ({"omega": [0.0, 2.0]}, "omega must contain positive frequencies in rad/s in ascending order"),
        ({"omega": []}, "omega must contain positive frequencies in rad/s in ascending order"),
        ({"omega": [3.0]}, r"shapes must have the shape \(2, 1\), but an array of shape \(2, 2\) was given"),
        ({"heights": [1.0]}, "heights must contain one height for each of the 2 degrees of freedom"),
    ],
)
def test_modes_refused(changes, words):
    good = {"omega": [1.0, 2.0], "shapes": [[1.0, 1.0], [2.0, -0.5]], "mass": [1.0, 1.0], "heights": [1.0, 2.0]}
    rf.from_modes(**good, **SCALARS)
    with pytest.raises(InputError, match=words):
        rf.from_modes(**(good | SCALARS | changes))


def test_a_mode_that_only_turns_is_refused():
    # Two masses and an antisymmetric mode of no base shear.
    words = r"Mode 1 \(1 rad/s\) contributes to the base moment but not to the base shear"
    with pytest.raises(InputError, match=words):
        rf.from_modes([1.0], [1.0, -1.0], [1.0, 1.0], [1.0, 2.0], **SCALARS)


def test_one_shape_may_be_a_vector():
    one = rf.from_modes([2.0], [1.0, 2.0], [1.0, 1.0], [1.0, 2.0], **SCALARS).rocking()
    assert one.effective_mass[0] == pytest.approx(9.0 / 5.0)
    assert one.effective_height[0] == pytest.approx(5.0 / 3.0)


def test_sparse_matrices_too_large_to_be_dense(tmp_path):
    (tmp_path / "k.mtx").write_text("%%MatrixMarket matrix coordinate real general\n900000 900000 1\n1 1 2.0\n")
    with pytest.raises(InputError, match=r"stiffness: .*k\.mtx contains a sparse matrix of shape \(900000, 900000\)"):
        rf.from_matrices([1.0], tmp_path / "k.mtx", [1.0], base_mass=1.0, half_width=1.0, damping_ratio=0.02)


def test_ragged_shapes_are_told():
    with pytest.raises(InputError, match=r"shapes must be a sequence of numbers in any unit, but list whose rows"):
        rf.from_modes([1.0], [[1.0], [1.0, 2.0]], [1.0], [1.0], base_mass=1.0, half_width=1.0, damping_ratio=0.02)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "its first line must declare a matrix"),
        ("1,1, 1,1, 1.0e6\n2,1, 1,1, -5.0e5\n", r"it is in Abaqus.s form MATRIX INPUT .* numpy\.savez"),
        ("** Abaqus\n*MATRIX INPUT, NAME=K\n1,1, 1,1, 1.0e6\n", "it is in Abaqus.s form MATRIX INPUT"),
        ("1 1 1.0e6\n2 1 -5.0e5\n2 2 5.0e5\n", "its entries lack the header of Matrix Market. Write above them"),
        ("%%MatrixMarket matrix coordinate complex general\n1 1 1\n1 1 2.0", "its first line must declare a matrix"),
        ("%%MatrixMarket matrix coordinate real general\n1 1\n", "its size line must give the numbers of rows"),
        (
            "%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 2.0\n",
            r"it must contain 3 entries of three numbers",
        ),
        ("%%MatrixMarket matrix coordinate real general\n2 2 1\n3 1 2.0\n", "its entries must lie in 2 rows and"),
        (
            "%%MatrixMarket matrix array real symmetric\n2 2\n1\n2\n",
            "it must contain 3 numbers for a matrix of 2 by 2",
        ),
        ("%%MatrixMarket matrix array real general\n1000000 1000000\n1\n", "it must contain 1000000000000 numbers"),
    ],
)
def test_damaged_matrix_market(tmp_path, text, words):
    (tmp_path / "k.mtx").write_text(text)
    with pytest.raises(InputError, match=rf"stiffness: no matrix of numbers can be read from .*k\.mtx: {words}"):
        rf.from_matrices([1.0], tmp_path / "k.mtx", [1.0], base_mass=1.0, half_width=1.0, damping_ratio=0.02)


@pytest.mark.parametrize(
    "text",
    [
        "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n2 2 3\n1 1 3.0\n2 1 -1.0\n2 2 1.0\n",
        "%%MatrixMarket matrix array integer symmetric\n2 2\n3\n-1\n1\n",
        "%%MatrixMarket matrix array real general\n2 2\n3.0\n-1.0\n-1.0\n1.0\n",
    ],
)
def test_forms_of_matrix_market(tmp_path, text):
    (tmp_path / "k.mtx").write_text(text)
    known = {"base_mass": 1.0, "half_width": 1.0, "damping_ratio": 0.02}
    read = rf.from_matrices([1.0, 1.0], tmp_path / "k.mtx", [1.0, 2.0], **known)
    assert read == rf.from_matrices([1.0, 1.0], [[3.0, -1.0], [-1.0, 1.0]], [1.0, 2.0], **known)
