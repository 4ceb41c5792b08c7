"""Python programs that reproduce the results of the page."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from rockflex.fragility._limit_states import LIMIT_STATES, NOMINAL, ROCKING
from rockflex.structure._attachment import element_parameters
from rockflex.structure._beam_sections import LumpedMasses
from rockflex.structure._cross_section import Section
from rockflex.structure._joint import Joint
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._wrappers import WRAPPERS, wrapper_arguments
from rockflex.studies._ground_tables import GroundTable, SpringBedTable, SpringsTable
from rockflex.studies._prepared_case import yielding_model_labels
from rockflex.studies.cloud import CloudStudy
from rockflex.studies.design._design_study import DesignStudy
from rockflex.web._earthquake import PULSES
from rockflex.web._selection import (
    RECORDS_FOLDER,
    VISITOR_FOLDER,
    VISITOR_SUITES,
    WHOLE_FOLDER,
    selection_options_of_choice,
    target_spectrum_call,
    target_spectrum_of_choice,
)
from rockflex.web._state import ROTATION, PageState, PulseChoice, TargetChoice, limit_of_choice
from rockflex.web._structure import build_page_structure
from rockflex.web._uploads import motion_file_name


def response_script(state: PageState, upload_name: str = "record") -> str:
    """Return a program that repeats the simulations of the Response tab, in `responses` by model."""
    extra = f", free_vibration={state.free_vibration!r}{_impact_law_code(state)}{_ground_argument_code(state)}"
    yields = bool(yielding_model_labels(state.models))
    if yields:
        extra += ', bouc_wen=yielding if "-BW" in model else None'
    return _python_program(
        state,
        _motion_code_lines(state, upload_name),
        [
            "",
            f"models = {list(state.models)!r}",
            f"responses = {{model: rf.simulate(structure, motion, model{extra}) for model in models}}",
            "for model, response in responses.items():",
            "    print(model, response.status)",
            '    print(f"  largest rotation {response.max_rotation:.6g} rad at {response.time_of_max_rotation:.4f} s")',
            '    print(f"  largest top displacement {response.max_top_displacement:.6g} m relative to the base,")',
            '    print(f"  {response.max_total_top_displacement:.6g} m relative to the ground")',
            '    print(f"  largest base moment {response.max_base_moment:.6g} N m")',
            '    print(f"  largest base shear {response.max_base_shear:.6g} N")',
            '    print(f"  the ground must hold {response.max_horizontal_reaction:.6g} N across")',
            *_element_code_lines(state),
            "    for warning in response.warnings:",
            '        print(f"  {warning}")',
            'rf.save_figure(rf.plot_history(responses.values()), "response.svg")',
            "",
            "# The same from a file that the page saves, Case (TOML):",
            '# table = rf.read_case("case.toml").run()',
        ],
        yields=yields,
    )


def cloud_script(state: PageState, study: CloudStudy) -> str:
    """Return a program that repeats the cloud of the Fragility tab, with its table in `runs`."""
    cloud = state.cloud
    lines = [
        f"runs = rf.run_cloud(structure, motions, {list(cloud.models)!r}, "
        f"{_study_options_code(state, study, cloud.scales)})",
        f"im = np.geomspace(runs[{cloud.measure!r}].min(), runs[{cloud.measure!r}].max(), 60)",
        "curves = {}",
        f"for fit in rf.fit_clouds(runs, {cloud.measure!r}, nominal={cloud.limit == NOMINAL.name}):",
    ]
    limit = limit_of_choice(cloud, build_page_structure(state.structure).properties.top_height)
    if cloud.limit == ROTATION:
        lines.append(f"    curves[fit.model] = fit.outcomes.exceedance(im, {cloud.rotation!r})")
    elif cloud.limit not in LIMIT_STATES:
        column, bound = str(limit).split(" > ")
        lines += [
            '    part = runs[runs["model"].astype(str) == fit.model]',
            f'    beyond = (part["{column}"].abs() > {bound}) | (part["status"] == "overturned")',
            "    if beyond.nunique() > 1:  # else there is no curve to fit",
            f"        curve = rf.fit_logistic(part[{cloud.measure!r}], beyond)",
            "        curves[fit.model] = curve.probability(im)",
        ]
    else:
        curve = "initiation" if cloud.limit == ROCKING.name else "overturning"
        lines.append(f"    curves[fit.model] = fit.outcomes.{curve}.probability(im)")
    return _python_program(
        state, [_suite_motions_code(cloud.suites)], [*lines, "print(curves)"], yields=study.bouc_wen is not None
    )


def design_script(state: PageState, study: DesignStudy) -> str:
    """Return a program that repeats the Design tab, with its chart in `table` and its answer in `answer`."""
    choice = state.design
    levels = [
        f"rf.TendonLevel({each.prestress_ratio!r}, {each.stiffness_ratio!r}, name={each.name!r})"
        for each in study.tendons
    ]
    widths = f"half_widths = {study.half_widths!r}"
    return _python_program(
        state,
        [_suite_motions_code(choice.suites), widths, f"tendons = [{', '.join(levels)}]"],
        [
            f"runs = rf.run_design(structure, motions, half_widths, tendons, {choice.model!r}, "
            f"{_study_options_code(state, study, choice.scales)})",
            f"table = rf.design_table(runs, {study.limits[0]!r}, measure={choice.measure!r}, at={choice.at!r})",
            f"answer = rf.smallest_width(table, {choice.target!r})",
            "print(answer)",
            f'rf.save_figure(rf.plot_design(table, {choice.target!r}), "design.svg")',
        ],
        yields=study.bouc_wen is not None,
    )


def record_set_script(state: PageState, study: Any) -> str:
    """Return a program that repeats the set of records of the Response tab, in `found`, with its checks in `table`."""
    choice, label = state.record_set, state.model_of_set
    scaled = f"motions = [motion.scaled({choice.scale!r}) for motion in motions]"
    yields = bool(yielding_model_labels([label]))
    extra = f"rule={choice.rule or None!r}, periods={study.periods!r}, free_vibration={state.free_vibration!r}"
    extra += f"{_impact_law_code(state)}{_ground_argument_code(state)}{', bouc_wen=yielding' if yields else ''}"
    return _python_program(
        state,
        [_suite_motions_code(choice.suites), *([] if choice.scale == 1.0 else [scaled])],
        [
            f"found = rf.simulate_set(structure, motions, {label!r}, {extra})",
            "print(found.statistics.to_string())",
            f"limits = rf.CheckLimits({_python_named_arguments(state.limits)})",
            "table = rf.check(found, limits)",
            "print(table.to_frame().to_string())",
            'rf.write_report(found, "report.html", structure=structure, limits=limits)',
        ],
        yields=yields,
    )


def tornado_script(state: PageState, study: Any) -> str:
    """Return a program that repeats the tornado of the Response tab, in `bars`."""
    choice, scale = state.record_set, state.record_set.scale
    if choice.shown:
        scaled = [] if scale == 1.0 else [f"motions = [motion.scaled({scale!r}) for motion in motions]"]
        lines, acting = [_suite_motions_code(choice.suites), *scaled], "motions"
    else:
        own = state.record.source in ("upload", "folder")
        lines, acting = _motion_code_lines(state, motion_file_name(study.motions[0]) if own else ""), "motion"
    yields = bool(yielding_model_labels([study.model]))
    extra = f"demand={study.demand!r}, free_vibration={state.free_vibration!r}{_impact_law_code(state)}"
    # A ground of the structure as it is: a function of each structure would have no numbers to change.
    extra += "" if state.ground is None else ", ground=ground(structure.rocking())"
    extra += ", bouc_wen=yielding" if yields else ""
    return _python_program(
        state,
        lines,
        [
            f"ranges = {_python_literal(study.ranges)}",
            f"bars = rf.tornado(structure, {acting}, {study.model!r}, ranges, {extra})",
            "print(bars.to_frame().to_string())",
            'rf.save_figure(rf.plot_tornado(bars), "tornado.svg")',
        ],
        yields=yields,
    )


def selection_script(choice: TargetChoice) -> str:
    """Return a program that repeats the choice of records for a target, in `chosen`."""
    name, values, named = target_spectrum_call(choice)
    if name == "read_target":
        target = target_spectrum_of_choice(choice)
        name, named = "TargetSpectrum", {"damping_ratio": target.damping_ratio, "name": target.name}
        values = [target.periods.tolist(), target.sa.tolist()]
    given = (
        f"rf.read_suite({WHOLE_FOLDER!r})  # unpacked from {WHOLE_FOLDER}.zip, which the page saves: Your records (ZIP)"
    )
    asked = [repr(choice.count), repr((choice.shortest, choice.longest))]
    asked += [f"{key}={value!r}" for key, value in selection_options_of_choice(choice).items() if value is not None]
    lines = [
        "import rockflex as rf",
        "",
        f"target = {_python_call(name, named, *values)}",
        f"suite = {given if choice.source == VISITOR_FOLDER else f'rf.load_suite({choice.source!r})'}",
        f"chosen = suite.select(target, {', '.join(asked)})",
        "print(chosen)",
        "print(chosen.table().to_string(index=False))",
        'chosen.spectra().to_csv("spectra.csv", index=False)',
        'rf.save_figure(rf.plot_selection(chosen), "selection.png")',
    ]
    return "\n".join([*lines, ""])


def uploaded_record_file_name(upload_name: str) -> str:
    """Name of the file in which the page saves an uploaded record."""
    return f"{upload_name}.csv"


def _element_code_lines(state: PageState) -> list[str]:
    """Return lines about the elements between the base and the ground; none without them."""
    if not state.structure.elements:
        return []
    return [
        '    print(f"  the base is left at {response.residual_rotation:.6g} rad")',
        '    print("  largest forces of its elements in N:", response.max_element_force)',
        '    print("  largest elongations in m:", response.max_element_elongation)',
        '    print("  dissipated energies in J:", response.element_energy)',
    ]


def _impact_law_code(state: PageState) -> str:
    """The argument for an impact law; empty if each model has its own."""
    return "" if state.impact is None else f", impact=rf.{state.law()!r}"


def _ground_argument_code(state: PageState) -> str:
    """The argument for the ground; empty if it is rigid and the base cannot slide."""
    return "" if state.ground is None else ", ground=ground"


def _ground_function_code_lines(given: GroundTable | None) -> list[str]:
    """The lines of a function that returns the ground of a structure; none without a ground."""
    if given is None:
        return []
    lines, table = ["def ground(properties):"], given.springs or given.bed
    if table is not None:
        lines += [f"    springs = {_springs_code(table)}"]
        if table.heave_damping_ratio is not None:
            lines += [f"    springs = springs.damped({table.heave_damping_ratio!r}, properties.m_tot)"]
    inertia = "" if given.base_inertia is None else f"base_inertia={given.base_inertia!r}"
    if given.mat_mass is not None:
        inertia = f"base_inertia={given.mat_mass!r} * (2 * properties.half_width) ** 2 / 12"
    parts = (_python_named_arguments({"friction": given.friction}), "" if table is None else "springs=springs", inertia)
    return ["", "", *lines, f"    return rf.Ground({', '.join(filter(None, parts))})", "", ""]


def _springs_code(table: SpringsTable | SpringBedTable) -> str:
    """The call that makes the springs of a file under the base of `properties`."""
    if isinstance(table, SpringsTable):
        edges = "[side * properties.half_width - properties.eccentricity for side in (-1, 1)]"
        positions = edges if table.positions is None else _python_literal(table.positions)
        named = _python_named_arguments(
            {"stiffness": table.stiffness, "damping": table.damping, "capacity": table.capacity}
        )
        return f"rf.Springs({positions}, {named})"
    named = _python_named_arguments(table.model_dump(exclude={"heave_damping_ratio", "method"}))
    maker = f"{table.method or 'asce41'}_bed" if table.subgrade_modulus is None else "winkler_bed"
    return f"rf.{maker}(properties.half_width, {named}, eccentricity=properties.eccentricity)"


def _study_options_code(state: PageState, study: CloudStudy | DesignStudy, scales: Sequence[float]) -> str:
    """The last arguments of a study."""
    yields = "" if study.bouc_wen is None else ", bouc_wen=yielding"
    rest = f"{_impact_law_code(state)}{_ground_argument_code(state)}{yields}"
    return f"scales={list(scales)!r}, free_vibration={study.free_vibration!r}{rest}"


def _python_program(state: PageState, motions: list[str], lines: list[str], *, yields: bool) -> str:
    hysteresis = [f"yielding = rf.{state.hysteresis()!r}"] if yields else []
    head = [
        "import numpy as np",
        "import rockflex as rf",
        "",
        *_structure_code_lines(state.structure),
        *motions,
        *_ground_function_code_lines(state.ground),
    ]
    return "\n".join([*head, *hysteresis, *lines, ""])


def _suite_motions_code(suites: Sequence[str]) -> str:
    embedded = [f"list(rf.load_suite({name!r}))" for name in suites if name not in VISITOR_SUITES]
    if len(embedded) == len(suites):
        return f"motions = {' + '.join(embedded)}"
    note = f"# unpacked from {RECORDS_FOLDER}.zip, which the page saves beside this program: Records (ZIP)"
    return f"motions = {' + '.join([*embedded, f'list(rf.read_suite({RECORDS_FOLDER!r}))'])}  {note}"


def _structure_code_lines(entry: StructureEntry) -> list[str]:
    given: Any = entry.table
    lines = [f"structure = {_python_call(type(given).makes.__name__, given.arguments(''))}"]
    elements = [each.element() for each in entry.elements or []]
    made = ", ".join(_python_call(type(each).__name__, element_parameters(each)) for each in elements)
    for key, value in entry.wrappers.items():
        arguments = _python_named_arguments(wrapper_arguments(key, value))
        lines.append(f"structure = rf.{WRAPPERS[key][0].__name__}(structure, {arguments})")
    if made:
        lines.append(f"structure = rf.Restrained(structure, [{made}])")
    return lines


def _motion_code_lines(state: PageState, upload_name: str) -> list[str]:
    choice = state.record
    if choice.source in ("upload", "folder"):
        line = f"motion = rf.read_motion({uploaded_record_file_name(upload_name)!r})  # saved by the page: Record (CSV)"
    elif choice.source == "pulse":
        line = f"motion = {_pulse_code(choice.pulse)}"
    else:
        line = f"motion = rf.load_suite({choice.suite!r})[{choice.name!r}]"
    return [line, f"motion = motion.scaled({state.scale!r})"]


def _pulse_code(choice: PulseChoice) -> str:
    pulse = PULSES[choice.shape]
    return _python_call(pulse.maker.__name__, pulse.options(choice), choice.amplitude, choice.period)


def _python_call(name: str, named: Mapping[str, Any], *values: Any) -> str:
    return f"rf.{name}({', '.join(filter(None, (*map(_python_literal, values), _python_named_arguments(named))))})"


def _python_named_arguments(values: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={_python_literal(value)}" for name, value in values.items() if value is not None)


def _python_literal(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return _python_literal(value.tolist())
    if isinstance(value, LumpedMasses | Section | Joint):
        return _python_call(type(value).__name__, {each.name: getattr(value, each.name) for each in fields(value)})
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key!r}: {_python_literal(each)}' for key, each in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(map(_python_literal, value))}]"
    if isinstance(value, tuple):
        return f"({', '.join(map(_python_literal, value))},)"
    return "np.inf" if value == math.inf else repr(value)
