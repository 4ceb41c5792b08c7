"""The files of the recorder on the tank: a line of keys, and one sample a line in milli-g."""

import numpy as np

import rockflex as rf
from rockflex.motion import RecordFormat


def is_log(lines):
    return lines[0].startswith("TANKLOG ")


def parse_log(file, lines):
    keys = dict(each.split("=") for each in lines[0].split()[1:])
    values = np.array([float(line) for line in lines[1:] if line.strip()])
    if len(values) != int(keys["n"]):
        raise rf.InputError(f"{file}, line 1: n = {keys['n']}, but {len(values)} samples follow. Copy the whole file.")
    info = rf.RecordInfo(station=keys["at"], source=file.name, source_format="TANKLOG")
    return [rf.GroundMotion(values * 9.81e-3, float(keys["dt"]), name=file.stem, metadata=info)]


TANKLOG = RecordFormat("TANKLOG", is_log, parse_log)
