"""The random population of Sections 3.3 and 3.4: its structures, its study and its statistics.

Names are imported when they are first used. The signatures are in ``__init__.pyi``.
"""

import lazy_loader as lazy

__getattr__, __dir__, __all__ = lazy.attach_stub(__name__, __file__)
