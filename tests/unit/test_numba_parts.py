"""Private parts of numba: the versions that have them, and that kernels say the same without any of them."""

import math
import tomllib
from pathlib import Path

import numba
import numpy as np
import pytest

from rockflex import _numba
from rockflex._kernel import Callback, Entry, sources_digest
from rockflex.solve.batch import run_all

VERSION = ".".join(numba.__version__.split(".")[:2])


@pytest.fixture(autouse=True)
def _a_cache_of_its_own(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))


def missing():
    """Private parts that the installed version lacks, or has elsewhere."""
    parts = {
        "an option _nrt, without which kernels count references and run slower": hasattr(
            getattr(getattr(run_all, "targetdescr", None), "options", None), "_nrt"
        ),
        "a source stamp, without which kernels compile anew in every process": hasattr(
            getattr(getattr(run_all, "_cache", None), "_cache_file", None), "_source_stamp"
        ),
        "a pipeline to change, without which kernels compile for four times as long and run slower": bool(
            _numba.PIPELINE and _numba.ENTRY
        ),
        "an entry point, without which every call looks at all its arguments": direct_entry_is_had(),
    }
    return [name for name, there in parts.items() if not there]


def direct_entry_is_had():
    kernel, given = _numba.compiled(doubled, "stamp"), (np.ones(2),)
    kernel(*given)
    return _numba.direct(kernel, given) is not kernel


def doubled(x):
    for i in range(x.size):
        x[i] *= 2.0
    return x.size


def swing(omega, zeta, t):
    damped = omega * math.sqrt(1 - zeta * zeta)
    return math.exp(-zeta * omega * t) * math.sin(damped * t) / damped, math.hypot(omega, t)


def for_kernels(function, _stamp):
    return _numba.compiled_within(function, inlined=False)


FOR_ALL = pytest.mark.parametrize("compiled", [_numba.compiled, for_kernels])


def says_the_same(kernel):
    ours = (6.0, 0.05, 0.3)
    return kernel(*ours) == pytest.approx(swing(*ours), rel=1e-12)


NEEDS_PARTS = pytest.mark.skipif(
    not _numba.KNOWN,
    reason=f"numba {VERSION} has not been tried. Add it to TRIED in src/rockflex/_numba.py, run all tests, and mend "
    "what it lacks.",
)


@NEEDS_PARTS
def test_versions_that_were_tried_have_every_part():
    assert missing() == []


@pytest.mark.parametrize("version", ["0.60.0", "0.69.0", "1.0.0", "0.6.0", "0.680.0", "0.70.0dev0+12"])
def test_a_version_that_was_not_tried_gets_no_private_part(version):
    assert not _numba.is_tried(version)


def test_the_installer_takes_no_version_after_the_last_one_tried():
    """Otherwise a new numba would be installed, and kernels would compile slowly, in every process again."""
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))["project"]
    (bounds,) = [each for each in project["dependencies"] if each.startswith("numba")]
    first, last = _numba.TRIED[0], int(_numba.TRIED[-1].split(".")[1])
    assert bounds == f"numba>={first},<0.{last + 1}"


@FOR_ALL
def test_with_a_version_that_was_not_tried_only_documented_options_are_given(monkeypatch, compiled):
    given = []

    def watched(**options):
        given.append(options)
        return numba.njit(**options)

    monkeypatch.setattr(_numba, "KNOWN", False)
    monkeypatch.setattr(_numba, "njit", watched)
    kernel = compiled(swing, "untried")
    assert given == [_numba.OPTIONS]
    assert type(kernel).__module__.startswith("numba.")  # no class of ours in place of numba's
    assert _numba.direct(kernel, (6.0, 0.05, 0.3)) is kernel
    assert says_the_same(kernel)


def test_the_cache_is_stamped_with_every_kernel_source():
    file = getattr(getattr(run_all, "_cache", None), "_cache_file", None)
    if not hasattr(file, "_source_stamp"):
        assert run_all.stats.cache_path is None  # nothing is kept that could be out of date
    else:
        assert file._source_stamp[1] == sources_digest()


def options_of_numba():
    return [each for each in type(run_all).targetdescr.options.__mro__ if "_nrt" in vars(each)]


@FOR_ALL
def test_without_the_option_kernels_count_references(monkeypatch, compiled):
    """As numba is today, which refuses an option that it does not know at the first call."""
    for each in options_of_numba():
        monkeypatch.delattr(each, "_nrt")
    kernel = compiled(swing, "without the option")
    assert "_nrt" not in kernel.targetoptions
    assert says_the_same(kernel)


@FOR_ALL
@pytest.mark.parametrize("option", ["_nrt", "no_cpython_wrapper", "forceinline", "pipeline_class"])
def test_an_option_that_is_refused_at_once_is_not_given(monkeypatch, option, compiled):
    def refuses(**options):
        if option in options:
            message = f"got an unexpected keyword argument {option!r}"
            raise TypeError(message)
        return numba.njit(**options)

    monkeypatch.setattr(_numba, "njit", refuses)
    kernel = compiled(doubled, "refused")
    assert kernel.targetoptions["nogil"]
    assert (kernel.stats.cache_path is not None) == (compiled is _numba.compiled)
    assert kernel(np.ones(3)) == 3


def without_stamp(kernel):
    kernel._cache._cache_file = object()


def without_cache_file(kernel):
    kernel._cache = None


@FOR_ALL
@pytest.mark.parametrize("take_away", [without_stamp, without_cache_file])
def test_without_a_stamp_nothing_is_kept_on_disk(monkeypatch, take_away, compiled):
    def later(**options):
        def decorate(function):
            kernel = numba.njit(**options)(function)
            if options.get("cache"):
                take_away(kernel)
            return kernel

        return decorate

    monkeypatch.setattr(_numba, "njit", later)
    kernel = compiled(swing, "stamp")
    assert kernel.stats.cache_path is None
    assert kernel.targetoptions["_nrt"] is False
    assert says_the_same(kernel)


@FOR_ALL
def test_without_a_folder_to_write_nothing_is_kept_on_disk(monkeypatch, compiled):
    def homeless(**options):
        if options.get("cache"):
            message = "cannot cache function 'doubled': no locator available for file 'kernel.py'"
            raise RuntimeError(message)
        return numba.njit(**options)

    monkeypatch.setattr(_numba, "njit", homeless)
    kernel = compiled(doubled, "stamp")
    assert kernel.stats.cache_path is None
    assert kernel(np.ones(3)) == 3


class WithoutEntryPoint:
    """A compiled function of another numba, whose overloads are of another kind."""

    def __init__(self):
        self.calls = 0
        self.overloads = {"float64": object()}

    def __call__(self, x):
        self.calls += 1
        return 2.0 * x


def test_without_an_entry_point_the_kernel_itself_is_called():
    kernel = WithoutEntryPoint()
    entry = Entry(kernel)
    assert [entry(1.0), entry(2.0), entry(3.0)] == [2.0, 4.0, 6.0]
    assert kernel.calls == 3


def test_a_kernel_of_several_types_has_one_entry_for_each():
    kernel = _numba.compiled(doubled, "two")
    plain, strided = (np.ones(2),), (np.ones(4)[::2],)
    kernel(*plain)
    first = _numba.direct(kernel, plain)
    assert first is not kernel
    assert _numba.direct(kernel, strided) is kernel  # not compiled for these yet
    kernel(*strided)
    second = _numba.direct(kernel, strided)
    assert second is not kernel
    assert second is not first
    assert _numba.direct(kernel, plain) is first
    assert [first(*plain), second(*strided)] == [2, 2]
    assert plain[0].tolist() == strided[0].tolist() == [4.0, 4.0]


def test_a_kernel_for_other_kernels_can_be_called_by_all():
    """It has no way in of its own, through which Python would crash; one is compiled at its first call."""
    inner = _numba.compiled_within(doubled, inlined=False)
    assert inner.targetoptions["no_cpython_wrapper"]
    first, second = np.ones(3), np.ones(4)[::2]
    assert [inner(first), inner(second), inner(first)] == [3, 2, 3]
    assert (first.tolist(), second.tolist()) == ([4.0] * 3, [2.0] * 2)

    def twice(x):
        return inner(x) + inner(x)

    outer = _numba.compiled(twice, "outer")
    third = np.ones(2)
    assert outer(third) == 4
    assert third.tolist() == [4.0, 4.0]


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize("pipeline", [True, False])
@pytest.mark.parametrize("inlined", [True, False])
def test_kernels_compute_the_same_however_they_are_compiled(monkeypatch, whole, pipeline, inlined):
    if not pipeline:
        monkeypatch.setattr(_numba, "PIPELINE", {})
    if not whole:
        monkeypatch.setattr(_numba, "ENTRY", {})
    inner = _numba.compiled_within(doubled, inlined=inlined)

    def thrice(x):
        return inner(x) + inner(x) + inner(x)

    middle = _numba.compiled_within(thrice, inlined=inlined)
    outer = _numba.compiled(lambda x: middle(x), "whole")
    x = np.ones(2)
    assert outer(x) == 6
    assert x.tolist() == [8.0, 8.0]
    assert inner(x) == 2  # after it was compiled into others
    assert x.tolist() == [16.0, 16.0]


def test_only_the_whole_is_made_into_machine_code():
    inner = _numba.compiled_within(doubled, inlined=False)
    outer = _numba.compiled(lambda x: inner(x), "outer")
    outer(np.ones(2))
    (part,), (whole,) = inner.overloads.values(), outer.overloads.values()
    assert whole.library.get_pointer_to_function(whole.fndesc.llvm_cpython_wrapper_name)
    assert not part.library.get_pointer_to_function(part.fndesc.llvm_func_name)


def calls(function, address, count):
    return function(address, count)


def test_a_callback_is_called_by_kernels_and_by_python():
    callback = Callback(lambda address, count: int(address) + 10 * count)
    assert callback(3, 4) == 43
    kernel = _numba.compiled(calls, "callback")
    assert kernel(callback, np.uint64(3), 4) == 43
    assert kernel(Callback(lambda _address, _count: 1), np.uint64(3), 4) == 1
    assert len(kernel.overloads) == 1  # all callbacks are of one type
