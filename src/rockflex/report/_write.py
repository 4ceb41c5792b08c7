"""The files of a report."""

from collections.abc import Callable
from pathlib import Path

from rockflex._files import write_whole
from rockflex.report._csv import to_csv
from rockflex.report._document import Document
from rockflex.report._html import to_html
from rockflex.report._markdown import to_markdown


def write_document(document: Document, folder: Path, progress: Callable[[str], None] | None = None) -> list[Path]:
    """Draw every figure, and write ``report.html``, ``report.md``, ``numbers.csv`` and the figures as SVG.

    Parameters
    ----------
    document
        The report.
    folder
        The folder; it is created if needed.
    progress
        Called with the stem of every figure that is drawn.

    Returns
    -------
    list of Path
        The files, figures first.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from rockflex.report import Document, write_document
    >>> document = Document("A title", "A paper, 2024", "none", {"rockflex": "1"}, {"met": "within 1 %"}, {}, [])
    >>> [path.name for path in write_document(document, Path(tempfile.mkdtemp()))]
    ['report.html', 'report.md', 'numbers.csv']
    """
    from rockflex.plot import save_figure

    figures: dict[str, Path] = {}
    for section in document.sections:
        for stem, draw in section.figures.items():
            figures[stem] = save_figure(draw(), folder / f"{stem}.svg")
            if progress is not None:
                progress(stem)
    drawings = {stem: path.read_text("utf-8") for stem, path in figures.items()}
    texts = {
        "report.html": to_html(document, drawings),
        "report.md": to_markdown(document),
        "numbers.csv": to_csv(document),
    }
    return [*figures.values(), *(write_whole(folder / name, text.encode()) for name, text in texts.items())]
