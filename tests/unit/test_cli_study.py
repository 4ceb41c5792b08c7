"""The commands of studies, and their figures."""

import json
from pathlib import Path

import pytest
from PIL import Image
from typer.testing import CliRunner

import rockflex as rf
import rockflex.studies._run_plan
from rockflex.cli._app import app
from rockflex.studies import load_study, parallel
from rockflex.studies._run_plan import map_chunks

FRAME = """
[structures.frame]
n_stories = 2
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = 0.5
aspect_ratio = 8.0
damping_ratio = 0.02
"""
RECORDS = '[records]\nsuites = ["fema-p695-far-field"]\ninclude = ["FF-1-*", "FF-2-*", "FF-3-*"]\n'
HEADS = {
    "cloud": 'models = ["2DOF-S", "MDOF-S"]\nscales = [0.5, 1.0, 2.0]\n',
    "incremental": 'models = ["2DOF-S"]\ngrowth = 1.5\ntolerance = 0.1\n',
    "stripes": 'models = ["2DOF-S"]\nmeasure = "pgv"\nlevels = [0.05, 0.2, 0.4, 2.0]\n',
    "population": "pairs = 30\nseed = 5\n",
    "monte_carlo": 'count = 8\nname = "Blocks"\nmodels = ["rigid"]\nvariables.b = { uniform = [0.1, 0.2] }\n'
    'structure = { block = { slenderness = "= b", half_diagonal = 3.0 } }\n',
}
COMMANDS = {kind: kind for kind in HEADS} | {"incremental": "ida", "monte_carlo": "monte-carlo"}
DRAWN = ("population", "monte_carlo")  # their structures


@pytest.fixture
def study(tmp_path):
    def write(kind, head=None):
        structures = "" if kind in DRAWN else f'[[structures]]\nname = "S"\n{FRAME}'
        file = tmp_path / f"{kind}.toml"
        file.write_text(f'study = "{kind}"\n{HEADS[kind] if head is None else head}{RECORDS}{structures}')
        return file

    return write


def invoke(*arguments, columns=220):
    return CliRunner().invoke(app, [*map(str, arguments)], env={"COLUMNS": str(columns)})


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("cloud", ["Outcomes, and P(uplift with θ_max > 1e-4 rad)", "log y = c1 + c2 log PGV", "36 rows in"]),
        ("incremental", ["Capacities to |θ| = π/2, lognormal", "PGA", "resurrections"]),
        ("stripes", ["Runs beyond the limit at each level of pgv", "overturning", "/6", "24 rows in"]),
        ("population", ["Pairs by outcome", "MDOF-S against 2DOF-S (Section 3.3)", "SRSS", "30 rows in"]),
        ("monte_carlo", ["Values of 8 random structures", "recentring_ratio", "Outcomes, and P(", "48 rows in"]),
    ],
)
def test_every_kind_is_run_kept_and_told(study, tmp_path, kind, words):
    file, folder = study(kind), tmp_path / "kept"
    done = invoke(COMMANDS[kind], file, "--out", folder)
    assert done.exit_code == 0, done.stderr
    for word in words:
        assert word in done.stdout
    assert f"Stored in {folder}; rockflex figures {folder} draws it" in done.stderr
    table = rf.run_study(file)
    assert len(rf.StudyFolder.load(folder).frame()) == len(table)
    again = invoke(COMMANDS[kind], file, "--out", folder)
    assert "1 of 1 parts are already in" in again.stderr
    body = [line for line in done.stdout.splitlines() if " rows in " not in line]
    assert [line for line in again.stdout.splitlines() if " rows in " not in line] == body


def test_numbers_are_those_of_the_library(study):
    file = study("cloud")
    done = invoke("cloud", file, "--json")
    document = json.loads(done.stdout)
    assert document["rows"] == 36
    assert document["failed"] == 0
    assert document["study"]["scales"] == [0.5, 1.0, 2.0]
    fits = rf.fit_clouds(rf.run_study(file))
    (outcomes, lines) = (document[key] for key in document if key.startswith(("Outcomes", "log y")))
    for k, (fit, row) in enumerate(zip(fits, outcomes, strict=True)):
        assert (row["model"], row["overturned"]) == (fit.model, fit.outcomes.n_overturned)
        rotation, relative, total = lines[3 * k : 3 * k + 3]
        assert rotation["c2"] == fit.outcomes.rotation.c2
        assert (relative["y"], relative["c1"]) == ("u_top relative to the base", fit.top_displacement.c1)
        assert (total["y"], total["c1"]) == ("u_top in total", fit.total_top_displacement.c1)


SLENDER = FRAME.replace("stories = 2", "stories = 5").replace("ratio = inf", "ratio = 0.0").replace("8.0", "10.0")


def test_runs_in_which_the_pivot_would_lift_are_counted_in_words(study, monkeypatch):
    monkeypatch.setattr("test_cli_study.FRAME", SLENDER)
    file = study("cloud", 'models = ["MDOF-S", "2DOF-S"]\nscales = [2.0]\n')
    runs = rf.run_study(file)
    document = json.loads(invoke("cloud", file, "--json").stdout)
    told = invoke("cloud", file).stdout
    assert len(document["pivot_lifts"]) == 2
    for each in document["pivot_lifts"]:
        mine = runs[(runs["model"] == each["model"]) & (runs["status"] == "rocking")]
        below = int((mine["min_vertical_reaction"] < 0.0).sum())
        assert (each["structure"], each["rocking"], each["lifting"]) == ("S", len(mine), below)
        said = f"S, {each['model']}: in {below} of {len(mine)} runs that rock and stand the model pulls the base down"
        assert (said in told) == (below > 0)
    assert any(each["lifting"] for each in document["pivot_lifts"])


def test_a_dry_run_counts_and_runs_nothing(study, tmp_path):
    done = invoke("cloud", study("cloud"), "--out", tmp_path / "kept", "--dry-run")
    assert "36 runs in 1 part, 6 records; about" in done.stdout
    assert not (tmp_path / "kept").exists()
    document = json.loads(invoke("ida", study("incremental"), "--dry-run", "--json").stdout)
    assert document["study"] == "incremental"
    assert document["runs"] > 60
    assert document["estimated_time"] > 0.0
    assert "at most" in invoke("ida", study("incremental"), "--dry-run").stdout


def test_the_wrong_command_names_the_right_one(study):
    file = study("incremental")
    done = invoke("cloud", file)
    assert done.exit_code == 2
    assert f'The file {file} has study = "incremental". Use rockflex ida {file}.' in done.stderr


def test_rows_with_errors_are_told_and_strict_says_so(study):
    file = study("cloud", 'models = ["2DOF-S", "7DOF-S"]\nscales = [1.0, 2.0]\n')
    done = invoke("population", study("population"), "--strict")
    assert done.exit_code == 0
    done = invoke("cloud", file, "--strict")
    assert done.exit_code == 1
    assert "2DOF-S" in done.stdout
    assert "No fit: S with 7DOF-S: No run of 'S' with 7DOF-S was solved. See the column error" in done.stderr
    assert "12 rows have an error, the first: Model 7DOF-S needs 6 modes, but the structure has 2." in done.stderr
    assert invoke("cloud", file).exit_code == 0


ONE = '[records]\nsuites = ["el-centro-1940"]\n'


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "head", "reasons"),
    [
        ("cloud", 'models = ["2DOF-S", "fixed"]\n', ["S with 2DOF-S: im must hold at least two different values"]),
        ("incremental", HEADS["incremental"], ["S with 2DOF-S, PGA: im must hold at least two different capacities"]),
        ("stripes", 'measure = "pgv"\nlevels = [1e-3, 2e-3]\n', ["S with MDOF-S, uplift: No run exceeds the limit"]),
        (
            "design",
            'measure = "pgv"\nlevel = 0.6\nhalf_widths = [1.0, 1.5]\nlimits = ["overturning"]\n',
            ["overturning: no probability of 2 of 2 designs. im must hold at least two different values"],
        ),
        ("population", "pairs = 2\nseed = 1\n", []),
    ],
)
def test_a_study_is_kept_and_told_where_nothing_can_be_fitted(tmp_path, kind, head, reasons):
    structures = "" if kind == "population" else f'[[structures]]\nname = "S"\n{FRAME}'
    file, folder = tmp_path / f"{kind}.toml", tmp_path / "kept"
    file.write_text(f'study = "{kind}"\n{head}{ONE}{structures}')
    command = COMMANDS.get(kind, kind)
    done = invoke(command, file, "--out", folder)
    assert done.exit_code == 0, done.stderr
    assert f"Stored in {folder}" in done.stderr
    assert f"{len(rf.StudyFolder.load(folder).frame())} rows in" in done.stdout
    for reason in reasons:
        assert f"No fit: {reason}" in done.stderr
    assert invoke(command, file, "--out", folder, "--strict").exit_code == bool(reasons)
    document = json.loads(invoke(command, file, "--out", folder, "--json").stdout)
    assert [text[: len(reason)] for text, reason in zip(document["unfitted"], reasons, strict=False)] == reasons
    assert bool(document["unfitted"]) == bool(reasons)


def test_one_model_that_cannot_be_fitted_does_not_take_the_others_away(study, tmp_path):
    file = study("cloud", 'models = ["2DOF-S", "7DOF-S"]\nscales = [1.0, 2.0]\n')
    done = invoke("cloud", file, "--out", tmp_path / "kept")
    (fits,) = rf.fit_clouds(rf.run_study(file).query("model == '2DOF-S'"))
    assert f"{fits.outcomes.rotation.c2:.3f}" in done.stdout
    drawn = invoke("figures", tmp_path / "kept")
    assert drawn.exit_code == 0, drawn.stderr
    assert "No fit: S with 7DOF-S: No run of 'S' with 7DOF-S was solved." in drawn.stderr
    assert {"fragility.png", "rotation.png"} <= {path.name for path in (tmp_path / "kept" / "figures").iterdir()}


def test_figures_where_nothing_can_be_fitted(tmp_path):
    file = tmp_path / "cloud.toml"
    file.write_text(f'study = "cloud"\n{ONE}[[structures]]\nname = "S"\n{FRAME}')
    assert invoke("cloud", file, "--out", tmp_path / "kept").exit_code == 0
    drawn = invoke("figures", tmp_path / "kept")
    assert drawn.exit_code == 0, drawn.stderr
    first, second, *_ = drawn.stderr.splitlines()
    assert first.startswith("No fit: S with MDOF-S: im must hold at least two different values")
    assert second == (
        "No figure fragility, and clouds without lines: add records or scales to the study, and run it again"
    )
    names = {path.stem for path in (tmp_path / "kept" / "figures").glob("*.png")}
    assert names == {"rotation", "top_displacement", "total_top_displacement"}


RECORD = "Some Event, 1/1/2001, Some Station, {}\nACCELERATION IN UNITS OF G\nNPTS= 4, DT= .1\n0 .3 -.2 0\n"


def test_files_of_a_folder_that_are_left_out_are_told_once(tmp_path):
    folder = tmp_path / "records"
    folder.mkdir()
    for component in ("000", "090", "-UP"):
        (folder / f"RSN1_X_ABC{component}.AT2").write_text(RECORD.format(component.strip("-")))
    (folder / "RSN2_X_GHI000.AT2").write_text(RECORD.format("000")[:-8])
    file = tmp_path / "cloud.toml"
    text = f'study = "cloud"\n[records]\nfolder = "records"\n[[structures]]\nname = "S"\n{FRAME}'
    file.write_text(text)
    refused = invoke("cloud", file)
    assert refused.exit_code == 2
    assert "1 of 4 files cannot be read." in refused.stderr
    assert 'on_error="skip" continues with the other files.' in refused.stderr
    file.write_text(text.replace("[records]\n", '[records]\non_error = "skip"\n'))
    for options in ((), ("--dry-run",)):
        done = invoke("cloud", file, *options)
        assert done.exit_code == 0, done.stderr
        assert done.stderr.count("Left out: 1 vertical component, RSN1_X_ABC-UP.AT2.") == 1
        assert done.stderr.count("Left out: 1 of 4 files cannot be read.") == 1
        assert "UserWarning" not in done.stderr
    assert "2 rows in" in invoke("cloud", file).stdout


@pytest.mark.slow
def test_a_cluster_that_does_not_answer(study, monkeypatch):
    monkeypatch.setattr(parallel, "CONNECT_TIMEOUT", 0.2)
    done = invoke("cloud", study("cloud"), "--dask", "tcp://127.0.0.1:9")
    assert done.exit_code == 2
    assert "No Dask scheduler answers at 'tcp://127.0.0.1:9'" in done.stderr


def test_ctrl_c_says_what_is_kept(study, tmp_path, monkeypatch):
    def interrupted(chunk, numbers, workers):
        yield next(map_chunks(chunk, numbers, 1))
        raise KeyboardInterrupt

    monkeypatch.setattr(rockflex.studies._run_plan, "map_chunks", interrupted)
    file = study("cloud", HEADS["cloud"] + "runs_per_chunk = 8\n")
    done = invoke("cloud", file, "--out", tmp_path / "kept")
    assert done.exit_code == 130
    assert f"Stopped. 1 of 5 parts are stored in {tmp_path / 'kept'}; the same command resumes it." in done.stderr
    assert "Stopped. Nothing was stored, because no --out was given." in invoke("cloud", file).stderr
    monkeypatch.undo()
    done = invoke("cloud", file, "--out", tmp_path / "kept")
    assert f"1 of 5 parts are already in {tmp_path / 'kept'}" in done.stderr
    assert done.exit_code == 0


def test_a_lost_cluster_exits_with_one(study, monkeypatch):
    def lost(*_arguments, **_options):
        message = "The Dask scheduler at tcp://x was lost"
        raise rf.ClusterError(message)

    monkeypatch.setattr(rockflex.studies._run_plan, "map_chunks_on_dask", lost)
    done = invoke("cloud", study("cloud"), "--dask", "tcp://x")
    assert done.exit_code == 1
    assert "Error: The Dask scheduler at tcp://x was lost" in done.stderr


def test_a_share_is_stored_and_nothing_reported(study, tmp_path):
    file = study("cloud", HEADS["cloud"] + "runs_per_chunk = 8\n")
    for place in (1, 2):
        done = invoke("cloud", file, "--out", tmp_path / f"share-{place}", "--share", f"{place}/2")
        assert (done.exit_code, done.stdout) == (0, "")
        assert f"Share {place}/2 is stored in" in done.stderr
        assert f"{(3, 2)[place - 1]} of 5 parts" in done.stderr
    for part in (tmp_path / "share-2" / "parts").iterdir():
        part.rename(tmp_path / "share-1" / "parts" / part.name)
    whole = invoke("cloud", file, "--out", tmp_path / "share-1")
    assert whole.exit_code == 0
    assert "5 of 5 parts are already in" in whole.stderr


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--share", "3"], '--share must be K/N, such as 3/10, but "3" was given'),
        (["--share", "1/2", "--json"], "--share only stores runs: it needs --out, and no --dry-run, --json or"),
        (["--share", "1/2", "--dry-run"], "--share only stores runs"),
        (["--share", "1/2", "--strict"], "--share only stores runs"),
    ],
)
def test_what_is_no_share_is_refused(study, tmp_path, options, message):
    done = invoke("cloud", study("cloud"), "--out", tmp_path / "out", *options)
    assert done.exit_code == 2
    assert message in " ".join(done.stderr.split())


SHORT_FRAME = """
[[structures]]
frame = {n_stories = 5, story_height = 3.0, story_mass = 40e3, base_mass = 40e3, stiffness_ratio = inf, period = 1.0,
         aspect_ratio = 10, damping_ratio = 0.02}
""".replace(",\n        ", ",")
TWO_RECORDS = 'records = {suites = ["fema-p695-far-field"], include = ["FF-1*"]}\n'
STUDIES = {
    "cloud": (
        "scales = [0.2, 1.0]\n" + TWO_RECORDS + SHORT_FRAME,
        ["fragility", "rotation", "top_displacement", "total_top_displacement"],
    ),
    "incremental": ('models = ["2DOF-S"]\ngrowth = 1.5\ntolerance = 0.1\n' + TWO_RECORDS + SHORT_FRAME, ["capacities"]),
    "stripes": ('levels = [0.5, 1.0, 2.0]\nmeasure = "pgv"\n' + TWO_RECORDS + SHORT_FRAME, ["stripes"]),
    "population": ("pairs = 12\n" + TWO_RECORDS, ["agreement", "modal_combination", "population"]),
    "monte_carlo": (
        "count = 12\nvariables.b = { uniform = [0.1, 0.2] }\nscales = [0.5, 1.5]\nmodels = ['rigid']\n"
        + TWO_RECORDS
        + "structure = { block = { slenderness = '= b', half_diagonal = 3.0 } }\n",
        ["fragility", "rotation", "top_displacement", "total_top_displacement"],
    ),
}


def invoke_figures(*arguments):
    return CliRunner().invoke(app, ["figures", *map(str, arguments)], env={"COLUMNS": "200"})


def kept(folder, kind, extra=""):
    """A study of a kind, run and stored in a folder."""
    file = folder / f"{kind}.toml"
    file.write_text(f'study = "{kind}"\n{extra}{STUDIES[kind][0]}', "utf-8")
    study = load_study(file)
    plan = study.plan()
    with rf.StudyFolder.open(folder / kind, study.document(), plan.n_chunks, {"rockflex": "0"}) as kept:
        for number in range(plan.n_chunks):
            kept.write(number, plan.chunk(number))
    return folder / kind


@pytest.mark.slow
@pytest.mark.parametrize("kind", STUDIES)
def test_figures_of_a_kept_study(tmp_path, kind):
    folder = kept(tmp_path, kind)
    result = invoke_figures(folder)
    assert result.exit_code == 0, result.stderr
    assert result.stderr.strip() == f"Written to {folder / 'figures'}"
    files = sorted(path.name for path in (folder / "figures").iterdir())
    assert files == sorted([*(f"{stem}.png" for stem in STUDIES[kind][1]), "summary.json"])
    assert json.loads((folder / "figures" / "summary.json").read_text("utf-8"))["study"]["study"] == kind
    assert rf.StudyFolder.load(folder).finished


@pytest.mark.slow
def test_figures_of_an_unfinished_study_elsewhere(tmp_path):
    folder = kept(tmp_path, "cloud", "runs_per_chunk = 3\n")
    next((folder / "parts").iterdir()).unlink()
    result = invoke_figures(folder, "--out", tmp_path / "there", "--format", "svg", "--measure", "sa_t1")
    assert result.exit_code == 0, result.stderr
    total = rf.StudyFolder.load(folder).n_chunks
    assert result.stderr.splitlines() == [
        f"1 of {total} parts are missing: the figures show the others",
        f"Written to {tmp_path / 'there'}",
    ]
    assert (tmp_path / "there" / "fragility.svg").read_text("utf-8").startswith("<?xml")


@pytest.mark.slow
def test_figures_replace_nothing_unless_told_to(tmp_path):
    folder = kept(tmp_path, "stripes")
    out = tmp_path / "there"
    assert invoke_figures(folder, "--out", out).exit_code == 0
    refused = invoke_figures(folder, "--out", out, "--format", "pdf")
    assert refused.exit_code == 2
    assert refused.stderr.strip() == (
        f"Error: The folder {out} is not empty. Give another one, or --force to replace the results in it."
    )
    assert invoke_figures(folder, "--out", out, "--format", "pdf", "--force").exit_code == 0
    assert sorted(path.name for path in out.iterdir()) == ["stripes.pdf", "summary.json"]
    for arguments, message in (
        (("--format", "jpg"), "--format must be one of png, svg, pdf, but 'jpg' was given."),
        (
            ("--measure", "pga"),
            f"--measure is for cloud, incremental and monte_carlo studies, but the study in {folder} is of kind "
            "stripes. Leave it out.",
        ),
    ):
        refused = invoke_figures(folder, *arguments)
        assert refused.exit_code == 2
        assert refused.stderr.strip() == f"Error: {message}"
    assert not Path(folder / "figures").exists()


@pytest.mark.slow
def test_figures_of_a_size_and_a_theme(tmp_path):
    folder = kept(tmp_path, "stripes")
    for size, width in (("column", 3.5), ("120x60", 120 / 25.4)):
        done = invoke_figures(folder, "--size", size, "--theme", "dark", "--force")
        assert done.exit_code == 0, done.stderr
        with Image.open(folder / "figures" / "stripes.png") as drawn:
            assert drawn.width == pytest.approx(200 * width, abs=1)
            assert sum(drawn.convert("RGB").getpixel((0, 0))) < 100
    for flag, given in (("--size", "wide"), ("--size", "0x60"), ("--theme", "night")):
        refused = invoke_figures(folder, flag, given, "--force")
        assert refused.exit_code == 2
        assert flag[2:] in refused.stderr
        assert "was given" in refused.stderr


def test_figures_of_no_study(tmp_path):
    refused = invoke_figures(tmp_path)
    assert refused.exit_code == 2
    assert refused.stderr.startswith(f"Error: There is no study at {tmp_path}")
