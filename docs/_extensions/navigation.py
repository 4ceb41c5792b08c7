"""The sidebar shows the branch of the page that is open; with all branches each page takes a third of a second."""

from typing import Any

from sphinx.application import Sphinx


def show_one_branch(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
    """Let the theme, which asks for the whole table of contents, have that of the page."""
    del app, page, template, doctree
    whole = context.get("toctree")
    if whole is not None:
        context["toctree"] = lambda **options: whole(**(options | {"collapse": True}))


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect the handler before that of the theme."""
    app.connect("html-page-context", show_one_branch, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
