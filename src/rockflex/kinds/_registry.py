"""Every kind of study, by the name that files use. A new kind needs its own module and one line here."""

from difflib import get_close_matches

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.kinds import _cloud, _design, _incremental, _monte_carlo, _population, _stripes
from rockflex.kinds._kind import StudyKind

KINDS: dict[str, StudyKind] = {
    kind.name: kind
    for kind in (
        _cloud.CLOUD,
        _incremental.INCREMENTAL,
        _stripes.STRIPES,
        _population.POPULATION,
        _monte_carlo.MONTE_CARLO,
        _design.DESIGN,
    )
}


def kind_named(name: object) -> StudyKind:
    """Return the kind of a name.

    Raises
    ------
    InputError
        If there is no such kind.
    """
    found = KINDS.get(name) if isinstance(name, str) else None
    if found is None:
        known = ", ".join(f'"{each}"' for each in KINDS)
        near = get_close_matches(str(name), KINDS, n=1)
        hint = f' Did you mean "{near[0]}"?' if near else ""
        was = "it is missing" if name is None else f"{shown(name)} was given"
        raise InputError(f"study must be one of {known}, but {was}.{hint}")
    return found
