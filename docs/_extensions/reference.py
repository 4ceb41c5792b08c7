"""Directive `every-name`: a line for each public name, under the titles of the pages that describe them."""

import re
from pathlib import Path

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


class EveryName(SphinxDirective):
    """The names of the pages that the content lists, with the first sentence of each."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Read the pages, and let autosummary make a table of each."""
        here = Path(self.env.doc2path(self.env.docname)).parent
        lines: list[str] = []
        for page in self.content:
            path = here / f"{page}.md"
            self.env.note_dependency(str(path))
            text = path.read_text("utf-8")
            names = re.findall(r"^   (rockflex\.\S+)$", text, re.MULTILINE)
            lines += [f".. rubric:: {text.partition(chr(10))[0].removeprefix('# ')}", ""]
            shown = (f"~{name}" if name.count(".") == 1 else name for name in names)
            lines += [".. autosummary::", "   :nosignatures:", "", *(f"   {name}" for name in shown), ""]
        parent = nodes.container()
        self.state.nested_parse(StringList(lines, self.env.docname), 0, parent)
        return parent.children


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("every-name", EveryName)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
