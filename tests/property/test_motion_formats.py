"""What is written in the format of a network comes back."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import rockflex as rf
from record_samples import cosmos, csmip, esm, geonet, knet, smc

pytestmark = pytest.mark.filterwarnings("ignore:.*about 1 g")  # of samples at random
SETTINGS = settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
SAMPLES = st.lists(st.floats(-900.0, 900.0).map(lambda value: round(value, 3)), min_size=3, max_size=40)


@SETTINGS
@given(counts=st.lists(st.integers(-(2**23), 2**23), min_size=3, max_size=40), full=st.sampled_from([980, 2000, 2400]))
def test_knet(tmp_path, counts, full):
    file = tmp_path / "a.ns"
    file.write_text(knet(counts=counts, scale=f"{full}(gal)/8388608"))
    # At most 4.9 g about the mean: above 5 g the unit is questioned.
    gal = (np.array(counts) - np.mean(counts)) * full / 8388608
    assert np.abs(rf.read_motion(file).acceleration - 0.01 * gal).max() <= 1e-12 * full


@SETTINGS
@given(samples=SAMPLES)
def test_esm(tmp_path, samples):
    file = tmp_path / "a.asc"
    file.write_text(esm(samples))
    assert rf.read_motion(file).acceleration.tolist() == [each * 0.01 for each in samples]


@SETTINGS
@given(samples=SAMPLES, form=st.sampled_from([(8, "F10.3"), (1, "F12.4"), (6, "F9.3"), (5, "E15.6")]))
def test_cosmos(tmp_path, samples, form):
    file = tmp_path / "a.v2"
    file.write_text(cosmos(samples=samples, form=form) + cosmos(400, samples, form=form))
    first, second = rf.read_components(file)
    # Seven digits of the exponential form.
    assert np.abs(first.acceleration - 0.01 * np.array(samples)).max() <= 1e-6 * 9.0
    assert np.array_equal(first.acceleration, second.acceleration)


@SETTINGS
@given(samples=SAMPLES, corrected=st.booleans())
def test_geonet(tmp_path, samples, corrected):
    file = tmp_path / "a.v2a"
    file.write_text(geonet("N30E", samples, corrected=corrected) + geonet("Up", samples, corrected=corrected))
    first, second = rf.read_components(file)
    assert first.acceleration.tolist() == [each * 1e-3 for each in samples]
    assert np.array_equal(first.acceleration, second.acceleration)


@SETTINGS
@given(samples=SAMPLES, volume=st.sampled_from([1, 2]))
def test_csmip(tmp_path, samples, volume):
    file = tmp_path / "a.v2"
    written = {"volume": volume, "text_unit": "IS CM/SEC/SEC"}
    file.write_text(csmip("90 DEG", samples, **written) + csmip("UP", samples, **written))
    first, second = rf.read_components(file)
    assert first.acceleration.tolist() == [each * 0.01 for each in samples]
    assert np.array_equal(first.acceleration, second.acceleration)


@SETTINGS
@given(samples=SAMPLES)
def test_smc(tmp_path, samples):
    file = tmp_path / "a.smc"
    file.write_text(smc(samples))
    # Five digits are written.
    assert np.abs(rf.read_motion(file).acceleration - 0.01 * np.array(samples)).max() <= 5e-5 * 9.0


@SETTINGS
@given(
    samples=SAMPLES,
    separator=st.sampled_from([";", "\t", " ", " ; "]),
    labels=st.sampled_from(["", "# Messung\n", "Zeit (s){}a (cm/s2)\n"]),
)
def test_decimal_commas(tmp_path, samples, separator, labels):
    rows = [f"{0.005 * k:.3f}{separator}{each!r}".replace(".", ",") for k, each in enumerate(samples)]
    file = tmp_path / "a.txt"
    file.write_text(labels.format(separator) + "\n".join(rows) + "\n")
    motion = rf.read_motion(file, units="cm/s2")
    assert motion.acceleration.tolist() == [each * 0.01 for each in samples]
    assert motion.dt == 0.005
