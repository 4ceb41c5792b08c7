"""Exact and fast seismic response of flexible structures whose base may uplift and rock.

Names are imported from their packages on first use, so that ``import rockflex`` and ``rockflex --help``
are instant. The public names are listed in ``__init__.pyi``.
"""

import lazy_loader as lazy

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = lazy.attach_stub(__name__, __file__)
