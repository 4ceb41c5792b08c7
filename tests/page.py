"""What the tests of reports share: a page read strictly."""

import re
from html.parser import HTMLParser

VOID = {"meta", "br", "img", "link", "input", "hr"}


class Page(HTMLParser):
    """Tags, texts and attributes of a page; raises where tags do not nest."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.attributes, self.open, self.cells = [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += [(tag, name, value or "") for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)
        if tag == "td":
            self.cells.append("")

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += [(tag, name, value or "") for name, value in attrs]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "td" in self.open:
            self.cells[-1] += data


def check_page(text, n_figures):
    """A page that loads nothing, with its figures drawn within, under names that occur once."""
    page = Page(text)
    assert page.tags.count("svg") == n_figures
    assert not {"script", "link", "iframe", "object", "embed", "img"} & set(page.tags)
    for tag, name, value in page.attributes:
        if name in ("src", "href", "xlink:href", "srcset", "data", "style"):
            assert "://" not in value, (tag, name, value)
            assert "//" not in value.split("base64,")[0], (tag, name, value)
        if name == "href":
            assert value.startswith(("#", "data:")), (tag, value)
    assert "@import" not in text
    assert "http" not in text
    names = [value for _, name, value in page.attributes if name == "id"]
    assert len(names) == len(set(names))
    for value in (value for _, name, value in page.attributes if name == "href" and value.startswith("#")):
        assert value[1:] in names
    for target in re.findall(r"url\(#([^)]*)\)", text):
        assert target in names
    return page
