"""Records as columns of text."""

import numpy as np
import pytest

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.motion import group_stations, read_components, read_motion

VALUES = np.array([0.001, -0.02, 0.3, 0.0, 0.125])


def write(tmp_path, text, name="record.txt"):
    path = tmp_path / name
    path.write_text(text, "utf-8")
    return path


def table(separator=",", head="", dt=0.01):
    rows = [f"{k * dt:.6g}{separator}{value}" for k, value in enumerate(VALUES)]
    return head + "\n".join(rows) + "\n"


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", "   ", ", ", " ; "])
def test_two_columns(tmp_path, separator):
    motion = read_motion(write(tmp_path, table(separator)), units="g")
    assert motion.dt == 0.01
    assert motion.acceleration == pytest.approx(VALUES * GRAVITY, rel=1e-15)
    assert motion.name == "record"
    assert motion.metadata.source == "record.txt"


@pytest.mark.parametrize(
    ("head", "factor"),
    [
        ("time,acc (g)\n", GRAVITY),
        ("time (s), acceleration [m/s2]\n", 1.0),
        ("Time [sec],Acc. (m/s²)\n", 1.0),
        ('"t","a (m/s^2)"\n', 1.0),
        ("t,acc (m/s**2)\n", 1.0),
        ("t,acc (m s^-2)\n", 1.0),
        ("t,acc (cm/s2)\n", 0.01),
        ("t,acc (cm/s/s)\n", 0.01),
        ("t,acc (Gal)\n", 0.01),
        ("# time (s), acc (g)\n", GRAVITY),
        ("# a record of 1940, in short\n\n# time,acc (g)\n", GRAVITY),
        ("Northridge; station 24\ntime,acc (g)\n", GRAVITY),
        ("time (s)  acc (g)\n", GRAVITY),
        ("% t [s]\ta [g]\n", GRAVITY),
        ("# time acc(g)\n", GRAVITY),
    ],
)
def test_units_from_the_header(tmp_path, head, factor):
    motion = read_motion(write(tmp_path, table("," if "," in head.splitlines()[-1] else "\t", head), "r.csv"))
    assert motion.acceleration == pytest.approx(VALUES * factor, rel=1e-15)


def test_comments_blank_lines_and_trailing_separators(tmp_path):
    text = "% made up\n! of nothing\n\n0.0, 1.0, # first\n0.1, 2.0,\n\n# done soon\n0.2, 3.0,\n"
    motion = read_motion(write(tmp_path, text), units="m/s2")
    assert motion.acceleration.tolist() == [1.0, 2.0, 3.0]


def test_columns_are_chosen_by_their_labels(tmp_path):
    text = "disp (m),acc (m/s2),time (s)\n9,1,0\n9,2,0.05\n9,3,0.1\n"
    motion = read_motion(write(tmp_path, text))
    assert (motion.acceleration.tolist(), motion.dt) == ([1.0, 2.0, 3.0], 0.05)
    swapped = read_motion(write(tmp_path, "acc (m/s2),time (s)\n1,0\n2,0.05\n3,0.1\n"))
    assert (swapped.acceleration.tolist(), swapped.dt) == ([1.0, 2.0, 3.0], 0.05)


def test_one_column(tmp_path):
    path = write(tmp_path, "1\n2\n-3.5e0\n1D-1\n")
    assert read_motion(path, units="cm/s2", dt=0.02).acceleration == pytest.approx([0.01, 0.02, -0.035, 0.001])
    path = write(tmp_path, "acc (g)\n1\n2\n3\n")
    assert read_motion(path, dt=0.02).pga == 3 * GRAVITY
    with pytest.raises(InputError, match="has one column and no times: give the sampling step"):
        read_motion(path)
    with pytest.raises(InputError, match="dt must be a positive"):
        read_motion(path, dt=-0.01)


def test_comment_with_npts_is_no_at2_header(tmp_path):
    path = write(tmp_path, "# NPTS= 3, DT= 0.01 SEC\n1\n2\n3\n")
    assert read_motion(path, units="m/s2", dt=0.01).pga == 3.0
    with pytest.raises(InputError, match="does not state the unit"):
        read_motion(path, dt=0.01)


def test_the_step_is_free_of_rounding(tmp_path):
    text = "\n".join(f"{5 + k * 0.02:.2f} {(-1) ** k}" for k in range(4000))
    assert read_motion(write(tmp_path, text), units="g").dt == 0.02


def test_given_step_replaces_rounded_times(tmp_path):
    dt = 1 / 256
    path = write(tmp_path, "\n".join(f"{k * dt:.3f},{k / 100}" for k in range(100)))
    with pytest.raises(InputError, match=r"time step is 0.003 s, but 0.004 s before.*printed times are only rounded"):
        read_motion(path, units="g")
    assert read_motion(path, units="g", dt=dt).dt == dt
    with pytest.raises(InputError, match=r"line 4: the time 0\.012 s does not fit dt=0.005 s.* mean step .* 0\.0039"):
        read_motion(path, units="g", dt=0.005)


def rows(*lines):
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (rows("0 1", "0.1 2", "0.2 x", "0.3 4"), "line 3: expected a finite number, but found 'x'"),
        (rows("0 1", "0.1 nan", "0.2 3"), "line 2: expected a finite number, but found 'nan'"),
        (rows("nan 1", "0.1 2", "0.2 3"), "line 1: expected a finite number, but found 'nan'"),
        (rows("0 1", "0.1 inf", "0.2 3"), "line 2: expected a finite number, but found 'inf'"),
        (rows("0,1", "0.1,", "0.2,3"), "line 2: expected a finite number, but found ''.*without gaps"),
        (rows("0 1", "0.1 2 3", "0.2 3"), "line 2: expected 2 columns as in line 1, but found 3"),
        (rows("0 1", "0.1 2", "", "end"), "line 4: expected 2 columns"),
        (rows("0 0.1", "0,1 0.2", "0.2 1"), "line 1: '0.1' has a decimal point, but other numbers have decimal commas"),
        (rows("0.O 1", "0.1 2", "0.2 3", "0.3 4"), "line 1: expected a finite number, but found '0.O'"),
        (rows("1x", "2", "3", "4"), "line 1: expected a finite number, but found '1x'"),
        (rows("0 1", "0.1 2", "0.3 3"), r"line 3: the time step is 0.2 s, but 0.1 s before.*resample the record"),
        (rows("0 1", "0.1 2", "0.1 3"), "line 3: time must increase, but it goes from 0.1 s to 0.1 s"),
        (rows("0 1", "0.1 2", "0.05 3"), "line 3: time must increase"),
        (rows("0 1", "0.1 2"), "has 2 samples, but a record needs at least 3"),
        (rows("0 1 2", "1 1 2", "2 1 2"), "has 3 columns, and its header does not name one as time"),
        (rows("t,acc,acc", "0,1,2", "1,1,2", "2,1,2"), 'at least one as acceleration .* "acc NS \\(g\\), acc EW'),
        (rows("t,acc x,acc y", "0,1,2", "0.1,1,2", "0.2,1,2"), r"components: 'x', 'y'\. Name one: .*component='x'"),
        (rows("t,vel", "0,1", "1,1", "2,2"), "an acceleration is expected, but the column is labelled 'vel'"),
        (rows("t (turns),acc", "0,1", "1,1", "2,2"), "times are in 'turns', but seconds are expected"),
        (rows("no", "numbers"), "holds no numbers"),
        (rows("0,00;0.001", "0,01;-0,02", "0,02;0,3"), r"line 1: '0\.001' has a decimal point, but other numbers"),
        (rows("0,00;1.000,5", "0,01;-0,02", "0,02;0,3"), r"line 1: .* but found '1\.000,5'"),
        (rows("0,00;1,0,5", "0,01;-0,02", "0,02;0,3"), "line 1: .* but found '1,0,5'"),
    ],
)
def test_refuses(tmp_path, text, message):
    path = write(tmp_path, text)
    with pytest.raises(InputError, match=message) as caught:
        read_motion(path, units="m/s2")
    assert "record.txt" in str(caught.value)


def test_the_unit_is_never_guessed(tmp_path):
    for head in ("", "time,acc\n", "t,a_g\n", "# values of g\n", "# PGA 0.3 g\n"):
        with pytest.raises(InputError, match=r"does not state the unit of its acceleration. Declare it"):
            read_motion(write(tmp_path, table(",", head)))
    with pytest.raises(InputError, match="header gives the unit 'ft/lb', which is not known"):
        read_motion(write(tmp_path, table(",", "time,acc (ft/lb)\n")), units="g")
    with pytest.raises(InputError, match=r"the unit is g .*label \"acc \(g\)\".*, but units='m/s2' was given"):
        read_motion(write(tmp_path, table(",", "time,acc (g)\n")), units="m/s2")
    with pytest.raises(InputError, match=r"units must be one of 'g', .*'in/s2', but 'ft/lb' was given"):
        read_motion(write(tmp_path, table()), units="ft/lb")


@pytest.mark.parametrize(
    ("units", "value", "smaller"), [("g", 9.7, "m/s² or cm/s²"), ("m/s2", 300.0, "cm/s²"), ("cm/s2", 9e4, "a smaller")]
)
def test_amplitudes_that_only_a_wrong_unit_explains(tmp_path, units, value, smaller):
    path = write(tmp_path, f"0 0\n0.1 {value}\n0.2 0\n")
    with pytest.raises(InputError) as caught:
        read_motion(path, units=units)
    assert f"the peak acceleration is {value:g} {units}, above 5 g. It looks like {smaller}" in str(caught.value)
    assert 'units="m/s2"' in str(caught.value)
    assert caught.value.field == "units"


@pytest.mark.parametrize(
    "text",
    [
        "0,00;0,001\n0,01;-0,02\n0,02;0,3\n0,03;0\n0,04;1,25E-1\n",
        "Zeit (s);Beschleunigung\n0,00;0,001\n0,01;-0,02\n0,02;0,3\n0,03;0\n0,04;0,125\n",
        "0,00\t0,001\n0,01\t-0,02\n0,02\t0,3\n0,03\t0\n0,04\t0,125\n",
        "0,00 0,001\n0,01 -0,02\n0,02 0,3\n0,03 0\n0,04 0,125\n",
        "0 0,001\n0,01 -0,02\n0,02 0,3\n0,03 0\n0,04 0,125\n",
    ],
)
def test_decimal_commas(tmp_path, text):
    motion = read_motion(write(tmp_path, text), units="g")
    assert motion.dt == 0.01
    assert motion.acceleration == pytest.approx(VALUES * GRAVITY, rel=1e-15)


@pytest.mark.parametrize("text", ["0,001\n-0,02\n0,3\n0,0\n0,125\n", "0\n0,5\n-0,25\n"])
def test_a_single_column_with_decimal_commas(tmp_path, text):
    expected = [float(line.replace(",", ".")) for line in text.split()]
    assert read_motion(write(tmp_path, text), units="m/s2", dt=0.01).acceleration.tolist() == expected


def test_whole_times_that_increase_are_a_column_of_their_own(tmp_path):
    motion = read_motion(write(tmp_path, "0,12\n1,-25\n2,9\n3,0\n"), units="m/s2", dt=0.02)
    assert (motion.dt, motion.acceleration.tolist()) == (0.02, [12.0, -25.0, 9.0, 0.0])


def test_labels_between_tabs_may_hold_blanks(tmp_path):
    motion = read_motion(write(tmp_path, "Time of day (s)\tacceleration of table [g]\n0\t0\n0.1\t0.5\n0.2\t0\n"))
    assert (motion.pga, motion.dt) == (0.5 * GRAVITY, 0.1)


@pytest.mark.parametrize("line", ["units: cm/s^2", "# Units = gal", "% made by hand; unit: (cm/s/s)"])
def test_units_from_a_line_above(tmp_path, line):
    assert read_motion(write(tmp_path, table(",", f"{line}\ntime,acc\n"))).pga == pytest.approx(0.003)
    with pytest.raises(InputError, match=r"the unit is cm/s2 .*line 1.*, but units='g' was given"):
        read_motion(write(tmp_path, table(",", f"{line}\n")), units="g")
    with pytest.raises(InputError, match=r"holds counts of a recorder by its line 1.*value of one count"):
        read_motion(write(tmp_path, table(",", "units: counts\n")))
    both = write(tmp_path, table(",", f"{line}\ntime,acc (g)\n"))
    with pytest.raises(InputError, match=r"contradicts itself about the unit: g \(label.*\), but cm/s2 \(line 1"):
        read_motion(both)
    assert read_motion(both, units="g").pga == 0.3 * GRAVITY


def test_the_step_from_a_line_above(tmp_path):
    file = write(tmp_path, "# dt = 0.005 s\nacc (g)\n0\n0.1\n0\n")
    assert read_motion(file).dt == 0.005
    assert read_motion(file, dt=0.005).dt == 0.005
    with pytest.raises(InputError, match=r"time step is 0\.005 .*line 1: .*, but dt=0\.01 was given"):
        read_motion(file, dt=0.01)


@pytest.mark.parametrize(
    ("units", "factor"),
    [
        ("gal", 0.01),
        ("mg", 1e-3 * GRAVITY),
        ("mm/s^2", 1e-3),
        ("in/s2", 0.0254),
        ("2.5e-1 cm/s2", 0.0025),
        (" 0.5 * g ", 0.5 * GRAVITY),
        ("1 m/s/s", 1.0),
    ],
)
def test_units_of_the_caller(tmp_path, units, factor):
    motion = read_motion(write(tmp_path, table()), units=units)
    assert motion.acceleration == pytest.approx(VALUES * factor, rel=1e-14)


@pytest.mark.parametrize("units", ["", "counts", "0 g", "-1 g", "1e999 g", "g g", "2", 2, None.__class__, "x" * 10_000])
def test_units_that_are_none(tmp_path, units):
    with pytest.raises(InputError, match=r'units must be one of .* one count: units="2\.4e-4 cm/s2"'):
        read_motion(write(tmp_path, table()), units=units)


def test_components_in_columns(tmp_path):
    rows = "".join(f"{k / 10},{k - 1},{2 * k},3\n" for k in range(3))
    text = "time (s),acc_N38E (g),acc S52E (g),vertical (g)\n" + rows
    found = read_components(write(tmp_path, text))
    assert [motion.name for motion in found] == ["record-N38E", "record-S52E", "record-vertical"]
    assert [motion.metadata.azimuth for motion in found] == [38.0, 128.0, None]
    assert [motion.metadata.direction for motion in found] == ["horizontal", "horizontal", "vertical"]
    assert read_motion(tmp_path / "record.txt", component="128").pga == 4 * GRAVITY
    plain = "NS (gal);EW (gal);Z (gal)\n" + "1;2;3\n" * 4
    found = read_components(write(tmp_path, plain), dt=0.01)
    assert [motion.pga for motion in found] == pytest.approx([0.01, 0.02, 0.03])
    assert found[2].metadata.direction == "vertical"
    with pytest.raises(InputError, match="has 3 columns and no times: give the sampling step"):
        read_components(tmp_path / "record.txt")
    with pytest.raises(InputError, match="has 4 columns, and its header does not name one as time"):
        read_components(write(tmp_path, "t,NS,EW,what\n" + "1,2,3,4\n" * 4))


@pytest.mark.parametrize(
    "head", ["Zeit [s];Weg [mm];Beschleunigung [gal]", "temps (s);u;accélération (gal)", "tiempo;d;aceleración (gal)"]
)
def test_labels_in_other_languages(tmp_path, head):
    assert read_motion(write(tmp_path, f"{head}\n0;9;1\n0,1;9;2\n0,2;9;3\n")).pga == pytest.approx(0.03)


@pytest.mark.parametrize(
    ("head", "names"),
    [
        ("t;a_x;a_z", ("x", "vertical")),
        ("time (s);a NS (g);a UD (g)", ("NS", "vertical")),
        ("t [s];a_x [g];a_y [g];a_z [g]", ("x", "y", "vertical")),
        ("Zeit;ax;ay;az", ("x", "y", "vertical")),
        ("t;a 000;a 090;a V", ("000", "090", "vertical")),
        ("a_x;a_z", ("x", "vertical")),
        ("a NS;a UD", ("NS", "vertical")),
        ("acc NS;acc UD", ("NS", "vertical")),
        ("NS (g);EW (g)", ("NS", "EW")),
    ],
)
@pytest.mark.parametrize("point", [".", ","])
def test_labels_that_name_components(tmp_path, head, names, point):
    timed = head.startswith(("t", "Z"))
    columns = [VALUES / (k + 1) for k in range(len(names))]
    rows = zip(*([0.01 * np.arange(VALUES.size)] if timed else []), *columns, strict=True)
    lines = [";".join(f"{value:.17g}".replace(".", point) for value in row) for row in rows]
    file = write(tmp_path, "\n".join([head, *lines, ""]), "lab.csv")
    found = read_components(file, units="g", dt=None if timed else 0.01)
    along = [motion for motion in found if not motion.metadata.is_vertical]
    upwards = [motion.vertical for motion in found if motion.vertical is not None]
    upwards += [motion.acceleration for motion in found if motion.metadata.is_vertical]
    wanted = [name for name in names if name != "vertical"]
    if len(wanted) > 1:
        assert [motion.metadata.component for motion in along] == wanted
        assert group_stations(found)[0].pair == tuple(along)
    read = [*(motion.acceleration for motion in along), *upwards]
    assert len(read) == len(names)
    for given, values in zip(columns, read, strict=True):
        np.testing.assert_allclose(values, given * GRAVITY, rtol=1e-14)
    assert {motion.dt for motion in found} == {0.01}


@pytest.mark.parametrize("head", ["t;a;b", "t;as;at", "t;avg;all", "t;a_filtered;a_raw"])
def test_labels_that_name_no_component_are_refused(tmp_path, head):
    rows = "".join(f"{0.01 * k};{value};{value}\n" for k, value in enumerate(VALUES))
    with pytest.raises(InputError, match="has 3 columns, and its header does not name"):
        read_components(write(tmp_path, f"{head}\n{rows}", "lab.csv"), units="g")


def test_two_columns_of_a_curve_are_time_and_acceleration(tmp_path):
    assert read_motion(write(tmp_path, table(";", "X;Y\n"), "lab.csv"), units="g").dt == 0.01
