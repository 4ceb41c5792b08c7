"""How kernels are compiled that only kernels call: up to LLVM's intermediate code, and no further.

numba optimises every function with all that it calls, and makes machine code of it. Along a chain of calls the same
code goes through that once for every caller above it, and only the outermost machine code ever runs. `intermediate`
leaves out all but that one, which is then optimised as a whole: compiled sooner, and faster.
"""

from typing import Any, Literal

from numba import _dynfunc  # pyright: ignore[reportPrivateUsage, reportAttributeAccessIssue, reportUnknownVariableType]
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.typed_passes import NativeLowering

# Looked up here, so that a version without them is known before anything is compiled.
make_function: Any = _dynfunc.make_function  # pyright: ignore[reportUnknownMemberType]
KNOWN: Any = JITCodeLibrary
USED = (KNOWN._optimize_final_module, KNOWN._finalize_final_module, KNOWN._finalize_dynamic_globals, Flags.no_compile)


@register_pass(mutates_CFG=True, analysis_only=False)
class IntermediateLowering(NativeLowering):
    """Lowering into a library of which no machine code is made."""

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
        # numba knows a function by an object to call; this one leads nowhere.
        described = state.cr.fndesc
        name = described.qualname.split(".")[-1]
        known_by = make_function(described.lookup_module(), name, "", 0, state.cr.env, (library,))
        state["cr"] = state.cr._replace(cfunc=known_by)
        state.targetctx.insert_user_function(known_by, described, [library])
        state.reload_init.extend(library._reload_init)
        return True


class Intermediate(CompilerBase):
    """numba's own pipeline, but for its lowering."""

    def define_pipelines(self) -> list[Any]:
        """Return the one pipeline."""
        passes = PassManager("intermediate")
        for step, why in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
            passes.add_pass(IntermediateLowering if step is NativeLowering else step, why)
        passes.finalize()
        return [passes]
