"""Studies from TOML files."""

from difflib import get_close_matches
from pathlib import Path

from rockflex._errors import InputError
from rockflex._files import path_of
from rockflex._shown import shown
from rockflex.structure.file import read_toml
from rockflex.study.plans._cloud import CloudStudy
from rockflex.study.plans._design import DesignStudy
from rockflex.study.plans._incremental import IncrementalStudy
from rockflex.study.plans._population import PopulationStudy
from rockflex.study.plans._stripes import StripeStudy

Study = CloudStudy | PopulationStudy | IncrementalStudy | StripeStudy | DesignStudy

KINDS: dict[str, type[Study]] = {
    "cloud": CloudStudy,
    "population": PopulationStudy,
    "incremental": IncrementalStudy,
    "stripes": StripeStudy,
    "design": DesignStudy,
}


def load_study(path: str | Path) -> Study:
    """Read a study from a TOML file.

    Its key `study` is "cloud", "population", "incremental", "stripes" or "design"; the others are the fields of
    `CloudStudy`, `PopulationStudy`, `IncrementalStudy`, `StripeStudy` or `DesignStudy`. Paths start from the folder of
    the file.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    CloudStudy, PopulationStudy, IncrementalStudy, StripeStudy or DesignStudy
        What the file says; `.plan()` makes it ready to run.

    Raises
    ------
    InputError
        If the file cannot be read, a key is unknown or missing, or a value is wrong; the message names file and key.
    """
    file = path_of("path", path)
    content = read_toml(file, "study")
    kind = content.get("study")
    model = KINDS.get(kind) if isinstance(kind, str) else None
    if model is None:
        known = ", ".join(f'"{name}"' for name in KINDS)
        near = get_close_matches(str(kind), KINDS, n=1)
        hint = f' Did you mean "{near[0]}"?' if near else ""
        was = f"{shown(kind)} was given" if "study" in content else "it is missing"
        raise InputError(f"{file}: study must be one of {known}, but {was}.{hint}")
    try:
        return model(**content).read_from(file.parent)
    except InputError as error:
        raise InputError(f"{file}: {error}") from error
