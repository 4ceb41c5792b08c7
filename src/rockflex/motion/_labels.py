"""Labels of columns: quantity, unit and component."""

import re
from dataclasses import dataclass
from typing import Literal

from rockflex.motion._record_info import HORIZONTAL_NAME, VERTICAL_NAME
from rockflex.motion._units import BRACKET, Quantity, Unit, end_of_last_bracket, parse_unit

Kind = Quantity | Literal["row number", "period", "component", "other", "unknown"]
# The last character of a label may be a number, as in acc1.
WORDS: tuple[tuple[Kind, str], ...] = (
    ("spectrum", r"p?s[_-]?[adv]|p?s[_-]?a[_-]?rotd\d*|spectr\w*|response\s*spectr\w*|sa\s*\(t\)|sa[_-]?rotd\d*"),
    ("period", r"periods?|periodo|période|periode"),
    ("frequency", r"f|freq|frequency|frequencies|frequenz|frecuencia|frequenza|fréquence"),
    (
        "time",
        r"t|times?|timestamp|datetime|date|epoch|elapsed|zeit|temps|tempo|tiempo|relative\s*time|s|secs?|seconds?|ms|msec",
    ),
    ("row number", r"|no|nr|num|number|index|idx|samples?|points?|row|i|n|k|id|step|unnamed:?\s*\d*|#|№"),
    ("acceleration", r"ag|a_g|acc[a-z]*|acel[^\W\d_]*|accél[^\W\d_]*|beschl[^\W\d_]*|ground\s*acc[a-z]*"),
    ("velocity", r"v|vel[a-z]*|geschw[a-z]*|vitesse"),
    ("displacement", r"d|u|dis|disp[a-z]*|weg|verschiebung\w*|spost\w*|desp\w*|dépl\w*"),
    ("force", r"force|load|kraft|fuerza|forza|p"),
    ("counts", r"counts?|cnts?"),
    # Of the size of an acceleration, and what else instruments record.
    (
        "other",
        r"(?:abs|absolute|resultant|total|norm|magnitude|srss|vector)\b.*|strain|drift|rotation|temp\w*|"
        r"volt\w*|pressure|moment|angle|tilt|\d+\s*%\s*damped|damped",
    ),
)
KINDS: list[tuple[Kind, re.Pattern[str]]] = [
    (kind, re.compile(rf"(?:{words})", re.IGNORECASE)) for kind, words in WORDS
]
ACCELERATION = re.compile(
    r"(?:ground[\s_-]++)?+(?:accelerations?|accelerazione|acceleracion|accelerogram|accel|acc|aceleraci[oó]n|acel|"
    r"beschleunigung|beschl|accélération|accél)\.?+"
    r"(?=(?:[XYZVUD]|[NSEW]{1,2}|U[DP]|H\d|[xyzv])(?![A-Za-z])|[^A-Za-zÀ-ÿ]|$)",
    re.IGNORECASE,
)
# The letter a alone needs the name of a component, as in a_x, ax or a NS, or a unit of acceleration.
SHORT = re.compile(r"a(?=[\s_.-]|[xyzvXYZV](?![A-Za-z]))")
BEGINS = re.compile(
    r"(time|zeit|temps|tempo|tiempo|veloc|vel|displ|disp|spectr|psa|period|freq)(?![a-z]{0,1}\Z)", re.IGNORECASE
)
BEGIN_KINDS: dict[str, Kind] = {
    "vel": "velocity",
    "dis": "displacement",
    "spe": "spectrum",
    "psa": "spectrum",
    "per": "period",
    "fre": "frequency",
}
BEFORE_TAIL = " \t_,;|/"
LABEL_UNITS = {"ms2": "m/s2", "cms2": "cm/s2", "mms2": "mm/s2", "m_s2": "m/s2", "cm_s2": "cm/s2", "mps2": "m/s2"}
MAX_LABEL = 200  # characters of a label that are looked at


@dataclass(frozen=True)
class Label:
    """The label of a column, and what it says; `unit` is None if it states none, and `unknown` one that is none."""

    text: str
    kind: Kind
    unit: Unit | None = None
    component: str = ""
    unknown: str = ""

    @property
    def said(self) -> str:
        """The label as evidence."""
        return f'label "{" ".join(self.text.split())[:80]}"'

    @property
    def vertical(self) -> bool:
        """Whether it names a vertical component."""
        return bool(VERTICAL_NAME.fullmatch(self.component))


def parse_label(text: str) -> Label:
    """Return what a label says."""
    plain = text[:MAX_LABEL].strip().strip('"')
    unit, unknown, component = None, "", ""
    rest = plain
    for bracket in BRACKET.finditer(plain, 0, end_of_last_bracket(plain)):
        inside = bracket[1].strip()
        found = parse_unit(inside)
        if found is not None and unit is None:
            unit = found
        elif _is_component(inside) and (len(inside) > 1 or ACCELERATION.search(plain)):  # volts are no direction
            component = inside
        elif inside and unit is None:
            unknown = inside
        rest = rest.replace(bracket[0], " ")
    rest = rest.strip()
    if unit is None and not unknown:
        rest, unit = _without_unit(rest)
    word, kind = _kind(rest, unit)
    named = word.strip(" _-.:,/") if kind in ("acceleration", "unknown", "velocity", "displacement") else ""
    component = component or named
    if kind == "unknown" and _is_component(component):
        kind = "component"
    return Label(text, kind, unit, component, unknown)


def _is_component(text: str) -> bool:
    return bool(text) and bool(
        HORIZONTAL_NAME.fullmatch(text) or VERTICAL_NAME.fullmatch(text) or text in ("X", "Y", "x", "y")
    )


def _without_unit(rest: str) -> tuple[str, Unit | None]:
    """Return a label without the unit at its end, as in acc_g, acc, m/s2 and acc in gal, and the unit."""
    for place in range(1, len(rest)):
        if rest[place - 1] not in BEFORE_TAIL:
            continue
        tail, before = rest[place:], rest[: place - 1].rstrip(BEFORE_TAIL)
        if before.casefold().endswith(" in"):
            before = before[:-3].rstrip(BEFORE_TAIL)
        # a_g is the acceleration of the ground, and a t_s may be any time.
        if not before or before[-1].isdigit() or (before.casefold() == "a" and tail.casefold() == "g"):
            continue  # a value with its unit is no label
        unit = parse_unit(LABEL_UNITS.get(tail.casefold(), tail))
        if unit is None or (unit.quantity in ("displacement", "force") and len(tail) < 2):
            continue
        if unit.quantity != "time" or _kind(before, None)[1] == "time":  # NS is a component
            return before, unit
    return rest, None


def _kind(rest: str, unit: Unit | None) -> tuple[str, Kind]:
    """Return what is left of a label without the word for its quantity, and the quantity."""
    plain = rest.strip(" _-.:,")
    if not plain and unit is not None:
        return "", unit.quantity
    by_unit: Kind | None = None if unit is None or unit.quantity in ("acceleration", "time") else unit.quantity
    if len(plain) == 1 and plain.isalpha() and unit is not None:
        if unit.acceleration is not None:  # N (g), V (g) and T (g) are components
            return ("", "acceleration") if plain.casefold() == "a" else (plain, "unknown")
        return "", by_unit or "time"
    for kind, pattern in KINDS:
        if pattern.fullmatch(plain) and (plain or unit is None) and not _names_component(plain, kind):
            return "", kind
    first = ACCELERATION.search(plain)
    if first and (first.start() == 0 or not plain[first.start() - 1].isalpha()):
        return f"{plain[: first.start()]} {plain[first.end() :]}", "acceleration"
    if by_unit is not None:
        return plain, by_unit
    if SHORT.match(plain) and _is_component(plain[1:].strip(" _-.")):
        return plain[1:], "acceleration"
    begins = BEGINS.match(plain)
    if begins:
        return plain[begins.end() :], BEGIN_KINDS.get(begins[1].casefold()[:3], "time")
    return plain, "unknown"


def _names_component(plain: str, kind: Kind) -> bool:
    """Return whether a word of an acceleration ends in a component, as AccZ and accx do."""
    first = ACCELERATION.match(plain) if kind == "acceleration" else None
    return first is not None and first.end() < len(plain)
