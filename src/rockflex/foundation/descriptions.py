"""Descriptions of arguments, said once, where the argument is: words, unit, rule, range and note.

    height: Annotated[float, Described("the height above the base", "m", rule="positive", low=0.01, high=2000.0)]

`described` makes the check of the value and the entry of the docstring; tables of files, flags and forms read it too.
"""

import inspect
import math
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, fields, is_dataclass
from functools import partial, wraps
from textwrap import TextWrapper
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, cast, get_args, get_origin, get_type_hints, overload

from rockflex.foundation.errors import InputError

NUMBER, WHOLE, PLAIN = "{}, a number{unit}", "{}, a whole number", "{}"
FLAG = "true or false: {}"

Rule = Literal[
    "positive",
    "zero or positive",
    "zero, positive or infinite",
    "finite",
    "from 0 to below 1",
    "from 0 to 1",
    "flag",
    "whole",
    "row",
]
Made = TypeVar("Made", bound=Callable[..., Any])
Judge = Callable[[Any], Any]


@dataclass(frozen=True)
class Described:
    """The description of an argument, inside ``Annotated``; its name, type and default are those of the argument.

    Attributes
    ----------
    description
        Completes the sentence "it must be ...".
    unit
        SI unit, or empty.
    rule
        The check of a single value, which words its message; empty where the class or function has its own.
    within
        Smallest and largest value of the rule "whole".
    remedy
        What a message says after what was given.
    note
        What the docstring says after description, unit and rule.
    form
        How the value is written, with the description in place of ``{}`` and " in <unit>" in place of ``{unit}``. Empty
        for that of the type.
    in_file
        The type of the value in a file, where Python takes others; False for what no file holds.
    label
        The name in a form, where it is not the key itself.
    low, high
        The smallest and the largest number that the page accepts; None for any of a reasonable size.
    flag, metavar
        The option and its placeholder on the command line, where they are not the key and its unit.
    page
        What the page says in place of `expected`, where a file may hold what a form cannot.
    hint
        What the help of the option says besides the description, the unit and the default.
    """

    description: str
    unit: str = ""
    rule: Rule | Literal[""] = field(default="", kw_only=True)
    within: tuple[int, int | None] = field(default=(1, None), kw_only=True)
    remedy: str = field(default="", kw_only=True)
    note: str = field(default="", kw_only=True)
    form: str = field(default="", kw_only=True)
    in_file: Any = field(default=None, kw_only=True)
    label: str = field(default="", kw_only=True)
    low: float | None = field(default=None, kw_only=True)
    high: float | None = field(default=None, kw_only=True)
    flag: str = field(default="", kw_only=True)
    metavar: str = field(default="", kw_only=True)
    hint: str = field(default="", kw_only=True)
    page: str = field(default="", kw_only=True)

    @property
    def expected(self) -> str:
        """Return the description of a valid value, and its form in a file."""
        return (self.form or NUMBER).format(self.description, unit=self.unit and f" in {self.unit}")

    @property
    def sentence(self) -> str:
        """Return the description with unit, range and note, for a docstring."""
        words = self.description
        begins = words[:1].upper() if words[:2].isalpha() or words[1:2] == " " else words[:1]  # not γ, EI or h*_1
        unit = f", in {self.unit}" if self.unit and f" in {self.unit}" not in words else ""
        low, high = self.within
        span = f", from {low} to {high}" if high else f", at least {low}"
        ranges = {"whole": span, "finite": "", "flag": "", "row": "", "": ""}.get(self.rule, f", {self.rule}")
        return f"{begins}{words[1:]}{unit}{ranges}.{self.note and f' {self.note}'}"

    def judge(self, name: str) -> tuple[type, float, float, Judge]:
        """Return a type and the open range of values that pass as they are, and the check of all others.

        The check returns the value, converted if need be, or raises an `InputError`.
        """
        from rockflex.foundation import checks  # it loads NumPy, which helps and lists of options must not wait for

        judges: dict[str, Judge] = {
            "positive": partial(checks.checked_positive, name, unit=self.unit),
            "zero or positive": partial(checks.checked_positive, name, unit=self.unit, zero=True),
            "zero, positive or infinite": partial(
                checks.checked_positive, name, unit=self.unit, zero=True, infinite=True
            ),
            "finite": partial(checks.checked_finite, name, unit=self.unit),
            "from 0 to below 1": partial(checks.checked_in_range, name, low=0.0, high=1.0),
            "from 0 to 1": partial(checks.checked_in_range, name, low=0.0, high=1.0, closed=True),
            "flag": partial(checks.checked_instance, name, kind=bool),
            "whole": partial(checks.checked_whole_number, name, low=self.within[0], high=self.within[1]),
            "row": partial(checks.checked_row, name),
        }
        judge = judges[self.rule]
        if self.rule == "flag":
            return bool, -1, 2, judge
        if self.rule == "whole":
            return int, self.within[0] - 1, math.inf if self.within[1] is None else self.within[1] + 1, judge
        return float, *_RANGES.get(self.rule, (math.nan, math.nan)), _with_remedy(judge, self.remedy)


_WRAPPED = TextWrapper(116, initial_indent="    ", subsequent_indent="    ", break_on_hyphens=False)
_HEADING = re.compile(r"\n\w++\n---++\n")
_BELOW_ZERO = math.nextafter(0.0, -1.0)
_RANGES: dict[str, tuple[float, float]] = {
    "positive": (0.0, math.inf),
    "zero or positive": (_BELOW_ZERO, math.inf),
    "finite": (-math.inf, math.inf),
    "from 0 to below 1": (_BELOW_ZERO, 1.0),
    "from 0 to 1": (_BELOW_ZERO, math.nextafter(1.0, 2.0)),
}
"""The open range of numbers that a rule takes as they are."""


def _with_remedy(judge: Judge, remedy: str) -> Judge:
    if not remedy:
        return judge

    def judged(value: Any) -> Any:
        try:
            return judge(value)
        except InputError as error:
            raise InputError(f"{error} {remedy}", field=error.field) from error

    return judged


def one_for_each(what: str) -> str:
    """Return the form of a number, or of one for each of many."""
    return f"{{}}, a number or one for each {what}"


def described_arguments(made: Any) -> dict[str, Described]:
    """Return what is known of the arguments of a class or function by their names, in their order.

    Of a dataclass that is not `described` it may be the metadata of the fields.
    """
    found = _annotated(get_type_hints(_own(made), include_extras=True))
    if is_dataclass(made) and made not in _DESCRIBED:
        for each in fields(made):
            if each.name not in found and each.init:
                told: dict[str, Any] = {"description": each.name, **each.metadata}
                found[each.name] = Described(**told)
    parameters = inspect.signature(cast("Callable[..., Any]", made)).parameters
    ordered = {name: found[name] for name in parameters if name in found}
    return ordered | ({} if isinstance(made, type) else found)


_DESCRIBED: set[Any] = set()


def is_described(made: Any) -> bool:
    """Return whether a class or function is `described`."""
    return made in _DESCRIBED


def _own(made: Any) -> Any:
    return made if isinstance(made, type) else inspect.unwrap(made)


def _annotated(hints: dict[str, Any]) -> dict[str, Described]:
    found: dict[str, Described] = {}
    for name, hint in hints.items():
        if get_origin(hint) is Annotated:
            found.update((name, part) for part in get_args(hint)[1:] if isinstance(part, Described))
        elif members := [part for part in get_args(hint) if hasattr(part, "__total__")]:  # **place: Unpack[Place]
            found |= _annotated(get_type_hints(members[0], include_extras=True))
    return found


@overload
def described(made: Made) -> Made: ...
@overload
def described(*, title: str) -> Callable[[Made], Made]: ...
def described(made: Any = None, *, title: str = "") -> Any:
    """Check the arguments of a dataclass or function by what is known of them, and tell it in the docstring.

    A dataclass needs a `__post_init__`, perhaps an inherited one, which is called after these checks: what one value
    says of another is checked there. `title` is the name of a function in the list of a form.
    """
    if made is None:
        return partial(described, title=title)
    _DESCRIBED.add(made)
    known, parameters, is_class = described_arguments(made), inspect.signature(made).parameters, isinstance(made, type)
    made.__doc__ = _with_entries(made, known, "Attributes" if is_class else "Parameters")
    judged = {name: each for name, each in known.items() if each.rule and name in parameters}
    checks = [(name, *_optional(each.judge(name), parameters[name].default is None)) for name, each in judged.items()]
    if is_class and made.__dataclass_params__.init:
        made.__post_init__ = _checking_fields(made, checks)
        made.__init__.__annotations__ = {  # as help shows them
            name: _without_extras(hint) for name, hint in made.__init__.__annotations__.items()
        }
    elif is_class:
        made.__init__ = _checking_arguments(made.__init__, checks)
    else:
        made = _checking_arguments(made, checks)
        made.title = title
        _DESCRIBED.add(made)
    return made


Check = tuple[str, type, float, float, Judge]


def _optional(judged: tuple[type, float, float, Judge], optional: bool) -> tuple[type, float, float, Judge]:
    kind, above, below, judge = judged
    return kind, above, below, (lambda value: None if value is None else judge(value)) if optional else judge


def _checking_fields(made: Any, checks: Iterable[Check]) -> Callable[[Any], None]:
    given: Callable[[Any], None] | None = getattr(made, "__post_init__", None)
    if given is None:
        raise TypeError(f"{made.__name__} needs a __post_init__, which its __init__ calls; it may do nothing.")
    # An inherited one has checks of its own, which are among these.
    own = given if "__post_init__" in vars(made) else getattr(given, "__wrapped__", given)

    @wraps(own)
    def check(self: Any) -> None:
        values = vars(self)
        for name, kind, above, below, judge in checks:
            value = values[name]
            if not (type(value) is kind and above < value < below):
                values[name] = judge(value)
        own(self)

    return check


def _checking_arguments(made: Callable[..., Any], checks: Iterable[Check]) -> Any:
    signature = inspect.signature(made)
    places = {name: place for place, name in enumerate(signature.parameters)}
    placed = [(places[name], name, *rest) for name, *rest in checks]

    @wraps(made)
    def checked(*args: Any, **named: Any) -> Any:
        first = list(args)
        for place, name, kind, above, below, judge in placed:
            held, key = (first, place) if place < len(first) else (named, name)
            if held is named and name not in named:
                continue
            value = held[key]  # pyright: ignore[reportArgumentType, reportCallIssue]
            if not (type(value) is kind and above < value < below):
                held[key] = judge(value)  # pyright: ignore[reportArgumentType, reportCallIssue]
        return made(*first, **named)

    plain = [each.replace(annotation=_without_extras(each.annotation)) for each in signature.parameters.values()]
    cast("Any", checked).__signature__ = signature.replace(parameters=plain)  # as help shows it
    return checked


def _with_entries(made: Any, known: dict[str, Described], heading: str) -> str | None:
    if made.__doc__ is None:  # as with python -OO
        return None
    text = inspect.cleandoc(made.__doc__)
    next_section = _HEADING.search(text)
    at = len(text) if next_section is None else next_section.start()
    hints = get_type_hints(_own(made))
    kinds = {name: _in_words(hints.get(name)) if heading == "Attributes" else "" for name in known}
    entries = [
        f"{name}{kinds[name] and f' : {kinds[name]}'}\n{_WRAPPED.fill(each.sentence)}" for name, each in known.items()
    ]
    return "\n".join([text[:at].rstrip(), "", heading, "-" * len(heading), *entries, text[at:]])


def _in_words(hint: Any) -> str:
    """Return a simple type as numpydoc has it; empty for others, which the signature shows."""
    members = get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,)
    names = {float: "float", int: "int", bool: "bool", str: "str", NoneType: "None"}
    return " or ".join(names[each] for each in members) if all(each in names for each in members) else ""


def _without_extras(hint: Any) -> Any:
    return get_args(hint)[0] if get_origin(hint) is Annotated else hint


def schema_keys(table: type) -> Iterator[tuple[str, Any, Described]]:
    """Yield the name, the type and what is known of each field of a class whose annotations say it."""
    kinds = get_type_hints(table)
    for name, key in _annotated(get_type_hints(table, include_extras=True)).items():
        yield name, kinds[name], key
