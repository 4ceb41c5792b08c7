"""Printing: tables on stdout, everything else on stderr."""

import math
import warnings
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, Self

from rockflex.foundation.errors import RecordWarning
from rockflex.foundation.units import with_decimal_commas
from rockflex.studies.progress import progress_bar, progress_counter

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table


_DECIMAL_COMMA = ContextVar("decimal_comma", default=False)


def choose_decimal_comma(chosen: bool) -> bool:
    """Print decimal commas from here to the end of the command, if they are chosen."""
    _DECIMAL_COMMA.set(chosen)
    return chosen


def _printed(text: str) -> str:
    return with_decimal_commas(text) if _DECIMAL_COMMA.get() else text


def print_error(message: str) -> None:
    """Print an error to stderr as one paragraph."""
    from rich.console import Console
    from rich.text import Text

    text = Text.assemble(("Error: ", "bold red"), " ".join(message.split()))
    Console(stderr=True).print(text, soft_wrap=True)


def print_remark(message: str) -> None:
    """Print a remark to stderr."""
    from rich.console import Console

    Console(stderr=True).print(message, markup=False, highlight=False, soft_wrap=True)


def print_warnings(messages: Iterable[str]) -> None:
    """Print warnings to stderr."""
    for message in messages:
        print_remark(_printed(f"Warning: {message}"))


@contextmanager
def printing_warnings_as_remarks() -> Generator[None]:
    """Print each warning about records once, as a remark."""
    told: set[str] = set()
    with warnings.catch_warnings():
        warnings.simplefilter("default", RecordWarning)
        elsewhere = warnings.showwarning

        def tell(message: Warning | str, category: type[Warning], *where: Any) -> None:
            if not issubclass(category, RecordWarning):
                elsewhere(message, category, *where)
            elif str(message) not in told:
                # Python itself forgets what it told whenever its filters change.
                told.add(str(message))
                print_remark(str(message))

        warnings.showwarning = tell
        yield


def print_line(text: str = "", style: str | None = None, *, wrap: bool = False) -> None:
    """Print text to stdout; long lines are broken at the width of the terminal only if `wrap` is set."""
    _stdout().print(_printed(text), style=style, markup=False, soft_wrap=not wrap)


def _stdout(width: int | None = None) -> "Console":
    from rich.console import Console

    return Console(width=width, highlight=False)


class StyledCell(str):
    """A cell of a table, and its style."""

    __slots__ = ("style",)
    style: str

    def __new__(cls, text: str, style: str) -> Self:
        cell = super().__new__(cls, text)
        cell.style = style
        return cell


def table(headings: Sequence[str], rows: Iterable[Sequence[str]], n_left: int = 1) -> "Table":
    """Return a table with `n_left` columns of words, aligned to the left, followed by columns of numbers."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    look: dict[str, Any] = {"box": box.SIMPLE_HEAD, "show_edge": False, "pad_edge": False, "collapse_padding": True}
    table = Table(**look)
    for place, heading in enumerate(headings):
        # The unit goes below the name, to keep the columns narrow.
        text = Text(heading.replace(" [", "\n[").replace("u_top ", "u_top\n"))
        table.add_column(text, justify="left" if place < n_left else "right", no_wrap=True, vertical="bottom")
    for row in rows:
        table.add_row(*(Text(_printed(cell), style=getattr(cell, "style", "")) for cell in row))
    return table


@contextmanager
def step_bar(title: str, total: int) -> Generator[Callable[[int], None]]:
    """Show a bar on stderr, or lines if it is no terminal; the yielded function advances it by a number of steps."""
    with progress_bar(title, transient=True) as show:
        yield progress_counter(lambda done, total: show(done, total, ""), total)


def table_fits(table: "Table") -> bool:
    """Tell whether a table fits the width of the terminal."""
    console = _stdout()
    return _table_width(console, table) <= console.width


def print_table(table: "Table") -> None:
    """Print a table in full, even where it is wider than the terminal."""
    console = _stdout()
    width = _table_width(console, table)
    (_stdout(width) if width > console.width else console).print(table)


def print_rows(headings: Sequence[str], rows: Iterable[Sequence[str]], n_left: int = 1) -> None:
    """Print a table of rows, as `table` makes it."""
    print_table(table(headings, rows, n_left))


def _table_width(console: "Console", table: "Table") -> int:
    return console.measure(table, options=console.options.update(width=100_000)).maximum


def number(value: float | None, digits: int = 4) -> str:
    """Write a number with `digits` significant digits, with an exponent only if it is very large or small."""
    if value is None or math.isnan(value):
        return "-"
    if value == 0.0 or math.isinf(value):
        return f"{value:g}"
    magnitude = math.floor(math.log10(abs(value)))
    if not -5 <= magnitude < 7:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - magnitude)}f}"
