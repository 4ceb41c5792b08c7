"""Motions with a vertical component: what carries it, what it is checked for, and its measures."""

import dataclasses
import math
import warnings

import numpy as np
import pytest

from record_samples import at2
from rockflex import GroundMotion, InputError, RecordInfo, RecordWarning, read_at2, read_motion
from rockflex.motion import MEASURES
from rockflex.motion._ground_motion import check_horizontal_component
from rockflex.motion._measures import MeasureInput, record_measures, vertical_measures

ALONG = np.array([0.0, 2.0, -4.0, 1.0, 0.0])
UPWARDS = np.array([0.0, -1.0, 3.0, 0.5, 0.0])
BOTH = GroundMotion(ALONG, 0.1, "both", RecordInfo(year=1999), UPWARDS)
LONG = GroundMotion(np.sin(np.arange(400.0)), 0.01, "long", vertical=np.cos(0.7 * np.arange(400.0)))


def test_holds_a_copy_of_both():
    samples = UPWARDS.copy()
    motion = GroundMotion(ALONG, 0.1, vertical=samples)
    samples[1] = 9.0
    assert motion.vertical.tolist() == UPWARDS.tolist()
    assert GroundMotion(ALONG, 0.1).vertical is None


def test_pickles_of_before_have_none():
    old = GroundMotion.__new__(GroundMotion)
    old.__setstate__({"acceleration": ALONG.copy(), "dt": 0.1, "name": "", "metadata": None})
    assert old == GroundMotion(ALONG, 0.1)


@pytest.mark.parametrize(
    ("vertical", "text"),
    [
        (UPWARDS[:4], r"vertical must have as many samples as acceleration, 5, but 4 were given\. Append zeros"),
        ([0, 1, np.nan, 0, 0], r"vertical must be finite, but 1 of 5 values are not, the first \(nan\) at index 2"),
    ],
)
def test_refuses(vertical, text):
    for make in (lambda: GroundMotion(ALONG, 0.1, vertical=vertical), lambda: BOTH.with_vertical(vertical)):
        with pytest.raises(InputError, match=text) as caught:
            make()
        assert caught.value.field == "vertical"


CHANGES = {
    "scaled": lambda motion: motion.scaled(-1.5),
    "refined": lambda motion: motion.refined(3),
    "resampled": lambda motion: motion.resampled(0.005),
    "baseline_corrected": lambda motion: motion.baseline_corrected(2),
    "band_passed": lambda motion: motion.band_passed(0.5, 20.0),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_changes_apply_to_both_alike(change):
    changed = change(LONG)
    assert changed.vertical_motion.acceleration.tolist() == change(LONG.vertical_motion).acceleration.tolist()
    assert changed.acceleration.tolist() == change(LONG.without_vertical()).acceleration.tolist()
    assert (changed.dt, changed.name) == (change(LONG.vertical_motion).dt, "long")
    assert changed.vertical.tolist() != LONG.vertical.tolist()


def test_measures_of_the_vertical_component():
    upwards = BOTH.vertical_motion
    assert upwards.acceleration.tolist() == UPWARDS.tolist()
    assert (BOTH.pga, BOTH.pva, upwards.pga) == (4.0, 3.0, 3.0)
    assert BOTH.scaled(-2.0).pva == 6.0
    assert math.isnan(BOTH.without_vertical().pva)
    ratio = LONG.vertical_ratio([0.0, 0.3], 0.02)
    assert ratio.tolist() == pytest.approx(
        [LONG.pva / LONG.pga, LONG.vertical_motion.sa(0.3, 0.02) / LONG.sa(0.3, 0.02)]
    )
    quiet = GroundMotion(np.zeros(5), 0.1, vertical=UPWARDS)
    assert math.isnan(quiet.vertical_ratio([0.5])[0])
    assert math.isnan(MEASURES["pva_pga"].of(MeasureInput(quiet)))


def test_the_registered_measures():
    assert [measure.name for measure in vertical_measures()] == ["pva", "pva_pga"]
    assert [measure.of(MeasureInput(BOTH)) for measure in vertical_measures()] == [3.0, 0.75]
    assert not set(map(id, vertical_measures())) & set(map(id, record_measures()))
    assert MEASURES["pva"].scaled(3.0, -2.0) == BOTH.scaled(-2.0).pva
    assert MEASURES["pva_pga"].scaled(0.75, -2.0) == 0.75


def test_without_a_vertical_component_there_is_no_motion_of_it():
    for call in (lambda: BOTH.without_vertical().vertical_motion, lambda: GroundMotion(ALONG, 0.1).vertical_ratio([1])):
        with pytest.raises(InputError, match=r"has no vertical component\. Give one: read_motion\(path, vertical="):
            call()


def test_the_vertical_motion_shakes_nothing_horizontally():
    with pytest.raises(InputError, match="A horizontal ground motion is expected, but 'both' is a vertical component"):
        check_horizontal_component(BOTH.vertical_motion)
    check_horizontal_component(BOTH)
    assert BOTH.vertical_motion.metadata == RecordInfo(year=1999, direction="vertical")


def test_the_shorter_component_is_followed_by_zeros():
    short, long = GroundMotion([0.0, 1.0, 2.0], 0.1, "short"), GroundMotion(ALONG, 0.1 * (1 + 1e-12), "long")
    assert short.with_vertical(long).acceleration.tolist() == [0.0, 1.0, 2.0, 0.0, 0.0]
    assert short.with_vertical(long).vertical.tolist() == ALONG.tolist()
    assert long.with_vertical(short).vertical.tolist() == [0.0, 1.0, 2.0, 0.0, 0.0]
    both = long.with_vertical(short)
    assert (both.name, both.dt, both.metadata.vertical_source) == ("long", long.dt, "short")
    assert both.with_vertical(UPWARDS).vertical.tolist() == UPWARDS.tolist()
    assert both.without_vertical().metadata == RecordInfo()


def test_lengths_that_are_far_apart_are_told():
    short, long = GroundMotion(np.ones(5), 0.1, "A"), GroundMotion(np.ones(16), 0.1)
    said = r"The motion 'A' lasts 0\.4 s, and its vertical component 1\.5 s; zeros were appended to the shorter one\."
    with pytest.warns(RecordWarning, match=said) as caught:
        short.with_vertical(long)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        short.with_vertical(GroundMotion(np.ones(15), 0.1))


def test_records_that_are_positive_downwards_are_reversed():
    down = GroundMotion(UPWARDS, 0.1, "ABC-DWN", RecordInfo(direction="down"))
    both = GroundMotion(ALONG, 0.1, "ABC000").with_vertical(down)
    assert both.vertical.tolist() == (-UPWARDS).tolist()
    assert both.metadata.vertical_source == "ABC-DWN (reversed: it is positive downwards)"


def test_directions_that_do_not_fit_are_refused():
    along = GroundMotion(ALONG, 0.1, "H", RecordInfo(direction="horizontal"))
    upwards = GroundMotion(UPWARDS, 0.1, "U", RecordInfo(direction="vertical"))
    assert along.with_vertical(upwards).metadata.direction == "horizontal"
    with pytest.raises(InputError, match=r"A vertical ground motion is expected, but 'H' is a horizontal component"):
        along.with_vertical(along)
    with pytest.raises(InputError, match="'U' is itself a vertical component"):
        upwards.with_vertical(upwards)
    with pytest.raises(InputError, match=r"'both' has a vertical component of its own\. Give one of both"):
        along.with_vertical(BOTH)
    coarse = dataclasses.replace(upwards, dt=0.2)
    with pytest.raises(InputError, match=r"dt = 0\.1 s and the vertical one 0\.2 s\. .* motion\.resampled\(0\.1\)"):
        along.with_vertical(coarse)
    assert along.with_vertical(coarse.resampled(0.1)).acceleration.size == 9


def test_read_from_two_files(tmp_path):
    along, upwards, down = (tmp_path / f"RSN1_X_ABC{end}.AT2" for end in ("000", "-UP", "DWN"))
    along.write_text(at2("0", samples=[0, 0.2, 0.1, 0]))
    upwards.write_text(at2("UP", samples=[0, 0.1, -0.3]))
    down.write_text(at2("DWN", samples=[0, 0.1, -0.3]))
    for read in (read_at2, read_motion):
        both = read(along, vertical=str(upwards))
        assert both.vertical.tolist() == pytest.approx([0.0, 0.981, -2.943, 0.0])
        assert both.acceleration.tolist() == read(along).acceleration.tolist()
        assert (both.name, both.metadata.component) == ("RSN1_X_ABC000", "0")
        assert both.metadata.vertical_source == "RSN1_X_ABC-UP"
        assert read(along, vertical=down).vertical.tolist() == pytest.approx([0.0, -0.981, 2.943, 0.0])
        with pytest.raises(InputError, match="'RSN1_X_ABC-UP' is itself a vertical component"):
            read(upwards, vertical=along)
        with pytest.raises(InputError, match="'RSN1_X_ABC000' is a horizontal component"):
            read(along, vertical=along)
        with pytest.raises(InputError, match="vertical must be a path"):
            read(along, vertical=5)


def test_unit_and_step_are_for_both_files(tmp_path):
    for name, peak in (("a.txt", 100.0), ("b.txt", 50.0)):
        (tmp_path / name).write_text(f"0\n{peak}\n0\n")
    both = read_motion(tmp_path / "a.txt", units="cm/s2", dt=0.02, vertical=tmp_path / "b.txt")
    assert (both.pga, both.pva, both.dt) == (1.0, 0.5, 0.02)
    (tmp_path / "a.txt").write_text("0\n1\n0\n")
    with pytest.raises(InputError, match=r"b\.txt: the peak acceleration is 50 m/s2"):
        read_motion(tmp_path / "a.txt", units="m/s2", dt=0.02, vertical=tmp_path / "b.txt")


@pytest.mark.parametrize(
    "label", ["vertical (m/s2)", "Up [m/s^2]", "acc_v (m/s2)", "acc-up (m/s2)", "UD (m/s2)", "acceleration vert (m/s2)"]
)
def test_a_column_may_be_vertical(tmp_path, label):
    file = tmp_path / "a.csv"
    file.write_text(f"time (s),acc (g),{label}\n0,0,0\n0.1,0.1,1.5\n0.2,0,0\n")
    motion = read_motion(file)
    assert motion.vertical.tolist() == [0.0, 1.5, 0.0]
    assert motion.pga == pytest.approx(0.981)


@pytest.mark.parametrize("label", ["v (m/s)", "update", "velocity", "vel_up"])
def test_other_columns_are_not(tmp_path, label):
    file = tmp_path / "a.csv"
    file.write_text(f"time (s),acc (g),{label}\n0,0,0\n0.1,0.1,1.5\n0.2,0,0\n")
    assert read_motion(file).vertical is None


def test_columns_of_two_verticals_or_of_one_alone(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("time (s),acc (g),up (g),vertical (g)\n0,0,0,0\n0.1,0.1,0.2,0.3\n0.2,0,0,0\n")
    with pytest.raises(InputError, match="the header names 2 columns as vertical, 'up \\(g\\)', 'vertical \\(g\\)'"):
        read_motion(file)
    file.write_text("time (s),acc (g),up\n0,0,0\n0.1,0.1,0.2\n0.2,0,0\n")
    with pytest.raises(InputError, match="does not state the unit"):
        read_motion(file)
    file.write_text("time (s),vertical (g)\n0,0\n0.1,0.1\n0.2,0\n")
    assert read_motion(file).metadata.direction == "vertical"
    assert read_motion(file).vertical is None
