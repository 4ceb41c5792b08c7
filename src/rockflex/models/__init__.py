"""Models of a structure on a base that may uplift."""

from rockflex.models._label import Model, parse_model
from rockflex.models._linear import LinearModel

__all__ = ["LinearModel", "Model", "parse_model"]
