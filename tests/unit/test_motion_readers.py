"""Checks of all readers: peaks in headers, and damaged or hostile files."""

import json
import subprocess
import sys
import warnings

import pytest

import rockflex as rf
from record_samples import SAMPLES, cosmos, csmip, esm, geonet, knet, smc

SIZE = 400_000  # characters; a quadratic pattern takes many minutes
PATIENCE = 60.0  # s for all, where some are needed
READ = """
import json, sys
from pathlib import Path
import rockflex as rf
path, texts, suffix = Path(sys.argv[1]), json.loads(sys.argv[2]), sys.argv[3]
for kind, text in texts.items():
    print(kind, end=": ", flush=True)
    file = path / f"crafted.{suffix}"
    file.write_text(eval(text))
    try:
        print("read", rf.read_motion(file, units="g", dt=0.01).name)
    except rf.InputError as error:
        print("refused", str(error)[:200].replace("\\n", " "))
"""
ROWS = "\\n0 .1\\n0.01 .2\\n0.02 .3\\n"
SERIES = "\\n0.1\\n0.2\\n0.3\\n"
KNET = knet().splitlines()[:17]
COSMOS = cosmos()
GEONET = geonet()
CSMIP, SMC = csmip(volume=1), smc()
HEADER = "NPTS= 3, DT= .01 SEC"
CRAFTED = {
    "digits": f"'1' * {SIZE} + 'x'",
    "digits after numbers": f"'0.1\\n0.2\\n' + '1' * {SIZE} + 'x\\n'",
    "digits and a comma": f"'0 .1\\n0.01 .2\\n' + '1' * {SIZE} + ',' + '1' * {SIZE} + ' .3\\n'",
    "digits with a point": f"'1' * {SIZE} + '.' + '1' * {SIZE} + 'e5x'",
    "exponent": f"'1e' + '1' * {SIZE} + 'x'",
    "signs": f"'+-' * {SIZE // 2}",
    "blanks": f"'time' + ' ' * {SIZE} + 'x{ROWS}'",
    "blanks in a bracket": f"'time (s) acc (' + ' ' * {SIZE} + 'g){ROWS}'",
    "label of a component": f"'t;a ' + '1' * {SIZE} + 'x;a_' + ' ' * {SIZE} + 'z;b\\n0;1;2;3\\n1;1;2;3\\n2;1;2;3'",
    "tabs and blanks": f"'time' + '\\t ' * {SIZE // 2} + 'x{ROWS}'",
    "brackets": f"'(' * {SIZE} + '{ROWS}'",
    "brackets closed once": f"'()' + '[(' * {SIZE // 2} + '{ROWS}'",
    "brackets of one column": f"'(' * {SIZE} + '{SERIES}'",
    "brackets with blanks": f"' (' * {SIZE // 2} + ')' + '{ROWS}'",
    "separators": f"', ;' * {SIZE // 3} + '{ROWS}'",
    "NPTS and blanks": f"'NPTS' + ' ' * {SIZE} + '{ROWS}'",
    "NPTS again and again": f"'NPTS DT = ' * {SIZE // 10} + '{ROWS}'",
    "NPTS of many digits": f"'NPTS= ' + '1' * {SIZE} + ', DT= .01 SEC{SERIES}'",
    "a few digits too many": "'NPTS= ' + '1' * 5000 + ', DT= .01 SEC" + SERIES + "'",
    "DT of many digits": f"'NPTS= 3, DT= .' + '1' * {SIZE} + ' SEC{SERIES}'",
    "bare header, blanks": f"' ' * {SIZE // 3} + '3' + ' ' * {SIZE // 3} + '.01' + ' ' * {SIZE // 3} + 'x{SERIES}'",
    "bare header, digits": f"'1' * {SIZE // 2} + ' ' + '1' * {SIZE // 2} + ' x{SERIES}'",
    "bare header, count": f"'3 ' + '0' * {SIZE} + ' NPT{SERIES}'",
    "units": f"'units ' * {SIZE // 6} + '\\n{HEADER}{SERIES}'",
    "units and blanks": f"'units' + ' ' * {SIZE} + '\\n{HEADER}{SERIES}'",
    "blanks after a date": f"'E, 1/2/1999' + ' ' * {SIZE} + 'x\\n{HEADER}{SERIES}'",
    "dates": f"'1/2/' * {SIZE // 4} + '\\n{HEADER}{SERIES}'",
    "component of blanks": f"'E, 1/2/1999, A' + ' ' * {SIZE} + 'x\\n{HEADER}{SERIES}'",
    "component of brackets": f"'E, 1/2/1999, A ' + '(' * {SIZE} + '\\n{HEADER}{SERIES}'",
    "values of many digits": f"'{HEADER}\\n0.1\\n0.2\\n0.3' + '1' * {SIZE} + 'x\\n'",
    "values run together": f"'{HEADER}\\n' + '1-' * {SIZE // 2} + 'x\\n'",
    "decimal commas": f"'0,1;' * {SIZE // 4} + '\\n'",
    "commas of one column": f"'0,' + '1' * {SIZE} + '\\n0,1\\n0,' + '2' * {SIZE} + 'x'",
    "unit of blanks": f"'units: ' + ' ' * {SIZE} + '{ROWS}'",
    "units again and again": f"'unit: ( ' * {SIZE // 8} + '{ROWS}'",
    "step of digits": f"'dt = ' + '1' * {SIZE} + ' x{SERIES}'",
    "steps again and again": f"'dt = 1' * {SIZE // 6} + '{SERIES}'",
    "scale of digits": f"{KNET!r}[0] + '\\n' + ('Scale Factor      ' + '1' * {SIZE} + '(gal)/1\\n') * 16 + '1 2 3'",
    "scale of blanks": f"'\\n'.join({KNET!r}).replace('(gal)/', ' ' * {SIZE}) + '\\n1 2 3'",
    "keys": f"'EVENT_NAME:\\n' + 'A' * {SIZE} + '\\n' + 'A:' * {SIZE // 2} + '\\n1'",
    "lines of text": f"{COSMOS!r}.replace('v01.20', 'v' + '1' * {SIZE})",
    "blanks of a format": f"{COSMOS!r}.replace('Format=', 'Format' + ' ' * {SIZE})",
    "numbers of a block": f"{COSMOS!r} + '\\n' + '9' * {SIZE} + ' acceleration\\n' + ' ' * {SIZE} + '1 '",
    "columns of a format": f"{COSMOS!r} + '\\n999999999 velocity pts, Format=(999F999.1)\\n'",
    "first line of GeoNet": f"{GEONET!r}.replace('_MADE_', '_20' * {SIZE // 3})",
    "blanks of a component": f"{GEONET!r}.replace('Component ', 'Component' + ' ' * {SIZE})",
    "numbers of GeoNet": f"{GEONET!r}.replace('   0.000', '       1' * {SIZE // 8}, 1)",
    "channels": f"{COSMOS!r}.replace('Sta Chan  1:', 'Sta ' + 'Chan 1' * {SIZE // 6} + ' ' * {SIZE})",
    "channel in a comment": f"{COSMOS!r}.replace('| Sensor', '|<SCNL>' + 'A' * {SIZE} + '. Sensor')",
    "text of CSMIP": f"{CSMIP!r}.replace(' ACCEL DATA', ' ' * {SIZE}).replace('UNITS', 'UNITS' * {SIZE // 5})",
    "blanks of CSMIP": f"{CSMIP!r}.replace(' POINTS', ' ' * {SIZE}).replace('CHAN', 'CHAN' + ' ' * {SIZE})",
    "channels of CSMIP": f"{CSMIP!r} * 50 + '/&\\n' * {SIZE // 3}",
    "numbers of SMC": f"{SMC!r}.replace('1.2125E+1', '1' * {SIZE})",
    "text of SMC": f"{SMC!r}.replace('component=', 'component' * {SIZE // 9} + ' ' * {SIZE} + '=')",
    "labels of K-NET": f"'#K-NET CSV\\n' + '#N-S(' * {SIZE // 5} + '\\n#0\\n' + '(' * {SIZE} + ')\\n1,2'",
    "table of JMA": f"'SITE CODE=' + '=' * {SIZE} + '\\nUNIT=' + '(' * {SIZE} + '\\nSAMPLING RATE=100Hz\\nN\\n1\\n'",
    "first lines": f"('file:' + ' ' * {SIZE} + '\\n') * 20 + '1\\n2\\n3\\n'",
    "codes": f"{COSMOS!r}.replace('Code:', 'Code:' * {SIZE // 5})",
    "labels of a table": f"'file,units' + ',m' * {SIZE // 2} + '{ROWS}'",
    "numbers with a comma": f"'{HEADER}\\n' + '1' * {SIZE // 2} + ',x' + '1' * {SIZE // 2} + '\\n'",
}


def test_close_peaks_agree(tmp_path):
    for peak in (12.125, -12.125, 12.2, 0.0):
        (tmp_path / "a.asc").write_text(esm(PGA_CM_S_2=str(peak)))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            assert rf.read_motion(tmp_path / "a.asc").pga == 0.12125


@pytest.mark.parametrize("read", [rf.read_motion, rf.read_components, lambda file: rf.read_suite([file])])
def test_a_peak_that_differs_a_little_is_told(tmp_path, read):
    (tmp_path / "a.asc").write_text(esm(PGA_CM_S_2="13.0"))
    said = (
        r"a\.asc: the header states a PGA of 0\.13 m/s², but the samples reach 0\.12125 m/s², and 0\.117969 m/s² when "
        r"their mean is subtracted\.$"
    )
    with pytest.warns(rf.RecordWarning, match=said) as caught:
        read(tmp_path / "a.asc")
    assert [each.filename for each in caught] == [__file__]


def test_a_peak_that_differs_much_is_refused(tmp_path):
    (tmp_path / "a.asc").write_text(esm(PGA_CM_S_2="24.25"))
    with pytest.raises(rf.InputError, match=r"a\.asc: the header states .* 0\.2425 m/s².* A wrong scale or a changed"):
        rf.read_motion(tmp_path / "a.asc")
    (tmp_path / "a.ns").write_text(knet(peak=1.0))
    with pytest.raises(rf.InputError, match=r"PGA of 0\.01 m/s², .* reach 0\.00152165 m/s² \(mean subtracted\)"):
        rf.read_motion(tmp_path / "a.ns")


def test_a_mean_that_explains_the_difference_is_named(tmp_path):
    shifted = [each + 30.0 for each in SAMPLES]
    mean = sum(shifted) / len(shifted)
    peak = max(abs(each - mean) for each in shifted)
    (tmp_path / "a.v1").write_text(cosmos(samples=shifted, reals={64: peak}))
    with pytest.warns(rf.RecordWarning, match=r"mean is subtracted, which was not done: .*baseline_corrected"):
        motion = rf.read_motion(tmp_path / "a.v1")
    assert motion.pga == pytest.approx(0.42125)


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["txt", "at2"])
def test_crafted_text(tmp_path, suffix):
    command = [sys.executable, "-c", READ, str(tmp_path), json.dumps(CRAFTED), suffix]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=True)
    except subprocess.TimeoutExpired as error:
        pytest.fail(f"A reader is still busy after {PATIENCE:g} s with {(error.stdout or b'').decode()[-100:]!r}")
    said = dict(line.split(": ", 1) for line in done.stdout.splitlines())
    assert said.keys() == CRAFTED.keys()
    assert all(word.startswith(("read", "refused")) for word in said.values())
    assert said["a few digits too many"].startswith("refused")
