"""The command line as ``python -m rockflex``."""

from rockflex.cli import main

if __name__ == "__main__":
    main()
