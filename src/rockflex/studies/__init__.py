"""Studies: one run, the cross product of many, studies of every kind, and rocking and overturning spectra.

Names are imported when they are first used. The signatures are in ``__init__.pyi``.
"""

import lazy_loader as lazy

__getattr__, __dir__, __all__ = lazy.attach_stub(__name__, __file__)
