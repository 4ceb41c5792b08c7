"""The kinds of study: a module a kind, one registry, and what loads and runs a study of any kind.

Names are imported when they are first used, so that ``rockflex --help`` takes no time. The signatures are in
``__init__.pyi``.
"""

import lazy_loader as lazy

__getattr__, __dir__, __all__ = lazy.attach_stub(__name__, __file__)
