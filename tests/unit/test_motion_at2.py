import numpy as np
import pytest

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.motion import read_at2, read_motion

VALUES = np.array([0.001, -0.02, 0.3, -0.3456e-3, 0.0, 0.125])

NGA = """PEER NGA STRONG MOTION DATABASE RECORD
Loma Prieta, 10/18/1989, Corralitos, 90
ACCELERATION TIME SERIES IN UNITS OF G
{header}
"""
OLD = """PEER STRONG MOTION DATABASE RECORD. PROCESSING BY PACIFIC ENGINEERING.
IMPERIAL VALLEY 10/15/79 2319, EL CENTRO ARRAY #6, 230 (USGS STATION 5158)
ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz
{header}
"""
BODY = "  .1000000E-02 -.2000000E-01  .3000000E+00\n -.3456000E-03  .0000000E+00  .1250000E+00\n"


def write(tmp_path, text, name="RSN753_LOMAP_CLS090.AT2", encoding="utf-8", newline="\n"):
    path = tmp_path / name
    path.write_bytes(text.replace("\n", newline).encode(encoding))
    return path


@pytest.mark.parametrize("form", [NGA, OLD])
@pytest.mark.parametrize(
    "header",
    [
        "NPTS=  6, DT= .00500 SEC",
        "NPTS=   6, DT=   .0050 SEC,                 ",
        "NPTS =  6, DT = 0.005 SEC,",
        "NPTS=6 DT=5.0E-03",
        "npts= 6, dt= 0.005 sec",
        "  6   0.0050   NPTS, DT",
        "  6  .0050  NPTS,DT",
    ],
)
def test_header_forms(tmp_path, form, header):
    motion = read_at2(write(tmp_path, form.format(header=header) + BODY))
    assert motion.dt == 0.005
    assert motion.acceleration == pytest.approx(VALUES * GRAVITY, rel=1e-15)
    assert motion.name == "RSN753_LOMAP_CLS090"


@pytest.mark.parametrize(
    "body",
    [
        "\n".join(f"{value:.7E}" for value in VALUES),
        "  ".join(f"{value:.7E}" for value in VALUES),
        ", ".join(f"{value:.7E}" for value in VALUES),
        " .1000E-02-.2000E-01 .3000E+00-.3456E-03 .0000E+00 .1250E+00",
        " .1000D-02-.2000D-01 .3000D+00\n-.3456d-03+.0000D+00+.1250D+00\n\n",
        "1E-003-2E-002+3.E-001-3.456E-004\t0 0.125",
        ".001-.02+.3-.0003456 0. .125",
    ],
)
def test_wrapped_and_run_together(tmp_path, body):
    motion = read_at2(write(tmp_path, NGA.format(header="NPTS= 6, DT= .005 SEC") + body))
    assert motion.acceleration == pytest.approx(VALUES * GRAVITY, rel=1e-15)


def test_title_of_the_nga_form(tmp_path):
    info = read_at2(write(tmp_path, NGA.format(header="NPTS= 6, DT= .005 SEC") + BODY)).metadata
    assert (info.event, info.year, info.station) == ("Loma Prieta", 1989, "Corralitos")
    assert (info.component, info.rsn) == ("90", 753)
    assert info.source == "Loma Prieta, 10/18/1989, Corralitos, 90"
    text = NGA.replace("Loma Prieta", "Chi-Chi, Taiwan").format(header="NPTS= 6, DT= .005 SEC")
    assert read_at2(write(tmp_path, text + BODY)).metadata.event == "Chi-Chi, Taiwan"


def test_title_of_the_old_form(tmp_path):
    info = read_at2(write(tmp_path, OLD.format(header="NPTS= 6, DT= .005 SEC") + BODY, "H-E06230.AT2")).metadata
    assert (info.event, info.year, info.rsn) == ("IMPERIAL VALLEY", 1979, None)
    assert (info.station, info.component) == ("EL CENTRO ARRAY #6", "230")


def test_no_title(tmp_path):
    info = read_at2(write(tmp_path, "NPTS= 6, DT= .005 SEC\n" + BODY, "a.at2")).metadata
    assert (info.event, info.source) == (None, "a.at2")


@pytest.mark.parametrize("encoding", ["utf-8-sig", "latin-1", "utf-16"])
@pytest.mark.parametrize("newline", ["\r\n", "\n", "\r"])
def test_encodings_and_line_ends(tmp_path, encoding, newline):
    text = NGA.replace("Corralitos", "Café").format(header="NPTS= 6, DT= .005 SEC") + BODY + "\x1a"
    motion = read_at2(write(tmp_path, text, encoding=encoding, newline=newline))
    assert motion.metadata.station == "Café"
    assert motion.acceleration.size == 6


def test_read_motion_knows_an_at2_file_by_its_content(tmp_path):
    path = write(tmp_path, NGA.format(header="NPTS= 6, DT= .005 SEC") + BODY, "record.txt")
    for motion in (read_motion(path), read_motion(path, units="g", dt=0.005)):
        assert motion.acceleration == pytest.approx(VALUES * GRAVITY)
    with pytest.raises(InputError, match=r"the unit is g .*line 3: .*UNITS OF G.*, but units='m/s2' was given"):
        read_motion(path, units="m/s2")
    with pytest.raises(InputError, match=r"the time step is 0\.005 .*line 4: .*, but dt=0\.01 was given"):
        read_motion(path, dt=0.01)


def case(header="NPTS= 6, DT= .005 SEC", body=BODY, form=NGA):
    return form.format(header=header) + body


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (case("NPTS= 7, DT= .005 SEC"), r"is truncated: its header says 7 \(line 4: .*\), but 6 values follow"),
        (case("NPTS= 5, DT= .005 SEC"), "contains too many values: its header says 5 .*, but 6 values"),
        (case("NPTS= 0, DT= .005 SEC", ""), "acceleration must have at least 3 samples, but 0"),
        (case("NPTS= 2, DT= .005 SEC", "0.1 0.2"), "acceleration must have at least 3 samples, but 2"),
        (case("DT= .005 SEC"), "no header line with NPTS and DT among the first 12 lines"),
        (case("NPTS= 6"), "no header line with NPTS and DT"),
        (case(body=BODY.replace(".3000000E+00", "abc")), "line 5: expected a finite number, but found 'abc'"),
        (case(body=BODY.replace(".0000000E+00", "NaN")), "line 6: expected a finite number, but found 'NaN'"),
        (case(body=BODY.replace(".0000000E+00", "*******")), r"line 6: expected .* found '\*\*\*\*\*\*\*'"),
        (case(body=BODY.replace(".0000000E+00", "1_0")), "line 6: expected .* found '1_0'"),
        (case(body=BODY.replace(".0000000E+00", "1e999")), "line 6: expected a finite number, but found '1e999'"),
        (case(body=BODY + "0.1E-020.2E-02"), "line 7: expected .* found '0.1E-020.2E-02'"),
        (case(body=BODY + "0.1.2"), "line 7: expected .* found '0.1.2'"),
        (case("NPTS= 6, DT= 0.0 SEC"), r"time step must be positive, but line 4: .* gives 0\.0\."),
        (case("NPTS= 6, DT= -.005 SEC"), r"time step must be positive, but line 4: .* gives -\.005\."),
        (case(form=NGA.replace("ACCELERATION", "VELOCITY").replace("OF G", "OF CM/S")), r"velocity \(line 3.*\(suffix"),
        (case(body=BODY.replace("E+00", "E+02")), r"peak acceleration is 30 g, above 5 g.*looks like m/s² or cm/s²"),
        (case(body=BODY.replace("E+00", "E+02")), "Correct the unit in line 3"),
        ("", "is empty"),
        (" \n\n", "is empty"),
        ("\x00\x01\x02", "is a binary file"),
    ],
)
def test_refuses(tmp_path, text, message):
    path = write(tmp_path, text)
    for reader in (read_at2, read_motion):
        with pytest.raises(InputError, match=message) as caught:
            reader(path)
        assert path.name in str(caught.value)


def test_missing_file_and_directory(tmp_path):
    for reader in (read_at2, read_motion):
        with pytest.raises(InputError, match=r"none\.AT2 does not exist \(working directory: "):
            reader(tmp_path / "none.AT2")
        with pytest.raises(InputError, match=r"is a directory. Read all its records with read_suite"):
            reader(tmp_path)
