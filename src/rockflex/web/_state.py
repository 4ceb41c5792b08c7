"""The state of the page as one value, which a link holds, and the choices that it offers."""

import json
import math
from collections.abc import Callable, Container, Generator, Sequence
from contextlib import contextmanager
from dataclasses import fields
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import AfterValidator, Field, StringConstraints, ValidationError
from pydantic_core import PydanticCustomError

from rockflex.foundation.errors import InputError
from rockflex.foundation.json import with_infinite_numbers
from rockflex.foundation.language import Language
from rockflex.foundation.units import SystemName
from rockflex.fragility._limit_states import (
    NOMINAL,
    OVERTURNING,
    ROCKED,
    ROCKING,
)
from rockflex.motion._measures import IntensityMeasure, scalable_measures
from rockflex.motion._recordings import Combination
from rockflex.response._limit_checks import CheckLimits
from rockflex.response._outputs import OF_MOTION, REACTIONS
from rockflex.structure._ground import Ground
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._toml_table import TomlTable, toml_problem_place
from rockflex.studies._case_keys import BoucWenTable, RunOptionKeys
from rockflex.studies._compare import MAX_ALTERNATIVES
from rockflex.studies._ground_tables import GroundTable
from rockflex.studies._prepared_case import RunOptions, yielding_model_labels
from rockflex.web._limits import (
    MAX_MODELS,
    RUN_WORK_LIMIT,
    check_form_numbers,
    form_number_errors,
    unclear_commas_text,
    wanted_value_text,
)
from rockflex.web._refusal import Refusal, errors_as_refusals


def check_of_known_names(known: Callable[[], Container[str]]) -> AfterValidator:
    """Return the check that a text is one of some names."""

    def checked(name: str) -> str:
        if name not in known():
            raise PydanticCustomError("unknown_name", "unknown name")
        return name

    return AfterValidator(checked)


class LimitStateChoice(NamedTuple):
    """The labels of a limit state."""

    name: str
    clause: str  # in the list "Limit state"
    noun: str  # in the design tab; empty if it does not offer this limit


NOMINAL_LIMIT = f"the nominal limit {NOMINAL.label.replace('_1', '₁')}"
ROTATION, DRIFT, RESIDUAL_DRIFT, DUCTILITY = "rotation", "drift", "residual_drift", "ductility"
OF_STORIES = (RESIDUAL_DRIFT, DUCTILITY)  # limits of stories that yield
LIMIT_STATE_CHOICES = (
    LimitStateChoice(ROCKING.name, f"it rocks (uplift with θ > {1e3 * ROCKED:g} mrad)", ""),
    LimitStateChoice(ROTATION, "the rotation exceeds …", "a rotation"),
    LimitStateChoice(DRIFT, "the top drifts, apart from the rotation, by more than …", ""),
    LimitStateChoice(RESIDUAL_DRIFT, "a story keeps a drift of more than …", ""),
    LimitStateChoice(DUCTILITY, "a story needs a ductility of more than …", ""),
    LimitStateChoice(NOMINAL.name, NOMINAL_LIMIT, NOMINAL_LIMIT),
    LimitStateChoice(OVERTURNING.name, "it overturns", OVERTURNING.label),
)
"""The limits of the studies; each of the second to fifth has a bound, the field of its name."""


LimitName = Annotated[str, check_of_known_names(lambda: [each.name for each in LIMIT_STATE_CHOICES])]
DesignLimit = Annotated[str, check_of_known_names(lambda: [each.name for each in LIMIT_STATE_CHOICES if each.noun])]


def limit_state_labels() -> list[dict[str, Any]]:
    """Return the labels of all limit states."""
    return [each._asdict() for each in LIMIT_STATE_CHOICES]


# In the list; the others follow in their own order.
FIRST_MEASURES = ("pgv", "pga", "pgd", "sa_t1_5", "sa_avg", "fiv3", "sa_t1", "sd_t1")


MeasureName = Annotated[str, check_of_known_names(lambda: [measure.name for measure in _measures_on_page()])]
SameForAll = Annotated[
    str, check_of_known_names(lambda: [measure.name for measure in _measures_on_page() if measure.of_what != "base"])
]
"""A measure that does not depend on the base, so that one level means the same motion for every width."""


def measure_labels() -> list[dict[str, Any]]:
    """Return the labels and the SI unit of each measure, and whether a search for a width can use it."""
    return [
        {
            "name": measure.name,
            "title": measure.title,
            "unit": measure.unit,
            "axis": measure.label,
            "of_base": measure.of_what == "base",
        }
        for measure in sorted(_measures_on_page(), key=_measure_list_order)
    ]


def _measures_on_page() -> list[IntensityMeasure]:
    """The measures of the suites that the page has, which hold no vertical components."""
    return [measure for measure in scalable_measures() if measure.of_what != "vertical"]


def _measure_list_order(measure: IntensityMeasure) -> int:
    return FIRST_MEASURES.index(measure.name) if measure.name in FIRST_MEASURES else len(FIRST_MEASURES)


MAX_TABLE_LETTERS = 20_000  # letters of a table
MAX_SELECTED = 60  # records that can be chosen
Source = Annotated[str, StringConstraints(max_length=120, pattern=r"^[^\x00-\x1f\x7f-\x9f]*$")]
Pasted = Annotated[
    str, StringConstraints(max_length=MAX_TABLE_LETTERS, pattern=r"^[^\x00-\x08\x0b\x0c\x0e-\x1f\x7f]*$")
]
InG = Annotated[float, Field(ge=0.001, le=5.0)]
Seconds = Annotated[float, Field(ge=0.01, le=100.0)]


class TargetChoice(TomlTable):
    """A target spectrum, and how records are chosen for it. Accelerations are in g, as codes and maps give them."""

    shown: bool = Field(False, description="true or false")
    kind: Literal["ec8", "ec8_second", "asce7", "asce7_site", "table"] = Field(
        "ec8", description='"ec8", "ec8_second", "asce7", "asce7_site" or "table"'
    )
    ag: InG = Field(0.25, description="a_gR in g, from 0.001 to 5")
    ground: Literal["A", "B", "C", "D", "E"] = Field("C", description="a ground type from A to E")
    type: Literal["1", "2"] = Field("1", description='"1" or "2"')
    importance: float = Field(1.0, ge=0.1, le=5.0, description="the importance factor, from 0.1 to 5")
    damping: float = Field(0.05, ge=0.005, le=0.5, description="a damping ratio from 0.005 to 0.5")
    s_alpha: InG = Field(0.5, description="S_α,RP in g, from 0.001 to 5")
    s_beta: InG = Field(0.15, description="S_β,RP in g, from 0.001 to 5")
    category: Literal["A", "B", "C", "D"] = Field("B", description="a site category from A to D")
    sds: InG = Field(1.0, description="S_DS in g, from 0.001 to 5")
    sd1: InG = Field(0.6, description="S_D1 in g, from 0.001 to 5")
    ss: InG = Field(1.5, description="S_S in g, from 0.001 to 5")
    s1: InG = Field(0.6, description="S_1 in g, from 0.001 to 5")
    site: Literal["A", "B", "C", "D", "default", "E"] = Field("C", description='a site class from A to E, or "default"')
    tl: Seconds = Field(8.0, description="T_L in s, from 0.01 to 100")
    mce: bool = Field(False, description="true or false")
    table: Pasted = Field("", description=f"a table of at most {MAX_TABLE_LETTERS} letters")
    units: Literal["", "g", "m/s2", "cm/s2"] = Field("", description='"g", "m/s2", "cm/s2", or nothing')

    source: Source = Field("fema-p695-far-field", description='the name of a suite, or "given"')
    count: int = Field(7, ge=1, le=MAX_SELECTED, description=f"how many records, from 1 to {MAX_SELECTED}")
    shortest: Seconds = Field(0.2, description="a period in s, from 0.01 to 100")
    longest: Seconds = Field(2.0, description="a period in s, from 0.01 to 100")
    measure: Combination = Field("component", description='"component", "geometric mean", "rotd50" or "rotd100"')
    smallest: float = Field(0.25, ge=0.01, le=1e3, description="the smallest factor, from 0.01 to 1000")
    largest: float = Field(4.0, ge=0.01, le=1e3, description="the largest factor, from 0.01 to 1000")
    per_event: int | None = Field(
        None, ge=1, le=MAX_SELECTED, description=f"how many records, from 1 to {MAX_SELECTED}, or nothing"
    )
    per_station: int | None = Field(
        None, ge=1, le=MAX_SELECTED, description=f"how many records, from 1 to {MAX_SELECTED}, or nothing"
    )
    record_weight: float = Field(0.0, ge=0.0, le=1.0, description="a weight from 0 to 1")
    least_ratio: float | None = Field(None, ge=0.1, le=2.0, description="a ratio from 0.1 to 2, or nothing")


Name = Annotated[str, StringConstraints(max_length=120, pattern=r"^[^\x00-\x1f\x7f-\x9f]*$")]
Scale = Annotated[float, Field(ge=0.01, le=20.0, description="a number from 0.01 to 20")]
Labels = Annotated[list[Name], Field(min_length=1, max_length=MAX_MODELS, description="a list of one to four models")]
Checksum = Annotated[str, StringConstraints(pattern=r"^([0-9a-f]{64})?$")]
Suites = Annotated[list[Name], Field(min_length=1, max_length=4, description="a list of one to four suites")]


MAX_FREE_VIBRATION = 60.0  # s
MAX_STATE_VALUES = 150_000  # values in a state: three matrices of 200 freedoms, and some room
MAX_MESSAGES = 50  # messages in one answer


class PulseChoice(TomlTable):
    """A mathematical pulse."""

    shape: Literal[
        "ricker_symmetric", "ricker_antisymmetric", "one_sine", "one_cosine", "half_sine", "rectangular", "mavroeidis"
    ] = Field("ricker_antisymmetric", description="the name of a pulse")
    amplitude: float = Field(
        2.0, ge=-50.0, le=50.0, description="the peak acceleration in m/s² (of a Mavroeidis pulse: velocity in m/s)"
    )
    period: float = Field(1.0, ge=0.05, le=20.0, description="the period in s, from 0.05 to 20")
    gamma: float = Field(1.5, ge=1.0, le=5.0, description="the number of oscillations γ, from 1 to 5")
    nu: float = Field(0.0, ge=-math.pi, le=math.pi, description="the phase ν in rad, from -π to π")


class SiteChoice(TomlTable):
    """The few numbers of a structure at a site, from which "My site" makes all others."""

    kind: Literal["pier", "building", "block"] = Field("pier", description='"pier", "building" or "block"')
    width: float = Field(7.0, ge=0.05, le=200.0, description="the width of the base in m, from 0.05 to 200")
    height: float = Field(24.0, ge=0.1, le=400.0, description="the height in m, from 0.1 to 400")
    weight: float = Field(15e6, ge=10.0, le=1e10, description="the weight in N, from 10 to 1e10")
    material: Literal["concrete", "steel", "timber", "masonry"] = Field(
        "concrete", description='"concrete", "steel", "timber" or "masonry"'
    )


class RecordChoice(TomlTable):
    """A ground motion: one of a suite, a pulse, an upload by its checksum, or one of the folder with its checksum.

    The folder is that of the studies too, and `vertical` says whether its vertical components are used.
    """

    source: Literal["suite", "pulse", "upload", "folder"] = Field(
        "suite", description='"suite", "pulse", "upload" or "folder"'
    )
    suite: Name = Field("el-centro-1940", description="the name of a suite")
    name: Name = Field("EL-CENTRO-1940-NS", description="the name of a record")
    pulse: PulseChoice = Field(default_factory=lambda: PulseChoice.model_validate({}), description="a table")
    upload: Checksum = Field("", description="the checksum of a file")
    folder: Checksum = Field("", description="the checksum of a folder")
    given: Name = Field("", description="the name of a record of the folder")
    vertical: bool = Field(False, description="true or false")


class CloudChoice(TomlTable):
    """A cloud analysis, and its limit state."""

    suites: Suites = Field(["fema-p695-far-field"], description="a list of one to four suites")
    scales: list[Scale] = Field(
        [0.5, 1.0, 2.0], min_length=1, max_length=20, description="one to twenty scale factors from 0.01 to 20"
    )
    models: Labels = Field(["MDOF-S"], description="a list of one to four models")
    measure: MeasureName = Field("pgv", description="an intensity measure")
    limit: LimitName = Field("rotation", description="a limit state")
    rotation: float = Field(0.01, ge=1e-4, le=1.5, description="a rotation in rad, from 0.0001 to 1.5")
    drift: float = Field(0.01, ge=1e-4, le=1.0, description="a drift over the height, from 0.0001 to 1")
    residual_drift: float = Field(
        0.005, ge=1e-5, le=1.0, description="a drift over the height of the story, from 0.00001 to 1"
    )
    ductility: float = Field(4.0, ge=1.0, le=100.0, description="a ductility from 1 to 100")
    confidence: float = Field(
        0.9,
        ge=0.5,
        le=0.99,
        description="the confidence of the bands, from 0.5 to 0.99",
    )


class DesignChoice(TomlTable):
    """A search for the width of the base."""

    suites: Suites = Field(["fema-p695-far-field"], description="a list of one to four suites")
    scales: list[Scale] = Field(
        [1.0, 2.0], min_length=1, max_length=5, description="one to five scale factors from 0.01 to 20"
    )
    model: Name = Field("2DOF-S", description="a model")
    narrowest: float = Field(1.0, ge=0.2, le=2.0, description="the narrowest base over the present one, from 0.2 to 2")
    widest: float = Field(3.0, ge=1.0, le=10.0, description="the widest base over the present one, from 1 to 10")
    widths: int = Field(8, ge=3, le=20, description="how many widths, from 3 to 20")
    tendons: list[Annotated[float, Field(ge=0.0, le=5.0)]] = Field(
        [0.0, 0.2], min_length=1, max_length=4, description="one to four initial forces over the weight, from 0 to 5"
    )
    stiffness: float = Field(0.5, ge=0.0, le=100.0, description="the tendon's stiffness over L_0^r g/B², from 0 to 100")
    measure: SameForAll = Field("pgv", description="an intensity measure")
    at: float = Field(0.6, gt=0.0, le=1e4, description="the intensity in its SI unit, above 0")
    limit: DesignLimit = Field("rotation", description="a limit state")
    rotation: float = Field(0.02, ge=1e-4, le=1.5, description="a rotation in rad, from 0.0001 to 1.5")
    target: float = Field(0.25, ge=1e-4, le=0.99, description="a probability from 0.0001 to 0.99")


class RecordSetChoice(TomlTable):
    """Records whose responses are one result, and the rule that makes one value for design of them."""

    shown: bool = Field(False, description="true or false")
    suites: Suites = Field(["chosen"], description="a list of one to four suites")
    scale: Scale = 1.0
    model: Name = Field("", description="one of the models; the first if it is none of them")
    rule: Literal["", "ec8", "asce7", "asce7-ii"] = Field("ec8", description='"ec8", "asce7", "asce7-ii" or nothing')


TornadoDemand = Annotated[str, check_of_known_names(lambda: TORNADO_DEMANDS)]
TORNADO_DEMANDS = (*OF_MOTION, *REACTIONS[:1])


class TornadoChoice(TomlTable):
    """How far each number of the structure is from its value, and the demand that is compared."""

    share: float = Field(0.1, ge=0.01, le=0.5, description="a relative range from 0.01 to 0.5")
    demand: TornadoDemand = Field("max_rotation", description="the name of a demand")


def limit_of_choice(choice: "CloudChoice | DesignChoice", height: float | None = None) -> float | str:
    """Return the limit of a tab in the form that the library expects; `height` is that of the top in m."""
    if choice.limit == ROTATION:
        return choice.rotation
    if isinstance(choice, DesignChoice):
        return choice.limit
    bounds = {
        DRIFT: ("max_top_displacement", choice.drift * (height or 1.0)),
        RESIDUAL_DRIFT: ("max_residual_drift_ratio", choice.residual_drift),
        DUCTILITY: ("max_ductility", choice.ductility),
    }
    return "{} > {!r}".format(*bounds[choice.limit]) if choice.limit in bounds else choice.limit


LimitOfCheck = Annotated[str, check_of_known_names(lambda: [each.name for each in fields(CheckLimits)])]


class Alternative(RunOptionKeys):
    """A structure that was kept under a name, with its models and their options."""

    name: Annotated[Name, Field(min_length=1, max_length=40, description="a name of at most 40 letters")]
    structure: StructureEntry = Field(description="a table")
    models: Labels


class PageState(RunOptionKeys):
    """The state of the whole page."""

    tab: Literal["structure", "earthquake", "response", "fragility", "design"] = Field(
        "structure", description="the name of a tab"
    )
    units: SystemName = Field("kN", description='"kN", "MN", "SI" or "kip-in"')
    language: Language = Field("en", description='"en", "de", "it", "fr" or "es"')
    structure: StructureEntry = Field(description="a table")
    record: RecordChoice = Field(default_factory=lambda: RecordChoice.model_validate({}), description="a table")
    scale: Scale = 1.0
    models: Labels = Field(["MDOF-S", "2DOF-S", "fixed"], description="a list of one to four models")
    free_vibration: float = Field(
        5.0, ge=0.0, le=MAX_FREE_VIBRATION, description="the free vibration after the record in s, from 0 to 60"
    )
    cloud: CloudChoice = Field(default_factory=lambda: CloudChoice.model_validate({}), description="a table")
    design: DesignChoice = Field(default_factory=lambda: DesignChoice.model_validate({}), description="a table")
    target: TargetChoice = Field(default_factory=lambda: TargetChoice.model_validate({}), description="a table")
    site: SiteChoice = Field(default_factory=lambda: SiteChoice.model_validate({}), description="a table")
    alternatives: list[Alternative] = Field(
        [], max_length=MAX_ALTERNATIVES, description=f"a list of at most {MAX_ALTERNATIVES} tables"
    )
    head: dict[Literal["title", "project", "author", "checker"], Name] = Field(
        default_factory=dict, description="a table of texts of at most 120 letters"
    )

    record_set: RecordSetChoice = Field(
        default_factory=lambda: RecordSetChoice.model_validate({}), description="a table"
    )
    tornado: TornadoChoice = Field(default_factory=lambda: TornadoChoice.model_validate({}), description="a table")
    limits: dict[LimitOfCheck, Any] = Field(
        default_factory=dict, description="a table of the arguments of rockflex.CheckLimits"
    )

    def head_texts(self) -> dict[str, str]:
        """Return the texts of the head of reports that are given."""
        return {name: text for name, text in self.head.items() if text}

    def kept_state(self, alternative: Alternative) -> "PageState":
        """Return the state with a kept alternative in the place of its structure, models and options."""
        own = {name: getattr(alternative, name) for name in Alternative.model_fields if name != "name"}
        usual = {"cloud": CloudChoice.model_validate({}), "design": DesignChoice.model_validate({})}
        return self.model_copy(update={**own, **usual, "alternatives": []})

    @property
    def model_of_set(self) -> str:
        """The model of the set of records: the chosen one, or the first of the Response tab."""
        return self.record_set.model if self.record_set.model in self.models else self.models[0]

    def check_limits(self, *, friction: bool = True) -> CheckLimits:
        """Return the limits of the checks; without that of the friction where it would take too long."""
        try:
            return CheckLimits(**{name: each for name, each in self.limits.items() if friction or name != "friction"})
        except InputError as error:
            asked = unclear_commas_text(self.limits.get(error.field or ""))
            raise Refusal({f"limits.{error.field}": f"{error}{asked}"}) from error

    def run_options(self, ground: Ground | None) -> RunOptions:
        """Return the options of the runs of the Response tab, on the ground of the structure."""
        return RunOptions.of(
            self.free_vibration, impact=self.law(), bouc_wen=self.hysteresis(), ground=ground, work_limit=RUN_WORK_LIMIT
        )

    def option_keys(self, labels: Sequence[str]) -> dict[str, Any]:
        """Return the impact law, the ground, and the hysteresis if one of the models yields, as keys of a study."""
        names = {"impact", "restitution", "ground", *(["bouc_wen"] if yielding_model_labels(labels) else [])}
        return self.model_dump(include=names, exclude_none=True)


def parse_page_json(body: bytes) -> Any:
    """Read JSON; infinite and absurdly large numbers are left to the checks of the fields."""
    try:
        return json.loads(body, parse_int=lambda text: int(text) if len(text) < 16 else float(text))
    except (ValueError, RecursionError) as error:
        raise Refusal(f"The request is not valid JSON: {str(error)[:200]}.", 400) from error


def parse_page_state(content: Any) -> PageState:
    """Return the state of a form or a link, checked."""
    if not isinstance(content, dict):
        raise Refusal("The link does not hold a state of the page.")
    try:
        if _number_of_values(content) > MAX_STATE_VALUES:
            raise Refusal(
                f"The link holds more than {MAX_STATE_VALUES} values, which is more than the page takes.", 413
            )
        state = PageState.model_validate(with_infinite_numbers(content))
    except ValidationError as error:
        structure = with_infinite_numbers(content.get("structure"))
        ranges = form_number_errors("structure", structure, StructureEntry) if isinstance(structure, dict) else {}
        raise Refusal(dict([*(ranges | _field_error_messages(error, content)).items()][:MAX_MESSAGES])) from error
    except RecursionError as error:
        raise Refusal("The link is nested too deep.") from error
    _check_state(state)
    names = [each.name for each in state.alternatives]
    if len(set(names)) < len(names):
        raise Refusal({"alternatives": "two of them have the same name. Name each differently."})
    for each in state.alternatives:
        with refusals_of_alternative(each.name):
            _check_state(state.kept_state(each))
    return state


@contextmanager
def refusals_of_alternative(name: str) -> Generator[None]:
    """Name a kept alternative in refusals, which have no field of the forms then."""
    try:
        yield
    except Refusal as error:
        raise Refusal({"alternatives": f"{name}: {error}"}, error.status) from error


def _check_state(state: PageState) -> None:
    try:
        state.structure.name.encode()
    except UnicodeEncodeError as error:
        raise Refusal({"structure.name": "it contains a character that cannot be encoded."}) from error
    check_form_numbers("structure", state.structure.model_dump(), StructureEntry)
    _check_models_of_state(state)
    _check_run_options_of_state(state)


def _check_models_of_state(state: PageState) -> None:
    for path, labels in (
        ("models", state.models),
        ("cloud.models", state.cloud.models),
        ("design.model", [state.design.model]),
    ):
        with errors_as_refusals(path):
            yields = yielding_model_labels(labels)
        if len(set(labels)) < len(labels):
            raise Refusal({path: "the same model is chosen twice."})
        if yields and state.bouc_wen is None:
            message = f"{yields[0]} yields, but no yield displacement was given. Choose it on the Response tab."
            raise Refusal({path: message})


def _check_run_options_of_state(state: PageState) -> None:
    with errors_as_refusals("restitution"):
        state.law()
    state.check_limits()
    if state.ground is not None:
        check_form_numbers("ground", state.ground.model_dump(), GroundTable)
    if state.bouc_wen is None:
        return
    check_form_numbers("bouc_wen", state.bouc_wen.model_dump(), BoucWenTable)
    try:
        state.hysteresis()
    except InputError as error:
        raise Refusal({f"bouc_wen.{error.field}": str(error)}) from error


def _number_of_values(value: Any) -> int:
    """The number of values, including tables and lists."""
    if isinstance(value, dict):
        return 1 + sum(map(_number_of_values, value.values()))
    return 1 + sum(map(_number_of_values, value)) if isinstance(value, list) else 1


def _field_error_messages(error: ValidationError, content: dict[str, Any]) -> dict[str, str]:
    """Return a sentence for each field at fault."""
    found: dict[str, str] = {}
    for problem in error.errors(include_url=False)[:MAX_MESSAGES]:
        spot = toml_problem_place(problem["loc"], content, PageState)
        needed = "something else" if spot.field is None else wanted_value_text(spot.field)
        if problem["type"] == "extra_forbidden":
            said = "it is not known here."
        elif problem["type"] in ("missing", "union_tag_not_found"):
            said = f"it is missing: {needed}."
        elif problem["type"] == "value_error":
            said = str(problem.get("ctx", {}).get("error", problem["msg"]))
        else:
            said = (
                f"it must be {needed}, but {_short_value_text(spot.value)} was given.{unclear_commas_text(spot.value)}"
            )
        found[".".join(map(str, spot.path))] = said
    return found


def _short_value_text(value: Any) -> str:
    text = str(value) if isinstance(value, int | float) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
