"""Ground motions by the name of a suite, of a record in it, or by path."""

import hashlib
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Literal

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._pulses import quiet_motion
from rockflex.motion._read_suite import OnError, Vertical, read_components_by_file, record_files_in_folder
from rockflex.motion._readers import read_motion
from rockflex.motion._suite import load_suite, suite_names

MIN_QUIET_TIME = 0.01  # s of quiet ground before a free vibration until at rest


@dataclass(frozen=True)
class FoundMotion:
    """A motion, and its suite or path."""

    motion: GroundMotion
    origin: str

    @property
    def sha256(self) -> str:
        """SHA-256 of the horizontal samples in m/s² as little-endian doubles."""
        return _checksum_of_samples(self.motion.acceleration)

    def same(self, other: "FoundMotion") -> bool:
        """Whether the samples of both motions are the same."""
        return (self.motion.dt, self.sha256, self._vertical()) == (other.motion.dt, other.sha256, other._vertical())

    def describe(self) -> dict[str, Any]:
        """Return the data that identify the motion, for a document."""
        motion = self.motion
        described: dict[str, Any] = {
            "name": motion.name,
            "origin": self.origin,
            "sha256": self.sha256,
            "npts": motion.acceleration.size,
            "dt": motion.dt,
            "duration": motion.duration,
            "pga": motion.pga,
            "metadata": motion.metadata,
        }
        return described | self._vertical()

    def _vertical(self) -> dict[str, Any]:
        vertical = self.motion.vertical
        return {} if vertical is None else {"pva": self.motion.pva, "vertical_sha256": _checksum_of_samples(vertical)}


def embedded_suite_facts() -> list[dict[str, Any]]:
    """Return the name, size, first and last record of every embedded suite."""
    suites = [load_suite(name) for name in suite_names()]
    return [
        {"suite": suite.name, "motions": len(suite), "first": suite.names[0], "last": suite.names[-1]}
        for suite in suites
    ]


def find_motions(
    names: Sequence[str],
    units: str | None = None,
    dt: float | None = None,
    on_error: OnError = "raise",
    vertical: str | None = None,
) -> list[FoundMotion]:
    """Find motions, in the order of their names; a motion that is named twice appears once.

    Parameters
    ----------
    names
        Each is an embedded suite, ``suite/record``, a file, or a directory of files.
    units, dt, on_error
        As in `read_suite`, for the files.
    vertical
        "pair", as in `read_suite`, or the file of the vertical component of the only motion.
    """
    if not names:
        raise InputError(
            f"No ground motion was given. Name a suite ({', '.join(suite_names())}), a record in one, such as "
            "fema-p695-far-field/FF-12-a, or a file."
        )
    files = {name: _record_files_of_name(name) for name in names if name.partition("/")[0] not in suite_names()}
    pair = "pair" if vertical == "pair" else None
    read = _read_components_of_files([file for each in files.values() for file in each], units, dt, on_error, pair)
    found: dict[str, FoundMotion] = {}
    for name in names:
        suite, _, record = name.partition("/")
        if name in files:
            motions = [motion for file in files[name] for motion in read.get(file, [])]
        else:
            motions = list(load_suite(suite)) if name == suite else [load_suite(suite)[record]]
        for motion in motions:
            member = FoundMotion(motion, name if name in files else suite)
            first = found.setdefault(motion.name, member)
            if not first.same(member):
                raise InputError(
                    f"{member.origin} and {first.origin} hold different motions, both named {shown(motion.name)}. "
                    "Rename one of the files."
                )
    own_file = vertical is not None and pair is None
    about_horizontal = on_error != "raise" or (not own_file and (units is not None or dt is not None))
    if not files and about_horizontal:
        raise InputError("--units, --dt and --on-error are for record files, but no file was given. Leave them out.")
    if not files and pair:
        raise InputError(
            "--vertical pair is for record files, but none was given: the embedded suites hold no vertical components. "
            "Name the files or their folder, or give the file of the vertical component of one record: --vertical FILE."
        )
    if own_file:
        return [_with_vertical_component(list(found.values()), str(vertical), units, dt)]
    return list(found.values())


def _with_vertical_component(found: list[FoundMotion], file: str, units: str | None, dt: float | None) -> FoundMotion:
    if len(found) != 1:
        raise InputError(
            f"--vertical {file} is the vertical component of one motion, but {len(found)} were given. Name one motion, "
            "or name all files of a station, or their folder, with --vertical pair."
        )
    with _naming_units_and_dt_flags():
        motion = found[0].motion.with_vertical(read_motion(file, units=units, dt=dt))
    return FoundMotion(motion, found[0].origin)


def quiet_ground_motion(free: float | Literal["settle"]) -> tuple[list[FoundMotion], float | Literal["settle"]]:
    """Return ground at rest for a free vibration, and the free vibration that follows it."""
    if free == 0.0:
        raise InputError(
            "A free vibration from --initial-rotation needs a ground motion or a length. "
            "Give --free-vibration in seconds, or settle."
        )
    if isinstance(free, str):
        return [FoundMotion(quiet_motion(MIN_QUIET_TIME), "at rest")], free
    return [FoundMotion(quiet_motion(free), "at rest")], 0.0


def _record_files_of_name(name: str) -> list[Path]:
    """Return the file of a name, or the files of a directory."""
    path = Path(name)
    if path.suffix.lower() == ".toml":
        raise InputError(
            f"{name} is a structure file, and one structure is simulated at a time. Give one such file, first."
        )
    if not path.exists():
        near = get_close_matches(name.partition("/")[0], suite_names(), n=1)
        hint = f" Did you mean {near[0]}?" if near else ""
        raise InputError(
            f"{shown(name)} is neither a suite ({', '.join(suite_names())}), nor a record in one, such as "
            f"fema-p695-far-field/FF-12-a, nor a file or directory (working directory: {Path.cwd()}).{hint}"
        )
    return record_files_in_folder(path) if path.is_dir() else [path]


def _read_components_of_files(
    files: Sequence[Path], units: str | None, dt: float | None, on_error: OnError, pair: Vertical | None
) -> dict[Path, list[GroundMotion]]:
    with _naming_units_and_dt_flags():
        return read_components_by_file(files, units, dt, on_error, pair, skip="--on-error skip")


@contextmanager
def _naming_units_and_dt_flags() -> Generator[None]:
    """Name the options in messages about `units` and `dt`."""
    try:
        yield
    except InputError as error:
        if error.field not in ("units", "dt"):
            raise
        text = f"{error} On the command line these are --units and --dt."
        raise InputError(text, longest=len(text), field=error.field) from error


def _checksum_of_samples(samples: Array) -> str:
    return hashlib.sha256(samples.astype("<f8").tobytes()).hexdigest()
