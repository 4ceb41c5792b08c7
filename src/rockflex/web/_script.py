"""Python programs that reproduce the results of the page."""

import math
from typing import Any

import numpy as np

from rockflex.fragility import NOMINAL, ROCKING
from rockflex.modal import Tendon
from rockflex.structure import LumpedMasses
from rockflex.structure.file import StructureEntry
from rockflex.study._yielding import yielding
from rockflex.study.assumed import Assumed
from rockflex.study.cloud import CloudStudy
from rockflex.study.design import DesignStudy
from rockflex.web._limit_states import ROTATION
from rockflex.web._records import PULSES
from rockflex.web._state import PulseChoice, State


def response_script(state: State, upload_name: str = "record") -> str:
    """Return a program that repeats the simulations of the Response tab, in `responses` by model."""
    extra = f", free_vibration={state.free_vibration!r}{_law(state)}"
    if yields := yielding(state.models):
        extra += ', bouc_wen=yielding if "-BW" in model else None'
    return "\n".join(
        [
            "import numpy as np",
            "import rockflex as rf",
            "",
            *_structure(state.structure),
            *_motion(state, upload_name),
            *([_hysteresis(state)] if yields else []),
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
            "    for warning in response.warnings:",
            '        print(f"  {warning}")',
            'rf.save_figure(rf.plot_history(responses.values()), "response.svg")',
            "",
        ]
    )


def cloud_script(state: State, study: CloudStudy) -> str:
    """Return a program that repeats the cloud of the Fragility tab, with its table in `runs`."""
    cloud = state.cloud
    records = " + ".join(f"list(rf.load_suite({name!r}))" for name in cloud.suites)
    lines = [
        "import numpy as np",
        "import rockflex as rf",
        "",
        *_structure(state.structure),
        f"motions = {records}",
        *([_hysteresis(state)] if study.bouc_wen else []),
        f"runs = rf.run_cloud(structure, motions, {list(cloud.models)!r}, scales={list(cloud.scales)!r}, "
        f"free_vibration={study.free_vibration!r}{_law(state)}{_yielding(study)})",
        f"im = np.geomspace(runs[{cloud.measure!r}].min(), runs[{cloud.measure!r}].max(), 60)",
        "curves = {}",
        f"for fit in rf.fit_clouds(runs, {cloud.measure!r}, nominal={cloud.limit == NOMINAL.name}):",
    ]
    if cloud.limit == ROTATION:
        lines.append(f"    curves[fit.model] = fit.outcomes.exceedance(im, {cloud.rotation!r})")
    else:
        curve = "initiation" if cloud.limit == ROCKING.name else "overturning"
        lines.append(f"    curves[fit.model] = fit.outcomes.{curve}.probability(im)")
    return "\n".join([*lines, "print(curves)", ""])


def design_script(state: State, study: DesignStudy) -> str:
    """Return a program that repeats the Design tab, with its chart in `table` and its answer in `answer`."""
    choice = state.design
    records = " + ".join(f"list(rf.load_suite({name!r}))" for name in choice.suites)
    levels = [
        f"rf.TendonLevel({each.prestress_ratio!r}, {each.stiffness_ratio!r}, name={each.name!r})"
        for each in study.tendons
    ]
    return "\n".join(
        [
            "import numpy as np",
            "import rockflex as rf",
            "",
            *_structure(state.structure),
            f"motions = {records}",
            f"half_widths = {study.half_widths!r}",
            f"tendons = [{', '.join(levels)}]",
            *([_hysteresis(state)] if study.bouc_wen else []),
            f"runs = rf.run_design(structure, motions, half_widths, tendons, {choice.model!r}, "
            f"scales={list(choice.scales)!r}, free_vibration={study.free_vibration!r}{_law(state)}{_yielding(study)})",
            f"table = rf.design_table(runs, {study.limits[0]!r}, measure={choice.measure!r}, at={choice.at!r})",
            f"answer = rf.smallest_width(table, {choice.target!r})",
            "print(answer)",
            f'rf.save_figure(rf.plot_design(table, {choice.target!r}), "design.svg")',
            "",
        ]
    )


def record_file(upload_name: str) -> str:
    """Name of the file in which the page saves an uploaded record."""
    return f"{upload_name}.csv"


def _law(state: State) -> str:
    """The argument for an impact law; empty if each model has its own."""
    return "" if state.impact is None else f", impact=rf.{state.law()!r}"


def _hysteresis(state: State) -> str:
    return f"yielding = rf.{state.hysteresis()!r}"


def _yielding(study: Assumed) -> str:
    return "" if study.bouc_wen is None else ", bouc_wen=yielding"


def _structure(entry: StructureEntry) -> list[str]:
    makes = type(entry.table).makes
    given: Any = entry.table
    arguments = {name: value for name, value in given.arguments("").items() if value is not None}
    inner = ", ".join(f"{name}={_literal(value)}" for name, value in arguments.items())
    lines = [f"structure = rf.{makes.__name__}({inner})"]
    held = [_literal(Tendon(**each.model_dump())) for each in entry.tendons]
    based = {"eccentricity": repr(entry.eccentricity)} if entry.eccentricity else {}
    based |= {"tendons": f"[{', '.join(held)}]"} if held else {}
    if based and entry.kind in ("properties", "block"):
        changes = ", ".join(f"{name}={value}" for name, value in based.items())
        return [*lines, "from dataclasses import replace", f"structure = replace(structure, {changes})"]
    wraps = {"eccentricity": "Eccentric", "tendons": "Restrained"}
    return lines + [f"structure = rf.{wraps[name]}(structure, {value})" for name, value in based.items()]


def _motion(state: State, upload_name: str) -> list[str]:
    choice = state.record
    if choice.source == "upload":
        line = f"motion = rf.read_motion({record_file(upload_name)!r})  # saved by the page: Record (CSV)"
    elif choice.source == "pulse":
        line = f"motion = rf.{_pulse(choice.pulse)}"
    else:
        line = f"motion = rf.load_suite({choice.suite!r})[{choice.name!r}]"
    return [line, f"motion = motion.scaled({state.scale!r})"]


def _pulse(p: PulseChoice) -> str:
    return PULSES[p.shape][1].format(a=repr(p.amplitude), T=repr(p.period), g=repr(p.gamma), n=repr(p.nu))


def _literal(value: Any) -> str:
    if isinstance(value, float) and math.isinf(value):
        return "np.inf"
    if isinstance(value, LumpedMasses):
        parts: dict[str, Any] = {"heights": value.heights, "masses": value.masses, "rotary": value.rotary}
        inner = ", ".join(f"{name}={_literal(np.asarray(each).tolist())}" for name, each in parts.items())
        return f"rf.LumpedMasses({inner})"
    if isinstance(value, Tendon):
        inner = f"initial_force={value.initial_force!r}, stiffness={value.stiffness!r}, position={value.position!r}"
        return f"rf.Tendon({inner}" + (
            f", yield_force={value.yield_force!r})" if value.yield_force is not None else ")"
        )
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key!r}: {_literal(each)}' for key, each in value.items())}}}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(_literal(each) for each in value)}]" if isinstance(value, list) else _tuple(value)
    return repr(value)


def _tuple(values: tuple[Any, ...]) -> str:
    return f"({', '.join(_literal(each) for each in values)},)"
