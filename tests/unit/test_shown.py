"""Values in messages: in full where they are short, and never long."""

import functools
import re
import time

import numpy as np
import pytest

from rockflex import InputError, SolverError
from rockflex.foundation.checks import (
    checked_finite,
    checked_finite_matrix,
    checked_finite_vector,
    checked_in_range,
    checked_instance,
    checked_positive,
    checked_whole_number,
)
from rockflex.foundation.files import checked_file_path
from rockflex.foundation.shown import number_with_noun, shortened, shown


@pytest.mark.parametrize(
    "value",
    [1.5, -0.0, True, None, "word", 10**30, [1.0, 2.0], (1,), {"b": 1, "a": {"c": [2]}}, {3}, np.float64(2.0), b"x"],
)
def test_short_values_are_written_as_they_are(value: object) -> None:
    assert shown(value) == repr(value)


class Plain:
    def method(self) -> None: ...


def enclosed() -> tuple[object, object]:
    class Inner: ...

    return Inner(), lambda: None


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (Plain(), "Plain"),
        (enclosed, "enclosed"),
        (enclosed()[0], "Inner"),
        (enclosed()[1], "<lambda>"),
        ([Plain(), 1], "[Plain, 1]"),
        (Plain().method, "<bound method Plain.method of Plain>"),
        (("<a at 0x12>", 3), "('<a at 0x12>', 3)"),
    ],
)
def test_nothing_is_named_by_its_place_in_memory(value: object, text: str) -> None:
    assert shown(value) == text


def test_addresses_are_not_cut_in_half() -> None:
    for width in range(120, 160):
        assert "0x" not in shown(functools.partial(enclosed, "x" * width, Plain()))


class Endless:
    def __repr__(self) -> str:
        raise RecursionError


def test_long_values_are_cut() -> None:
    loop: list[object] = []
    loop.append(loop)
    begin = time.perf_counter()
    for value in ("x" * 10**7, list(range(10**6)), np.zeros(10**6), {"k" * 10**6: "v" * 10**6}, loop, Endless()):
        assert len(shown(value)) <= 160
    assert shown([["deep", [["er"]]]] * 30).startswith("[['deep', [[...]]], [")
    assert shown({n: n for n in range(99)}).endswith("11: 11, ...}")
    assert time.perf_counter() - begin < 1.0
    assert shown("ab" * 200).startswith("'abab")
    assert shown("ab" * 200).endswith("abab'")


@pytest.mark.parametrize("sign", [1, -1])
def test_integers_that_python_does_not_write(sign: int) -> None:
    assert shown(sign * 10**5000) == "an integer of about 5000 digits"


def test_text_keeps_both_ends() -> None:
    assert shortened("short", 20) == "short"
    assert shortened("0123456789" * 9, 26) == "0123456789 ... 0123456789"


@pytest.mark.parametrize("kind", [InputError, SolverError])
def test_messages_end(kind: type[Exception]) -> None:
    text = str(kind("file " + "x" * 10**6 + " mend it."))
    assert len(text) < 2000
    assert text.startswith("file xxx")
    assert text.endswith("xxx mend it.")


HUGE = 10**400


@pytest.mark.parametrize(
    ("check", "message"),
    [
        (lambda: checked_positive("a", HUGE, "m"), "a number in m, but an integer of about 400 digits was given."),
        (lambda: checked_positive("a", 1j, "m"), "a number in m, but 1j was given."),
        (lambda: checked_positive("a", np.ones(1), "m"), "a number in m, but array([1.]) was given."),
        (lambda: checked_finite("a", HUGE, "m"), "a finite number in m, but an integer of about 400 digits was given."),
        (
            lambda: checked_in_range("a", -(10**5000), 0.0, 1.0),
            "a number, but an integer of about 5000 digits was given.",
        ),
        (lambda: checked_whole_number("a", HUGE, 1, 9), "from 1 to 9, but an integer of about 400 digits was given."),
        (lambda: checked_finite_vector("a", [1.0, HUGE], "m"), "list with a number too large for double precision was"),
        (lambda: checked_finite_vector("a", np.ones(2) * 1j, "m"), "but ndarray of complex numbers was given."),
        (lambda: checked_finite_vector("a", np.zeros(2, "M8[D]"), "m"), "but ndarray was given."),
        (
            lambda: checked_finite_matrix("a", [[1.0], [1.0, 2.0]], "m", (2, 2)),
            "but list whose rows differ in length was",
        ),
        (lambda: checked_instance("a", InputError, str), "of type str, but the class InputError was given."),
        (lambda: checked_instance("a", 1, str), "of type str, but int was given."),
        (lambda: checked_file_path("path", 1), "path must be a path, but int was given."),
        (lambda: checked_file_path("path", "a\0b"), "but 'a\\x00b' was given: a path cannot contain a null character."),
        (lambda: checked_file_path("path", "\ud800"), "but '\\ud800' was given: it contains a character that is not"),
    ],
)
def test_messages(check: object, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        check()


def test_a_path_too_long() -> None:
    with pytest.raises(InputError, match=r"^path must be a valid path, but 'xxx.*x' was given: File name too long"):
        checked_file_path("path", "x" * 10**5)


def test_a_number_has_its_noun_in_the_right_form():
    assert [number_with_noun(n, "record") for n in (0, 1, 2)] == ["0 records", "1 record", "2 records"]
    assert [number_with_noun(n, "entry", "entries") for n in (1, 3)] == ["1 entry", "3 entries"]
