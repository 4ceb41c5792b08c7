"""Calls between kernels: large named tuples are passed as one pointer, and kernels that cannot fail are not checked.

numba passes every word of a tuple as an argument of its own, some two hundred in a call of the driver, and checks
after every call whether it raised an exception. Here the words of a tuple are in memory, eight bytes each, where the
outermost kernel put them; inner kernels read those that they use, and pass the pointer on.
"""

from functools import cache
from typing import Any

from llvmlite import ir  # pyright: ignore[reportMissingTypeStubs]
from llvmlite.ir import instructions  # pyright: ignore[reportMissingTypeStubs]
from llvmlite.ir.values import ArgumentAttributes  # pyright: ignore[reportMissingTypeStubs]
from numba.core import cgutils
from numba.core.callconv import RETCODE_NONE, RETCODE_OK, errcode_t, excinfo_ptr_t
from numba.core.datamodel.models import StructModel, UniTupleModel
from numba.core.imputils import fix_returning_optional
from numba.core.types import BaseNamedTuple, Optional, none

WORD = 8  # bytes
FEW = 8  # words that are passed by value
BIT, BYTES, INDEX = ir.IntType(1), ir.IntType(8).as_pointer(), ir.IntType(64)
KNOWN = ArgumentAttributes._known  # pyright: ignore[reportPrivateUsage, reportUnknownMemberType]
READ_ONLY = ("noalias", "readonly", "captures(none)" if "captures(none)" in KNOWN else "nocapture")
SUCCESSES = {RETCODE_OK.constant, RETCODE_NONE.constant}


class Layout:
    """Where the words of a value are, by the parts of its model."""

    def __init__(self, model: Any) -> None:
        self.type = model.get_value_type()
        self.parts: list[tuple[Layout, int]] = []  # and the first word of each
        self.words = 0
        self.is_word = not isinstance(model, (StructModel, UniTupleModel))
        models: list[Any] = []
        if isinstance(model, StructModel):
            models = list(model._models)  # pyright: ignore[reportPrivateUsage]
        elif isinstance(model, UniTupleModel):
            models = [model._elem_model] * model._count  # pyright: ignore[reportPrivateUsage]
        for each in models:
            part = layout_of(each)
            self.parts.append((part, self.words))
            self.words += part.words
        if self.is_word:
            self.words = 1
            self.stored: Any = ir.IntType(8) if self.type == BIT else self.type

    def fits(self) -> bool:
        """Return True if all parts are single words."""
        if self.is_word:
            whole = isinstance(self.type, ir.IntType) and self.type.width <= 8 * WORD
            return whole or isinstance(self.type, (ir.PointerType, ir.DoubleType, ir.FloatType))
        return all(part.fits() for part, _ in self.parts)

    def read(self, builder: Any, pointer: Any) -> Any:
        """Return the value of a word."""
        value = builder.load(builder.bitcast(pointer, self.stored.as_pointer()))
        return builder.trunc(value, BIT) if self.type == BIT else value

    def write(self, builder: Any, value: Any, pointer: Any) -> None:
        """Write a word."""
        value = builder.zext(value, self.stored) if self.type == BIT else value
        builder.store(value, builder.bitcast(pointer, self.stored.as_pointer()))


@cache
def layout_of(model: Any) -> Layout:
    """Return the layout of a model of data."""
    return Layout(model)


class Lent(ir.Value):
    """A tuple in memory that nobody changes. Parts are read where they are used; see `settle` for the whole."""

    def __init__(self, pointer: Any, layout: Layout, first: int) -> None:
        self.pointer = pointer
        self.layout = layout
        self.first = first
        self.type = layout.type

    def set_metadata(self, name: str, node: Any) -> None:
        """Ignore what would be said about an instruction."""

    def part(self, builder: Any, path: tuple[int, ...]) -> Any:
        """Return a part, read if it is one word."""
        layout, first = self.layout, self.first
        for index in path:
            layout, offset = layout.parts[index]
            first += offset
        if not layout.is_word:
            return Lent(self.pointer, layout, first)
        return builder.known(self.pointer, first) or self._read(builder, layout, first)

    def _read(self, builder: Any, layout: Layout, first: int) -> Any:
        value = layout.read(builder, _place(builder, self.pointer, first))
        builder.learn(self.pointer, first, value)
        return value

    def whole(self, builder: Any) -> Any:
        """Return the whole as one value."""
        value = ir.Constant(self.type, ir.Undefined)
        for index in range(len(self.layout.parts)):
            part = self.part(builder, (index,))
            value = builder.insert_value(value, part.whole(builder) if isinstance(part, Lent) else part, index)
        return value


def _place(builder: Any, pointer: Any, word: int) -> Any:
    return builder.gep(pointer, [ir.Constant(INDEX, WORD * word)], inbounds=True) if word else pointer


def lend(builder: Any, value: Any, layout: Layout) -> Any:
    """Return a pointer to the words of a tuple; put them into memory if they are not there."""
    if isinstance(value, Lent):
        return _place(builder, value.pointer, value.first)
    room = builder.bitcast(cgutils.alloca_once(builder, ir.ArrayType(INDEX, layout.words)), BYTES)
    _put(builder, value, layout, room, 0)
    return room


def _put(builder: Any, value: Any, layout: Layout, room: Any, first: int) -> None:
    if layout.is_word:
        layout.write(builder, value, _place(builder, room, first))
    for index, (part, offset) in enumerate(layout.parts):
        _put(builder, builder.extract_value(value, [index]), part, room, first + offset)


def lendable(context: Any, kind: Any) -> Layout | None:
    """Return the layout of a type that is passed as a pointer, None for others."""
    if not isinstance(kind, BaseNamedTuple):
        return None
    layout = layout_of(context.data_model_manager[kind])
    return layout if layout.words > FEW and layout.fits() else None


class Passing:
    """How the arguments of one kernel are passed."""

    def __init__(self, context: Any, described: Any) -> None:
        self.described = described
        self.restype = described.restype
        self.layouts = [lendable(context, kind) for kind in described.argtypes]
        self.packers = [context.get_arg_packer([kind]) for kind in described.argtypes]
        self.counts = [
            1 if layout else len(packer.argument_types)
            for layout, packer in zip(self.layouts, self.packers, strict=True)
        ]
        kinds: list[Any] = []
        for layout, packer in zip(self.layouts, self.packers, strict=True):
            kinds.extend([BYTES] if layout else packer.argument_types)
        result = context.call_conv.get_return_type(self.restype)
        self.type = ir.FunctionType(errcode_t, [result, ir.PointerType(excinfo_ptr_t), *kinds])
        self.fails = True  # until it is known

    def declare(self, module: Any) -> Any:
        """Return the function in a module."""
        name = self.described.mangled_name
        if name in module.globals:
            return module.globals[name]
        function = ir.Function(module, self.type, name)
        for each in function.args[:2]:
            each.add_attribute("noalias")
            each.add_attribute(READ_ONLY[-1])
        place = 2
        for layout, count in zip(self.layouts, self.counts, strict=True):
            if layout:
                set.update(function.args[place].attributes, READ_ONLY)  # llvmlite does not know all
                function.args[place].attributes.dereferenceable = WORD * layout.words
            place += count
        if self.described.inline:
            function.attributes.add("alwaysinline")
        return function

    def decode(self, builder: Any, function: Any) -> list[Any]:
        """Return the arguments of a function."""
        values: list[Any] = []
        place = 2
        for layout, packer, count in zip(self.layouts, self.packers, self.counts, strict=True):
            words = function.args[place : place + count]
            values.append(Lent(words[0], layout, 0) if layout else packer.from_arguments(builder, words)[0])
            place += count
        return values

    def call(self, context: Any, builder: Any, sig: Any, args: Any) -> Any:
        """Write a call, and return its result."""
        kind = context.call_conv.get_return_type(self.restype).pointee
        result = cgutils.alloca_once(builder, kind)
        given: list[Any] = []
        for value, layout, packer in zip(args, self.layouts, self.packers, strict=True):
            given.extend([lend(builder, value, layout)] if layout else packer.as_arguments(builder, [value]))
        function = self.declare(builder.module)
        if not self.fails:
            builder.call(function, [result, builder.function.args[1], *given])
            if self.restype == none:
                return context.get_dummy_value()
            return context.get_returned_value(builder, self.restype, builder.load(result))
        builder.store(cgutils.get_null_value(kind), result)
        error = cgutils.alloca_once(builder, excinfo_ptr_t, name="excinfo")
        code = builder.call(function, [result, error, *given])
        status = context.call_conv._get_return_status(builder, code, builder.load(error))
        found = context.get_returned_value(builder, self.restype, builder.load(result))
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return fix_returning_optional(context, builder, sig, status, found)

    def register(self, context: Any, known_by: Any, library: Any) -> None:
        """Let other functions call the kernel in this way."""

        def imp(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            return self.call(context, builder, sig, args)

        made: Any = imp
        made.signature = self.described.argtypes
        made.libs = (library,)
        context._defns[known_by].append(made, made.signature)

    def look_at(self, function: Any) -> None:
        """See whether the written function can fail."""
        codes = [
            each.operands[0]
            for block in function.blocks
            for each in block.instructions
            if isinstance(each, instructions.Ret)
        ]
        self.fails = isinstance(self.restype, Optional) or not all(
            isinstance(code, ir.Constant) and code.constant in SUCCESSES for code in codes
        )


def settle(function: Any, start: Any) -> None:
    """Read tuples that are used as a whole where that happens, with builders that `start` returns for a block."""
    for block in function.blocks:
        for each in list(block.instructions):
            if isinstance(each, instructions.PhiInstr):
                for index, (value, source) in enumerate(each.incomings):
                    if isinstance(value, Lent):
                        builder = start(source)
                        builder.position_before(source.terminator)
                        each.incomings[index] = value.whole(builder), source
            for value in [operand for operand in each.operands if isinstance(operand, Lent)]:
                builder = start(block)
                builder.position_before(each)
                each.replace_usage(value, value.whole(builder))
            if isinstance(each, instructions.InsertValue):
                each.aggregate, each.value = each.operands
