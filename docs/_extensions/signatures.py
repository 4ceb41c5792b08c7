"""Signatures of the reference, as the source has them: numpy's unions are not expanded, and aliases are."""

import ast
import copy
import functools
import inspect
import re
import textwrap
from pathlib import Path
from typing import Any, Protocol

from docutils import nodes
from pydantic import BaseModel
from sphinx import addnodes
from sphinx.application import Sphinx

import rockflex

ARRAY = re.compile(r"(?:numpy\.)?ndarray\[tuple\[.*?\], (?:numpy\.)?dtype\[.*?\]\]")


def signature(
    app: Sphinx, what: str, name: str, obj: Any, options: object, given: str | None, returned: str | None
) -> tuple[str | None, str | None] | None:
    """Signature with the annotations of the source, where numpy's unions are not expanded."""
    del app, name, options
    if what not in ("function", "method", "class"):
        return None
    if what == "class":
        listed = issubclass(obj, BaseModel) or Protocol in obj.__bases__  # keys and methods follow in the text
        return ("()" if listed else _fields(obj) or _constructor(obj) or given, None)
    return _written(obj, what == "method") or (given, returned)


def _written(function: Any, bound: bool) -> tuple[str, str | None] | None:
    """Parameters and result of a function as in its source, without the first one if `bound`."""
    tree = _parsed(function)
    if tree is None or not isinstance(tree, ast.FunctionDef):
        return None
    arguments = tree.args
    if bound:
        for kind in (arguments.posonlyargs, arguments.args):
            kind[:] = [each for each in kind if each.arg not in ("self", "cls")]
    for each in ast.walk(arguments):
        if isinstance(each, ast.arg) and each.annotation is not None:
            each.annotation = _plain(each.annotation)
    constants = getattr(inspect.unwrap(function), "__globals__", {})
    for defaults in (arguments.defaults, arguments.kw_defaults):
        defaults[:] = [_value(each, constants) for each in defaults]
    result = None if tree.returns is None else ast.unparse(_plain(tree.returns))
    return f"({ast.unparse(arguments)})", result


def parameter_types(obj: Any) -> dict[str, str]:
    """Return the types of the parameters of a function, or of the fields of a class, for readers, as in the source."""
    if isinstance(obj, type):
        return {
            node.target.id: ast.unparse(_plain(node.annotation))
            for base in reversed(obj.__mro__)
            for node in _body(base)
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
        }
    tree = _parsed(inspect.unwrap(obj))
    if not isinstance(tree, ast.FunctionDef):
        return {}
    arguments = [*tree.args.posonlyargs, *tree.args.args, *tree.args.kwonlyargs]
    return {each.arg: ast.unparse(_plain(each.annotation)) for each in arguments if each.annotation is not None}


def _value(default: ast.expr | None, constants: dict[str, Any]) -> ast.expr | None:
    """A default; the number itself in place of the name of a constant."""
    value = None
    if isinstance(default, ast.Name):
        value = constants.get(default.id)
    elif isinstance(default, ast.Attribute) and isinstance(default.value, ast.Name):  # study.WORK_LIMIT
        value = getattr(constants.get(default.value.id), default.attr, None)
    return ast.Constant(value) if isinstance(value, int | float) else default


class _Plain(ast.NodeTransformer):
    """Annotations for readers: aliases are replaced by what they stand for, arrays by `ndarray`, indices by `int`."""

    def visit_Name(self, node: ast.Name) -> ast.expr:
        if node.id == "SupportsIndex":
            return ast.Name("int")
        alias = _aliases().get(node.id)
        return node if alias is None else self.visit(copy.deepcopy(alias))

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        return self.visit_Name(ast.Name(node.attr))  # DataFrame for pd.DataFrame, Motions for study.Motions

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        if isinstance(node.value, ast.Name) and node.value.id == "NDArray":
            return ast.Name("ndarray")
        if isinstance(node.value, ast.Name) and node.value.id == "Annotated" and isinstance(node.slice, ast.Tuple):
            return self.visit(node.slice.elts[0])  # what is known of an argument stands in the text
        literal = isinstance(node.value, ast.Name) and node.value.id == "Literal"
        return node if literal else self.generic_visit(node)  # type: ignore[return-value]


@functools.cache
def _aliases() -> dict[str, ast.expr]:
    """Type aliases of the package by name: assignments of unions and of subscripted types at the top of a module."""
    root = Path(rockflex.__file__).parent
    found: dict[str, ast.expr] = {}
    for path in sorted(root.rglob("*.py")):
        if path.relative_to(root).parts[0] in ("cli", "web", "papers"):
            continue
        for node in ast.parse(path.read_text("utf-8")).body:
            target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
            value = getattr(node, "value", None)
            union = isinstance(value, ast.BinOp) and isinstance(value.op, ast.BitOr)
            generic = isinstance(value, ast.Subscript) and isinstance(value.value, ast.Name)
            if isinstance(target, ast.Name) and not target.id.isupper() and (union or generic):
                found[target.id] = value
    return found


def _plain(node: ast.expr) -> ast.expr:
    """An annotation for readers, without the quotes that defer it; those of Literal stay."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        node = ast.parse(node.value, mode="eval").body
    return _Plain().visit(node)


def _fields(obj: Any) -> str | None:
    """Signature of a dataclass, its annotations from the source."""
    if "__dataclass_fields__" not in vars(obj) or _own_init(obj) is not None:
        return None
    notes = parameter_types(obj)
    parameters, starred = [], False
    for name, parameter in inspect.signature(obj).parameters.items():
        if parameter.kind is parameter.KEYWORD_ONLY and not starred:
            parameters.append("*")
            starred = True
        default = "" if parameter.default is parameter.empty else f" = {parameter.default!r}"
        parameters.append(f"{name}: {notes.get(name, 'Any')}{default}")
    return f"({', '.join(parameters)})"


def _constructor(obj: Any) -> str | None:
    """Signature of a class from the source of its `__init__`."""
    init = _own_init(obj)
    found = None if init is None else _written(init, bound=True)
    return None if found is None else found[0]


def _own_init(obj: Any) -> Any:
    """The `__init__` that the source of a class or of a base in this package defines; None if none does."""
    for base in obj.__mro__:
        if any(isinstance(node, ast.FunctionDef) and node.name == "__init__" for node in _body(base)):
            return vars(base)["__init__"] if base.__module__.startswith("rockflex") else None
    return None


def _body(obj: type) -> list[ast.stmt]:
    tree = _parsed(obj)
    return tree.body if isinstance(tree, ast.ClassDef) else []


def _parsed(obj: Any) -> ast.stmt | None:
    """The statement that defines a function or class; None where there is no source."""
    try:
        return ast.parse(textwrap.dedent(inspect.getsource(obj))).body[0]
    except (OSError, TypeError, SyntaxError):
        return None


def shorten(app: Sphinx, doctree: nodes.document) -> None:
    """Write the types of properties as in signatures: `ndarray` without its parameters."""
    del app
    for note in doctree.findall(addnodes.desc_annotation):
        text = ARRAY.sub("ndarray", note.astext())
        if text != note.astext():
            note.children = [nodes.Text(text)]


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect the handlers."""
    app.connect("autodoc-process-signature", signature)
    app.connect("doctree-read", shorten)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
