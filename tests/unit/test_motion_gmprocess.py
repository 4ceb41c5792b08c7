"""Networks that gmprocess reads: their files are known by their first lines, with it and without it."""

import sys
import types
from datetime import datetime

import numpy as np
import pytest

import rockflex as rf
from rockflex.motion import _gmprocess

HEADS = {
    "BHRC": "* VOL1DS FILE:  5526/01\nInst Type = SSA-2\nCOMP L1\nNO. OF POINTS =   3      DURATION =  0.015\n",
    "CSMNC": "051BXD130420080201\nUNCORRECTED ACCELERATION          UNIT: CM/SEC/SEC\n"
    "NO. OF POINTS:  3  EQUALLY SPACED INTERVALS OF:  0.005  SEC\n",
    "CWB": "#Earthquake Information\n#RecordLength(sec): 0.015\n#SampleRate(Hz): 200\n"
    "#AmplitudeMAX. U:    1.196~   -1.017\n#AmplitudeMAX. N:    10.000~   -20.000\n",
    "ISESD": "\tfile:                 002727xa.cor\n\tearthquake code:      990\n",
    "NSMN": "STRONG GROUND MOTION RECORDS OF TURKIYE\nNUMBER OF DATA          : 3\nSAMPLING INTERVAL (sec) : 0.005\n"
    "RAW PGA VALUES (gal)    : (N-S) 20.0\n",
    "RENADIC": "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 06/30/2011\n0911131\n"
    "UNIVERSIDAD DE CHILE - RENADIC\nNO. OF POINTS =   3  RECORD LENGTH = 0.015 SEC\n"
    "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = -0.0204 G, AT   3.910 SEC\n",
    "SIGMA": "Event Date & Time             : 2009-04-06 01:32:39\nStation Code / Name           : 2987 / Colle\n",
    "UNAM": "*****\n  INSTITUTO DE INGENIERIA, UNAM\nARCHIVO ESTANDAR DE ACELERACION:\n"
    "INTERVALO DE MUESTREO, C1-C6 (s)       : /0.005/0.005/0.005\n"
    "NUM. TOTAL DE MUESTRAS, C1-C6          : /3/3/3\nACEL. MAX.(Gal), C1-C6                 : /-20.00\n",
    "USC": "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:\nSTATION USC# 0057\n"
    "NO. OF POINTS =   3      DURATION =  0.015 SEC\n",
}
READ = [name for name in HEADS if name not in ("CSMNC", "ISESD", "SIGMA")]
ROWS = "    0.000    10.000\n    0.005   -20.000\n    0.010     0.000\n"
GAL = [10.0, -20.0, 0.0]


class Stats(types.SimpleNamespace):
    """What gmprocess knows of a trace."""


class Trace:
    """A trace as gmprocess returns them."""

    def __init__(self, channel="HN1", data=GAL, *, delta=0.005, units="cm/s/s", azimuth=30.0, resampled=False):
        self.data, self._resampled = np.array(data), resampled
        standard = Stats(units=units, horizontal_orientation=azimuth, process_level="uncorrected physical units")
        begin = Stats(datetime=datetime(2020, 1, 2, 3, 4, 5))
        self.stats = Stats(
            channel=channel, delta=delta, standard=standard, starttime=begin, station="ABC", network="XX"
        )

    def get_provenance(self, kind):
        return [kind] if self._resampled and kind == "resample" else []


@pytest.fixture
def installed(monkeypatch):
    """A gmprocess whose readers return given traces, or raise."""

    def install(*traces, error=None):
        def read(file):
            import logging

            logging.warning("Setting elevation to 0.0")
            if error is not None:
                raise error
            return [list(traces)]

        monkeypatch.setattr(_gmprocess, "is_gmprocess_installed", lambda: True)
        for name in READ:
            module = types.SimpleNamespace(**{f"read_{name.lower()}": read})
            monkeypatch.setitem(sys.modules, f"gmprocess.io.{name.lower()}.core", module)

    return install


@pytest.fixture
def write(tmp_path):
    def write(name, text=None):
        file = tmp_path / f"{name.lower()}.dat"
        file.write_text((HEADS[name] + ROWS) if text is None else text)
        return file

    return write


@pytest.mark.parametrize("name", HEADS)
@pytest.mark.parametrize("given", [{}, {"units": "g", "dt": 0.02}])
def test_without_gmprocess_the_message_names_the_network(write, monkeypatch, name, given):
    """Never are such files read as plain columns, whatever unit and step are given."""
    monkeypatch.setattr(_gmprocess, "is_gmprocess_installed", lambda: False)
    remedy = r"pip install 'rockflex\[gmprocess\]'" if name in READ else "Copy its numbers into a file of their own"
    with pytest.raises(rf.InputError, match=rf"{name.lower()}\.dat: this is a file of .*{name}.*{remedy}"):
        rf.read_motion(write(name), **given)


@pytest.mark.parametrize("name", READ)
def test_with_gmprocess(write, installed, name):
    installed(Trace())
    motion = rf.read_motion(write(name))
    info = motion.metadata
    assert motion.acceleration == pytest.approx([0.1, -0.2, 0.0])
    assert (motion.dt, info.component, info.direction, info.azimuth) == (0.005, "HN1", "horizontal", 30.0)
    assert (info.station, info.start_time, info.processing) == ("ABC", "2020-01-02T03:04:05+00:00", "uncorrected")
    assert info.source_format == name
    peak = {"BHRC": None, "CWB": None, "USC": None, "RENADIC": pytest.approx(0.2, rel=1e-3)}.get(
        name, pytest.approx(0.2)
    )
    assert info.stated_pga == peak
    with pytest.raises(rf.InputError, match=f"in the {name} format, which states its unit"):
        rf.read_motion(write(name), units="g")
    with pytest.raises(rf.InputError, match=r"states DT = 0\.005 s, but dt=0\.02 was given"):
        rf.read_motion(write(name), dt=0.02)


def test_components(write, installed, tmp_path):
    installed(Trace("HN2", azimuth=float("nan")), Trace("HNZ", [2.0, 1.0, 0.0], azimuth=0.0))
    along, upwards = rf.read_components(write("BHRC"))
    assert [along.name, upwards.name] == ["bhrc-HN2", "bhrc-HNZ"]
    assert (along.metadata.azimuth, upwards.metadata.azimuth, upwards.metadata.direction) == (None, None, "vertical")
    (tmp_path / "bhrc.dat").rename(tmp_path / "5526-1.V1")
    assert [motion.pva for motion in rf.read_suite(tmp_path, vertical="pair")] == pytest.approx([0.02])


def test_peaks_of_several_components(write, installed):
    installed(Trace("BNZ", [0.0, 1.196, 0.0]), Trace("BN1", [0.0, 0.0, -20.0]))
    found = rf.read_components(write("CWB"))
    assert [motion.metadata.stated_pga for motion in found] == pytest.approx([0.01196, 0.2])
    in_a_line = HEADS["NSMN"].replace("(N-S) 20.0", "(N-S) 20.0 (E-W) 10.0 (U-D) 5.0")
    installed(Trace("HN1"), Trace("HN2", [10.0, 0.0, 0.0]), Trace("HNZ", [5.0, 0.0, 0.0]))
    found = rf.read_components(write("NSMN", in_a_line + ROWS))
    assert [motion.metadata.stated_pga for motion in found] == pytest.approx([0.2, 0.1, 0.05])


@pytest.mark.parametrize(
    ("name", "trace", "message"),
    [
        ("NSMN", Trace(data=GAL[:2]), r"reads 2 samples of 0\.005 s, which is not what the header states \(line 2: "),
        ("CWB", Trace(data=GAL * 3), "reads 9 samples"),
        ("NSMN", Trace(delta=0.01), r"reads a step of 0\.01 s, which the header does not state"),
        ("NSMN", Trace(units="cm/s"), "cannot read it: samples in cm/s, not in cm/s²"),
        ("NSMN", Trace(data=[1.0, float("nan"), 0.0]), "values that are no numbers"),
        ("UNAM", Trace(data=[1.0, 2.0, 0.0]), r"states a PGA of 0\.2 m/s², but the samples reach 0\.02"),
    ],
)
def test_what_does_not_agree_with_the_header_is_refused(write, installed, name, trace, message):
    installed(trace)
    with pytest.raises(rf.InputError, match=message):
        rf.read_motion(write(name))


def test_a_step_that_is_one_sample_too_long_is_that_of_the_header(write, installed):
    """The duration over one step too few, as some of the readers compute it."""
    head = HEADS["BHRC"].replace("  3  ", "  2000").replace("0.015", "10.000")
    installed(Trace(data=[1.0] * 2000, delta=10.0 / 1999))
    assert rf.read_motion(write("BHRC", head + ROWS)).dt == 0.005


def test_steps_made_equal_are_told(write, installed):
    installed(Trace(data=[*GAL, 0.0], delta=0.004, resampled=True))
    motion = rf.read_motion(write("USC"))
    assert (motion.dt, motion.metadata.processing) == (0.004, "uncorrected; resampled to equal steps")


def test_what_it_raises_is_told_by_name(write, installed, capsys, caplog):
    installed(error=BaseException("a line is missing"))
    with pytest.raises(
        rf.InputError, match=r"is a file of Turkey's NSMN, but gmprocess cannot read it: a line is miss"
    ):
        rf.read_motion(write("NSMN"))
    installed()
    with pytest.raises(rf.InputError, match="it holds no samples"):
        rf.read_motion(write("NSMN"))
    assert (*capsys.readouterr(), caplog.records) == ("", "", [])  # nor does it write to the log
    installed(error=KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        rf.read_motion(write("NSMN"))


def test_the_page_does_not_use_it(write, installed):
    from rockflex.motion._readers import read_motion_without_obspy

    installed(Trace())
    with pytest.raises(rf.InputError, match="this is a file of Turkey's NSMN"):
        read_motion_without_obspy(write("NSMN"))
