"""Directive `drawing`: the figure that some lines of Python end with, drawn while the pages are built."""

import ast
from hashlib import sha256
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

import rockflex as rf

FOLDER = "_drawings"


class Drawing(SphinxDirective):
    """Lines whose last expression is a matplotlib figure; `rf` is imported. The option `alt` says what it shows."""

    has_content = True
    option_spec: ClassVar[dict[str, Any]] = {"alt": directives.unchanged_required, "width": directives.unchanged}

    def run(self) -> list[nodes.Node]:
        """Draw the figure into a file named after its lines, and return the image."""
        source = "\n".join(self.content)
        name = f"{FOLDER}/{sha256(source.encode()).hexdigest()[:16]}.png"
        *lines, last = ast.parse(source).body
        names: dict[str, Any] = {"rf": rf}
        exec(compile(ast.Module(lines, []), "drawing", "exec"), names)
        figure = eval(compile(ast.Expression(last.value), "drawing", "eval"), names)  # pyright: ignore
        rf.save_figure(figure, Path(self.env.srcdir) / name)
        image = nodes.image(uri=f"/{name}", alt=self.options["alt"], width=self.options.get("width", "100%"))
        return [image]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("drawing", Drawing)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
