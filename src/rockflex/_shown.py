"""What was given, as a message repeats it: in full where it is short, and never longer than a line or two."""

import math
import reprlib
from itertools import islice

WIDTH = 160  # characters of a value


def shown(value: object) -> str:
    """Return `value` as Python writes it, without its middle where that is long; at once even where it is huge."""
    return shortened(_SHORT.repr(value), WIDTH)


def shortened(text: str, most: int = WIDTH) -> str:
    """Return `text`, without its middle where it is longer than `most` characters."""
    half = most // 2 - 3
    return text if len(text) <= most else f"{text[:half]} ... {text[-half:]}"


class _Short(reprlib.Repr):
    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxlist, self.maxtuple, self.maxdict, self.maxset = 3, 12, 12, 12, 12
        self.maxstring = self.maxother = WIDTH

    def repr_dict(self, x: dict[object, object], level: int) -> str:
        """The base class sorts the keys, which is not how they were written."""
        items = [f"{self.repr1(k, level - 1)}: {self.repr1(v, level - 1)}" for k, v in islice(x.items(), self.maxdict)]
        more = ["..."] if len(x) > self.maxdict else []
        return f"{{{', '.join([*items, *more])}}}" if level > 0 else "{...}"

    def repr_int(self, x: int, level: int) -> str:
        digits = round(x.bit_length() * math.log10(2.0))  # Python refuses to write more than some thousands of them
        return f"an integer of about {digits} digits" if digits > self.maxlong else super().repr_int(x, level)


_SHORT = _Short()
