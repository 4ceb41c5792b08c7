"""The kinds of study that the page shows, by their names."""

from importlib import import_module

from rockflex.kinds import KINDS
from rockflex.web._studies import StudyPage

PAGES: dict[str, StudyPage] = {
    kind.name: import_module(f"rockflex.web.{kind.page}").PAGE for kind in KINDS.values() if kind.page
}
