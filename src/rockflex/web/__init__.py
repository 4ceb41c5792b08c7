"""The web page: a stateless server of JSON, and the page that draws what it answers."""

from rockflex.web._serve import make_app, serve

__all__ = ["make_app", "serve"]
