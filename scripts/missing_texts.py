"""List the texts that the catalogues of languages lack, and which therefore appear in English."""

import sys
from pathlib import Path
from typing import get_args

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from catalogue_texts import missing_texts
from rockflex.foundation.language import Language

for name in get_args(Language):
    missing = [] if name == "en" else missing_texts(name)
    print(f"{name}: {len(missing)} missing")
    for text in missing:
        print(f"  {text}")
