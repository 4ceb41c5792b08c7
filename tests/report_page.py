"""The pages of reports, read in tests."""

from html.parser import HTMLParser

VOID = {"meta", "br", "path", "use", "rect", "circle"}


class Reader(HTMLParser):
    """The tables of a page as lists of rows of (text, name, value), and whether all tags close."""

    def __init__(self):
        super().__init__()
        self.open, self.tables, self.text, self.facts = [], {}, "", {}
        self.cell = None

    def handle_starttag(self, tag, attrs):
        known = dict(attrs)
        if tag == "table":
            self.rows = self.tables[known["id"]] = []
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th", "dd"):
            self.cell = ["", known.get("data-of", ""), float(known.get("data-value", "nan"))]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        pass

    def handle_endtag(self, tag):
        if tag in VOID:
            return
        assert self.open.pop() == tag
        if tag in ("td", "th"):
            self.rows[-1].append(tuple(self.cell))
        if tag == "dd" and self.cell[1]:
            self.facts[self.cell[1]] = tuple(self.cell)
        if tag in ("td", "th", "dd"):
            self.cell = None

    def handle_data(self, data):
        self.text += data
        if self.cell is not None:
            self.cell[0] += data


def read(path):
    reader = Reader()
    reader.feed(path.read_text("utf-8"))
    reader.close()
    assert reader.open == []
    return reader


def number(text):
    return float(text.replace("−", "-").replace("\u202f", ""))
