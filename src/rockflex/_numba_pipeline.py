"""Compilation of kernels that only kernels call: up to LLVM's intermediate code, and no further.

numba optimises every function together with all functions that it calls, and generates machine code. In a chain of
calls the same code is processed once for every caller, and only the machine code of the outermost function ever runs.
Here only the outermost function is optimised, as a whole: it compiles sooner and runs faster.
"""

from typing import Any, Literal

from numba import _dynfunc  # pyright: ignore[reportPrivateUsage, reportAttributeAccessIssue, reportUnknownVariableType]
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.typed_passes import NativeLowering

# Looked up here, so that a version without them is detected before anything is compiled.
make_function: Any = _dynfunc.make_function  # pyright: ignore[reportUnknownMemberType]
KNOWN: Any = JITCodeLibrary
USED = (KNOWN._optimize_final_module, KNOWN._finalize_final_module, KNOWN._finalize_dynamic_globals, Flags.no_compile)


@register_pass(mutates_CFG=True, analysis_only=False)
class IntermediateLowering(NativeLowering):
    """Lowering into a library without machine code."""

    _name = "intermediate_lowering"

    def run_pass(self, state: Any) -> Literal[True]:
        """Lower one function."""
        library = state.targetctx.codegen().create_library(state.func_id.func_qualname)

        def finalized() -> None:
            library._finalize_dynamic_globals()
            library._finalized = True

        library._optimize_final_module = lambda: None
        library._finalize_final_module = finalized
        state.library, state.flags.no_compile = library, True
        super().run_pass(state)
        # numba identifies a function by a callable object; this one does nothing.
        described = state.cr.fndesc
        name = described.qualname.split(".")[-1]
        known_by = make_function(described.lookup_module(), name, "", 0, state.cr.env, (library,))
        state["cr"] = state.cr._replace(cfunc=known_by)
        state.targetctx.insert_user_function(known_by, described, [library])
        state.reload_init.extend(library._reload_init)
        return True


class Intermediate(CompilerBase):
    """numba's own pipeline except for the lowering."""

    def define_pipelines(self) -> list[Any]:
        """Return the pipeline."""
        passes = PassManager("intermediate")
        for step, why in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
            passes.add_pass(IntermediateLowering if step is NativeLowering else step, why)
        passes.finalize()
        return [passes]
