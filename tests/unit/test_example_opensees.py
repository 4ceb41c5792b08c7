"""The OpenSeesPy example against a stand-in that assembles plane frames as OpenSees does, signs included."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

from builders import make_frame

PATH = Path(__file__).parents[2] / "examples" / "opensees_modes.py"
SCALARS = {"base_mass": 40e3, "half_width": 1.5, "damping_ratio": 0.02}


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("opensees_modes", PATH)
    module = importlib.util.module_from_spec(spec)
    sys.modules["opensees_modes"] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    yield module
    del sys.modules["opensees_modes"]


class OpenSees:
    """What the example calls of OpenSeesPy: plane elastic frames, turning counterclockwise, equations shuffled."""

    def __init__(self, turning_mass=0.0, axial=1.0):
        self.turning_mass, self.axial = turning_mass, axial

    def wipe(self):
        self.nodes, self.held, self.masses, self.members, self.calls = {}, set(), {}, [], []

    def model(self, *words):
        assert words == ("basic", "-ndm", 2, "-ndf", 3)

    def node(self, tag, x, y):
        self.nodes[tag] = (x, y)

    def fix(self, tag, *held):
        assert held == (1, 1, 1)
        self.held.add(tag)

    def mass(self, tag, x, y, turn):
        self.masses[tag] = (x, y, turn + self.turning_mass)

    def geomTransf(self, kind, tag):  # noqa: N802
        assert (kind, tag) == ("Linear", 1)

    def element(self, kind, tag, i, j, area, modulus, moment, transformation):
        assert kind == "elasticBeamColumn"
        assert transformation == 1
        assert tag == len(self.members) + 1
        self.members.append((i, j, self.axial * area * modulus, modulus * moment))

    def wipeAnalysis(self):  # noqa: N802
        self.calls = []

    def __getattr__(self, name):
        if name not in ("constraints", "numberer", "system", "algorithm", "analysis"):
            raise AttributeError(name)
        return lambda *words: self.calls.append((name, *words))

    def integrator(self, kind, *factors):
        assert kind == "GimmeMCK"
        self.factors = factors

    def analyze(self, steps, dt):
        assert (steps, dt) == (1, 0.0)
        assert ("system", "FullGeneral") in self.calls
        free = [(tag, k) for tag in self.nodes if tag not in self.held for k in range(3)]
        order = np.random.default_rng(3).permutation(len(free))
        self.equations = {freedom: int(i) for freedom, i in zip(free, order, strict=True)}
        return -3  # as with a singular matrix

    def systemSize(self):  # noqa: N802
        return len(self.equations)

    def printA(self, flag):  # noqa: N802
        assert flag == "-ret"
        m, _, k = self.factors
        mass, stiffness = self.matrices()
        return (m * mass + k * stiffness).ravel().tolist()

    def matrices(self):
        size = len(self.equations)
        mass, stiffness = np.zeros((2, size, size))
        for (tag, k), i in self.equations.items():
            mass[i, i] = self.masses[tag][k]
        for a, b, ea, ei in self.members:
            k = member(np.array(self.nodes[a]), np.array(self.nodes[b]), ea, ei)
            place = [self.equations.get((tag, j), -1) for tag in (a, b) for j in range(3)]
            free = [n for n, p in enumerate(place) if p >= 0]
            at = [place[n] for n in free]
            stiffness[np.ix_(at, at)] += k[np.ix_(free, free)]
        return mass, stiffness

    def getNodeTags(self):  # noqa: N802
        return list(self.nodes)

    def nodeCoord(self, tag):  # noqa: N802
        return list(self.nodes[tag])

    def nodeDOFs(self, tag):  # noqa: N802
        return [self.equations.get((tag, k), -1) for k in range(3)]

    def eigen(self, count):
        return frequencies(*self.matrices())[:count] ** 2


def member(start, end, ea, ei):
    """Plane frame element in global axes, (u, v, θ) of both ends, θ counterclockwise."""
    length = float(np.hypot(*(end - start)))
    c, s = (end - start) / length
    bend = ei / length**3 * np.array(
        [
            [12, 6 * length, -12, 6 * length],
            [6 * length, 4 * length**2, -6 * length, 2 * length**2],
            [-12, -6 * length, 12, -6 * length],
            [6 * length, 2 * length**2, -6 * length, 4 * length**2],
        ]
    )  # fmt: skip
    local = np.zeros((6, 6))
    local[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = bend
    local[np.ix_([0, 3], [0, 3])] = ea / length * np.array([[1, -1], [-1, 1]])
    turn = np.kron(np.eye(2), np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))
    return turn.T @ local @ turn


def frequencies(mass, stiffness):
    """From the flexibility, as freedoms without mass have no frequency."""
    values = scipy.linalg.eigvals(np.linalg.solve(stiffness, mass)).real
    return 1.0 / np.sqrt(np.sort(values[values > 1e-12 * values.max()])[::-1])


def structure_from(example, ops):
    example.build_frame(ops)
    return example.structure_of(*example.matrices_of(ops), **SCALARS)


def test_the_frame_of_inextensible_members_is_the_library_s(example):
    # With a high axial stiffness the model is the frame of Table 1.
    ops = OpenSees(axial=1e6)
    found = structure_from(example, ops).rocking(5)
    ratio = (example.BEAM[1] / example.BAY) / (2.0 * example.COLUMN[1] / example.STORY_HEIGHT)
    frame = make_frame(
        n_stories=example.N_STORIES,
        story_height=example.STORY_HEIGHT,
        story_mass=example.FLOOR_MASS,
        stiffness_ratio=ratio,
        period=2.0 * np.pi / found.omega[0],
        aspect_ratio=found.effective_height[0] / 1.5,
    )
    expected = frame.rocking()
    for name in ("omega", "effective_mass", "effective_height", "top_ordinate", "i_theta", "l0r", "m_tot"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=2e-5)


def test_frequencies_and_totals_of_the_flexible_frame(example):
    ops = OpenSees()
    structure = structure_from(example, ops)
    # Joints of a floor moving apart are excited by neither the ground nor the rotation.
    every = frequencies(*ops.matrices())
    assert len(structure.modal().omega) == example.N_STORIES < len(every) == 2 * example.N_STORIES
    np.testing.assert_allclose(structure.modal().omega[:3], every[:3], rtol=1e-9)
    p = structure.rocking()
    heights = example.STORY_HEIGHT * np.arange(1, 6)
    assert p.l0r == pytest.approx(40e3 * heights.sum())
    assert p.i_theta == pytest.approx(40e3 * (heights @ heights) + 240e3 * 1.5**2)
    assert p.effective_mass.sum() == pytest.approx(200e3)


def test_rotations_change_their_sign(example):
    ops = OpenSees(turning_mass=3e4)
    p = structure_from(example, ops).rocking()
    mass, stiffness = ops.matrices()
    rigid = np.zeros(len(mass))
    for (tag, k), i in ops.equations.items():
        # A base that turns clockwise moves a node at the height h by h along x, and turns it clockwise.
        rigid[i] = (ops.nodes[tag][1], 0.0, -1.0)[k]
    shift = np.array([float(k == 0) for (_, k), _ in sorted(ops.equations.items(), key=lambda item: item[1])])
    assert p.i_theta == pytest.approx(rigid @ mass @ rigid + 240e3 * 1.5**2, rel=1e-12)
    # Σ m* h*²/ω² = rigid^T M K^-1 M rigid, and Σ m* h*/ω² the same with the shift: no modes are needed.
    pushed = np.linalg.solve(stiffness, mass @ rigid)
    first = p.effective_mass * p.effective_height / p.omega**2
    assert first @ p.effective_height == pytest.approx(rigid @ mass @ pushed, rel=1e-9)
    assert first.sum() == pytest.approx(shift @ mass @ pushed, rel=1e-9)


def test_the_example_runs_and_names_what_it_cannot_take(example, capsys):
    ops = OpenSees()
    example.run(ops)
    lines = capsys.readouterr().out.splitlines()
    for line in lines[1:4]:
        _, theirs, ours = map(float, line.split())
        assert theirs == pytest.approx(ours, rel=1e-6)
    assert lines[-1].startswith("MDOF-S: rocking")
    mass, stiffness, freedoms = example.matrices_of(ops)
    side = next(i for i, freedom in enumerate(freedoms) if freedom.kind == "y" and freedom.height == 3.0)
    mass[side, side] = 1.0
    with pytest.raises(ValueError, match=r"There is vertical mass -?2 m off the axis, at a height of 3 m"):
        example.structure_of(mass, stiffness, freedoms, **SCALARS)
    with pytest.raises(ValueError, match=r"29 freedoms were given for matrices of 30 and 30 rows"):
        example.structure_of(mass, stiffness, freedoms[1:], **SCALARS)
    tied = ops.equations[3, 0]
    ops.nodeDOFs = lambda tag: [tied, -1, -1] if tag > 2 else [-1, -1, -1]
    with pytest.raises(ValueError, match="Node 4 shares an equation with another"):
        example.matrices_of(ops)


def test_without_openseespy_it_says_so(example, monkeypatch):
    monkeypatch.setitem(sys.modules, "openseespy", None)
    monkeypatch.setitem(sys.modules, "openseespy.opensees", None)
    with pytest.raises(SystemExit, match=r"needs OpenSeesPy: pip install openseespy"):
        example.main()
