"""The web page: a stateless server of JSON, and a page that draws its answers."""

from rockflex.web._serve import make_app, serve

__all__ = [
    "make_app",
    "serve",
]
