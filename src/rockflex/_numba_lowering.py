"""Lowering of kernels into less of LLVM's intermediate code.

numba passes a tuple of arrays number by number, packs it into an aggregate at the start of a function, stores that on
the stack, loads it for every use, and unpacks it again for every access and call. LLVM removes nine tenths of this
code, but that takes most of the time of a compilation. Here most of it is never written.
"""

from typing import Any

from llvmlite import ir  # pyright: ignore[reportMissingTypeStubs]
from llvmlite.ir import instructions as instructions  # pyright: ignore[reportMissingTypeStubs]
from numba.core.analysis import compute_cfg_from_blocks, compute_use_defs, must_use_alloca
from numba.core.ir import Assign
from numba.core.lowering import Lower

from rockflex._numba_calls import Lent, Passing, lend, lendable, settle

# Private parts of numba and llvmlite are looked up here, so that a version without them is detected
# before anything is compiled.
KNOWN: Any = Lower
USED = (KNOWN._find_singly_assigned_variable, KNOWN.setup_function, KNOWN.delvar, KNOWN.lower_normal_function)
USED_IN_CALLS = (KNOWN.extract_function_arguments, KNOWN._lower_call_RecursiveCall)
Builder: Any = ir.IRBuilder
USED_OF_BUILDER = (Builder._insert, Builder.extract_value, Builder.load)

# Besides arithmetic: an instruction of these kinds whose result is not used can be left out.
PURE = (
    instructions.AllocaInstr,
    instructions.CastInstr,
    instructions.CompareInstr,
    instructions.ExtractValue,
    instructions.GEPInstr,
    instructions.InsertValue,
    instructions.LoadInstr,
    instructions.SelectInstr,
)


class Numbers:
    """Numbers as the names of values, which is quicker than to make given names unique."""

    def __init__(self) -> None:
        self._count = 0

    def register(self, _name: str, deduplicate: bool = False) -> str:  # noqa: ARG002
        """Return a name that no other value of this function has."""
        self._count += 1
        return str(self._count)


class TerseBuilder(Builder):
    """A builder that looks up what was packed or stored, instead of writing instructions that fetch it again."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._places: dict[int, tuple[Any, tuple[int, ...]]] = {}  # pointers into the stack: slot, and where in it
        self._contents: dict[int, tuple[Any, Any]] = {}  # of slots: block of the last store, and value
        self._shared: set[int] = set()  # slots with a pointer that other instructions use
        self._read: dict[tuple[int, int], tuple[Any, Any, Any]] = {}  # words of tuples: pointer, block and value

    def extract_value(self, agg: Any, idx: Any, name: str = "") -> Any:
        """Return the value that was inserted there, if known."""
        path = tuple(idx) if isinstance(idx, (tuple, list)) else (idx,)
        return self._part(agg, path, name)

    def load(self, ptr: Any, *arguments: Any, **options: Any) -> Any:
        """Return the value that was stored there, if known."""
        slot, path = self._places.get(id(ptr), (None, ()))
        if slot is not None and id(slot) not in self._shared and self._at_end() and id(slot) in self._contents:
            block, value = self._contents[id(slot)]
            if block is self.block:
                found = self._part(value, path)
                if hasattr(found, "set_metadata"):
                    return found
        return super().load(ptr, *arguments, **options)

    def phi(self, typ: Any, *arguments: Any, **options: Any) -> Any:
        """Trust no slot any more if a pointer has several sources."""
        if isinstance(typ, ir.PointerType):
            self._places.clear()
        return super().phi(typ, *arguments, **options)

    def known(self, pointer: Any, word: int) -> Any:
        """Return a word of a tuple in memory if this block has read it."""
        _, block, value = self._read.get((id(pointer), word), (None, None, None))
        return value if block is self.block and self._at_end() else None

    def learn(self, pointer: Any, word: int, value: Any) -> None:
        """Remember a word that this block has read."""
        if self._at_end():
            self._read[id(pointer), word] = pointer, self.block, value

    def _part(self, value: Any, path: tuple[int, ...], name: str = "") -> Any:
        for depth, index in enumerate(path):
            found = value
            if isinstance(found, Lent):
                return found.part(self, path[depth:])
            while isinstance(found, instructions.InsertValue) and len(found.indices) == 1:
                if found.indices[0] == index:
                    break
                found = found.aggregate
            if isinstance(found, Lent):
                return found.part(self, path[depth:])
            if not isinstance(found, instructions.InsertValue) or len(found.indices) != 1:
                return super().extract_value(found, path[depth:], name)
            value = found.value
        return value

    def _at_end(self) -> bool:
        return self._anchor == len(self.block.instructions)

    def _insert(self, instr: Any) -> None:
        at_end = self._at_end()
        super()._insert(instr)
        if isinstance(instr, instructions.AllocaInstr):
            self._places[id(instr)] = (instr, ())
            if instr.operands:
                self._shared.add(id(instr))
            return
        if isinstance(instr, instructions.CallInstr):
            self._contents.clear()
        pointers = [self._places[id(operand)] for operand in instr.operands if id(operand) in self._places]
        if not pointers or isinstance(instr, instructions.LoadInstr):
            return
        slot, path = pointers[0]
        if isinstance(instr, instructions.StoreInstr) and len(pointers) == 1 and id(instr.operands[1]) in self._places:
            self._contents.pop(id(slot), None)
            if not path and at_end:
                self._contents[id(slot)] = (self.block, instr.operands[0])
        elif isinstance(instr, instructions.GEPInstr) and _is_fixed(instr):
            self._places[id(instr)] = (slot, (*path, *(index.constant for index in instr.indices[1:])))
        else:
            self._shared.update(id(each) for each, _ in pointers)


def _is_fixed(pointer: Any) -> bool:
    indices = pointer.indices
    return all(isinstance(index, ir.Constant) for index in indices) and indices[0].constant == 0


def sweep(function: Any) -> None:
    """Leave out instructions without effect, and slots that are never read."""
    stores: dict[int, list[Any]] = {}
    live: set[int] = set()
    todo: list[Any] = []
    for block in function.blocks:
        for each in block.instructions:
            if isinstance(each, instructions.StoreInstr) and (slot := _slot_of(each.operands[1])) is not None:
                stores.setdefault(id(slot), []).append(each)
            elif not isinstance(each, PURE) and type(each) is not instructions.Instruction:
                todo.append(each)
    while todo:
        each = todo.pop()
        if id(each) in live:
            continue
        live.add(id(each))
        sources = [value for value, _ in each.incomings] if isinstance(each, instructions.PhiInstr) else each.operands
        sources = [source.pointer if isinstance(source, Lent) else source for source in sources]
        todo.extend(source for source in sources if isinstance(source, instructions.Instruction))
        todo.extend(stores.get(id(each), ()))
    for block in function.blocks:
        block.instructions[:] = [each for each in block.instructions if id(each) in live]
        for each in block.instructions:
            if not isinstance(each, (instructions.LoadInstr, instructions.CallInstr, instructions.Terminator)):
                each.metadata.clear()  # a length that was meant to be loaded


def _slot_of(pointer: Any) -> Any:
    while isinstance(pointer, instructions.GEPInstr):
        pointer = pointer.pointer
    return pointer if isinstance(pointer, instructions.AllocaInstr) else None


def _ignore(_name: str, _node: Any) -> None:
    pass


class TerseLower(Lower):
    """numba's own lowering, for functions without reference counts."""

    def setup_function(self, fndesc: Any) -> None:
        """Take the terse builder."""
        self.function = self.declare(fndesc)
        self.function.scope = Numbers()
        self.entry_block = self.function.append_basic_block("entry")
        self.builder = TerseBuilder(self.entry_block)
        self.call_helper = self.call_conv.init_call_helper(self.builder)
        for argument in self.function.args:  # numba marks the lengths that it loads as not negative
            argument.set_metadata = _ignore

    def declare(self, fndesc: Any) -> Any:
        """Return the function as numba calls it."""
        return self.context.declare_function(self.module, fndesc)

    def extract_function_arguments(self) -> list[Any]:
        """Put large tuples into memory, for all kernels."""
        values = super().extract_function_arguments()
        layouts = [lendable(self.context, kind) for kind in self.fndesc.argtypes]
        self.fnargs = [
            Lent(lend(self.builder, value, layout), layout, 0) if layout else value
            for value, layout in zip(values, layouts, strict=True)
        ]
        return self.fnargs

    def lower_normal_function(self, fndesc: Any) -> None:
        """Sweep at the end."""
        super().lower_normal_function(fndesc)
        sweep(self.function)
        settle(self.function, TerseBuilder)

    def delvar(self, name: str) -> None:
        """Do nothing, since nothing is counted."""

    def _find_singly_assigned_variable(self) -> None:
        """Keep all variables that are assigned in one place off the stack, not only those of one block."""
        super()._find_singly_assigned_variable()
        blocks = self.func_ir.blocks
        counts: dict[str, int] = {}
        home: dict[str, int] = {}
        for label, block in blocks.items():
            for each in block.find_insts(Assign):
                counts[each.target.name] = counts.get(each.target.name, 0) + 1
                home[each.target.name] = label
        dominators = compute_cfg_from_blocks(blocks).dominators()
        wanted = {name for name, count in counts.items() if count == 1} - must_use_alloca(blocks)
        for label, used in compute_use_defs(blocks).usemap.items():
            wanted -= {name for name in used & wanted if home[name] == label or home[name] not in dominators[label]}
        self._singly_assigned_vars |= wanted


class InnerLower(TerseLower):
    """For kernels that only kernels call."""

    def declare(self, fndesc: Any) -> Any:
        """Return the function as kernels call it."""
        self.library.passing = Passing(self.context, fndesc)
        return self.library.passing.declare(self.module)

    def extract_function_arguments(self) -> list[Any]:
        """Take large tuples from memory."""
        self.fnargs = self.library.passing.decode(self.builder, self.function)
        return self.fnargs

    def lower_normal_function(self, fndesc: Any) -> None:
        """See at the end whether the function can fail."""
        super().lower_normal_function(fndesc)
        self.library.passing.look_at(self.function)

    def _lower_call_RecursiveCall(self, fnty: Any, expr: Any, signature: Any) -> Any:  # noqa: N802
        message = f"the kernel {self.fndesc.qualname} calls itself, which kernels cannot do; write a loop"
        raise NotImplementedError(message)
