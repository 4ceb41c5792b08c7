"""The tables and figures of Silva & Stojadinović (2024), with every number compared to print.

The paper is "Surrogate models for seismic response analysis of flexible rocking structures", Earthquake Engng Struct
Dyn, doi 10.1002/eqe.4193. A target is a table or a figure: a title, and a function of the records that returns a
`rockflex.report.ReproducedResult`. `_targets` lists them, each section of the paper has a module, and `_comparison` has
the rules by which a number passes.

The package also holds what the library has only for this paper: the random `population` and the equivalents of the two
tested specimens. Names are imported when they are first used.
"""

import lazy_loader as lazy

__getattr__, __dir__, __all__ = lazy.attach_stub(__name__, __file__)
