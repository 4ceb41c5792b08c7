"""What commands that simulate one structure prepare from their arguments: the structure, its motions and the runs."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import typer

from rockflex._schema import BedKeys, BoucWenKeys, FrameFlags, GroundKeys, ImpactKeys, InitialKeys
from rockflex.cli._choices import choose_models, make_assumptions, number_or_word, parse_work_limit
from rockflex.cli._console import note
from rockflex.cli._flags import given, naming
from rockflex.cli._motions import FoundMotion, find_motions, quiet_ground
from rockflex.cli._simulations import Batch
from rockflex.cli._structures import LoadedStructure, load_structure, split_arguments
from rockflex.motion import OnError
from rockflex.response import friction_coefficient
from rockflex.study._arguments import factors_of, free_vibration_time
from rockflex.study._ranges import parsed
from rockflex.study._yielding import yielding

FLAGS = {"free_vibration": "--free-vibration", "scales": "--scale", "mu": "--friction"}


@dataclass(frozen=True)
class Asked:
    """The arguments of such a command as they were given; None of each was not given."""

    arguments: Sequence[str]
    structure: Path | None
    motion: Sequence[str] | None
    model: Sequence[str] | None
    scale: Sequence[str]
    free_vibration: str
    work_limit: str | None = None
    workers: int | None = None
    friction: float | None = None
    units: str | None = None
    dt: float | None = None
    on_error: OnError = "raise"
    vertical: str | None = None


@dataclass(frozen=True)
class Prepared:
    """A structure, the motions that were found, and the runs of one with the other."""

    loaded: LoadedStructure
    found: list[FoundMotion]
    batch: Batch


def prepare(context: typer.Context, asked: Asked, *, histories: int) -> Prepared:
    """Return the runs that the arguments and the generated flags of a command ask for.

    Histories are kept of up to `histories` motions, each scale counted.

    Raises
    ------
    InputError
        If an argument, a file or a record cannot be used.
    """
    file, names = split_arguments(asked.structure, asked.arguments)
    loaded = load_structure(file, given(context, FrameFlags))
    law, bouc_wen, initial = (given(context, table) for table in (ImpactKeys, BoucWenKeys, InitialKeys))
    ground = given(context, GroundKeys) | given(context, BedKeys)
    assumptions = make_assumptions(file, loaded.assumed, law, bouc_wen, initial, ground, loaded.properties)
    models = choose_models(asked.model, loaded.properties, assumptions, by_flag=bool(bouc_wen))
    if assumptions.bouc_wen is not None and not yielding(models):
        note(f"[bouc_wen] of {file} is for models that end in -BW, such as 2DOF-S-BW; none was given")
    names += asked.motion or []
    with naming(FLAGS):
        free = number_or_word(asked.free_vibration)
        free_vibration_time(free)
        mu = None if asked.friction is None else friction_coefficient(asked.friction)
        if names or asked.vertical or not initial:
            found = find_motions(names, asked.units, asked.dt, asked.on_error, asked.vertical)
        else:
            found, free = quiet_ground(free)
        given_scales = [factor for text in asked.scale for factor in parsed(text)]
        strongest = max((each.motion for each in found), key=lambda it: it.pga)
        scales = list(dict.fromkeys(factors_of(given_scales, strongest)))
        batch = Batch(
            properties=loaded.properties,
            motions=[each.motion for each in found],
            scales=scales,
            models=models,
            free_vibration=free,
            history=len(found) * len(scales) <= histories,
            workers=asked.workers,
            assumptions=assumptions,
            friction=mu,
            work_limit=parse_work_limit(asked.work_limit),
        )
    return Prepared(loaded, found, batch)
