"""Equations as MathML, which browsers display without a script or network."""

import re
from html import escape, unescape
from typing import Any
from xml.etree import ElementTree as ET

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util.logging import getLogger

NAMESPACE = ' xmlns="http://www.w3.org/1998/Math/MathML"'  # not needed in HTML
LOG = getLogger(__name__)
ENTITY = re.compile(r"&(?!amp;|lt;|gt;|quot;|apos;|#)\w+;")  # those that XML does not know
DOTS = ("\u02d9", "\u00a8")  # of first and second derivatives


def mathml(node: nodes.Element, *, as_block: bool) -> str:
    """MathML of an equation; one that cannot be parsed causes a warning and stays as TeX."""
    try:
        text = tex2mathml(node.astext(), as_block=as_block)
    except MathError as error:
        LOG.warning("%s", error, location=node)
        return f"<code>{escape(node.astext())}</code>"
    tree = ET.fromstring(ENTITY.sub(lambda found: unescape(found[0]), text.replace(NAMESPACE, "")))
    for element in list(tree.iter()):
        # The converter puts the index of a dotted letter below it; it belongs next to it.
        if element.tag in ("mover", "munderover") and element[-1].text in DOTS:
            letter, dots = element[0], element[-1]
            index = element[1] if element.tag == "munderover" else None
            dotted = element if index is None else ET.Element("mover")
            dotted[:] = [letter, dots]
            dotted.set("accent", "true")
            if index is not None:
                element.tag = "msub"
                element[:] = [dotted, index]
    for bar in tree.iter("mo"):
        if bar.text == "|":  # a fence, not an operator between two letters
            bar.set("form", "prefix" if bar.get("class") == "mathopen" else "postfix")
    for element in tree.iter("msup"):
        if element[0].tag == "msub":
            element.tag = "msubsup"
            element[:] = [*element[0], element[1]]
    return ET.tostring(tree, encoding="unicode")


def inline(self: Any, node: nodes.math) -> None:
    """Write an equation within a line."""
    self.body.append(mathml(node, as_block=False))
    raise nodes.SkipNode


def block(self: Any, node: nodes.math_block) -> None:
    """Write a displayed equation, with its number if it has one."""
    self.body.append(self.starttag(node, "div", CLASS="math"))
    self.body.append(f"{mathml(node, as_block=True)}</div>")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
