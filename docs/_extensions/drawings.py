"""Directive `drawing`: what some lines of Python end with, a figure or what a notebook shows, made in the build."""

import ast
import contextlib
import io
import re
import tempfile
from hashlib import sha256
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from matplotlib.figure import Figure
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

import rockflex as rf

FOLDER = "_drawings"
BLOCK = re.compile(r"^```python\n(?!# \S+\.py\n)(.*?)^```$", re.MULTILINE | re.DOTALL)


class Drawing(SphinxDirective):
    """Lines whose last expression is a matplotlib figure, or an object that notebooks show; `rf` is imported.

    The option `alt` says what it shows. With `blocks` the first Python blocks of the page, so many of them, run before.
    """

    has_content = True
    option_spec: ClassVar[dict[str, Any]] = {
        "alt": directives.unchanged_required,
        "width": directives.unchanged,
        "blocks": directives.nonnegative_int,
    }

    def run(self) -> list[nodes.Node]:
        """Run the lines, save the figure in a file named after them, and return the image."""
        page = Path(self.env.doc2path(self.env.docname)).read_text("utf-8")
        source = "".join(
            [*BLOCK.findall(page)[: self.options.get("blocks", 0)], *(f"{line}\n" for line in self.content)]
        )
        name = f"{FOLDER}/{sha256(source.encode()).hexdigest()[:16]}.png"
        target = Path(self.env.srcdir) / name
        if not target.exists():
            made = _last_value(source)
            if not isinstance(made, Figure):
                return [nodes.raw("", f'<div class="notebook">{made._repr_html_()}</div>', format="html")]
            rf.save_figure(made, target)
        image = nodes.image(uri=f"/{name}", alt=self.options["alt"], width=self.options.get("width", "100%"))
        return [nodes.figure("", image, *_caption(source), classes=["drawing"])]


def _caption(source: str) -> list[nodes.Node]:
    """Return the call that drew the picture, if the last line is one of rockflex."""
    last = ast.unparse(ast.parse(source).body[-1])
    return [nodes.caption("", "", nodes.literal(text=last))] if last.startswith("rf.plot_") else []


def _last_value(source: str) -> Any:
    """Run lines in an empty folder, and return the value of the last one, an expression."""
    *lines, last = ast.parse(source).body
    if not isinstance(last, ast.Expr):
        raise ValueError(f"A drawing must end with an expression, but it ends with {ast.unparse(last)!r}.")
    names: dict[str, Any] = {"rf": rf}
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
        exec(compile(ast.Module(lines, []), "drawing", "exec"), names)
        return eval(compile(ast.Expression(last.value), "drawing", "eval"), names)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("drawing", Drawing)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
