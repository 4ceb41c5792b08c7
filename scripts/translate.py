"""Translate modules to C, all in one process: `python translate.py FOLDER PACKAGE.SHARED [OPTION...] SOURCE...`.

Cython takes longer to start than to translate one of our modules. What the modules share, such as memory views, becomes
a module of its own; with each of them it would be twice as much code for the C compiler.
"""

import filecmp
import sys
import tempfile
from pathlib import Path

from Cython.Compiler import Main

folder, shared, *rest = sys.argv[1:]
with tempfile.TemporaryDirectory(dir=folder) as made:
    own = Path(made, shared.rpartition(".")[2] + ".c")
    sys.argv[1:] = [*rest, "--shared", shared, "-o", made]
    Main.setuptools_main()
    sys.argv[1:] = ["--generate-shared", str(own), "--module-name", shared]
    Main.setuptools_main()
    for each in Path(made).glob("*.c"):  # what has not changed keeps its time, and is not compiled again
        if not Path(folder, each.name).exists() or not filecmp.cmp(each, Path(folder, each.name), shallow=False):
            each.replace(Path(folder, each.name))
