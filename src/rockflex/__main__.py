"""The command line as ``rockflex`` and ``python -m rockflex``."""

import sys


def main() -> None:
    """Run the command line, and end without a traceback if Ctrl-C comes while it is still being imported."""
    try:
        from rockflex.cli._app import main as run

        run()
    except KeyboardInterrupt:
        sys.stderr.write("Stopped; nothing was written.\n")
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
