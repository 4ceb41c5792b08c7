"""The command line: ``rockflex run``, ``rockflex motion``, ``rockflex survey`` and others.

Importing this package imports no numerical library; every command imports what it needs when it runs.
"""

from rockflex.cli._app import app, main

__all__ = ["app", "main"]
