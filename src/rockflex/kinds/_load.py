"""Studies from TOML files."""

from pathlib import Path

from rockflex._errors import InputError
from rockflex._files import path_of
from rockflex.kinds._registry import kind_named
from rockflex.structure.file import read_toml
from rockflex.study.plan import Spec


def load_study(path: str | Path) -> Spec:
    """Read a study from a TOML file.

    Its key `study` is "cloud", "incremental", "stripes", "population", "monte_carlo" or "design"; the other keys are
    the fields of `CloudStudy`, `IncrementalStudy`, `StripeStudy`, `PopulationStudy`, `MonteCarloStudy` or
    `DesignStudy`. Relative paths start from the folder of the file.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    CloudStudy, IncrementalStudy, StripeStudy, PopulationStudy, MonteCarloStudy or DesignStudy
        The study; `.plan()` prepares its runs.

    Raises
    ------
    InputError
        If the file cannot be read, a key is unknown or missing, or a value is wrong; the message names file and key.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import rockflex as rf
    >>> text = '''
    ... study = "population"
    ... pairs = 5
    ... records.suites = ["el-centro-1940"]
    ... '''
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "study.toml")
    ...     _ = file.write_text(text)
    ...     study = rf.load_study(file)
    >>> study.plan().n_runs
    10
    """
    file = path_of("path", path)
    content = read_toml(file, "study")
    try:
        return kind_named(content.get("study")).spec()(**content).read_from(file.parent, file)
    except InputError as error:
        raise InputError(f"{file}: {error}") from error
