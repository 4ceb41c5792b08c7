"""Drawings of structures: what is written, where it is, and that no text runs into another."""

import math
from dataclasses import dataclass
from itertools import combinations, product

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_hex

import rockflex as rf
from builders import PROPERTIES, make_frame
from drawing import notes
from rockflex.plot._figures import RED
from rockflex.plot._run_sheet import draw_run_sheet
from rockflex.structure._outline import SYMBOLS, structure_outline

RECORD = rf.load_suite("el-centro-1940")[0]
SIZES = ("page", (5.0, 2.5), (3.0, 6.0))


@dataclass(frozen=True, repr=False)
class Bumper(rf.ElementLaw):
    """An element of a user, without a title."""

    stiffness: float
    position: float = 0.0

    def branches(self):
        return {"pressed": rf.Branch(self.stiffness)}


def every_element(b):
    """All kinds of elements of a base of half-width b."""
    return [
        *(rf.Tendon(initial_force=200e3, stiffness=8e6, yield_force=400e3, position=x * b) for x in (-0.5, 0.5)),
        *(rf.YieldingDissipator(stiffness=40e6, yield_force=90e3, position=x * b) for x in (-0.5, 0.5)),
        rf.ViscousDamper(coefficient=2e5),
        rf.FrictionDamper(force=50e3),
        rf.GapBar(stiffness=2e7, gap=0.01),
        rf.FlagShapedBar(2e7, 60e3, 0.02, 0.5),
        rf.MultilinearBar((0.01, 0.03), (5e4, 7e4)),
        Bumper(3e6),
    ]


def on_floors(z):
    return [rf.ViscousDamper(1e5, between=(0, 1), cosine=0.8), rf.Tendon(1e5, 5e6, height=z, cosine=-0.6)]


def shear_frame():
    return rf.FishBone(
        [4.0, 3.0, 3.0, 2.5], [60e3, 50e3, 50e3, 30e3], [2e8] * 4, [math.inf] * 4, base_mass=3e4, half_width=3.0,
        damping_ratio=0.02,
    )  # fmt: skip


def pier(**more):
    return rf.CantileverWithTipMass(
        height=12.0, tip_mass=500e3, bending_stiffness=4e10, base_mass=120e3, half_width=1.5, damping_ratio=0.03, **more
    )


def structures():
    """One structure of every kind, and frames of several aspect ratios."""
    yield from ((f"frame, h/B = {ratio}", make_frame(aspect_ratio=ratio)) for ratio in (0.5, 2.0, 10.0, 60.0))
    yield "one story", make_frame(n_stories=1, aspect_ratio=3.0)
    yield "fifty stories", make_frame(n_stories=50, period=4.0)
    yield "unequal stories", shear_frame()
    different = rf.LumpedStructure(
        np.linspace(20e3, 50e3, 9), 1e7 * (2.0 * np.eye(9) - np.eye(9, k=1) - np.eye(9, k=-1)),
        np.cumsum(np.linspace(2.5, 4.0, 9)), base_mass=2e4, half_width=2.0, damping_ratio=0.02,
    )  # fmt: skip
    yield "all different", different
    leaning = rf.YieldingStories(rf.Leaning(shear_frame(), 1e5), [8e5, 7e5, 6e5, 5e5], 0.05)
    yield "leaning, yielding, eccentric", rf.Eccentric(leaning, 0.5)
    yield "pier", pier(n_modes=1)
    yield (
        "tower",
        rf.TaperedTower(
            height=200, base_radius=8, top_radius=4, wall=1, density=2400, elastic_modulus=25e9, damping_ratio=0.02
        ),
    )
    yield "beam", rf.Beam(
        height=20.0, mass=800.0, bending_stiffness=2e9, half_width=1.0, damping_ratio=0.02, n_modes=2,
        lumped_masses=rf.LumpedMasses(heights=[12.0, 18.0], masses=[5e3, 8e3]),
    )  # fmt: skip
    yield "wall", rf.WallFrame(30.0, 8e3, 2.0, 5e4, 1.2, 5.0, 0.02)
    yield "matrices", rf.from_matrices([20e3], [[4e6]], [3.0], base_mass=2e4, half_width=0.6, damping_ratio=0.02)
    yield "properties", rf.RockingProperties(**PROPERTIES, top_height=13.0)
    yield "block", rf.rigid_block(slenderness=0.3, half_diagonal=2.0)


STRUCTURES = dict(structures())


def bed(p):
    springs = rf.winkler_bed(p.half_width, breadth=4.0, subgrade_modulus=1e8).damped(0.3, p.m_tot)
    return rf.Ground(friction=0.4, springs=springs, base_inertia=1e5)


def properties(structure):
    return structure if isinstance(structure, rf.RockingProperties) else structure.rocking()


def held(structure):
    """A structure with every element that it can have."""
    if isinstance(structure, rf.RockingProperties):
        return structure
    p = structure.rocking()
    found = every_element(0.6 * p.half_width)
    if p.floors is not None:
        found += on_floors(0.6 * float(p.floors.heights.max()))
    return rf.Restrained(structure, found)


def boxes(figure):
    """The texts that are drawn, and their boxes."""
    figure.draw_without_rendering()
    return [(text.get_text(), text.get_window_extent()) for text in figure.axes[0].texts if text.get_text()]


def overlapping(found):
    return [
        (one, other)
        for (one, a), (other, b) in combinations(found, 2)
        if min(a.x1, b.x1) - max(a.x0, b.x0) > 0.5 and min(a.y1, b.y1) - max(a.y0, b.y0) > 0.5
    ]


@pytest.mark.parametrize("name", STRUCTURES)
def test_no_text_runs_into_another_or_off_the_figure(name):
    structure = STRUCTURES[name]
    p = properties(structure)
    cases = [
        *product(("column", None), (structure, held(structure)), (None, bed(p))),
        *product(SIZES, [held(structure)], [bed(p)]),
    ]
    for size, given, ground in cases:
        figure = rf.plot_structure(given, ground, size=size)
        found = boxes(figure)
        assert overlapping(found) == []
        room = figure.bbox.padded(1.0)
        assert [text for text, box in found if not (room.contains(*box.min) and room.contains(*box.max))] == []


@pytest.mark.parametrize("language", ["de", "it", "fr", "es"])
def test_large_letters_and_other_languages_have_room(language):
    with rf.figure_style(units="kN", language=language), mpl.rc_context({"font.size": 14.0}):
        figure = rf.plot_structure(held(STRUCTURES["leaning, yielding, eccentric"]))
    assert overlapping(boxes(figure)) == []
    assert not any(text.split(",")[0] == "base" for text in notes(figure.axes[0]) if language == "de")


def test_the_notes_say_what_stands_there():
    frame = make_frame(n_stories=5, aspect_ratio=4.0)
    fuses = [rf.YieldingDissipator(2e7, 200e3, position=x) for x in (-1.0, 1.0)]
    texts = notes(rf.plot_structure(rf.Restrained(frame, [rf.Tendon(500e3, 20e6), *fuses])).axes[0])
    assert "Tendon, 500 kN, 20 MN/m, x = 0 m" in texts
    assert "2 × Fuse, 20 MN/m, 200 kN, x = ±1 m" in [text.replace("\n", " ") for text in texts]
    assert {"5 × 3 m", "15 m", f"B = {frame.half_width:.3g} m", "pivot"} <= set(texts)
    assert "5 × 40\u202f000 kg" in texts
    texts = notes(rf.plot_structure(STRUCTURES["leaning, yielding, eccentric"]).axes[0])
    assert {"4 m", "2 × 3 m", "2.5 m", "B + e = 3.5 m", "B − e = 2.5 m"} <= set(texts)
    assert {"m = 60\u202f000 kg", "leaning columns, 400\u202f000 kg", "4 stories yield at 500 kN … 800 kN"} <= set(
        texts
    )
    texts = notes(rf.plot_structure(pier(n_modes=1), bed(pier(n_modes=1).rocking())).axes[0])
    assert {"m = 500\u202f000 kg", "μ = 0.4", "12 m"} <= set(texts)
    assert any("springs, Σ k = " in text for text in texts)
    assert "pivot" not in texts


def test_units_are_those_of_the_style():
    with rf.figure_style(units="kip-in"):
        texts = notes(rf.plot_structure(rf.Restrained(pier(n_modes=1), rf.Tendon(500e3, 20e6))).axes[0])
    assert "Tendon, 112 kip, 114 kip/in, x = 0 in" in [text.replace("\n", " ") for text in texts]


def test_every_symbol_can_be_drawn_and_springs_are():
    assert {each.symbol for each in every_element(1.0)} | {"spring"} == set(SYMBOLS)
    bare, sprung = (rf.plot_structure(STRUCTURES["pier"], ground) for ground in (None, bed(pier().rocking())))
    count = bed(pier().rocking()).springs.n

    def turns(figure):
        return sum(int(np.isnan(line.get_xdata()).sum()) for line in figure.axes[0].lines if len(line.get_xdata()) > 50)

    assert turns(sprung) == turns(bare) + count


def body(figure):
    """Points of the lines of the structure in points of the figure: thick black ones that are no pivots."""
    lines = [
        line for line in figure.axes[0].lines if to_hex(line.get_color()) == "#000000" and line.get_linewidth() > 1.2
    ]
    points = np.concatenate([line.get_xydata() for line in lines])
    return points[~np.isnan(points).any(axis=1)]


@pytest.mark.parametrize("by", [1.0, 3.0])
def test_the_top_is_drawn_where_the_response_has_it(by):
    frame = make_frame(aspect_ratio=4.0)
    response = rf.simulate(frame, RECORD.scaled(3.0), "MDOF-S")
    at = response.time_of_max_rotation
    moved = rf.plot_structure(frame, response=response, at=at, amplification=by)
    bars = [
        line for line in moved.axes[0].lines if to_hex(line.get_color()) == "#404040" and line.get_linewidth() == 2.0
    ]
    (scale,) = bars
    words = [text for text in moved.axes[0].texts if text.get_position()[1] < 12.0]
    zoom = np.ptp(scale.get_xdata()) / float(words[0].get_text().split()[0])
    state = response.at(at)
    rest = [line.get_xydata() for line in moved.axes[0].lines if to_hex(line.get_color()) == "#c9ced6"]
    top = max(rest, key=lambda points: points[:, 1].min()).mean(axis=0)
    points = body(moved)
    roof = points[points[:, 1] > points[:, 1].max() - zoom * by * 0.2 - 1.0]
    expected = float(state.total_top_displacement[0])
    pivot = frame.half_width
    theta = by * float(state.rotation[0])
    across = np.sign(theta) * pivot * (1.0 - math.cos(theta)) + 15.0 * math.sin(theta)
    across += by * float(state.top_displacement[0]) * math.cos(theta)
    assert (roof[:, 0].min() + roof[:, 0].max()) / 2.0 - top[0] == pytest.approx(zoom * across, abs=1.5)
    assert across == pytest.approx(by * expected, rel=0.05)
    assert f"t = {at:.2f} s" in notes(moved.axes[0])[0]


def colors(figure):
    return {to_hex(line.get_color()) for line in figure.axes[0].lines if len(line.get_xdata())}


def test_elements_have_the_colour_of_their_state():
    frame = rf.Restrained(
        make_frame(aspect_ratio=3.0),
        [rf.YieldingDissipator(4e7, 2e5, position=0.8), rf.Tendon(1e5, 1e7, height=12.0, cosine=0.6)],
    )
    response = rf.simulate(frame, RECORD.scaled(3.0), "MDOF-S")
    times, states = response.time, response.element_state[:, 0]
    rise = np.flatnonzero((states[1:] == 1) & (states[:-1] == 1))[0]
    at = float(times[rise : rise + 2].mean())
    figure = rf.plot_structure(frame, response=response, at=at)
    assert RED in colors(figure)
    (text,) = (text for text in notes(figure.axes[0]) if text.startswith("Fuse"))
    assert text.replace("\n", " ").endswith("yielding")
    before = rf.plot_structure(frame, response=response, at=float(times[0]))
    assert RED not in colors(before)
    later = notes(rf.plot_structure(frame, response=response, at=float(times[-1])).axes[0])
    assert any(text.replace("\n", " ").endswith("has yielded") for text in later)


def test_without_an_instant_it_is_that_of_the_largest_rotation():
    frame = make_frame(aspect_ratio=4.0)
    response = rf.simulate(frame, RECORD.scaled(3.0), "2DOF-S")
    text = notes(rf.plot_structure(frame, response=response).axes[0])[0]
    assert f"t = {response.time_of_max_rotation:.2f} s: uplifted" in text
    still = rf.simulate(frame, RECORD.scaled(0.1), "2DOF-S")
    text = notes(rf.plot_structure(frame, response=still).axes[0])[0]
    assert f"t = {still.time_of_max_top_displacement:.2f} s: in contact" in text


@pytest.mark.parametrize(
    ("arguments", "field", "said"),
    [
        (("tower",), "structure", "must be a structure"),
        ((rf.Frame,), "structure", "must be a structure"),
        ((pier(), "soil"), "ground", "must be of type Ground"),
        ((pier(), None, None, 3.0), "at", "belongs to a response"),
    ],
)
def test_what_cannot_be_drawn_is_refused(arguments, field, said):
    with pytest.raises(rf.InputError, match=said) as caught:
        rf.plot_structure(*arguments)
    assert caught.value.field == field


def test_an_instant_is_within_a_response_of_the_same_structure():
    response = rf.simulate(pier(), RECORD, "2DOF-S")
    for given, field in ((1e3, "at"), (math.nan, "at")):
        with pytest.raises(rf.InputError) as caught:
            rf.plot_structure(pier(), response=response, at=given)
        assert caught.value.field == field
    with pytest.raises(rf.InputError, match="not that of"):
        rf.plot_structure(make_frame(), response=response)
    with pytest.raises(rf.InputError, match="peaks"):
        rf.plot_structure(pier(), response=rf.simulate(pier(), RECORD, "2DOF-S", output="peaks"))
    with pytest.raises(rf.InputError, match="without one"):
        rf.plot_structure(pier(), amplification=2.0)


def test_a_tower_is_as_wide_as_its_radii():
    tower = rf.TaperedTower(200.0, 8.0, 4.0, 1.0, 2400.0, 25e9, 0.02)
    (body,) = (each for each in structure_outline(tower.rocking(), tower).strokes if each.filled)
    x, z, _ = body.points.T
    np.testing.assert_allclose(np.abs(x), 8.0 - 4.0 * z / 200.0, rtol=1e-12)
    assert (z.min(), z.max()) == (0.0, 200.0)
    assert {*np.sign(x)} == {-1.0, 1.0}


def test_a_report_draws_the_structure_beside_its_histories():
    """Where there is room: as it stands at its largest rotation, within the place above its loops."""
    frame = make_frame()
    run = rf.simulate(frame, RECORD.scaled(3.0), "MDOF-S")
    tall, low = (draw_run_sheet(run, structure=frame, width=185.0, height=height) for height in (130.0, 60.0))
    assert len(tall.axes) == 4 + 1 + 1
    assert len([axes for axes in low.axes if not axes.axison]) == 0
    (stage,) = (axes for axes in tall.axes if not axes.axison)
    texts = [text.get_text() for text in stage.texts]
    assert f"t = {run.time_of_max_rotation:.2f} s" in texts
    loops = tall.axes[-1]
    assert stage.get_position().y0 >= loops.get_position().y1
