"""Figures: sizes, letters, settings of the caller, files, and notebooks."""

import inspect
import os
import re
import stat
import struct
from functools import cache
from itertools import combinations

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Text

import rockflex as rf
from builders import make_frame
from rockflex.foundation.errors import InputError
from rockflex.plot import save_figure

FRAME = make_frame()
PULSE = rf.ricker_pulse(4.0, 0.6)
RECORD = rf.load_suite("el-centro-1940")[0]
MODELS = ("MDOF-S", "3DOF-S", "2DOF-S")
LONG = "a name of a structure that is longer than the panel is wide, as names of studies are"


@cache
def responses():
    return [rf.simulate(FRAME, RECORD, model) for model in (*MODELS, "fixed")]


def wall():
    beam = rf.CantileverWithTipMass(
        height=10.0, tip_mass=50e3, bending_stiffness=2e9, base_mass=10e3, half_width=1.5, damping_ratio=0.02
    )
    fuse = rf.YieldingDissipator(stiffness=60e6, yield_force=150e3)
    return rf.Restrained(beam, [rf.Tendon(initial_force=300e3, stiffness=8e6), fuse])


def on_springs():
    bed = rf.winkler_bed(FRAME.half_width, breadth=3.0, subgrade_modulus=2e8).damped(0.3, 240e3)
    return rf.simulate(FRAME, RECORD, "2DOF-S", ground=rf.Ground(springs=bed, base_inertia=1e4))


@cache
def yielding():
    law = rf.BoucWen(yield_displacement=0.01)
    return [rf.simulate(FRAME, RECORD, model, bouc_wen=law) for model in ("2DOF-S-BW", "1DOF-fixed-BW")]


@cache
def cloud():
    motions = {str(a): rf.ricker_pulse(2.5, a) for a in (0.5, 0.8, 1.2)}
    structures = {LONG: FRAME, "#2": make_frame(period=0.6)}
    return rf.run_cloud(structures, motions, ["2DOF-S", "3DOF-S"], scales=[0.3, 0.6, 1.0, 1.7, 3.0])


@cache
def record_set():
    return rf.simulate_set(FRAME, {LONG: PULSE, "#2": RECORD}, "2DOF-S")


def pushed() -> rf.Pushover:
    return rf.pushover(rf.YieldingStories(make_frame(stiffness_ratio=float("inf")), 2e5, 0.05), 0.3, lifts=False)


def ladders():
    block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    return rf.run_incremental(block, {"a": PULSE, "b": rf.ricker_pulse(2.5, 1.0)}, "rigid", growth=1.5)


def stripes():
    levels, n = np.repeat([0.2, 0.4, 0.8], 10), [1, 5, 9]
    fell = [place % 10 < n[place // 10] for place in range(30)]
    runs = pd.DataFrame({"structure": LONG, "model": "MDOF-S", "level": levels, "nominal_overturning": fell})
    runs["status"] = np.where(fell, "overturned", "rocking")
    runs["max_rotation"] = np.where(fell, 1.571, 0.01)
    return runs


def designs():
    pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    scales = [0.5, 1.0, 2.0, 4.0]
    small = make_frame(n_stories=3, period=0.6, aspect_ratio=6.0)
    runs = rf.run_design(small, pulses, half_widths=[1.0, 1.5, 2.0], models=["2DOF-S", "3DOF-S"], scales=scales)
    return rf.design_table(runs, 0.005, at=0.5, confidence=None)


def search():
    held = rf.Restrained(make_frame(n_stories=3, period=0.6), rf.Tendon(initial_force=300e3, stiffness=2e6))
    pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    asked = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0], refinements=1)
    targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(half_width=1.0, prestress=5e-7)
    runs = rf.search_design(held, pulses, asked, targets, cost, model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    return rf.best_design(runs, targets, cost)


def spectrum():
    return rf.rocking_spectrum(PULSE, slendernesses=[0.1, 0.2, 0.3], periods=[2.0, 4.0, 6.0, 8.0])


def overturning():
    def pulse(amplitude, frequency):
        return rf.ricker_pulse(amplitude, 6.28 / frequency)

    block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    return rf.overturning_spectrum(block, pulse, [1.0, 2.0, 3.0], relative_amplitudes=[1.0, 2.0, 4.0, 8.0])


def spread():
    return [responses()[0]], [[rf.simulate(FRAME, RECORD.scaled(s), "MDOF-S") for s in (0.9, 1.1)]]


def ratios():
    return {name: rf.frequency_ratios(each, [2.0, 4.0, 8.0, 16.0]) for name, each in ((LONG, FRAME), ("#2", FRAME))}


@cache
def pairs():
    return rf.run_population(rf.load_suite("el-centro-1940"), pairs=12, seed=1)


def tower():
    return rf.TaperedTower(
        height=200, base_radius=8, top_radius=4, wall=1, density=2400, elastic_modulus=25e9, damping_ratio=0.02
    )


def both_components():
    return rf.GroundMotion(PULSE.acceleration, PULSE.dt, vertical=0.5 * PULSE.acceleration, name=LONG)


ARGUMENTS = {
    "plot_agreement": lambda: (pairs(),),
    "plot_clouds": lambda: (cloud(), "max_top_displacement"),
    "plot_design": lambda: (designs(), 0.5),
    "plot_design_search": lambda: (search(),),
    "plot_energy": lambda: (responses()[0],),
    "plot_footing": lambda: (on_springs(),),
    "plot_fragility": lambda: (cloud(),),
    "plot_frequency_equation": lambda: ({LONG: FRAME, "#2": make_frame(aspect_ratio=5.0)},),
    "plot_frequency_ratios": lambda: (ratios(),),
    "plot_comparison": lambda: (rf.compare({LONG: FRAME, "other": make_frame(period=0.6)}, RECORD),),
    "plot_history": lambda: (responses(),),
    "plot_hysteresis": lambda: (yielding(),),
    "plot_ida": lambda: (ladders(),),
    "plot_loops": lambda: (rf.moment_rotation(wall(), [0.02, -0.02, 0.0]),),
    "plot_modal_combination": lambda: (pairs(),),
    "plot_mode_shapes": lambda: (FRAME,),
    "plot_moment_rotation": lambda: (responses(),),
    "plot_moment_rotation_laws": lambda: (FRAME,),
    "plot_motion": lambda: (both_components(),),
    "plot_overturning_spectrum": lambda: ({LONG: overturning(), "the same": overturning()},),
    "plot_population": lambda: (pairs(),),
    "plot_pushover": lambda: (pushed(), pushed().fit()),
    "plot_rocking_spectrum": lambda: (spectrum(),),
    "plot_selection": lambda: (rf.load_suite("fema-p695-far-field").select(rf.ec8_spectrum(2.5, "C"), 7, (0.2, 2.0)),),
    "plot_set": lambda: (record_set(),),
    "plot_spread": lambda: spread(),
    "plot_stripes": lambda: (stripes(),),
    "plot_tornado": lambda: (rf.tornado(wall(), RECORD, parameters={"half_width": 0.1}),),
    "plot_structure": lambda: (wall(), None, rf.simulate(wall(), RECORD, "2DOF-S")),
    "plot_tower": lambda: (tower(),),
    "plot_yielding": lambda: (yielding(),),
}


@pytest.fixture(scope="module")
def given():
    """Arguments of each function, made once."""
    made = {}

    def of(name):
        if name not in made:
            made[name] = ARGUMENTS[name]()
        return made[name]

    return of


def written(figure, monkeypatch):
    """Texts and the boxes that their letters take, of all that is drawn; ticks outside the axes are not."""
    found = []
    draw = Text.draw

    def recorded(text, renderer, *args, **kwargs):
        draw(text, renderer, *args, **kwargs)
        if text.get_visible() and text.get_text().strip():
            found.append((text.get_text(), text.get_window_extent(renderer)))

    with mpl.rc_context(figure.settings):
        figure.get_layout_engine().execute(figure)
    figure.set_layout_engine("none")
    with monkeypatch.context() as patch:
        patch.setattr(Text, "draw", recorded)
        figure.draw_without_rendering()
    return found


def overlaps(one, other):
    """Whether two boxes overlap by more than a dot at either side, about the white around letters."""
    return min(one.x1, other.x1) - max(one.x0, other.x0) > 1.5 and min(one.y1, other.y1) - max(one.y0, other.y0) > 1.5


def test_every_figure_is_here():
    public = {name for name in rf.__all__ if name.startswith("plot_")}
    assert public == set(ARGUMENTS)
    assert all("size" in inspect.signature(getattr(rf, name)).parameters for name in public)


@pytest.mark.slow
@pytest.mark.parametrize("name", ARGUMENTS)
def test_in_a_column_no_text_runs_into_another_or_off_the_figure(name, given, monkeypatch):
    """In the theme of journals, whose letters are those of a column in any theme."""
    with rf.figure_style("journal"):
        figure = getattr(rf, name)(*given(name), size="column")
    assert figure.get_size_inches()[0] == 3.5
    texts = written(figure, monkeypatch)
    assert texts
    assert min(text.get_fontsize() for text in figure.findobj(Text) if text.get_text().strip()) >= 7.0
    room = figure.bbox.padded(1.5)
    assert [text for text, box in texts if not (room.contains(*box.min) and room.contains(*box.max))] == []
    assert [(a, b) for (a, p), (b, q) in combinations(texts, 2) if overlaps(p, q)] == []
    assert_words_stand_out(figure, bright=False)


@pytest.mark.slow
@pytest.mark.parametrize(("size", "width"), [("column", 3.5), ("page", 7.2), ((5.0, 2.5), 5.0), (None, 7.2)])
def test_the_size_is_a_name_or_inches(size, width):
    figure = rf.plot_motion(PULSE, size=size)
    assert figure.get_size_inches()[0] == width
    if isinstance(size, tuple):
        assert tuple(figure.get_size_inches()) == size


@pytest.mark.parametrize("size", ["colum", 3.5, (3.5,), (3.5, -1.0), (np.inf, 2.0), ("wide", "high")])
def test_another_size_is_refused(size):
    with pytest.raises(rf.InputError, match=r'"column" .* but .* was given'):
        rf.plot_motion(PULSE, size=size)


def sizes(figure):
    """Sizes of the letters of titles, labels, ticks and the legend in points."""
    axes = figure.axes[0]
    tick = axes.get_xticklabels()[0] if axes.get_xticklabels() else axes.get_yticklabels()[0]
    return [each.get_fontsize() for each in (figure._suptitle, axes.yaxis.label, tick, axes._right_title)]


@pytest.mark.slow
def test_letters_are_those_of_the_caller_or_of_the_size():
    assert sizes(rf.plot_motion(PULSE)) == pytest.approx([9.0, 9.0, 8.0, 8.0])
    assert sizes(rf.plot_motion(PULSE, size="page")) == pytest.approx([9.0, 9.0, 8.0, 8.0])
    assert sizes(rf.plot_motion(PULSE, size="column")) == pytest.approx([8.0, 8.0, 64 / 9, 64 / 9])
    with mpl.rc_context({"font.size": 12.0, "font.family": "serif"}):
        figure = rf.plot_motion(PULSE, size="column")
        assert figure.axes[0].yaxis.label.get_fontfamily() == ["serif"]
    assert sizes(figure) == pytest.approx([12.0, 12.0, 32 / 3, 32 / 3])
    with mpl.rc_context({"axes.labelsize": 14.0, "legend.fontsize": "x-large"}):
        assert sizes(rf.plot_motion(PULSE))[1] == 14.0
        rf.plot_history(responses(), size="column")


@pytest.mark.slow
def test_ticks_keep_the_settings_when_the_figure_is_drawn_later(tmp_path):
    with mpl.rc_context({"xtick.labelsize": 13.0, "ytick.labelsize": 13.0}):
        figure = rf.plot_motion(PULSE)
    rf.save_figure(figure, tmp_path / "pulse.png")
    assert {label.get_fontsize() for axes in figure.axes for label in axes.get_yticklabels()} == {13.0}


@pytest.mark.slow
def test_lines_are_as_much_wider_as_those_of_the_caller():
    plain = [line.get_linewidth() for line in rf.plot_history(responses()).axes[0].get_lines()]
    with mpl.rc_context({"lines.linewidth": 3.0}):
        wide = [line.get_linewidth() for line in rf.plot_history(responses()).axes[0].get_lines()]
    np.testing.assert_allclose(wide, 3.0 * np.array(plain))


def test_colours_and_background_are_those_of_the_caller():
    cycle = ["#112233", "#445566", "#778899", "#aabbcc"]
    with mpl.rc_context({"axes.prop_cycle": mpl.cycler(color=cycle), "figure.facecolor": "#eeeeee"}):
        figure = rf.plot_history(responses(), panels=["top_displacement"])
    assert [to_hex(line.get_color()) for line in figure.legends[0].get_lines()] == cycle
    assert to_hex(figure.get_facecolor()) == "#eeeeee"


def test_on_a_dark_background_black_turns_into_the_colour_of_the_text():
    with mpl.rc_context({"axes.facecolor": "black", "figure.facecolor": "black", "text.color": "white"}):
        figure = rf.plot_motion(PULSE)
    assert to_hex(figure.axes[0].get_facecolor()) == "#000000"
    assert to_hex(figure.axes[0].get_lines()[0].get_color()) == "#ffffff"


@pytest.mark.slow
@pytest.mark.parametrize("name", ARGUMENTS)
def test_on_dark_ground_what_is_written_stands_out(name, given):
    with rf.figure_style("dark"):
        figure = getattr(rf, name)(*given(name))
    figure.set_layout_engine("none")  # colours do not depend on it
    figure.draw_without_rendering()
    assert_words_stand_out(figure, bright=True)


def assert_words_stand_out(figure, *, bright):
    """On the ground of the theme, after the figure was drawn."""
    assert (sum(to_rgb(figure.get_facecolor())) < 0.5) == bright
    grounds = {sum(to_rgb(axes.get_facecolor())) / 3.0 for axes in figure.axes if axes.patch.get_visible()}
    assert all((ground < 0.5) == bright for ground in grounds)
    ticks = [label for axes in figure.axes for axis in (axes.xaxis, axes.yaxis) for label in axis.get_ticklabels()]
    words = [text for text in (*ticks, *figure.findobj(Text)) if text.get_text().strip() and text.get_visible()]
    assert words
    ground = "#14181d" if bright else "#ffffff"
    faint = {(text.get_text(), text.get_color()) for text in words if contrast(text.get_color(), ground) < 1.9}
    assert faint == set()


def contrast(one, other):
    """The ratio of contrast of two colours, as WCAG 2 defines it: from 1 to 21."""

    def luminance(color):
        parts = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(color)]
        return np.dot([0.2126, 0.7152, 0.0722], parts)

    low, high = sorted(luminance(color) + 0.05 for color in (one, other))
    return high / low


@pytest.mark.slow
def test_a_block_of_a_style_and_a_size_of_one_figure():
    with rf.figure_style("journal", "column"):
        one, other = rf.plot_motion(PULSE), rf.plot_motion(PULSE, size="page")
        with rf.figure_style("dark"):
            inner = rf.plot_motion(PULSE)
    after = rf.plot_motion(PULSE)
    assert [each.get_size_inches()[0] for each in (one, other, inner, after)] == [3.5, 7.2, 7.2, 7.2]
    grids = [each.axes[0].xaxis.get_gridlines()[0].get_visible() for each in (one, other, inner, after)]
    assert grids == [False, False, True, True]
    assert sizes(other) == pytest.approx([8.0, 8.0, 64 / 9, 64 / 9])
    assert to_hex(inner.axes[0].get_lines()[0].get_color()) == "#d7dbe0"


def test_open_symbols_stay_open_on_dark_ground(given):
    with rf.figure_style("dark"):
        figure = rf.plot_design_search(*given("plot_design_search"))
    lines = {line.get_label(): line for line in figure.legends[0].get_lines()}
    assert lines["run, does not"].get_markerfacecolor() == "none"
    assert to_hex(lines["run, meets all targets"].get_markerfacecolor()) == "#d7dbe0"


def test_another_theme_is_refused():
    with pytest.raises(rf.InputError, match="'light', 'dark', 'journal', but 'night' was given") as caught:
        rf.figure_style("night").__enter__()
    assert caught.value.field == "theme"
    with pytest.raises(rf.InputError, match="size must be"), rf.figure_style(size="high"):
        pass


@pytest.fixture
def figure():
    figure = Figure(figsize=(2.0, 1.5))
    figure.subplots().plot([0.0, 1.0], [1.0, 0.0])
    return figure


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "start"), [("a.png", b"\x89PNG"), ("b/c/a.pdf", b"%PDF"), ("a.svg", b"<?xml"), ("A.PNG", b"\x89PNG")]
)
def test_the_suffix_names_the_format(figure, tmp_path, name, start):
    path = save_figure(figure, tmp_path / name)
    assert path == tmp_path / name
    assert path.read_bytes().startswith(start)
    assert [p for p in tmp_path.rglob("*") if p.is_file()] == [path]


def test_png_has_two_hundred_dots_an_inch(figure, tmp_path):
    content = save_figure(figure, str(tmp_path / "a.png")).read_bytes()
    assert struct.unpack(">II", content[16:24]) == (400, 300)


@pytest.mark.parametrize("name", ["a.png", "a.pdf", "a.svg"])
def test_equal_figures_give_equal_files(tmp_path, name):
    contents = set()
    for folder in ("one", "two"):
        figure = Figure(figsize=(2.0, 1.5))
        figure.subplots().plot([0.0, 1.0], [1.0, 0.0], clip_on=True)
        contents.add(save_figure(figure, tmp_path / folder / name).read_bytes())
    (content,) = contents
    assert b"CreationDate" not in content
    assert b"<dc:date>" not in content


@pytest.mark.parametrize(("name", "suffix"), [("a.jpg", ".jpg"), ("a", ""), (".png", "")])
def test_other_suffixes_are_refused(figure, tmp_path, name, suffix):
    path = tmp_path / name
    with pytest.raises(
        InputError, match=re.escape(f"as .png, .pdf or .svg, but the path {str(path)!r} ends in {suffix!r}")
    ):
        save_figure(figure, path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("error", "said"), [(ValueError, "nothing"), (rf.InputError, "No space left")])
def test_a_figure_that_cannot_be_drawn_or_written_leaves_the_old_file(figure, tmp_path, monkeypatch, error, said):
    path = save_figure(figure, tmp_path / "a.png")
    before = path.read_bytes()

    def fill(_descriptor):
        message = "No space left on device"
        raise OSError(message)

    if error is rf.InputError:
        monkeypatch.setattr("os.fsync", fill)
    else:
        figure.axes[0].set_xlabel(r"$\nothing$")
    with pytest.raises(error, match=said):
        save_figure(figure, path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_in_the_way_leaves_nothing_behind(figure, tmp_path):
    (tmp_path / "a.png" / "full").mkdir(parents=True)
    with pytest.raises(rf.InputError, match=r"a\.png") as error:
        save_figure(figure, tmp_path / "a.png")
    assert error.value.field == "path"
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]


@pytest.mark.skipif(os.name == "nt", reason="file modes are POSIX")
def test_the_file_has_the_usual_mode(figure, tmp_path):
    (tmp_path / "plain").touch()
    usual = stat.S_IMODE((tmp_path / "plain").stat().st_mode)
    assert stat.S_IMODE(save_figure(figure, tmp_path / "a.png").stat().st_mode) == usual


def size_of(png: bytes) -> tuple[int, int]:
    """Width and height of a PNG in dots."""
    assert png.startswith(b"\x89PNG")
    width, height = struct.unpack(">II", png[16:24])
    return width, height


def test_a_figure_shows_itself_as_a_sharp_picture():
    figure = rf.plot_motion(PULSE)
    assert isinstance(figure, Figure)
    png, size = figure._repr_png_()
    inches = figure.get_size_inches()
    assert (size["width"], size["height"]) == tuple(round(100 * each) for each in inches)
    assert size_of(png) == pytest.approx((2 * size["width"], 2 * size["height"]), abs=1)


@pytest.mark.slow
def test_the_settings_of_the_caller_change_nothing():
    figure = rf.plot_motion(PULSE)
    before = figure._repr_png_()
    dpi = figure.dpi
    with mpl.rc_context({"savefig.dpi": 30, "savefig.bbox": "tight", "font.family": "serif"}):
        assert size_of(figure._repr_png_()[0]) == size_of(before[0])
    assert figure.dpi == dpi


def test_pyplot_shows_it_no_second_time():
    import matplotlib.pyplot as plt

    rf.plot_motion(PULSE)
    assert plt.get_fignums() == []
