"""Given values as quoted in messages: in full if short, and never longer than a line or two."""

import math
import os
import re
import reprlib
from collections.abc import Sequence
from itertools import islice

WIDTH = 160  # most characters of a value
FEW = 8  # texts that are all shown
# Objects without a repr of their own, and functions: a name, and where they are in memory, which tells nobody anything.
_AT_ADDRESS = re.compile(
    r"<(?:function )?+([^\s<]*+(?:<locals>[^\s<]*+)*+(?:<lambda>)?+)(?: object)?+ at 0x[0-9A-Fa-f]++>"
)
_ADDRESS = re.compile(r" at 0x[0-9A-Fa-f]++(?=>)")


def shown(value: object) -> str:
    """Return the repr of `value`, without the middle part if it is long; fast even for huge values."""
    return shortened(_SHORT.repr(value), WIDTH)


def shortened(text: str, most: int = WIDTH) -> str:
    """Return `text`, without the middle part if it is longer than `most` characters."""
    half = most // 2 - 3
    return text if len(text) <= most else f"{text[:half]} ... {text[-half:]}"


def path_shown(path: object) -> str:
    """Return a path as text that can be printed: bytes that are not UTF-8 as escapes, and without a long middle."""
    try:
        content = os.fsencode(path) if isinstance(path, str | bytes | os.PathLike) else str(path).encode()
    except UnicodeEncodeError:
        content = str(path).encode("utf-8", "backslashreplace")
    return shortened(content.decode("utf-8", "backslashreplace"))


def few_texts_shown(texts: Sequence[str]) -> str:
    """Return some texts separated by commas; of many the first four and the last two."""
    return ", ".join(texts if len(texts) <= FEW else [*texts[:4], "...", *texts[-2:]])


def first_texts_shown(texts: Sequence[str], most: int = 10) -> str:
    """Return some texts separated by commas; of many the first ones, and how many more there are."""
    more = f" and {len(texts) - most} more" if len(texts) > most else ""
    return ", ".join(texts[:most]) + more


def number_with_noun(n: int, one: str, several: str = "") -> str:
    """Return a number with its noun: 1 record, 2 records; `several` is the plural if it is not `one` with an s."""
    return f"{n} {one if n == 1 else several or f'{one}s'}"


class _ShortRepr(reprlib.Repr):
    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxlist, self.maxtuple, self.maxdict, self.maxset = 3, 12, 12, 12, 12
        self.maxstring = self.maxother = WIDTH

    def repr_dict(self, x: dict[object, object], level: int) -> str:
        """Return the repr with the keys in their original order; the base class sorts them."""
        items = [f"{self.repr1(k, level - 1)}: {self.repr1(v, level - 1)}" for k, v in islice(x.items(), self.maxdict)]
        more = ["..."] if len(x) > self.maxdict else []
        return f"{{{', '.join([*items, *more])}}}" if level > 0 else "{...}"

    def repr_instance(self, x: object, level: int) -> str:
        """Return the repr with names in the place of memory addresses."""
        del level
        try:
            text = repr(x)
        except Exception:
            return f"<{type(x).__name__} instance>"
        text, half = _ADDRESS.sub("", _AT_ADDRESS.sub(_own_name, text)), self.maxother // 2 - 2
        return text if len(text) <= self.maxother else f"{text[:half]}...{text[-half:]}"

    def repr_int(self, x: int, level: int) -> str:
        digits = round(x.bit_length() * math.log10(2.0))  # Python does not convert more than a few thousand digits
        return f"an integer of about {digits} digits" if digits > self.maxlong else super().repr_int(x, level)


def _own_name(found: re.Match[str]) -> str:
    return found[1].rpartition(".")[2]


_SHORT = _ShortRepr()
