"""What says which quantity, unit, time step and component samples have, and what is refused when evidence lacks."""

import numpy as np
import pytest

import rockflex as rf
from rockflex.foundation.constants import GRAVITY

VALUES = [round(0.2 * np.sin(0.3 * k) * np.exp(-(((k - 30) / 12) ** 2)), 6) for k in range(60)]
PEAK = max(map(abs, VALUES))


def columns(values=VALUES, dt=0.01, separator=",", times=None, head=""):
    times = [f"{k * dt:.10g}" for k in range(len(values))] if times is None else times
    return head + "".join(f"{time}{separator}{value}\n" for time, value in zip(times, values, strict=True))


def column(values=VALUES, head="acc (gal)\n"):
    return head + "".join(f"{value}\n" for value in values)


def sequence(unit="ACCELERATION TIME SERIES IN UNITS OF G", npts="NPTS= 60, DT= .0100 SEC", below="", width=5):
    rows = [" ".join(f"{value:.6E}" for value in VALUES[k : k + width]) for k in range(0, 60, width)]
    return f"PEER\nEvent, 1/1/1994, Station, 90\n{unit}\n{npts}\n{below}" + "\n".join(rows) + "\n"


def write(tmp_path, text, name="record.csv"):
    file = tmp_path / name
    file.write_text(text, "utf-8")
    return file


@pytest.mark.parametrize(
    ("unit", "below", "factor"),
    [
        ("ACCELERATION (M/S2)", "", 1.0),
        ("acceleration (m/s/s)", "", 1.0),
        ("ACCELERATION IN CM/SEC**2", "", 0.01),
        ("UNITS: m/s2", "", 1.0),
        ("ACCELERATION", "UNITS: CM/SEC/SEC\n", 0.01),
        ("Units of G*0.1", "", 0.1 * GRAVITY),
        ("ACCELERATION IN %G", "", 0.01 * GRAVITY),
        ("Acceleration [mg]", "", 1e-3 * GRAVITY),
    ],
)
def test_units_above_a_sequence(tmp_path, unit, below, factor):
    motion = rf.read_motion(write(tmp_path, sequence(unit, below=below), "record.txt"))
    assert motion.pga == pytest.approx(PEAK * factor, rel=1e-5)
    said = {each.what: each.evidence for each in motion.metadata.findings}
    assert said["unit"].startswith("line 5" if below else "line 3")
    assert said["time step"].startswith("line 4")


def test_a_suffix_that_contradicts_the_header_is_refused_and_the_caller_decides(tmp_path):
    file = write(tmp_path, sequence("ACCELERATION (M/S2)"), "record.AT2")
    with pytest.raises(rf.InputError, match=r"the unit: m/s2 \(line 3: .*\), but g \(suffix \.AT2") as error:
        rf.read_motion(file)
    assert error.value.field == "units"
    assert rf.read_motion(file, units="m/s2").pga == pytest.approx(PEAK, rel=1e-5)
    with pytest.raises(rf.InputError, match=r"but units='cm/s2' was given"):
        rf.read_motion(file, units="cm/s2")


def test_two_units_in_a_header_are_asked_for(tmp_path):
    file = write(tmp_path, columns(head="# Full scale unit: g\n# Data: acceleration, cm/s2\n", separator=" "))
    with pytest.raises(rf.InputError, match=r"g \(line 1: .*\), but cm/s2 \(line 2: .*\)"):
        rf.read_motion(file)
    assert rf.read_motion(file, units="gal").pga == pytest.approx(0.01 * PEAK)


def test_a_value_with_a_unit_says_nothing_about_the_samples(tmp_path):
    head = "PGA = 0.24 g\nPeak velocity: 23 cm/s\nVs30 = 300 m/s\nsensor range 2 g\ntime (s),acc (gal)\n"
    assert rf.read_motion(write(tmp_path, columns(head=head))).pga == pytest.approx(0.01 * PEAK)


@pytest.mark.parametrize(
    ("name", "text", "quantity"),
    [
        ("record.vel", column(head=""), "velocity"),
        ("record.VT2", sequence("no word"), "velocity"),
        ("record.DT2", sequence("DISPLACEMENT TIME SERIES IN UNITS OF CM"), "displacement"),
        ("record.txt", sequence("VELOCITY (CM/SEC)"), "velocity"),
        ("record.txt", sequence("File Type: Velocities (m/s)"), "velocity"),
        ("record.csv", columns(head="T (s),PSA (g)\n"), "spectrum"),
        ("record.csv", columns(head="Period (s),acc (g)\n"), "spectrum"),
        ("record.csv", columns(head="f (Hz),acc (g)\n"), "spectrum"),
        ("record.csv", columns(head="t (s),v (cm/s)\n"), "velocity"),
        ("record.csv", columns(head="t (s);F (kN)\n", separator=";"), "force"),
        ("record.csv", columns(head="t (s),d (cm)\n"), "displacement"),
        ("RSN1-VEL.txt", column(head=""), "velocity"),
    ],
)
def test_what_is_no_acceleration_is_refused_by_name(tmp_path, name, text, quantity):
    with pytest.raises(rf.InputError, match=f"a {quantity}"):
        rf.read_motion(write(tmp_path, text, name), units=None if name.endswith("2") else "g", dt=0.01)


def test_values_of_one_sign_without_a_label_are_no_acceleration(tmp_path):
    text = columns([0.3 + 0.01 * k for k in range(40)], dt=0.02)
    with pytest.raises(rf.InputError, match="values are positive, as those of a spectrum"):
        rf.read_motion(write(tmp_path, text), units="g")
    assert rf.read_motion(write(tmp_path, "time (s),acc (g)\n" + text)).acceleration.size == 40


@pytest.mark.parametrize(
    ("head", "scale"),
    [("t_ms,acc_g\n", 1e3), ("time [ms],acc_g\n", 1e3), ("t (µs),acc in g\n", 1e6), ("Time (min),acc, g\n", 1 / 60)],
)
def test_times_in_other_units_are_converted_where_these_are_stated(tmp_path, head, scale):
    separator = ";" if "acc, g" in head else ","
    text = columns(dt=0.01 * scale, separator=separator, head=head.replace("),", ");") if separator == ";" else head)
    assert rf.read_motion(write(tmp_path, text)).dt == pytest.approx(0.01, rel=1e-6)


@pytest.mark.parametrize("label", ["timestamp", "t", "date"])
@pytest.mark.parametrize(("scale", "begin"), [(1e3, 1_700_000_000_000), (1e6, 0), (1 / 86400, 45000)])
def test_times_in_an_unknown_unit_need_the_word_of_the_caller(tmp_path, label, scale, begin):
    times = [f"{begin + k * 0.01 * scale:.12f}" for k in range(len(VALUES))]
    file = write(tmp_path, columns(times=times, head=f"{label},acc (g)\n"))
    with pytest.raises(rf.InputError) as error:
        rf.read_motion(file)
    assert error.value.field == "dt"
    assert rf.read_motion(file, dt=0.01).dt == 0.01


@pytest.mark.parametrize("label", ["", "Sample", "No.", "index", "#"])
@pytest.mark.parametrize("first", [0, 1])
def test_row_numbers_are_no_times(tmp_path, label, first):
    times = [str(first + k) for k in range(len(VALUES))]
    file = write(tmp_path, columns(times=times, head=f"{label},acc (g)\n"))
    with pytest.raises(rf.InputError) as error:
        rf.read_motion(file)
    assert error.value.field == "dt"
    assert rf.read_motion(file, dt=0.01).dt == 0.01


@pytest.mark.parametrize(
    ("line", "dt"),
    [
        ("dt = 5 ms", 0.005),
        ("DT: 0,01 SEC", 0.01),
        ("Sampling rate: 200 Hz", 0.005),
        ("SAMPLING RATE= 100Hz", 0.01),
        ("fs = 0.1 kHz", 0.01),
        ("200 samples per second", 0.005),
        ("Time step = 0.01 sec", 0.01),
        ("Sampling interval (ms): 4", 0.004),
    ],
)
def test_steps_in_headers(tmp_path, line, dt):
    file = write(tmp_path, column(head=f"# {line}\nacc (g)\n"))
    assert rf.read_motion(file).dt == pytest.approx(dt, rel=1e-12)
    with pytest.raises(rf.InputError, match=r"time step is .*line 1.*but dt=0\.02 was given"):
        rf.read_motion(file, dt=0.02)


@pytest.mark.parametrize("dt", [0.2, 1.0, 5e-5])
def test_a_step_that_no_recorder_has_needs_the_word_of_the_caller(tmp_path, dt):
    for text in (columns(dt=dt, head="time (s),acc (g)\n"), sequence(npts=f"NPTS= 60, DT= {dt:g} SEC")):
        file = write(tmp_path, text)
        with pytest.raises(rf.InputError, match="records have steps of") as error:
            rf.read_motion(file)
        assert error.value.field == "dt"
        assert rf.read_motion(file, dt=dt).dt == dt


def test_times_printed_with_too_few_digits(tmp_path):
    times = [f"{0.005 * k:.2f}" for k in range(len(VALUES))]
    file = write(tmp_path, columns(times=times, head="time (s),acc (g)\n"))
    with pytest.raises(rf.InputError, match=r"time must increase.*give the step: dt="):
        rf.read_motion(file)
    assert rf.read_motion(file, dt=0.005).dt == 0.005
    with pytest.raises(rf.InputError, match="does not fit"):
        rf.read_motion(file, dt=0.01)


@pytest.mark.parametrize(
    ("name", "head"),
    [
        ("a.csv", "t (s),AccZ (g)\n"),
        ("a.csv", "t (s),UP (g)\n"),
        ("a.csv", "t (s),HNZ (g)\n"),
        ("a.csv", "t (s),Acc (g) - Z\n"),
        ("a.csv", "# component: UP\nt (s),acc (g)\n"),
        ("a.csv", "# Component Up    Vertical Accelerometer Axis\nt (s),acc (g)\n"),
        ("a.csv", "# STREAM: HNZ\nt (s),acc (g)\n"),
        ("a.csv", "# Direction: Vertical\nt (s),acc (g)\n"),
        ("a.csv", "# channel BNZ\nt (s),acc (g)\n"),
        ("station.HNZ.csv", "t (s),acc (g)\n"),
        ("station_UD.csv", "t (s),acc (g)\n"),
    ],
)
def test_vertical_components(tmp_path, name, head):
    motion = rf.read_motion(write(tmp_path, columns(head=head), name))
    assert motion.metadata.is_vertical
    assert "vertical" in next(each.value for each in motion.metadata.findings if each.what == "component")
    with pytest.raises(rf.InputError, match="No horizontal component"):
        rf.read_suite([tmp_path / name])


@pytest.mark.parametrize(
    ("name", "head"),
    [
        ("a-NS.csv", "# component: UP\nt (s),acc (g)\n"),
        ("a-UP.csv", "t (s),acc NS (g)\n"),
        ("a.csv", "# component: N38E\nt (s),AccZ (g)\n"),
    ],
)
def test_directions_that_contradict_each_other_are_refused(tmp_path, name, head):
    with pytest.raises(rf.InputError, match=r"contradicts itself about the component: .*vertical"):
        rf.read_motion(write(tmp_path, columns(head=head), name))


@pytest.mark.parametrize(
    "cell", ["#N/A", "#DIV/0!", "%", "", "nan", "null", "-", "-999", "999.99", "-9999", "9.999E+02"]
)
@pytest.mark.parametrize("timed", [False, True])
def test_a_cell_without_a_number_is_refused_with_its_line(tmp_path, cell, timed):
    cells = [str(100 * value) for value in VALUES]
    cells[30] = cell
    text = columns(cells, head="t (s),acc (gal)\n") if timed else column(cells)
    with pytest.raises(rf.InputError, match="line 32"):
        rf.read_motion(write(tmp_path, text), dt=None if timed else 0.01)


def test_two_blocks_are_refused(tmp_path):
    for between in ("\n", "acc EW (gal)\n", "# second\n"):
        text = column() + between + column(head="")
        with pytest.raises(rf.InputError, match="line 62"):
            rf.read_motion(write(tmp_path, text), dt=0.01)


def test_line_ends_of_two_systems_are_no_gaps(tmp_path):
    assert rf.read_motion(write(tmp_path, column().replace("\n", "\n\n")), dt=0.01).acceleration.size == 60


def test_the_weight_among_the_samples_is_told(tmp_path):
    file = write(tmp_path, columns([1.0 + value for value in VALUES], head="t (s),UD (g)\n"))
    with pytest.warns(rf.RecordWarning, match="about 1 g.*measured gravity"):
        rf.read_motion(file)


@pytest.mark.parametrize(
    ("text", "arguments"),
    [
        (column(head="demo\n60 0.01\n"), {}),
        (column(head="0.01 60\n"), {}),
        (column(head="60\n0.01\n"), {}),
        (column(head="60\n"), {"dt": 0.01}),
        ("\n".join(sequence(width=8).splitlines()[4:]), {"dt": 0.01}),
        ("\n".join(sequence(width=3).splitlines()[4:]), {"dt": 0.01, "layout": "sequence"}),
        (sequence(npts="Number of points = 60\nTime step = 0.01 sec"), {}),
    ],
)
def test_values_in_sequence(tmp_path, text, arguments):
    motion = rf.read_motion(write(tmp_path, text, "record.txt"), units="g", **arguments)
    assert (motion.acceleration.size, motion.dt) == (60, 0.01)
    assert motion.pga == pytest.approx(PEAK * GRAVITY, rel=1e-5)
    assert "samples" in [each.what for each in motion.metadata.findings]


def test_few_columns_without_labels_are_no_sequence(tmp_path):
    text = "\n".join(sequence(width=3).splitlines()[4:])
    with pytest.raises(rf.InputError, match='layout="sequence"'):
        rf.read_motion(write(tmp_path, text, "record.txt"), units="g", dt=0.01)


def test_a_first_line_with_the_step_is_no_sample(tmp_path):
    file = write(tmp_path, column(head="0.01\n"), "record.txt")
    with pytest.raises(rf.InputError, match=r"first value, 0\.01, is the time step"):
        rf.read_motion(file, units="g", dt=0.01)
    assert rf.read_motion(file, units="g", dt=0.01, layout="columns").acceleration.size == 61


@pytest.mark.parametrize(
    ("text", "arguments"),
    [
        ('"time (s)","acc (g)"\n' + "".join(f'"{0.01 * k:.2f}","{v}"\n' for k, v in enumerate(VALUES)), {}),
        ("Time,Acc\ns,g\n" + columns(), {}),
        ("Number of points: 60\n" + columns(head="time (s),acc (g)\n"), {}),
        ("3 components were recorded\n" + columns(), {"units": "g"}),
        (columns(head="time (s),acc (g)\n").replace("-", "\u2212"), {}),
        ("t (sec.)\tacc (N-S)\n" + columns(separator="\t"), {"units": "g"}),
        ("Units: s, g\n" + columns(separator=" "), {}),
        ("t (seg);acel (g)\n" + columns(separator=";"), {}),
        ("  acc (g)\n" + columns(separator="  ", times=[str(k) for k in range(60)]), {"dt": 0.01}),
    ],
)
def test_tables_as_people_have_them(tmp_path, text, arguments):
    motion = rf.read_motion(write(tmp_path, text), **arguments)
    assert (motion.acceleration.size, motion.dt) == (60, 0.01)
    assert motion.pga == pytest.approx(PEAK * GRAVITY)


@pytest.mark.parametrize(
    ("cell", "hint"), [("1,234.5", "separators of thousands"), ("1.234-05", "lost the E"), ("0.1.2", "finite number")]
)
def test_hints_at_cells(tmp_path, cell, hint):
    cells = [str(value) for value in VALUES]
    cells[30] = cell
    with pytest.raises(rf.InputError, match=f"line 32.*{hint}"):
        rf.read_motion(write(tmp_path, columns(cells, separator=";", head="time (s);acc (g)\n")))


@pytest.mark.parametrize(
    ("date", "year"), [("11/03/02", 2002), ("1/17/94", 1994), ("05/18/40", 1940), ("3/11/2011", 2011)]
)
def test_years_of_two_digits(tmp_path, date, year):
    text = sequence().replace("1/1/1994", date)
    assert rf.read_at2(write(tmp_path, text, "a.AT2")).metadata.year == year


def test_the_size_of_an_acceleration_is_no_component(tmp_path):
    head = "Time (s),Acceleration x (m/s^2),Acceleration y (m/s^2),Absolute acceleration (m/s^2)\n"
    rows = "".join(f"{0.01 * k:.2f},{v},{v},{abs(v)}\n" for k, v in enumerate(VALUES))
    assert [each.name for each in rf.read_components(write(tmp_path, head + rows))] == ["record-x", "record-y"]


def test_one_component_in_two_states_is_refused(tmp_path):
    head = "Time (s),raw acc (g),corrected acc (g)\n"
    rows = "".join(f"{0.01 * k:.2f},{v},{v}\n" for k, v in enumerate(VALUES))
    with pytest.raises(rf.InputError, match=r"'raw acc .*names no direction"):
        rf.read_components(write(tmp_path, head + rows))


@pytest.mark.parametrize("label", ["strain", "drift (%)", "voltage (V)", "5% damped (g)", "temperature (C)"])
def test_other_quantities_beside_times_are_refused_by_their_label(tmp_path, label):
    with pytest.raises(rf.InputError, match="another quantity"):
        rf.read_motion(write(tmp_path, columns(head=f"time (s),{label}\n")), units="g")


def test_a_layout_that_there_is_not(tmp_path):
    with pytest.raises(rf.InputError, match='layout must be "columns" or "sequence"') as error:
        rf.read_motion(write(tmp_path, columns()), units="g", layout="rows")
    assert error.value.field == "layout"
