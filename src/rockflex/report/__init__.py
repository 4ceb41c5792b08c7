"""Results as documents: a run, a study, a project or a publication.

A run is one page of HTML, for an appendix; a project is one file; a publication is a page of HTML, the same as
Markdown, and a table of numbers. Names are imported when they are first used. The signatures are in ``__init__.pyi``.
"""

import lazy_loader as lazy

__getattr__, __dir__, __all__ = lazy.attach_stub(__name__, __file__)
