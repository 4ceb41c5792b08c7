"""Figures as parts of a page of HTML."""

import re


def inline(drawing: str, stem: str, label: str) -> str:
    """Turn an SVG file into an element of a page.

    The prolog, metadata and namespaces of a separate file are removed. Identifiers get the stem as a prefix, because
    other figures in the page may use the same ones. The element fills the available width.

    Parameters
    ----------
    drawing
        The file's text.
    stem
        A name that no other figure in the page has.
    label
        Alternative text for readers who cannot see the figure, without quotes or markup.
    """
    body = drawing[drawing.index("<svg") :]
    body = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", body, flags=re.DOTALL)
    body = re.sub(r'\s+xmlns(:\w+)?="[^"]*"', "", body).replace("xlink:href=", "href=")
    body = re.sub(r'(\bid="|\bhref="#|\burl\(#)', rf"\g<1>{stem}-", body)
    head, rest = body.split(">", 1)
    head = re.sub(r'\s(width|height)="[^"]*"', "", head)
    # A rule of one figure would hold for the whole page.
    rest = re.sub(r'<style type="text/css">.*?</style>', "", rest, flags=re.DOTALL)
    return f'{head} role="img" aria-label="{label}" class="drawing">{rest}'
