"""Compilation of kernels that only kernels call: up to LLVM's intermediate code, and no further.

numba optimises every function together with all functions that it calls, and generates machine code. In a chain of
calls the same code is processed once for every caller, and only the machine code of the outermost function ever runs.
Here only the outermost function is optimised, as a whole: it compiles sooner and runs faster.
"""

import gc
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any, Literal

from numba import _dynfunc  # pyright: ignore[reportPrivateUsage, reportAttributeAccessIssue, reportUnknownVariableType]
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.typed_passes import InlineOverloads, NativeLowering, NopythonRewrites
from numba.core.untyped_passes import (
    FindLiterallyCalls,
    InlineClosureLikes,
    InlineInlinables,
    LiteralPropagationSubPipelinePass,
    LiteralUnroll,
    MakeFunctionToJitFunction,
    RewriteDynamicRaises,
    WithLifting,
)

from rockflex import _numba_library
from rockflex._numba_lowering import InnerLower, TerseLower
from rockflex._numba_typing import attentive, remembering

# Looked up here, so that a version without them is detected before anything is compiled.
make_function: Any = _dynfunc.make_function  # pyright: ignore[reportUnknownMemberType]
USED = Flags.no_compile


@register_pass(mutates_CFG=True, analysis_only=False)
class IntermediateLowering(NativeLowering):
    """Lowering into a library without machine code."""

    _name = "intermediate_lowering"
    lowering_class: Any = InnerLower  # pyright: ignore[reportIncompatibleMethodOverride, reportAssignmentType]

    def run_pass(self, state: Any) -> Literal[True]:
        """Lower one function."""
        library = _numba_library.Intermediate(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library, state.flags.no_compile = library, True
        super().run_pass(state)
        # numba identifies a function by a callable object; this one does nothing.
        described = state.cr.fndesc
        name = described.qualname.split(".")[-1]
        known_by = make_function(described.lookup_module(), name, "", 0, state.cr.env, (library,))
        state["cr"] = state.cr._replace(cfunc=known_by)
        library.passing.register(state.targetctx, known_by, library)
        if hasattr(library, "_reload_init"):
            state.reload_init.extend(library._reload_init)
        return True


@register_pass(mutates_CFG=True, analysis_only=False)
class WholeLowering(NativeLowering):
    """Lowering of an entry point, optimised with everything that it calls."""

    _name = "whole_lowering"
    lowering_class: Any = TerseLower  # pyright: ignore[reportIncompatibleMethodOverride, reportAssignmentType]

    def run_pass(self, state: Any) -> Literal[True]:
        """Lower one function."""
        state.library = _numba_library.Whole(state.targetctx.codegen(), state.func_id.func_qualname)
        super().run_pass(state)
        return True


class QuickFlags(Flags):
    """numba's flags, which are compared at every call of a function; the original asks for each by name."""

    __slots__ = ()

    def __hash__(self) -> int:
        return NAMES

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Flags) and self.values() == other.values())  # pyright: ignore[reportAttributeAccessIssue, reportUnknownMemberType]

    def values(self) -> dict[str, Any]:
        """Return all values."""
        return DEFAULTS | self._values  # pyright: ignore[reportAttributeAccessIssue]


QuickFlags.__name__ = Flags.__name__  # part of the names of compiled functions
DEFAULTS = {name: option.default for name, option in Flags.options.items()}  # pyright: ignore[reportAttributeAccessIssue]

NAMES = hash(tuple(sorted(DEFAULTS)))  # as the original

# Passes for what no kernel uses: closures, `with`, unrolled tuples, literal arguments, functions inlined by numba,
# expressions of arrays, exceptions with computed arguments.
UNUSED = {
    FindLiterallyCalls,
    InlineClosureLikes,
    InlineInlinables,
    InlineOverloads,
    LiteralPropagationSubPipelinePass,
    LiteralUnroll,
    MakeFunctionToJitFunction,
    NopythonRewrites,
    RewriteDynamicRaises,
    WithLifting,
}


class Terse(CompilerBase):
    """numba's own pipeline without the passes for what no kernel uses."""

    lowering: Any

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.state.flags.__class__ = QuickFlags

    def define_pipelines(self) -> list[Any]:
        """Return the pipeline."""
        self.state.typingctx = attentive(self.state.typingctx)
        passes = PassManager(self.lowering._name)
        for step, why in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
            if step not in UNUSED:
                passes.add_pass(self.lowering if step is NativeLowering else step, why)
        passes.finalize()
        return [passes]


class Intermediate(Terse):
    """For kernels that only kernels call."""

    lowering = IntermediateLowering


class Whole(Terse):
    """For kernels that Python calls."""

    lowering = WholeLowering

    def compile_extra(self, func: Any) -> Any:
        """Compile, with what helps to do so quickly."""
        with remembering(), without_collection():
            return super().compile_extra(func)


@contextmanager
def without_collection() -> Generator[None, None, None]:
    """Let no garbage be collected: there is little, among many objects."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
