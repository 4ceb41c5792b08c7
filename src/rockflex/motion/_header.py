"""Statements of the lines above the numbers: quantity, unit, time step, count and component."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rockflex.foundation.errors import InputError
from rockflex.motion import _text
from rockflex.motion._findings import Evidence, quoted_line
from rockflex.motion._record_info import VERTICAL_NAME, component_azimuth, is_horizontal_component_name
from rockflex.motion._units import BRACKET, TIMES, AccelerationUnit, Quantity, Unit, end_of_last_bracket, parse_unit

Lines = Sequence[tuple[int, str]]
MAX_LINES = 500  # above the numbers that are looked at
MAX_LINE = 500  # characters of a line that are looked at
# A line about one value of the record, or of the instrument, says nothing about the unit of the samples.
ABOUT_A_VALUE = re.compile(
    r"\b(?:peak|pga|pgv|pgd|max(?:imum|\.)?|min(?:imum)?|rms|scale|sensitivity|range|resolution|offset|magnitude|vs30|"
    r"threshold|gain|filter(?:ed)?|corner|depth|altitude|elevation|hypocent\w*|epicent\w*|distance|target|spectr\w*)\b",
    re.IGNORECASE,
)
UNIT_WORD = re.compile(r"\bunits?\b\s*+(?:of\b|is\b|are\b|in\b|for\b|[:=])?+\s*+", re.IGNORECASE)
STATES_UNIT = re.compile(r"\bunits?\s*+[:=]\s*+\(?+([^\s,;()]++)", re.IGNORECASE)
BETWEEN_UNITS = re.compile(r"[,;|]|\b(?:and|y)\b|\s{2,}|\t", re.IGNORECASE)
IN_WORD = re.compile(r"\bin\s++(?!units?\b)", re.IGNORECASE)
QUANTITY_WORDS: tuple[tuple[str, Quantity], ...] = (
    (
        r"acc(?:el(?:eration|erations|erogram|erograms|erogramme|erograma)?)?|acel\w*|beschleunigung\w*|accél\w*",
        "acceleration",
    ),
    (r"vel(?:oc(?:ity|ities)?)?|geschwindigkeit\w*|velocit\w*|velocidad\w*|vitesse\w*", "velocity"),
    (r"disp(?:l(?:acement|acements)?)?|verschiebung\w*|spostament\w*|desplazamient\w*|déplacement\w*", "displacement"),
    (r"force\w*|load|kraft|fuerza|forza", "force"),
    (r"counts?", "counts"),
)
QUANTITY: dict[Quantity, re.Pattern[str]] = {
    kind: re.compile(rf"(?<![\w])(?:{words})(?![\w])", re.IGNORECASE) for words, kind in QUANTITY_WORDS
}
SPECTRUM = re.compile(
    r"(?:(?:pseudo|acceleration|velocity|displacement|elastic|design|target|fourier|power|5\s*+%\s*+damped)[\s_-]++)*+"
    r"(?:response[\s_-]++)?+spectr(?:um|a|al)\b(?![\s_-]++(?:compatible|match\w*))|.*\bresponse[\s_-]++spectr(?:um|a)\b(?!\s*+:)",
    re.IGNORECASE,
)
MATCHED = re.compile(r"match|compatib|scaled\s++to", re.IGNORECASE)
TYPE_LINE = re.compile(
    r"(?:(?:data|file|record|motion|signal|series|quantity|channel|value)\w*[\s_]*+)?(?:type|quantity|kind)\s*+[:=]\s*+(.*)",
    re.IGNORECASE,
)
STEP_NAME = re.compile(
    r"^(?:delta(?!\s*+t\b)|step|interval)(?![A-Za-z])|\b(?:dt|d_t|delta_?t|Δt|delta\s++t|time[\s_-]*+(?:step|interval|increment|spacing)|(?:sampling|sample)[\s_-]*+"
    r"(?:interval|period|step|time|spacing)|intervalo[\w\s]{0,20}|paso(?:[\s_-]++de[\s_-]++tiempo)?|"
    r"pas\s++de\s++temps|zeitschritt|abtastintervall|passo)(?![A-Za-z])",
    re.IGNORECASE,
)
RATE_NAME = re.compile(
    r"^(?:rate|freq(?:uency|\.)?)(?![A-Za-z])|\b(?:(?:sampling|sample)[\s_-]*+(?:rate|freq(?:uency|\.)?)|fs|abtastrate|"
    r"frecuencia\s++de\s++muestreo)(?![A-Za-z])",
    re.IGNORECASE,
)
RATE_PHRASE = re.compile(
    rf"(?<![\w.])({_text.DECIMAL.pattern})\s*+(hz\b|sps\b|(?:samples?|points|pts)\s*+(?:/|per\s++)\s*+s(?:ec(?:ond)?)?\b)",
    re.IGNORECASE,
)
COUNT_NAME = re.compile(
    r"\b(?:npts|n_?points|num_?points|ndata|nsamp\w*|n_samples|"
    r"(?:number|no\.?|num\.?|#|numero|anzahl)\s*+(?:of|de|der|di)?+\s*+(?:data\s++)?+(?:points?|pts|samples?|values?|data|"
    r"puntos|datos|muestras|werte|punti))(?![A-Za-z])",
    re.IGNORECASE,
)
AFTER_NAME = re.compile(
    r"\s*+(?:[(\[]([^)\]]{0,20}+)[)\]])?+\s*+(?:[:=]|is\b|of\b|at\b)?+\s*+"
    r"([+-]?+(?:\d++(?:,\d++|\.\d*+)?+|\.\d++)(?:[EeDd][+-]?+\d++)?+)\s*+[(\[]?+([A-Za-zµμ./]*+)"
)
NUMBERS_FIRST = re.compile(
    rf"\s*+(\d++)(?:\s*+,\s++|\s++)({_text.DECIMAL.pattern})(?:\s*+,\s++|\s++)NPTS\s*+,?+\s*+DT\b", re.IGNORECASE
)
COMPONENT = re.compile(
    r"\b(?:comp(?:onent[ei]?|onente|\.)?|chan(?:nel)?\.?|cha|dir(?:ection|\.)?|orientation|stream|axis|scnl|azimuth)"
    r"(?![A-Za-z])(?:\s*+#?\d{1,2}+(?=\s*+[:=]))?+\s*+[:=]?+\s*+([^\s,;()]++)",
    re.IGNORECASE,
)
VERTICAL_PHRASE = re.compile(
    r"\b(?:vertical|up-down|updown)\b(?=[\s_]++(?:comp|dir|axis|accel|motion|record|channel|sensor))", re.IGNORECASE
)
MIN_STEP, MAX_STEP = 1e-4, 0.1  # s; other steps need the word of the user
MAX_COUNT_DIGITS = 18  # of a count that are read; no file has more samples


@dataclass(frozen=True)
class Header:
    """The statements of the lines above the numbers, each with its line."""

    quantities: list[Evidence[Quantity]] = field(default_factory=list["Evidence[Quantity]"])
    units: list[Evidence[AccelerationUnit]] = field(default_factory=list[Evidence[AccelerationUnit]])
    steps: list[Evidence[float]] = field(default_factory=list[Evidence[float]])
    counts: list[Evidence[int]] = field(default_factory=list[Evidence[int]])
    components: list[Evidence[str]] = field(default_factory=list[Evidence[str]])
    time_units: list[Evidence[float]] = field(default_factory=list[Evidence[float]])
    unknown: list[Evidence[str]] = field(default_factory=list[Evidence[str]])  # units that are none


def header_of_lines(file: Path, lines: Lines) -> Header:
    """Return what the lines above the numbers say; `lines` are pairs of a line's number and its text."""
    found = Header()
    for number, text in lines[:MAX_LINES]:
        line = text[:MAX_LINE].strip().lstrip("#%!*/; \t")
        if not line:
            continue
        said = quoted_line(number, line)
        _add_quantity_and_unit(found, line, said)
        _add_step_and_count(file, found, number, line, said)
        _add_component(found, line, said)
    return found


def _add_quantity_and_unit(found: Header, line: str, said: str) -> None:
    words: list[Quantity] = [kind for kind, pattern in QUANTITY.items() if pattern.search(line)]
    units = list(units_in_line(line))
    typed = TYPE_LINE.match(line)
    about_value = ABOUT_A_VALUE.search(line)
    if SPECTRUM.match(typed[1] if typed else line) and not MATCHED.search(line):
        found.quantities.append(Evidence("spectrum", said))
        return
    for unit in units:
        if unit.quantity == "time":
            found.time_units.append(Evidence(unit.si, said))
        elif unit.acceleration is not None:
            if not (about_value and not UNIT_WORD.search(line)):
                found.units.append(Evidence(unit.acceleration, said))
        elif unit.quantity == "counts":
            found.quantities.append(Evidence("counts", said))
    stated = STATES_UNIT.search(line)
    if stated and not units:
        found.unknown.append(Evidence(stated[1], said))
    if len(words) == 1 and not about_value:
        (word,) = words
        begins = QUANTITY[word].match(typed[1] if typed else line)
        same = any(unit.quantity == word for unit in units)
        valued = re.search(r"[:=]\s*+[+-]?+\d", line)
        if word != "counts" and ((begins and not valued) or (same and not valued)):
            found.quantities.append(Evidence[Quantity](word, said))
    elif not words and not about_value and UNIT_WORD.search(line):
        kinds: list[Quantity] = [
            each for each in ("displacement", "force", "velocity") if each in {unit.quantity for unit in units}
        ]
        found.quantities.extend(Evidence[Quantity](kind, said) for kind in kinds)


def units_in_line(line: str) -> Iterator[Unit]:
    """Yield the units that a line states: after the word unit, in brackets, after "in", or as a word by itself."""
    word = UNIT_WORD.search(line)
    if word:
        rest = line[word.end() :]
        # "of" and "in" after "units for the acceleration"
        chunks = [
            chunk for chunk in re.split(r"[,;|]|\band\b|\by\b|\s{2,}|\t", rest, flags=re.IGNORECASE) if chunk.strip()
        ]
        for chunk in chunks:
            unit = _unit_at_start(chunk)
            if unit is not None:
                yield unit
        if any(_unit_at_start(chunk) for chunk in chunks):
            return
    found = False
    for bracket in BRACKET.finditer(line, 0, end_of_last_bracket(line)):
        before = line[: bracket.start()].rstrip()
        unit = parse_unit(bracket[1])
        if unit is not None and not (before and before[-1].isdigit()):
            found = True
            yield unit
    if found:
        return
    for place in IN_WORD.finditer(line):
        unit = _unit_at_start(line[place.end() :])
        if unit is not None and unit.quantity not in ("time", "frequency"):
            yield unit
            return
    for place in re.finditer(r"[^\s,;:=]++", line):
        before = line[: place.start()].rstrip()
        unit = parse_unit(place[0]) if "/" in place[0] or "-2" in place[0] or "gal" in place[0].casefold() else None
        if unit is not None and unit.acceleration is not None and not (before and before[-1].isdigit()):
            yield unit
            return


def _unit_at_start(text: str) -> Unit | None:
    """Return the unit that the first words of a text are, as many as possible."""
    words = text.strip().strip(":=").split()[:4]
    words = words[1:] if words and words[0].casefold() in ("of", "in", "is", "are", "the") else words
    for count in range(len(words), 0, -1):
        unit = parse_unit(" ".join(words[:count]).rstrip(".,;:"))
        if unit is not None:
            return unit
    if not words:
        return None
    # As in a header of JMA, where the unit stands twice, once in brackets.
    name, _, inside = words[0].partition("(")
    return parse_unit(name) or parse_unit(inside.rstrip(").")) if name else parse_unit(inside.rstrip(")."))


def _add_step_and_count(file: Path, found: Header, number: int, line: str, said: str) -> None:
    if bare := NUMBERS_FIRST.match(line):
        found.counts.append(Evidence(int(bare[1][:MAX_COUNT_DIGITS]), said))
        found.steps.append(Evidence(_step(file, number, bare[2], 1.0, said), said))
        return
    about_value = ABOUT_A_VALUE.search(line)
    for name in COUNT_NAME.finditer(line):
        after = AFTER_NAME.match(line, name.end())
        if after and after[2].isdecimal():
            found.counts.append(Evidence(int(after[2][:MAX_COUNT_DIGITS]), said))
            break
    for name in STEP_NAME.finditer(line):
        after = AFTER_NAME.match(line, name.end())
        if after:
            unit = _unit_of_time(after[1], after[3])
            if unit is not None:
                found.steps.append(Evidence(_step(file, number, after[2], unit.si, said), said))
                return
    for name in RATE_NAME.finditer(line):
        after = AFTER_NAME.match(line, name.end())
        unit = _unit_of_time(after[1], after[3]) if after else None
        if after and unit is not None and (unit.quantity == "frequency" or not (after[1] or after[3])):
            rate = _step(file, number, after[2], unit.si if unit.quantity == "frequency" else 1.0, said)
            found.steps.append(Evidence(1.0 / rate, said))
            return
    phrase = RATE_PHRASE.search(line)
    if phrase and ("sampl" in line.casefold() or not phrase[2].casefold().startswith("hz")) and not about_value:
        found.steps.append(Evidence(1.0 / _step(file, number, phrase[1], 1.0, said), said))


def _unit_of_time(bracket: str | None, after: str) -> Unit | None:
    """Return the unit of a step or rate, in brackets before the number or after it; seconds where none is written."""
    written = (after or bracket or "").strip().rstrip(".,;")
    if not written or (written.casefold() not in TIMES and not re.match(r"[a-zµμ1]+", written, re.IGNORECASE)):
        return Unit("time")
    unit = parse_unit(written) or (parse_unit(bracket) if bracket else None)
    if unit is None and after and after.casefold().startswith(("sample", "point", "sps")):
        return Unit("frequency")
    return unit if unit is not None and unit.quantity in ("time", "frequency") else None


def _step(file: Path, line: int, text: str, factor: float, said: str) -> float:
    # A comma is a decimal one here: it is followed by digits, and begins no other entry.
    value = _text.parse_decimal(text.replace(",", "."), file, line) * factor
    if not value > 0.0:
        raise InputError(f"{file}: the time step must be positive, but {said} gives {text}. Correct it.", field="dt")
    return float(f"{value:.12g}")


def _add_component(found: Header, line: str, said: str) -> None:
    if VERTICAL_PHRASE.search(line):
        found.components.append(Evidence("vertical", said))
        return
    for place in COMPONENT.finditer(line):
        word = place[1].strip("\"'.")
        channel = word.split(".")[1] if word.count(".") == 3 else word
        if len(channel) == 1 and channel.isdigit():
            continue  # the number of a channel
        if VERTICAL_NAME.fullmatch(channel) or is_horizontal_component_name(channel):
            found.components.append(Evidence(channel, said))
            return
        if component_azimuth(channel) is not None:
            found.components.append(Evidence(channel, said))
            return
