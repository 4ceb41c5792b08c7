"""A package of a user's own, known by its entry points alone: files, commands, studies, saved responses, a cluster."""

import json
from pathlib import Path

import pytest

from own_package_site import install, path_with, run

TANK = """
[{prefix}tank]
volume = 40.0
height = 12.0
column_stiffness = 4e6
half_width = 1.2
shell_masses = [500.0, 700.0]

[[{prefix}elements]]
kind = "flag"
stiffness = 2e7
yield_force = 50e3
position = -0.5
"""
STUDY = """
study = "{study}"
models = ["MDOF-S", "2DOF-C"]
runs_per_chunk = 4
{more}
[records]
suites = ["fema-p695-far-field"]
include = ["FF-1-*", "FF-2-*"]
[[structures]]
name = "tank"
""" + TANK.format(prefix="structures.")
STUDIES = {
    "both_ways": ("both-ways", "free_vibration = 2.0"),
    "stripes": ("stripes", 'measure = "pga_pgv"\nlevels = [0.3, 1.0, 2.0]'),
    "incremental": ("ida", 'limit = "pipe_break"\nlargest_scale = 1.0\ngrowth = 2.0\nfree_vibration = 0.0'),
    "design": ("design", 'half_widths = [1.0, 1.2]\nlevel = 0.3\nlimits = ["pipe_break"]'),
}


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """A folder of installed packages."""
    folder = tmp_path_factory.mktemp("site")
    install(folder)
    return folder


@pytest.fixture
def here(tmp_path) -> Path:
    """A folder with the files of a user."""
    (tmp_path / "records").mkdir()
    for record in (tmp_path / "a.log", tmp_path / "records" / "a.log"):
        record.write_text("TANKLOG at=T1 dt=0.01 n=4\n0.0\n20.0\n-30.0\n10.0\n", "utf-8")
    (tmp_path / "tank.toml").write_text(TANK.format(prefix=""), "utf-8")
    for study, (_, more) in STUDIES.items():
        (tmp_path / f"{study}.toml").write_text(STUDY.format(study=study, more=more), "utf-8")
    return tmp_path


READ = """
import rockflex as rf
from rockflex.motion import MEASURES
from rockflex.fragility import LIMIT_STATES
from rockflex.studies import KINDS
from rockflex_tank.elements import Flag
from rockflex_tank.structures import Tank

tank = rf.read_structure("tank.toml")
assert tank.elements == (Flag(2e7, 50e3, position=-0.5),)
assert tank.structure == Tank(40.0, 12.0, 4e6, 1.2, shell_masses=(500.0, 700.0))
assert list(MEASURES.added) == ["pga_pgv"] and list(LIMIT_STATES.added) == ["pipe_break"]
assert list(KINDS.added) == ["both_ways"]

motion = rf.load_suite("fema-p695-far-field")[0]
same = rf.Restrained(tank.structure, rf.FlagShapedBar(2e7, 50e3, 0.05, 0.8, -0.5, tension_only=True))
for model in ("MDOF-S", "2DOF-C"):
    run = rf.simulate(tank, motion, model)
    assert run.element_energy[0] > 0.0
    assert abs(run.max_rotation / rf.simulate(same, motion, model).max_rotation - 1.0) < 1e-9
    back = rf.Response.load(run.save(model))
    assert back.history.model.properties.elements == tank.elements
    assert (back.element_force == run.element_force).all()
    assert back.max_rotation == run.max_rotation
assert rf.read_motion("a.log").pga == 9.81e-3 * 30.0
assert [each.metadata.station for each in rf.read_suite("records")] == ["T1"]
ground = rf.Ground(springs=rf.winkler_bed(1.2, 2.4, 1e8, n=8), base_inertia=1e5)
assert rf.simulate(tank, motion, ground=ground).element_energy[0] > 0.0
"""


@pytest.mark.slow
def test_in_python(site, here):
    run(here, "-c", READ, site=site)
    assert "no installed package registers" in run(
        here, "-c", "import rockflex as rf; rf.Response.load('MDOF-S.npz')", fails=True
    )


COMMANDS = """
import json, sys
from typer.testing import CliRunner
from rockflex.cli import app

done = [CliRunner().invoke(app, line.split()) for line in json.loads(sys.argv[1])]
print(json.dumps([[each.exit_code, " ".join(each.output.split())] for each in done]))
"""


@pytest.mark.slow
def test_commands(site, here):
    """All in one program, since each would take seconds to start."""
    wrong = (here / "tank.toml").read_text("utf-8").replace("2e7", '"stiff"')
    (here / "wrong.toml").write_text(wrong, "utf-8")
    lines = [
        "--help",
        "motion a.log",
        "modes tank.toml",
        "modes wrong.toml",
        "run tank.toml el-centro-1940 --out out --report r.html",
    ]
    for study, (command, _) in STUDIES.items():
        again = f"{command} {study}.toml --out {study}"
        lines += [f"{command} {study}.toml --dry-run", again, f"figures {study}", again]
    printed = json.loads(run(here, "-c", COMMANDS, json.dumps(lines), site=site))
    told = dict(zip(lines, printed, strict=True))  # of the same line twice, the second
    code, text = told.pop("modes wrong.toml")
    assert code == 2
    assert "stiffness must be the elastic stiffness, a number in N/m, but 'stiff' was given" in text
    assert [line for line, (code, _) in told.items() if code] == []
    assert "both-ways" in told["--help"][1]
    assert "flag" in told["modes tank.toml"][1]
    assert "flag" in (here / "out" / "summary.json").read_text("utf-8")
    for study, (command, _) in STUDIES.items():
        assert "an error" not in told[f"{command} {study}.toml --out {study}"][1]
        assert "are already in" in told[f"{command} {study}.toml --out {study}"][1]
        assert any((here / study / "figures").glob("*.png"))
    assert "Larger rotation of both directions" in told["both-ways both_ways.toml --out both_ways"][1]
    counted = told["stripes stripes.toml --out stripes"][1]
    assert "at each level of pga_pgv" in counted
    assert "break of the pipe" in counted
    assert "Capacities to break of the pipe" in told["ida incremental.toml --out incremental"][1]


RESUMED = """
import pandas as pd
import rockflex as rf

def stop(progress):
    if progress.done == 2:
        raise KeyboardInterrupt

for study in ("both_ways", "stripes"):
    seen, kept = [], f"stopped-{study}"
    whole = rf.run_study(f"{study}.toml")
    try:
        rf.run_study(f"{study}.toml", kept, workers=1, progress=stop)
    except KeyboardInterrupt:
        pass
    assert rf.StudyFolder.load(kept).missing(), study
    resumed = rf.run_study(f"{study}.toml", kept, progress=seen.append)
    assert seen[0].kept == 2, study
    pd.testing.assert_frame_equal(resumed, whole)
    assert whole["error"].isna().all() and (whole["n_uplifts"] > 0).any(), study
"""


@pytest.mark.slow
def test_a_study_that_is_stopped_and_resumed_has_the_same_table(site, here):
    run(here, "-c", RESUMED, site=site)


@pytest.mark.slow
def test_a_study_is_not_resumed_with_another_source(here, tmp_path_factory):
    site = tmp_path_factory.mktemp("changing")
    install(site)
    once = "import rockflex as rf; rf.run_study('both_ways.toml', 'kept')"
    run(here, "-c", once, site=site)
    changes = {
        "elements": ("0.5 * k", "0.50 * k", "source of flag"),
        "structures": ("1000.0 * share", "1025.0 * share", "source of tank"),
        "measures": ("math.sqrt(", "2.0 * math.sqrt(", "measure pga_pgv, rockflex_tank.measures"),
        "studies": ("factor, -factor", "factor, -2.0 * factor", "study, rockflex_tank.studies"),
    }
    files = {name: site / "rockflex_tank" / f"{name}.py" for name in changes}
    sources = {name: file.read_text("utf-8") for name, file in files.items()}
    for name, (old, new, _) in changes.items():
        assert old in sources[name]
        files[name].write_text(sources[name].replace(old, new), "utf-8")
    said = run(here, "-c", once, site=site, fails=True)
    assert [named for _, _, named in changes.values() if f"{named}: " not in said] == []
    for name, file in files.items():
        file.write_text(sources[name], "utf-8")
    run(here, "-c", once, site=site)


@pytest.mark.slow
def test_a_study_on_a_cluster_has_the_same_table(site, here, tmp_path_factory):
    from dask_cluster import TESTS, Cluster

    with Cluster(tmp_path_factory.mktemp("dask"), PYTHONPATH=path_with(site, TESTS)) as cluster:
        code = (
            "import pandas as pd, rockflex as rf\n"
            "for study in ('both_ways', 'stripes'):\n"
            f"    there = rf.run_study(f'{{study}}.toml', f'there-{{study}}', dask='{cluster.address}')\n"
            "    pd.testing.assert_frame_equal(there, rf.run_study(f'{study}.toml'))\n"
        )
        run(here, "-c", code, site=site)
