import numpy as np
import pytest

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.motion import read_motion

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
    ],
)
def test_units_from_the_header(tmp_path, head, factor):
    motion = read_motion(write(tmp_path, table(",", head), "r.csv"))
    assert motion.acceleration == pytest.approx(VALUES * factor, rel=1e-15)


@pytest.mark.parametrize("head", ["time (s)  acc (g)\n", "% t [s]\ta [g]\n", "# time acc(g)\n"])
def test_units_from_the_header_of_blank_separated_columns(tmp_path, head):
    assert read_motion(write(tmp_path, table("\t", head))).acceleration == pytest.approx(VALUES * GRAVITY)


def test_comments_blank_lines_and_trailing_separators(tmp_path):
    text = "% made up\n! of nothing\n\n0.0, 1.0, # first\n0.1, 2.0,\n\n# done soon\n0.2, 3.0,\n"
    motion = read_motion(write(tmp_path, text), units="m/s2")
    assert motion.acceleration.tolist() == [1.0, 2.0, 3.0]


def test_columns_are_chosen_by_their_labels(tmp_path):
    text = "disp (m),acc (m/s2),time (s)\n9,1,0\n9,2,0.5\n9,3,1\n"
    motion = read_motion(write(tmp_path, text))
    assert (motion.acceleration.tolist(), motion.dt) == ([1.0, 2.0, 3.0], 0.5)
    swapped = read_motion(write(tmp_path, "acc (m/s2),time (s)\n1,0\n2,0.5\n3,1\n"))
    assert (swapped.acceleration.tolist(), swapped.dt) == ([1.0, 2.0, 3.0], 0.5)


def test_one_column(tmp_path):
    path = write(tmp_path, "1\n2\n-3.5e0\n1D-1\n")
    assert read_motion(path, units="cm/s2", dt=0.02).acceleration == pytest.approx([0.01, 0.02, -0.035, 0.001])
    path = write(tmp_path, "acc (g)\n1\n2\n3\n")
    assert read_motion(path, dt=0.02).pga == 3 * GRAVITY
    with pytest.raises(InputError, match="has one column and no times: give the sampling step"):
        read_motion(path)


def test_comment_with_npts_is_no_at2_header(tmp_path):
    path = write(tmp_path, "# NPTS= 3, DT= 0.01 SEC\n1\n2\n3\n")
    assert read_motion(path, units="m/s2", dt=0.01).pga == 3.0
    with pytest.raises(InputError, match="does not state the unit"):
        read_motion(path, dt=0.01)


def test_the_step_is_free_of_rounding(tmp_path):
    text = "\n".join(f"{5 + k * 0.02:.2f} 1.0" for k in range(4000))
    assert read_motion(write(tmp_path, text), units="g").dt == 0.02


def test_given_step_replaces_rounded_times(tmp_path):
    dt = 1 / 256
    path = write(tmp_path, "\n".join(f"{k * dt:.3f},{k / 100}" for k in range(100)))
    with pytest.raises(InputError, match=r"time step is 0.003 s, but 0.004 s before.*printed times are only rounded"):
        read_motion(path, units="g")
    assert read_motion(path, units="g", dt=dt).dt == dt
    with pytest.raises(InputError, match=r"line 4: the time 0\.012 s does not fit dt=0.005 s. Leave dt out"):
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
        (rows("0,1", "0.1,", "0.2,3"), "line 2: expected 2 columns as in line 1, but found 1"),
        (rows("0 1", "0.1 2 3", "0.2 3"), "line 2: expected 2 columns as in line 1, but found 3"),
        (rows("0 1", "0.1 2", "", "end"), "line 4: expected 2 columns"),
        (rows("0 0.1", "0,1 0.2", "0.2 1"), "line 2: expected .* found '0,1'. Write decimals with a point"),
        (rows("0.O 1", "0.1 2", "0.2 3", "0.3 4"), "line 1: expected a finite number, but found '0.O'"),
        (rows("1x", "2", "3", "4"), "line 1: expected a finite number, but found '1x'"),
        (
            rows("0 1", "0.1 2", "0.3 3"),
            r"line 3: the time step is 0.2 s, but 0.1 s before.*resample the record",
        ),
        (rows("0 1", "0.1 2", "0.1 3"), "line 3: time must increase, but it goes from 0.1 s to 0.1 s"),
        (rows("0 1", "0.1 2", "0.05 3"), "line 3: time must increase"),
        (rows("0 1", "0.1 2"), "has 2 samples, but a record needs at least 3"),
        (rows("0 1 2", "1 1 2", "2 1 2"), "has 3 columns, and its header does not name one as time"),
        (rows("t,acc,acc", "0,1,2", "1,1,2", "2,1,2"), 'at least one as acceleration .* "acc NS \\(g\\), acc EW'),
        (rows("t,acc x,acc y", "0,1,2", "1,1,2", "2,1,2"), r"holds 2 components: 'x', 'y'\. Name one: .*component='x'"),
        (rows("t,vel", "0,1", "1,1", "2,2"), "an acceleration is expected, but the column is labelled 'vel'"),
        (rows("t (ms),acc", "0,1", "1,1", "2,2"), "times are in 'ms', but seconds are expected"),
        (rows("no", "numbers"), "holds no numbers"),
    ],
)
def test_refuses(tmp_path, text, message):
    path = write(tmp_path, text)
    with pytest.raises(InputError, match=message) as caught:
        read_motion(path, units="m/s2")
    assert "record.txt" in str(caught.value)


def test_the_unit_is_never_guessed(tmp_path):
    for head in ("", "time,acc\n", "t,a_g\n", "# values in g\n"):
        with pytest.raises(InputError, match=r"does not state the unit of its acceleration. Declare it"):
            read_motion(write(tmp_path, table(",", head)))
    with pytest.raises(InputError, match="header gives the unit 'ft/s2', which is not known"):
        read_motion(write(tmp_path, table(",", "time,acc (ft/s2)\n")), units="g")
    with pytest.raises(InputError, match="column header says g, but units='m/s2' was given"):
        read_motion(write(tmp_path, table(",", "time,acc (g)\n")), units="m/s2")
    with pytest.raises(InputError, match="units must be one of 'g', .*'in/s2', but 'ft/s2' was given"):
        read_motion(write(tmp_path, table()), units="ft/s2")


@pytest.mark.parametrize("dt", [0, -0.01, float("nan")])
def test_dt_must_be_positive(tmp_path, dt):
    with pytest.raises(InputError, match="dt must be a positive"):
        read_motion(write(tmp_path, "1\n2\n3\n"), units="g", dt=dt)


@pytest.mark.parametrize(
    ("units", "value", "smaller"),
    [("g", 9.7, "m/s² or cm/s²"), ("m/s2", 300.0, "cm/s²"), ("cm/s2", 9e4, "a smaller")],
)
def test_amplitudes_that_only_a_wrong_unit_explains(tmp_path, units, value, smaller):
    path = write(tmp_path, f"0 0\n0.1 {value}\n0.2 0\n")
    with pytest.raises(InputError) as caught:
        read_motion(path, units=units)
    text = str(caught.value)
    assert f"the peak acceleration is {value:g} {units}, above 5 g" in text
    assert f"It looks like {smaller}" in text
    assert f"although {units} was declared" in text
    assert 'units="m/s2"' in text
    assert "motions can be scaled without limit" in text


def test_binary_file(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match="is a binary file; a record is expected as text"):
        read_motion(path)
