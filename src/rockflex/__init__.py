"""Exact and fast seismic response of flexible structures whose base may uplift and rock.

Names are imported from their layers when they are first used, so that ``import rockflex`` and
``rockflex --help`` take no time. The signatures stand in ``__init__.pyi``.
"""

import lazy_loader as lazy

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = lazy.attach_stub(__name__, __file__)
