"""Records for studies: embedded suites, the visitor's folder, and records selected for a target spectrum."""

import json
import math
import warnings
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from pydantic import PrivateAttr

from rockflex.engine.stops import check_interruption
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.foundation.json import as_json_value
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._spectra import TargetSpectrum
from rockflex.motion._suite import Selection, Suite, load_suite
from rockflex.motion._target_files import read_target
from rockflex.motion._targets import asce7_site_spectrum, asce7_spectrum, ec8_second_spectrum, ec8_spectrum
from rockflex.studies._record_tables import Records
from rockflex.web._earthquake import chosen_motion
from rockflex.web._limits import unclear_commas_text
from rockflex.web._refusal import Refusal, errors_as_refusals
from rockflex.web._state import PageState, TargetChoice
from rockflex.web._structure import build_page_structure
from rockflex.web._uploads import LatestValuesCache, UploadedRecords

VISITOR_FOLDER = "given"  # stands for the visitor's folder among the names of suites
SELECTED = "chosen"  # and this for the records chosen for the target spectrum
VISITOR_SUITES = (VISITOR_FOLDER, SELECTED)
RECORDS_FOLDER = "records"  # of a study file, next to it
WHOLE_FOLDER = "your-records"  # the folder of the visitor, as it was given
UNPACK_HINT = (
    f"# Unpack the records, which the page saves as {RECORDS_FOLDER}.zip, into the folder {RECORDS_FOLDER} next to "
    "this file.\n"
)


class VisitorRecords(Records):
    """Records of suites, and motions in memory, which a study file takes from a folder."""

    _motions: tuple[GroundMotion, ...] = PrivateAttr(())

    @property
    def motions(self) -> tuple[GroundMotion, ...]:
        """The motions in memory."""
        return self._motions

    @classmethod
    def of(cls, suites: Sequence[str], motions: Sequence[GroundMotion]) -> "VisitorRecords":
        """Return the records of embedded suites, and these motions."""
        content: dict[str, Any] = {"suites": list(suites)} | ({"folder": RECORDS_FOLDER} if motions else {})
        found = cls(**content)
        found._motions = tuple(motions)
        return found

    def load(self, base: Path) -> Suite:  # noqa: ARG002 - nothing is read from files
        """Load the records; the suites come first."""
        return Suite([*(motion for name in self.suites for motion in load_suite(name)), *self._motions])


def folder_suite(state: PageState, uploads: UploadedRecords) -> Suite:
    """Return the records of the visitor's folder, with vertical components if these are wanted."""
    return uploads.folders.get(state.record.folder).suite(vertical=state.record.vertical)


MAX_SELECTIONS = 4  # selections in memory
CURVE_POINTS = 70  # of a curve
PERIOD_MARGIN = 3.0  # the chart reaches beyond the range of periods by this factor
ROTATED_COST = 6.0  # times the work of a component: a spectrum in 180 directions
MAX_SPECTRUM_SAMPLES = 12_000_000  # samples whose spectra are computed for one choice
MIN_SCALE, MAX_SCALE = 0.01, 20.0  # scale factors of the page

# The fields of the form by the arguments of the library.
FIELDS = {
    "kind": "type",
    "damping_ratio": "damping",
    "periods": "longest",
    "n": "count",
    "scale_limits": "largest",
    "sa": "table",
}
Selected = tuple[Selection, list[str]]


@contextmanager
def _refusing_target(missing: str) -> Generator[None]:
    """Turn an error of the library into a refusal at the field of its argument, or at `missing`."""
    try:
        yield
    except InputError as error:
        name = FIELDS.get(error.field or "", error.field or missing)
        raise Refusal({f"target.{name if name in TargetChoice.model_fields else missing}": error.said}) from error


def target_spectrum_of_choice(choice: TargetChoice) -> TargetSpectrum:
    """Return the target spectrum."""
    with _refusing_target("kind"):
        name, values, named = target_spectrum_call(choice)
        if name == "read_target":
            return _pasted_target_spectrum(choice)
        makers: dict[str, Callable[..., TargetSpectrum]] = {
            "ec8_spectrum": ec8_spectrum,
            "ec8_second_spectrum": ec8_second_spectrum,
            "asce7_spectrum": asce7_spectrum,
            "asce7_site_spectrum": asce7_site_spectrum,
        }
        return makers[name](*values, **named)


def target_spectrum_call(choice: TargetChoice) -> tuple[str, list[Any], dict[str, Any]]:
    """Return the function of the library that makes a target, and its arguments in m/s² and s."""
    if choice.kind == "ec8":
        named: dict[str, Any] = {"importance": choice.importance, "damping_ratio": choice.damping}
        return "ec8_spectrum", [choice.ag * GRAVITY, choice.ground, int(choice.type)], named
    if choice.kind == "ec8_second":
        values = [choice.s_alpha * GRAVITY, choice.s_beta * GRAVITY, choice.category]
        return "ec8_second_spectrum", values, {"damping_ratio": choice.damping}
    if choice.kind == "asce7":
        return "asce7_spectrum", [choice.sds * GRAVITY, choice.sd1 * GRAVITY, choice.tl], {"mce": choice.mce}
    if choice.kind == "asce7_site":
        values = [choice.ss * GRAVITY, choice.s1 * GRAVITY, choice.site, choice.tl]
        return "asce7_site_spectrum", values, {"mce": choice.mce}
    return "read_target", [], {"units": choice.units or None, "damping_ratio": choice.damping}


def _pasted_target_spectrum(choice: TargetChoice) -> TargetSpectrum:
    if not choice.table.strip():
        raise Refusal({"target.table": "no table was given yet: two columns, the period in s and S_a."})
    try:
        with TemporaryDirectory() as folder:
            file = Path(folder) / "table.csv"  # it names the target
            file.write_text(choice.table, encoding="utf-8")
            try:
                return read_target(file, choice.units or None, choice.damping)
            except InputError as error:
                said = error.said.replace(str(file), "the table")
                said = said.partition(" Declare it: read_target")[0]
                place = "units" if "unit of its acceleration" in said or error.field == "units" else "table"
                raise Refusal({f"target.{place}": said}) from error
    except (OSError, UnicodeEncodeError) as error:
        raise Refusal({"target.table": "the table contains a character that cannot be stored."}) from error


class LatestSelections:
    """The latest choices of records of all visitors, so that charts, files and studies do not repeat them."""

    def __init__(self) -> None:
        self._selections = LatestValuesCache[Selected](MAX_SELECTIONS)

    def of(self, state: PageState, uploads: UploadedRecords) -> Selected:
        """Return the records chosen for the target of a state, and remarks on the choice."""
        choice = state.target
        key = json.dumps([choice.model_dump(exclude={"shown"}), self._source(state), state.language])
        found = self._selections.get(key)
        if found is not None:
            return found
        target, suite = target_spectrum_of_choice(choice), suite_to_select_from(state, uploads)
        _check_work_of_selection(suite, choice)
        check_interruption()  # the visitor may have changed the choice while it waited for its turn
        with warnings.catch_warnings(record=True) as caught, _refusing_target("count"):
            warnings.simplefilter("always", RecordWarning)
            chosen = suite.select(
                target, choice.count, (choice.shortest, choice.longest), **selection_options_of_choice(choice)
            )
        found = (chosen, [str(each.message) for each in caught])
        self._selections.put(key, found)
        return found

    @staticmethod
    def _source(state: PageState) -> list[Any]:
        return [state.record.folder, state.record.vertical] if state.target.source == VISITOR_FOLDER else []


SELECTIONS = LatestSelections()


def selection_options_of_choice(choice: TargetChoice) -> dict[str, Any]:
    """Return the named arguments of `Suite.select`."""
    return {
        "measure": choice.measure,
        "scale_limits": (choice.smallest, choice.largest),
        "per_event": choice.per_event,
        "per_station": choice.per_station,
        "record_weight": choice.record_weight,
        "least_ratio": choice.least_ratio,
    }


def suite_to_select_from(state: PageState, uploads: UploadedRecords) -> Suite:
    """Return the records that are chosen from."""
    if state.target.source != VISITOR_FOLDER:
        with _refusing_target("source"):
            return load_suite(state.target.source)
    try:
        return folder_suite(state, uploads)
    except Refusal as error:
        raise Refusal({"target.source": next(iter(error.errors.values()))}, error.status) from error


def _check_work_of_selection(suite: Suite, choice: TargetChoice) -> None:
    rotated = choice.measure.startswith("rotd")
    work = sum(motion.acceleration.size for motion in suite) * (ROTATED_COST if rotated else 1.0)
    if work > MAX_SPECTRUM_SAMPLES:
        message = "spectra of so many records in all directions take too long for a page. Use rockflex select, or"
        raise Refusal({"target.measure": f"{message} choose the geometric mean."})


def selection_view(state: PageState, uploads: UploadedRecords) -> dict[str, Any]:
    """Return the chosen records with their factors, and the spectra around the range of periods."""
    chosen, notes = SELECTIONS.of(state, uploads)
    target, low, high = chosen.target, float(chosen.periods[0]), float(chosen.periods[-1])
    first, last = float(target.periods[0]), float(target.periods[-1])
    around = np.geomspace(max(low / PERIOD_MARGIN, first, 0.01), min(high * PERIOD_MARGIN, last), CURVE_POINTS)
    periods = np.unique(np.concatenate((around, [low, high])))
    rows = chosen.at(periods)
    logs = np.log(rows)
    spread = logs.std(axis=0, ddof=1) if len(rows) > 1 else np.zeros(periods.size)
    table = chosen.table().astype(object)
    return as_json_value(
        {
            "target": target.name,
            "damping": target.damping_ratio,
            "range": [low, high],
            "first_period": _first_period(state),
            "offered": len(suite_to_select_from(state, uploads)),
            "periods": periods,
            "wanted": target.at(periods),
            "mean": rows.mean(axis=0),
            "low": np.exp(logs.mean(axis=0) - spread),
            "high": np.exp(logs.mean(axis=0) + spread),
            "singles": rows,
            "records": table.where(table.notna(), None).to_dict("records"),
            "misfit": chosen.misfit,
            "least_ratio": chosen.least_ratio,
            "zero_period_ratio": chosen.zero_period_ratio,
            "dispersion": chosen.dispersion.max(),
            "notes": notes,
        }
    )


def _first_period(state: PageState) -> float | None:
    with suppress(Refusal):  # records can be chosen before the structure is complete
        p = build_page_structure(state.structure).properties
        return 2.0 * math.pi / float(p.omega[0]) if p.n_modes else None
    return None


def scale_factor_view(state: PageState, uploads: UploadedRecords, period: object) -> dict[str, Any]:
    """Return the factor that scales the record to the target at a period in s, or over the range if it is None."""
    choice, motion, target = state.target, chosen_motion(state.record, uploads), target_spectrum_of_choice(state.target)
    if period is None:
        with _refusing_target("longest"):
            scaled = motion.scaled_to(target, (choice.shortest, choice.longest))
    else:
        if not isinstance(period, int | float) or isinstance(period, bool) or not 0.0 <= period <= 100.0:
            hint = unclear_commas_text(period)
            message = f"it must be a period in s, from 0 to 100, but {str(period)[:40]} was given.{hint}"
            raise Refusal({"target.period": message})
        try:
            wanted = float(target.at([period])[0])
            scaled = motion.scaled_to(sa=wanted, period=float(period), damping_ratio=target.damping_ratio)
        except InputError as error:
            raise Refusal({"target.period": error.said}) from error
    factor = scaled.pga / motion.pga
    if not MIN_SCALE <= factor <= MAX_SCALE:
        message = (
            f"the factor would be {factor:.3g}, but the page takes {MIN_SCALE:g} to {MAX_SCALE:g}. Choose another "
            "record."
        )
        raise Refusal({"target.period": message})
    return {"factor": factor}


TITLES = {VISITOR_FOLDER: "your folder", SELECTED: "the records for the target"}


def records_of_named_suites(
    state: PageState, names: Sequence[str], uploads: UploadedRecords, path: str
) -> VisitorRecords:
    """Return the records of the suites with these names, the choice of the field `path`."""
    own = dict[str, Suite]()
    try:
        if VISITOR_FOLDER in names:
            own[VISITOR_FOLDER] = folder_suite(state, uploads)
        if SELECTED in names:
            own[SELECTED] = SELECTIONS.of(state, uploads)[0].suite
    except Refusal as error:  # the field at fault is on another tab
        raise Refusal({path: next(iter(error.errors.values()))}, error.status) from error
    embedded = [name for name in names if name not in VISITOR_SUITES]
    with errors_as_refusals(path):
        _check_different_suite_records({name: load_suite(name) for name in embedded} | own if own else {}, path)
        return VisitorRecords.of(embedded, [motion for suite in own.values() for motion in suite])


def _check_different_suite_records(suites: Mapping[str, Suite], path: str) -> None:
    """Refuse suites with a record of the same name: records for a target may be those of another suite, scaled."""
    found = dict[str, str]()
    for name, suite in suites.items():
        for motion in suite:
            other = found.setdefault(motion.name, name)
            if other != name:
                both = " and ".join(TITLES.get(each, each) for each in (other, name))
                message = f"{motion.name[:80]} is a record of two of these suites: {both}. Choose one of the two."
                raise Refusal({path: message})
