"""The peak that a header states, against the samples."""

import warnings

import pytest

import rockflex as rf
from record_samples import SAMPLES, cosmos, esm, knet


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
