"""A project: alternatives under the same records, their checks and reports, and the file that holds it all."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, cast

from rockflex.foundation.archives import archive_bytes
from rockflex.foundation.checks import checked_instance
from rockflex.foundation.descriptions import schema_keys
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path, write_given_file
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.language import Language
from rockflex.foundation.schema import ReportKeys
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.foundation.units import Decimal, SystemName
from rockflex.foundation.values import Value
from rockflex.foundation.versions import package_versions
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import ImpactLaw
from rockflex.models._label import parse_model
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._suite import Selection
from rockflex.report.project._archive import read_archive
from rockflex.report.project._project_file import input_checksum, project_arguments, project_members
from rockflex.report.run._report_page import checked_report_path, write_report
from rockflex.response._comparison import Comparison
from rockflex.response._limit_checks import CheckLimits, check
from rockflex.response._record_set import RecordSet, Rule, checked_rule
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import (
    InitialState,
    Motions,
    RockingStructure,
    checked_motions,
    checked_structures,
    free_vibration_time,
)
from rockflex.studies._compare import MAX_ALTERNATIVES, compare
from rockflex.studies._simulate import checked_period_range, simulate_set
from rockflex.studies.running import WorkLimit

if TYPE_CHECKING:
    import pandas as pd

SUFFIX = ".rockflex"
HEAD = tuple(name for name, _, _ in schema_keys(ReportKeys))


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class ProjectResults(Value):
    """The results of a project as tables, in SI units; `Project.run` makes them.

    Attributes
    ----------
    runs : pandas.DataFrame
        A row for each structure and motion with the columns of `RecordSet.peaks`.
    statistics : pandas.DataFrame
        A row for each structure and demand with the columns of `RecordSet.statistics`.
    checks : pandas.DataFrame
        A row for each structure and check (`name`) with the columns of `CheckTable.to_frame`.
    inputs : str
        SHA-256 of what they were computed from.
    version : str
        Version of rockflex that computed them.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> pulse = rf.one_sine_pulse(amplitude=4.0, period=1.0)
    >>> results = rf.Project({"block": block}, pulse, "rigid",
    ...     limits=rf.CheckLimits(rotation_ratio=0.5)).run().results
    >>> results.checks.loc[results.checks["limit"].notna(),
    ...     ["structure", "name", "ok"]].values.tolist()
    [['block', 'rotation', True], ['block', 'rotation over α', True]]
    """

    runs: "pd.DataFrame"
    statistics: "pd.DataFrame"
    checks: "pd.DataFrame"
    inputs: str
    version: str

    def __repr__(self) -> str:
        failed = number_with_noun(self.n_failed, "check")
        return f"ProjectResults({number_with_noun(len(self.runs), 'run')}, {failed} failed)"

    @property
    def n_failed(self) -> int:
        """Number of checks whose limit is exceeded."""
        return int(self.checks["ok"].eq(False).sum())


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Project(HtmlTable, Value):
    """Alternatives under the same records, with limits and the head of their reports, in one file.

    Parameters
    ----------
    structures : mapping
        One to six structures by their names.
    motions
        One record, a sequence, a mapping from names, or a `Selection`, as in `simulate_set`; scaled as they act. Their
        factors are those of `RecordInfo.scale`.
    model : str or mapping
        A label for all. This and the next four may be mappings from the names of structures, as in `compare`.
    bouc_wen, impact, ground, initial
        As in `simulate_set`; `impact` is one of rockflex's laws, and `ground` a `Ground`.
    rule, periods, free_vibration
        As in `simulate_set`.
    limits : CheckLimits
        Limits of `check`.
    head : mapping
        Texts of the head of reports: `title`, `project`, `author`, `checker` and `date`, as in `write_report`.
    results : ProjectResults, optional
        The results of exactly these structures, motions, options and limits.

    Raises
    ------
    InputError
        If there are no or too many structures, an option names another one, a value is wrong, or `results` are of other
        inputs.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> tied = rf.Restrained(frame, rf.Tendon(initial_force=100e3, stiffness=5e6))
    >>> pulses = {f"T = {t} s": rf.one_sine_pulse(amplitude=3.0, period=t)
    ...     for t in (0.5, 0.6, 0.7)}
    >>> project = rf.Project({"free": frame, "tied": tied}, pulses, rule="ec8",
    ...     head={"author": "A. Engineer"}).run()
    >>> project
    Project('free', 'tied' under 3 records: 6 runs, 0 checks failed)
    >>> path = project.save("pier.rockflex")
    >>> rf.read_project(path) == project
    True
    """

    structures: Mapping[str, Any]
    motions: tuple[GroundMotion, ...]
    model: Mapping[str, str]
    bouc_wen: Mapping[str, BoucWen]
    impact: Mapping[str, ImpactLaw]
    ground: Mapping[str, Ground]
    initial: Mapping[str, InitialState]
    rule: Rule | None
    periods: tuple[float, float] | None
    free_vibration: float | Literal["settle"]
    limits: CheckLimits
    head: Mapping[str, str]
    results: ProjectResults | None = field(repr=False)

    def __init__(
        self,
        structures: Mapping[str, RockingStructure | RockingProperties],
        motions: Motions,
        model: str | Mapping[str, str] = "MDOF-S",
        *,
        bouc_wen: BoucWen | Mapping[str, BoucWen] | None = None,
        impact: ImpactLaw | Mapping[str, ImpactLaw] | None = None,
        ground: Ground | Mapping[str, Ground] | None = None,
        initial: InitialState | Mapping[str, InitialState] | None = None,
        rule: Rule | None = None,
        periods: tuple[float, float] | None = None,
        free_vibration: float | Literal["settle"] = 0.0,
        limits: CheckLimits | None = None,
        head: Mapping[str, str] | None = None,
        results: ProjectResults | None = None,
    ) -> None:
        if not isinstance(structures, Mapping) or not 1 <= len(structures) <= MAX_ALTERNATIVES:  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"structures must be a mapping from names to 1 to {MAX_ALTERNATIVES} structures, such as "
                f"{{'A': structure}}, but {shown(structures)} was given.",
                field="structures",
            )
        built, named = checked_structures(structures)
        names = named or []
        if isinstance(motions, Selection):
            periods = periods or (float(motions.periods.min()), float(motions.periods.max()))
        records = tuple(checked_motions(motions))
        labels = _of_each("model", model, names, str)
        if len(labels) < len(names):
            raise InputError("model must be a label for all structures, or a mapping with one for each.", field="model")
        texts = dict(head or {})
        for key, text in texts.items():
            if key not in HEAD or not isinstance(text, str):  # pyright: ignore[reportUnnecessaryIsInstance]
                raise InputError(
                    f"head must be a mapping from {', '.join(HEAD)} to texts, but {shown({key: text})} was given.",
                    field="head",
                )
        free_vibration_time(free_vibration)
        vars(self).update(
            structures=dict(zip(names, built, strict=True)),
            motions=records,
            model={name: parse_model(label).label for name, label in labels.items()},
            bouc_wen=_of_each("bouc_wen", bouc_wen, names, BoucWen),
            impact=_of_each("impact", impact, names, ImpactLaw),
            ground=_of_each("ground", ground, names, Ground),
            initial=_of_each("initial", initial, names, InitialState),
            rule=checked_rule(rule, len(records)),
            periods=None if periods is None else checked_period_range(periods),
            free_vibration=free_vibration,
            limits=CheckLimits() if limits is None else checked_instance("limits", limits, CheckLimits),
            head={key: texts[key] for key in HEAD if key in texts},
            results=results,
        )
        if results is not None and checked_instance("results", results, ProjectResults).inputs != self.inputs:
            raise InputError(
                "The results are of other structures, records, options or limits than those of the project. Leave them "
                "out, results=None, and run it again.",
                field="results",
            )

    def __repr__(self) -> str:
        done = "not run" if self.results is None else repr(self.results).partition("(")[2][:-1]
        names = ", ".join(map(repr, self.structures))
        return f"Project({names} under {number_with_noun(len(self.motions), 'record')}: {done})"

    def _shown_as(self) -> dict[str, Any]:
        models = {f"structure {name}": label for name, label in self.model.items()}
        done = "not run" if self.results is None else repr(self.results)
        return {**self.head, **models, "records": len(self.motions), "rule": self.rule, "results": done}

    @property
    def inputs(self) -> str:
        """SHA-256 of structures, motions, options and limits; the head does not count."""
        return input_checksum(self)

    def record_set(self, structure: str | None = None, workers: SupportsIndex | None = None) -> RecordSet:
        """Return what `simulate_set` returns for a structure, by default the first.

        Raises
        ------
        InputError
            If there is no structure of this name, or as `simulate_set`.
        SolverError
            If a run cannot be solved.
        """
        name = self._checked_name(structure)
        return simulate_set(
            self.structures[name],
            self.motions,
            self.model[name],
            self.rule,
            self.periods,
            free_vibration=self.free_vibration,
            bouc_wen=self.bouc_wen.get(name),
            impact=self.impact.get(name),
            ground=self.ground.get(name),
            initial=self.initial.get(name),
            workers=workers,
        )

    def comparison(self, workers: SupportsIndex | None = None, work_limit: WorkLimit = "default") -> Comparison:
        """Return what `compare` returns for all structures, of which there must be two at least.

        `workers` and `work_limit` are as there.

        Raises
        ------
        InputError
            If there is only one, or as `compare`.
        SolverError
            If a run cannot be solved.
        """
        return compare(
            self.structures,
            self.motions,
            self.model,
            free_vibration=self.free_vibration,
            bouc_wen=self.bouc_wen,
            impact=self.impact,
            initial=self.initial,
            ground=self.ground,
            workers=workers,
            work_limit=work_limit,
        )

    def run(self, workers: SupportsIndex | None = None) -> "Project":
        """Return the project with the results of all its structures: peaks, statistics and checks.

        Raises
        ------
        InputError
            As `simulate_set` and `check`.
        SolverError
            If a run cannot be solved.
        """
        import pandas as pd

        parts: dict[str, list[pd.DataFrame]] = {"runs": [], "statistics": [], "checks": []}
        for name in self.structures:
            found = self.record_set(name, workers)
            checks = check(found, self.limits).to_frame().astype({"limit": float, "ratio": float, "ok": "boolean"})
            tables = {
                "runs": found.peaks.reset_index(),
                "statistics": found.statistics.rename_axis("demand").reset_index(),
                "checks": checks.reset_index(),
            }
            for key, table in tables.items():
                table.insert(0, "structure", name)
                parts[key].append(table)
        made = {key: pd.concat(tables, ignore_index=True) for key, tables in parts.items()}
        version = package_versions(("rockflex",))["rockflex"]
        return replace(self, results=ProjectResults(**made, inputs=self.inputs, version=version))

    def report(
        self,
        path: str | Path,
        structure: str | None = None,
        workers: SupportsIndex | None = None,
        *,
        units: SystemName = "kN",
        language: Language = "en",
        decimal: Decimal | None = None,
    ) -> Path:
        """Write the report of a structure: peaks by record, values for design, checks; or of all side by side.

        Parameters
        ----------
        path
            The file to write, which ends in .html, .pdf or .docx, as in `write_report`.
        structure
            Name of a structure. Default: all, compared with the first, or the only one.
        workers
            Number of threads; None for one a core.
        units, language, decimal
            Units, language and decimal sign, as in `write_report`.

        Returns
        -------
        Path
            The file written. It is written completely or not at all.

        Raises
        ------
        InputError
            If there is no structure of this name, or as `write_report`.
        SolverError
            If a run cannot be solved.
        """
        checked_report_path("path", path)  # before anything is simulated
        head: dict[str, Any] = {**self.head, "units": units, "language": language, "decimal": decimal}
        if structure is None and len(self.structures) > 1:
            return write_report(self.comparison(workers), path, **head)
        name = self._checked_name(structure)
        found = self.record_set(name, workers)
        return write_report(found, path, structure=self.structures[name], limits=self.limits, **head)

    def save(self, path: str | Path) -> Path:
        """Write everything to one file, a ZIP of TOML, CSV and Parquet, and return its path; see `read_project`.

        The suffix ``.rockflex`` is added if the path has another one or none. The same project gives the same bytes.

        Raises
        ------
        InputError
            If a structure, a law or a ground cannot be written to a file, or the path cannot be written to.
        """
        target = checked_file_path("path", path)
        target = target if target.suffix == SUFFIX else target.with_name(target.name + SUFFIX)
        content = archive_bytes(project_members(self))
        return write_given_file(target, content)

    def _checked_name(self, name: str | None) -> str:
        first = next(iter(self.structures))
        if name is not None and name not in self.structures:
            raise InputError(
                f"structure must be one of {', '.join(self.structures)}, but {shown(name)} was given.",
                field="structure",
            )
        return first if name is None else name


def _of_each(option: str, given: Any, names: list[str], kind: Any) -> dict[str, Any]:
    """Return the option of each structure that has one."""
    several = isinstance(given, Mapping)
    found: dict[str, Any] = dict(cast("Mapping[str, Any]", given)) if several else dict.fromkeys(names, given)
    found = {name: value for name, value in found.items() if value is not None}
    for name, value in found.items():
        if name not in names:
            raise InputError(
                f"{option} has {shown(name)}, which is no structure; these are {', '.join(names)}.", field=option
            )
        if isinstance(value, type) or not isinstance(value, kind):
            raise InputError(
                f"{option} must be of type {kind.__name__}, or a mapping from names to it, but {shown(value)} was "
                "given.",
                field=option,
            )
    return {name: found[name] for name in names if name in found}


def read_project(path: str | Path) -> Project:
    """Return the project of a file that `Project.save` wrote; nothing is unpacked to disk.

    Raises
    ------
    InputError
        If the file does not exist, is damaged, too large or of another version of the format, holds other files than
        it lists, or a value in it is wrong.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> project = rf.Project({"block": block},
    ...     rf.one_sine_pulse(amplitude=4.0, period=1.0), "rigid")
    >>> rf.read_project(project.save("block.rockflex"))
    Project('block' under 1 record: not run)
    """
    members = read_archive(path, "project")
    try:
        arguments = project_arguments(members)
        results = arguments.pop("results")
        return Project(**arguments, results=None if results is None else ProjectResults(**results))
    except RecursionError as error:
        raise InputError(f"{path} is nested too deep to be read.", field="path") from error
    except InputError as error:
        raise InputError(str(error), place=str(path), field=error.field) from error
