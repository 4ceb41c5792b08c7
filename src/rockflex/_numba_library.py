"""Libraries of LLVM's intermediate code: one for each inner kernel, and one for an entry point with all that it calls.

numba optimises the functions of every library, verifies it, and copies it with everything that it calls into each of
its callers. Here the text of a kernel is parsed once for every entry point that contains it, and optimised only there.
"""

from collections.abc import Iterator
from typing import Any

from llvmlite import binding  # pyright: ignore[reportMissingTypeStubs]
from llvmlite.binding import newpassmanagers  # pyright: ignore[reportMissingTypeStubs]
from numba.core.cgutils import normalize_ir_text
from numba.core.codegen import JITCodeLibrary

# Private parts are looked up here, so that a version without them is detected before anything is compiled.
KNOWN: Any = JITCodeLibrary
USED = (
    KNOWN._optimize_functions,
    KNOWN._optimize_final_module,
    KNOWN._finalize_dynamic_globals,
    KNOWN._finalize_final_module,
    KNOWN._get_module_for_linking,
)


class Intermediate(KNOWN):
    """The text of one kernel, and the libraries that it needs."""

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.texts: list[str] = []

    def add_ir_module(self, ir_module: Any) -> None:
        """Keep the text."""
        self.texts.append(normalize_ir_text(str(ir_module)))

    def finalize(self) -> None:
        """Neither optimise nor generate machine code."""
        self._raise_if_finalized()
        inherit(self)
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """Return the kernel with all that it calls, for a function that is compiled by numba's own pipeline."""
        self._ensure_finalized()
        if self._shared_module is None:
            link(self._final_module, [self])
            # Not internal: LLVM would change what such functions take, and others would call them by the same name.
            declare(self._final_module, defined(self._final_module), "linkonce_odr")
            self._shared_module = self._final_module
        return self._shared_module


class Whole(KNOWN):
    """An entry point, optimised with everything that it calls."""

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.enable_object_caching()

    def finalize(self) -> None:
        """Optimise and generate machine code."""
        self._raise_if_finalized()
        inherit(self)
        own = defined(self._final_module)
        link(self._final_module, self._linking_libraries)
        self._final_module.verify()
        # What is internal from the start LLVM makes into fewer and larger functions, for twice the time.
        declare(self._final_module, defined(self._final_module) - own, "linkonce_odr")
        optimize(self._codegen, self._final_module)
        # Of equal names, LLVM would take the first in the process, even from a function that was freed.
        declare(self._final_module, defined(self._final_module) - own, "internal")
        self._finalize_final_module()

    def _optimize_functions(self, ll_module: Any) -> None:
        ll_module.data_layout = self._codegen._data_layout


def inherit(library: Any) -> None:
    """Take over what must be initialised when code is loaded from disk; older versions have nothing of the kind."""
    for each in library._linking_libraries:
        if hasattr(library, "_reload_init"):
            library._reload_init.update(each._reload_init)


def link(module: Any, libraries: list[Any]) -> None:
    """Link libraries, and all that they need, into a module."""
    for library in _all_of(libraries, set()):
        if isinstance(library, Intermediate):
            for text in library.texts:
                part = binding.parse_assembly(text)
                part.data_layout = library._codegen._data_layout
                module.link_in(part)
        else:
            module.link_in(library._get_module_for_linking(), preserve=True)


def defined(module: Any) -> set[str]:
    """Return the names of the functions in a module."""
    return {each.name for each in module.functions if not each.is_declaration}


def declare(module: Any, names: set[str], linkage: str) -> None:
    """Say who may call these functions of a module."""
    for each in module.functions:
        if each.name in names:
            each.linkage = linkage


def _all_of(libraries: list[Any], seen: set[Any]) -> Iterator[Any]:
    for library in libraries:
        if library not in seen:
            seen.add(library)
            yield library
            if isinstance(library, Intermediate):
                yield from _all_of(library._linking_libraries, seen)


def optimize(codegen: Any, module: Any) -> None:
    """Optimise without unrolling or vectorising loops, which makes three times as much code, and no faster code."""
    tuning = newpassmanagers.create_pipeline_tuning_options(3)
    tuning.loop_vectorization = tuning.slp_vectorization = tuning.loop_unrolling = False
    builder = newpassmanagers.create_pass_builder(codegen._tm, tuning)
    builder.getModulePassManager().run(module, builder)
