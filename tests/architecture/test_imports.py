"""The layers' allowed imports, as docs/design/0001-layers.md has them, against the source as it stands."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2] / "src" / "rockflex"

# What each layer may import besides itself and the foundation. A new layer needs a row here.
ALLOWED = {
    "engine": set(),
    "fragility": set(),
    "motion": {"engine"},
    "structure": set(),
    "models": {"structure", "engine"},
    "response": {"models", "engine", "structure", "motion"},
    "studies": {"response", "models", "engine", "structure", "motion", "fragility"},
    "plot": {"studies", "response", "structure", "motion", "fragility"},
    "report": {"plot", "studies", "response", "models", "structure", "motion", "fragility"},
    "papers": {"report", "plot", "studies", "response", "models", "structure", "motion", "fragility"},
}
FOUNDATION = "foundation"  # every layer may import it, and it none
FACES = {"cli", "web", "__main__"}  # may import anything, and nothing below them or the front
USERS = {"papers"}  # may import the package's own front too, as its users do

# The one place of each of these libraries: layers, or modules of them.
HOME = {
    "matplotlib": {"plot", "papers"},
    "typer": {"cli"},
    "rich": {"cli", "studies.progress"},
    "IPython": {"studies.progress"},
    "distributed": {"studies.parallel", "studies._dask_worker"},
    "dask": {"studies.parallel"},
    "jinja2": {"report"},
    "starlette": {"web"},
    "uvicorn": {"web"},
    "anyio": {"web"},
    "tomli_w": {"studies", "report.project"},
    "obspy": {"motion"},
    "gmprocess": {"motion"},
    "openpyxl": {"motion"},
    "xarray": {"response"},
    "PIL": {"plot"},
    "imageio_ffmpeg": {"plot"},
}
NEVER_AT_IMPORT = {
    "pandas",
    "obspy",
    "gmprocess",
    "openpyxl",
    "imageio_ffmpeg",
}  # only inside functions, or for the type checker
NOT_LOADED = {
    *("scipy", "pandas", "matplotlib", "typer", "rich", "pydantic", "pyarrow", "statsmodels", "sklearn"),
    *("distributed", "jinja2", "IPython", "starlette", "uvicorn", "obspy", "openpyxl", "xarray", "PIL"),
}  # by `import rockflex`
ONLY_FOR_REPORTS = {
    *("matplotlib", "PIL", "jinja2", "markupsafe", "statsmodels", "scipy.stats"),
    *("anyio", "starlette", "uvicorn", "tomli_w", "docx", "xarray"),
}  # with the page and fits
MAX_LINES = 600
MAX_LINES_OF_ONE_TOPIC = 900  # of a module that is one class, or figures of one topic
ONE_TOPIC = {
    "rockflex.response._history",
    "rockflex.engine.flow",
    "rockflex.models._rocking_model",
    "rockflex.models._fields",
    *(f"rockflex.plot._{each}" for each in ("fragility", "history", "loops")),
}

RUNTIME, TYPING, DEFERRED = "when the module is imported", "for the type checker", "inside a function"


@dataclass(frozen=True)
class Import:
    """One imported module: from where, what, and when it is loaded."""

    importer: str
    line: int
    target: str
    when: str

    def __str__(self) -> str:
        return f"{self.importer}:{self.line} imports {self.target} {self.when}"


def read(root: Path) -> dict[str, str]:
    """Source of every module of the package by its dotted name, `__init__` included."""
    paths = sorted(root.rglob("*.py"))
    names = [".".join(path.relative_to(root.parent).with_suffix("").parts) for path in paths]
    return {name: path.read_text("utf-8") for name, path in zip(names, paths, strict=True)}


def imports(sources: dict[str, str]) -> list[Import]:
    """Every import of every module, wherever it stands."""
    modules = {public(name) for name in sources}
    return [found for name in sources for found in _walk(name, ast.parse(sources[name]), modules, RUNTIME)]


def _walk(name: str, node: ast.AST, modules: set[str], when: str) -> Iterator[Import]:
    for child in ast.iter_child_nodes(node):
        for target in _targets(name, child, modules):
            yield Import(name, child.lineno, target, when)
        then = when
        if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            then = DEFERRED
        elif isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test) and when == RUNTIME:
            for part in child.body:  # what stands under `else` is loaded
                yield from _walk(name, ast.Module([part], []), modules, TYPING)
            child = ast.Module(child.orelse, [])
        yield from _walk(name, child, modules, then)


def _targets(name: str, node: ast.AST, modules: set[str]) -> list[str]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom):
        above = name.split(".")[: -node.level] if node.level else []
        base = ".".join([*above, node.module] if node.module else above)
        # `from package import module` names a module, `from module import thing` does not.
        return [full if (full := f"{base}.{alias.name}") in modules else base for alias in node.names]
    if isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in ("import_module", "__import__"):
        return [arg.value for arg in node.args[:1] if isinstance(arg, ast.Constant) and isinstance(arg.value, str)]
    return []


def public(name: str) -> str:
    """Name by which a module is imported."""
    return name.removesuffix(".__init__")


def layer(module: str) -> str:
    """Second part of the dotted name; empty for the package's own front."""
    return [*public(module).split("."), ""][1]


def forbidden(found: list[Import]) -> list[str]:
    """Imports between our modules that the table does not have."""
    wrong = []
    for each in found:
        if each.target.split(".")[0] != "rockflex":
            continue
        importer, target = layer(each.importer), layer(each.target)
        if importer in FACES or importer == target:
            continue
        known = {FOUNDATION} | ALLOWED.get(importer, set()) if importer != FOUNDATION else set[str]()
        if importer in USERS:
            known |= {""}
        if target not in known:
            wrong.append(str(each))
    return wrong


def misplaced(found: list[Import]) -> list[str]:
    """Imports of libraries outside their one place, or at a time when they cost every user."""
    wrong = []
    for each in found:
        library = each.target.split(".")[0]
        home = HOME.get(library)
        module = public(each.importer).removeprefix("rockflex.")
        places = {layer(each.importer), module, module.rpartition(".")[0]}
        elsewhere = home is not None and not home & places
        if elsewhere or (library in NEVER_AT_IMPORT and each.when == RUNTIME):
            wrong.append(str(each))
    return wrong


def cycle(found: list[Import], sources: dict[str, str]) -> list[str]:
    """Modules that import each other in a ring, late and typing imports included; empty if there is none."""
    graph: dict[str, set[str]] = {public(name): set() for name in sources}
    for each in found:
        if each.target in graph:
            graph[public(each.importer)].add(each.target)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def handed_on(sources: dict[str, str]) -> list[str]:
    """Imports inside the package from an `__init__`, which is for users, and not from where the name is defined."""
    modules = {public(name) for name in sources}
    packages = {public(name) for name in sources if name.endswith(".__init__")} - {"rockflex"}
    return [
        f"{name}:{node.lineno} imports {alias.name} from {node.module}"
        for name, source in sources.items()
        if not name.endswith(".__init__")
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ImportFrom) and node.module in packages
        for alias in node.names
        if f"{node.module}.{alias.name}" not in modules
    ]


def careless(sources: dict[str, str]) -> list[str]:
    """Modules without a docstring, too long, or of a layer that the table does not know."""
    wrong = []
    for name, source in sources.items():
        length = len(source.splitlines())
        if length > (MAX_LINES_OF_ONE_TOPIC if name in ONE_TOPIC else MAX_LINES):
            wrong.append(f"{name} has {length} lines")
        if not ast.get_docstring(ast.parse(source)):
            wrong.append(f"{name} has no docstring")
        if layer(name) not in ALLOWED.keys() | {FOUNDATION, ""} | FACES:
            wrong.append(f"{name} belongs to no layer of the table")
    return wrong


SOURCES = read(ROOT)


@pytest.fixture(scope="module")
def found() -> list[Import]:
    """Every import of the package."""
    return imports(SOURCES)


def test_the_walk_sees_the_package(found: list[Import]) -> None:
    assert {"rockflex.__init__", "rockflex.foundation.errors", "rockflex.models._prepared_model"} <= SOURCES.keys()
    assert any(each.when == DEFERRED for each in found)
    assert any(each.when == TYPING for each in found)


def test_the_table_points_downward_only() -> None:
    TopologicalSorter(ALLOWED).prepare()
    assert set().union(*ALLOWED.values()) <= ALLOWED.keys()


def test_layers_import_only_what_the_table_allows(found: list[Import]) -> None:
    assert forbidden(found) == []


def test_libraries_stay_in_their_place(found: list[Import]) -> None:
    assert misplaced(found) == []


def test_names_are_imported_from_where_they_are_defined() -> None:
    assert handed_on(SOURCES) == []
    package = {"motion/__init__": "from rockflex.motion._a import x", "motion/_a": "x = 1"}
    assert handed_on(synthetic(package | {"plot/_b": "from rockflex.motion import x, _a"})) == [
        "rockflex.plot._b:1 imports x from rockflex.motion"
    ]


def test_no_import_cycles_between_files(found: list[Import]) -> None:
    assert cycle(found, SOURCES) == []


@pytest.mark.slow
def test_every_module_is_short_documented_and_of_a_layer() -> None:
    assert careless(SOURCES) == []


def test_importing_the_package_loads_no_heavy_library() -> None:
    program = f"import sys, rockflex; rockflex.__version__; print(*sorted({NOT_LOADED!r} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def synthetic(modules: dict[str, str]) -> dict[str, str]:
    """A package of one's own: keys are paths; every package has an `__init__`."""
    sources = {f"rockflex.{name.replace('/', '.')}": text for name, text in modules.items()}
    packages = {".".join(name.split(".")[:i]) for name in sources for i in range(1, name.count(".") + 1)}
    return {f"{package}.__init__": "" for package in packages} | sources


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("motion/_pulses", "from rockflex.structure import Frame"),
        ("motion/_pulses", "import rockflex.models._work as work"),
        ("motion/_pulses", "from rockflex import studies"),
        ("motion/_pulses", "from rockflex import Frame"),
        ("motion/_pulses", "from ..studies import simulate"),
        ("motion/__init__", "from ..studies import simulate"),
        ("structure/_rocking", "def f():\n    from rockflex.motion import GroundMotion"),
        ("structure/_rocking", "class A:\n    def f(self):\n        if self:\n            import rockflex.plot"),
        ("engine/march", "if TYPE_CHECKING:\n    from rockflex.structure import RockingProperties"),
        ("engine/march", "if typing.TYPE_CHECKING:\n    pass\nelse:\n    from rockflex.structure import X"),
        ("engine/march", "engine = importlib.import_module('rockflex.studies')"),
        ("models/_linear", "try:\n    from rockflex.response import Response\nexcept ImportError:\n    pass"),
        ("response/_file", "from rockflex.cli import main"),
        ("plot/_history", "from rockflex.engine.solution import Solution"),
        ("foundation/checks", "from rockflex.motion import GroundMotion"),
    ],
)
def test_a_forbidden_arrow_is_seen(module: str, source: str) -> None:
    sources = synthetic({"studies/_table": "", "plot/_style": "", module: source})
    (wrong,) = forbidden(imports(sources))
    assert f"rockflex.{module.replace('/', '.')}:" in wrong


def test_allowed_arrows_pass() -> None:
    sources = synthetic(
        {
            "foundation/checks": "from rockflex.foundation.errors import InputError",
            "structure/_frames": "from ._beam import f, g\nimport math\nfrom ..foundation import checks",
            "structure/_beam": "import numpy",
            "cli/_run": "import rockflex as rf, typer, rich.console\nfrom rockflex.studies import simulate",
            "studies/_table": "import pandasql\ndef f():\n    import pandas\nif TYPE_CHECKING:\n    import pandas",
            "plot/_history": "import matplotlib.pyplot as plt",
        }
    )
    found = imports(sources)
    assert len(found) == 14
    assert forbidden(found) == []
    assert misplaced(found) == []
    assert cycle(found, sources) == []


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("studies/_table", "import pandas as pd"),
        ("studies/_table", "class A:\n    from pandas import DataFrame"),
        ("studies/_table", "if TYPE_CHECKING:\n    pass\nelse:\n    import pandas"),
        ("response/_history", "def show():\n    import matplotlib.pyplot as plt"),
        ("studies/_table", "from rich.table import Table"),
        ("motion/_spectra", "from xarray import Dataset"),
    ],
)
def test_a_misplaced_library_is_seen(module: str, source: str) -> None:
    (wrong,) = misplaced(imports(synthetic({module: source})))
    assert "imports" in wrong


def test_a_cycle_is_seen() -> None:
    ring = synthetic({"structure/_a": "from rockflex.structure._b import x", "structure/_b": "from . import _a"})
    assert {"rockflex.structure._a", "rockflex.structure._b"} == set(cycle(imports(ring), ring))
    late = synthetic(
        {"structure/_a": "from rockflex.structure._b import x", "structure/_b": "def f():\n    from . import _a"}
    )
    assert {"rockflex.structure._a", "rockflex.structure._b"} == set(cycle(imports(late), late))


def test_a_careless_module_is_seen() -> None:
    text = '"""A docstring."""\n'
    assert careless({"rockflex.structure": text * MAX_LINES}) == []
    assert careless({"rockflex.structure": text * (MAX_LINES + 1)}) == [f"rockflex.structure has {MAX_LINES + 1} lines"]
    assert careless({"rockflex.structure": "x = 1"}) == ["rockflex.structure has no docstring"]
    assert careless({"rockflex.wizard._a": text}) == ["rockflex.wizard._a belongs to no layer of the table"]


def test_a_first_run_loads_no_heavy_library():
    """What takes long to import waits until something needs it."""
    code = (
        "import sys, rockflex as rf\n"
        "frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)\n"
        "rf.simulate(frame, rf.load_suite('el-centro-1940')[0])\n"
        "print(*sorted({name.partition('.')[0] for name in sys.modules} | {*sys.modules}))"
    )
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "numpy" in loaded
    assert not {"scipy", "pandas", "pyarrow", "pydantic", "matplotlib", "typer", "jinja2", "numpy.ma"} & {*loaded}


@pytest.mark.slow
@pytest.mark.parametrize(
    "work",
    [
        "rf.simulate(frame, motion)",
        "rf.simulate_many(frame, motion, ['2DOF-S', 'MDOF-S'], scales=(1.0, 2.0)).to_csv('many.csv')",
        "rf.run_cloud(frame, motion, '2DOF-S', scales=[1.0, 2.0])",
        "main(['run', 'a.toml', 'el-centro-1940', '--model', '2DOF-S,MDOF-S', '--out', 'results', '--figures', '0'])",
        "main(['cloud', 'cloud.toml', '--dry-run'])",
        "main(['modes', 'a.toml'])",
    ],
)
def test_runs_need_nothing_that_only_reports_the_page_and_fits_need(work, tmp_path):
    """As if what draws, serves and fits were not installed."""
    text = (
        "n_stories = 2\nstory_height = 3.0\nstory_mass = 40e3\nbase_mass = 40e3\nstiffness_ratio = 1.0\nperiod = 0.5\n"
    )
    text += "aspect_ratio = 8.0\ndamping_ratio = 0.02\n"
    (tmp_path / "a.toml").write_text(f"[frame]\n{text}", "utf-8")
    cloud = 'study = "cloud"\nmodels = ["2DOF-S"]\nscales = [1.0]\n[records]\nsuites = ["el-centro-1940"]\n'
    (tmp_path / "cloud.toml").write_text(f"{cloud}[[structures]]\n[structures.frame]\n{text}", "utf-8")
    code = (
        "import sys\n"
        f"sys.modules.update(dict.fromkeys({sorted(ONLY_FOR_REPORTS)!r}))\n"
        "import rockflex as rf\n"
        "from rockflex.cli._app import app\n"
        "main = lambda words: app(words, standalone_mode=False)\n"
        "frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)\n"
        "motion = rf.load_suite('el-centro-1940')[0]\n" + work
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 0, done.stderr
