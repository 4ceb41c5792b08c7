"""Modules of the engine run as plain Python, beside the compiled ones."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

from rockflex import engine
from rockflex.engine import run as compiled


def as_python(*names: str, instead: dict[str, ModuleType] | None = None) -> dict[str, ModuleType]:
    """Return modules of `rockflex.engine` by name, loaded from their sources in this order.

    They import one another, and other modules in place of those `instead`; what is imported elsewhere stays compiled.
    """
    beside = Path(str(compiled.__file__)).parent
    place = beside if (beside / "run.py").exists() else Path(__file__).parents[2] / "src" / "rockflex" / "engine"
    others = {f"rockflex.engine.{name}": module for name, module in (instead or {}).items()}
    wanted = {name: f"rockflex.engine.{name}" for name in names}
    known = {name: sys.modules.pop(name) for name in (*wanted.values(), *others)}
    attributes = {name: getattr(engine, name) for name in instead or {}}  # which `from rockflex.engine import` reads
    sys.modules.update(others)
    vars(engine).update(instead or {})
    try:
        for name, whole in wanted.items():
            spec = importlib.util.spec_from_file_location(whole, place / f"{name}.py")
            assert spec is not None
            assert spec.loader is not None
            sys.modules[whole] = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(sys.modules[whole])
        return {name: sys.modules[whole] for name, whole in wanted.items()}
    finally:
        sys.modules.update(known)
        vars(engine).update(attributes)
