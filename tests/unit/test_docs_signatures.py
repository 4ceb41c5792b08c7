"""Signatures of the reference: readable, without numpy's unions and without private aliases."""

import importlib.util
import inspect
from pathlib import Path

import pytest

import rockflex

pytest.importorskip("sphinx")
SOURCE = Path(__file__).parents[2] / "docs" / "_extensions" / "signatures.py"
SPEC = importlib.util.spec_from_file_location("signatures", SOURCE)
signatures = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(signatures)


def rendered(name: str) -> str:
    """Parameters and result of a public name."""
    obj = getattr(rockflex, name)
    what = "class" if isinstance(obj, type) else "function"
    return " ".join(filter(None, signatures.signature(None, what, name, obj, None, str(inspect.signature(obj)), None)))


def is_shown(name: str) -> bool:
    obj = getattr(rockflex, name)
    return callable(obj) and not (isinstance(obj, type) and issubclass(obj, Exception))


@pytest.mark.parametrize("name", list(filter(is_shown, rockflex.__all__)))
def test_a_signature_has_readable_types(name):
    for word in ("_Buffer", "_SupportsArray", "SupportsIndex", "NDArray", "Float", "Array ", "Motions", "WorkLimit"):
        assert word not in rendered(name)


def test_aliases_and_constants_are_written_out():
    assert rendered("read_suite").startswith("(paths: str | Path | Iterable[str | Path], ")
    assert "work_limit: float | Literal['default', 'none'] | None='default'" in rendered("simulate")
    assert "output: Literal['history', 'peaks']='history'" in rendered("simulate")
    assert rendered("HazardCurve") == "(im: ArrayLike, rate: ArrayLike, *, damping: float=0.05)"
    assert rendered("CloudFit").endswith("covariance: ndarray, n_groups: int = 0)")
