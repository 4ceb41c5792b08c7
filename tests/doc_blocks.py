"""Fenced blocks of code in a page of Markdown, run in their order in one namespace and one folder."""

import contextlib
import io
import re
import shlex
from dataclasses import dataclass
from pathlib import Path

from typer.testing import CliRunner

from rockflex.cli._app import app

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"# ([\w-]+\.(?:toml|py|csv|txt))\b.*\n")
NOT_RUN = ("reproduce", "serve")  # some minutes, and for ever


@dataclass(frozen=True)
class Block:
    """One fenced block, and the output that stands right after it."""

    language: str
    source: str
    line: int
    output: str | None


def blocks_of(text: str) -> list[Block]:
    """The fenced blocks of a page in their order."""
    found = list(BLOCK.finditer(text))
    blocks = []
    for match, after in zip(found, [*found[1:], None][: len(found)], strict=True):
        printed = (
            after is not None
            and after[1] == "text"
            and match[1] == "python"
            and not text[match.end() : after.start()].strip()
        )
        line = text.count("\n", 0, match.start()) + 2
        blocks.append(Block(match[1], match[2], line, after[2] if printed and after is not None else None))
    return blocks


def run_page(page: Path, folder: Path) -> list[tuple[Block, str]]:
    """Run a page's blocks in `folder`, the working directory, and return what the python blocks printed."""
    return run_blocks(blocks_of(page.read_text("utf-8")), folder, page.name)


def run_blocks(blocks: list[Block], folder: Path, page: str) -> list[tuple[Block, str]]:
    """Run blocks of a page in `folder`, the working directory, and return what the python blocks printed."""
    names: dict[str, object] = {"__name__": "__main__"}
    printed = []
    for block in blocks:
        file = FILE.match(block.source)
        if file is not None:
            (folder / file[1]).write_text(block.source, "utf-8")
            if block.language == "python":
                compile(block.source, file[1], "exec")
        elif block.language == "python":
            code = compile("\n" * (block.line - 1) + block.source, page, "exec")
            with contextlib.redirect_stdout(io.StringIO()) as out:
                exec(code, names)
            printed.append((block, out.getvalue()))
        elif block.language == "sql":
            import duckdb

            duckdb.sql(block.source).fetchall()
        elif block.language == "console":
            for line in block.source.splitlines():
                command = shlex.split(line.removeprefix("$ "), comments=True)
                if line.startswith("$ rockflex") and "--dask" not in command and command[1] not in NOT_RUN:
                    result = CliRunner().invoke(app, command[1:])
                    assert result.exit_code == 0, f"{page}: {line}\n{result.output}"
    return printed
