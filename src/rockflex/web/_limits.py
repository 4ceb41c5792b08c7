"""Limits of the requests of one visitor, the same for forms, links and files."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, get_origin

from pydantic.fields import FieldInfo

from rockflex.foundation.descriptions import Described
from rockflex.foundation.shown import number_with_noun
from rockflex.models._label import parse_model
from rockflex.models._work import Task
from rockflex.motion._ground_motion import GroundMotion
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._element_tables import ELEMENTS, ElementTable
from rockflex.structure.file._toml_table import (
    TomlTable,
    first_table_in_annotation,
    members_of_annotation,
    schema_key_of_field,
    tables_of_fields,
    valid_value_description,
)
from rockflex.studies._prepared_case import PreparedCase
from rockflex.web._refusal import Refusal, errors_as_refusals

if TYPE_CHECKING:
    from rockflex.studies.cloud import CloudPlan

MAX_FILE_BYTES = 5_000_000  # bytes of an upload
MAX_BODY_BYTES = 6_000_000  # bytes of any request, except one with a folder
MAX_FOLDER_FILES = 500  # of a folder
MAX_FOLDER_BYTES = 80_000_000  # bytes of its files, unpacked
MAX_PROJECT_BYTES = 20_000_000  # of a project's file, packed; unpacked it has the limits of a folder
MAX_TOML_BYTES = 1_000_000  # of its tables: they are read slowly
MAX_FREEDOMS = 200  # stories, masses, rows of a matrix
MAX_ELEMENTS = 20  # between the base and the ground: each can change its branch at every turn of the base
MAX_SAMPLES = 200_000
MAX_DURATION = 300.0  # s of a record
MAX_FOLDER_SAMPLES = 8_000_000  # of the records of a folder
MAX_CACHED_SAMPLES = 30_000_000  # of all folders in memory, 240 MB
MAX_MODELS = 4  # at once
MAX_STUDY_RUNS = 20_000  # of a study
MAX_RUN_COST = 1.5  # s of estimated computing time of one run (`CostModel`)
RUN_WORK_LIMIT = 5.0  # s of computing after which a run is stopped: hard runs take three times their estimate
MAX_RUN_STATES = 500_000  # time steps of a run whose history is kept, free vibration included: some 500 MB of curves
MAX_ANSWER_COST = 3.0  # s of estimated computing time of the runs of one answer
MAX_STUDY_COST = 180.0  # s of estimated computing time of all runs of a study
MAX_SET_SAMPLES = 600_000  # of all records of a set, whose histories are kept
MAX_SET_STATES = 2_000_000  # of the same with their free vibrations

MAX_NUMBER = 1e15


def check_form_numbers(path: str, value: Any, table: type[TomlTable]) -> None:
    """Raise the errors of `form_number_errors` as a refusal."""
    if errors := form_number_errors(path, value, table):
        raise Refusal(errors)


def form_number_errors(path: str, value: Any, table: type[TomlTable]) -> dict[str, str]:
    """Return a message for each number outside the range of its field, each list that is too long, and each text.

    A text in place of numbers would be the path of a file: nothing that a visitor writes reaches the file system.
    """
    errors: dict[str, str] = {}
    for place, field, each in _form_values_and_fields(path, value, table):
        if isinstance(each, str):
            if field is None or not _field_takes_text(field):
                needed = "numbers" if field is None else wanted_value_text(field)
                errors[place] = f"it must be {needed}, but {each[:60]!r} was given.{unclear_commas_text(each)}"
        elif isinstance(each, list):
            errors[place] = f"it holds {len(each)} values, but the page takes {_most_values_of_list(each)} at most."
        elif isinstance(each, int | float) and not isinstance(each, bool):
            key = Described("") if field is None else schema_key_of_field(field)
            low, high = (-MAX_NUMBER if key.low is None else key.low), (MAX_NUMBER if key.high is None else key.high)
            if not low <= each <= high:  # NaN, too
                errors[place] = f"it must be from {low:g} to {high:g}, but {each:g} was given."
    return errors


def wanted_value_text(field: FieldInfo) -> str:
    """Return the condition on the value of a field, for a message."""
    return schema_key_of_field(field).page or valid_value_description(field)


def unclear_commas_text(value: Any) -> str:
    """Return how to write numbers whose commas may be read in two ways; empty if there are none."""
    values = value if isinstance(value, list) else [value]
    if not any(isinstance(each, str) and re.fullmatch(r"[-+\d.,\s]*\d,\d[\d.,\s]*", each) for each in values):
        return ""
    return (
        " A comma may separate thousands, decimals or numbers: write a decimal point, no thousands separators, and "
        "spaces between numbers."
    )


def _field_takes_text(field: FieldInfo) -> bool:
    """Tell whether a field holds a word, a name or a table; one for numbers takes text as the path of a file."""
    kinds = members_of_annotation(field.annotation)
    words = kinds == [str] or any(get_origin(kind) is Literal for kind in kinds)
    return words or first_table_in_annotation(field.annotation) is not None


def _form_values_and_fields(
    path: str, value: Any, table: type[TomlTable] | None, field: FieldInfo | None = None
) -> Iterator[tuple[str, FieldInfo | None, Any]]:
    """Yield every number and text with its field, and every list that is too long."""
    if isinstance(value, Mapping):
        if table is not None and issubclass(table, ElementTable):
            table = ELEMENTS.get(str(value.get("kind")), table)
        for key, each in value.items():
            if str(key).isdigit():  # the heights of degrees of freedom by their indices
                yield from _form_values_and_fields(path, each, None, field)
            else:
                inner = None if table is None else table.model_fields.get(str(key))
                below = None if table is None else tables_of_fields(table).get(str(key))
                yield from _form_values_and_fields(f"{path}.{key}", each, below, inner)
    elif isinstance(value, list | tuple):
        if value and len(value) > _most_values_of_list(value):
            yield path, field, list(value)
            return
        for place, each in enumerate(value):
            yield from _form_values_and_fields(
                f"{path}.{place}" if isinstance(each, Mapping) else path, each, table, field
            )
    elif value is not None:
        yield path, field, value


def _most_values_of_list(values: Sequence[Any]) -> int:
    """Return how many values or tables a list may have."""
    return MAX_ELEMENTS if isinstance(values[0], Mapping) else MAX_FREEDOMS


def check_record_length(motion: GroundMotion, path: str) -> None:
    """Refuse records that are too long."""
    if motion.acceleration.size > MAX_SAMPLES or motion.duration > MAX_DURATION:
        message = (
            f"the record has {motion.acceleration.size} samples over {motion.duration:.6g} s, but the page takes "
            f"{MAX_SAMPLES} samples and {MAX_DURATION:g} s at most. Cut it, or use the library."
        )
        raise Refusal({path: message})


def check_work_of_runs(cases: Sequence[PreparedCase], motion: GroundMotion) -> None:
    """Refuse runs that take too long, individually or together."""
    together = sum(_checked_work_of_run(case.task(motion), "models") for case in cases)
    if together > MAX_ANSWER_COST:
        message = "these models take too long together for a page. Choose fewer of them, or a shorter record."
        raise Refusal({"models": message})


def _checked_work_of_run(task: Task, path: str) -> float:
    """Return the estimated computing time of a run in s; refuse one that takes too long."""
    if task.history and (states := _states_of_run(task)) > MAX_RUN_STATES:
        message = (
            f"{task.model.label} over {states:.3g} time steps of {task.dt:g} s, free vibration included, takes too "
            f"much memory for a page, which keeps {MAX_RUN_STATES} at most. Give a record with a longer time step, or "
            "less free vibration."
        )
        raise Refusal({path: message})
    work = task.work().total
    if work > MAX_RUN_COST:
        modes = number_with_noun(task.cost_model.modes, "mode")
        message = (
            f"{task.model.label} with {modes} over {task.record.size} samples takes too long for a page. Choose a "
            "model with fewer modes, a wider base or a shorter record, or use the library."
        )
        raise Refusal({path: message})
    return work


def _states_of_run(task: Task) -> float:
    """Return the number of time steps of a run, free vibration included."""
    return task.record.size + (task.free_vibration or 0.0) / task.dt


def check_size_of_set(cases: Sequence[PreparedCase], motions: Sequence[GroundMotion], path: str) -> None:
    """Refuse a set of records whose runs take too long, individually or together, or whose histories take too much."""
    tasks = [case.task(motion) for case in cases for motion in motions]
    work, states = sum(_checked_work_of_run(task, path) for task in tasks), sum(map(_states_of_run, tasks))
    samples = len(cases) * sum(motion.acceleration.size for motion in motions)
    if work > MAX_STUDY_COST or samples > MAX_SET_SAMPLES or states > MAX_SET_STATES:
        of = f" for {len(cases)} structures" if cases[1:] else ""
        message = (
            f"{len(motions)} records with {samples} samples{of} are too many for a page, which keeps all histories. "
            "Choose fewer records or a model with fewer modes, or use rockflex check."
        )
        raise Refusal({path: message})


def check_work_of_tornado(case: PreparedCase, motions: Sequence[GroundMotion], n_cases: int, path: str) -> None:
    """Refuse a tornado whose runs take too long, individually or together; each case is about as fast as the first."""
    if n_cases * sum(_checked_work_of_run(case.task(motion), path) for motion in motions) > MAX_STUDY_COST:
        message = (
            f"{n_cases * len(motions)} runs take too long for a page. Choose fewer records or fewer modes, or use "
        )
        raise Refusal({path: f"{message}rockflex tornado."})


def _check_model_of_structure(plan: "CloudPlan", properties: RockingProperties, label: str, path: str) -> None:
    """Refuse a model that the structure cannot have, such as one with modes for a rigid block."""
    with errors_as_refusals(path):
        plan.matrix.options.model_of(parse_model(label), properties)


def check_size_of_study(plan: "CloudPlan", path: str) -> None:
    """Refuse a study whose runs are impossible, too many, or too long."""
    if plan.n_runs > MAX_STUDY_RUNS:
        message = f"it has {plan.n_runs} runs, but the page takes {MAX_STUDY_RUNS} at most. Use the command line."
        raise Refusal({path: message})
    matrix = plan.matrix
    largest = max(plan.scales, key=abs)
    for structure, _, model, _ in matrix.cross([largest], records=[0]):
        _check_model_of_structure(plan, matrix.structures[structure], matrix.labels[model], path)
    tasks = (matrix.task(*run) for run in matrix.cross([largest]))
    work = len(plan.scales) * sum(_checked_work_of_run(task, path) for task in tasks if task is not None)
    if work > MAX_STUDY_COST:
        raise Refusal({path: "it takes too long for a page. Choose models with fewer modes, or use the command line."})
