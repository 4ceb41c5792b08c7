"""The notebook of the examples: clean as it is stored, and run as a reader would run it."""

import json
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).parents[2] / "examples" / "notebook.ipynb"
IMAGES = ("image/png", "image/gif")


def outputs_of(cell) -> dict[str, object]:
    """What a cell shows, by the kind of content."""
    found: dict[str, object] = {}
    for output in cell.outputs:
        assert output.output_type in ("display_data", "execute_result", "stream"), output
        if output.output_type == "stream":
            assert "kernels" in output.text, output.text  # the first run on a machine compiles
        else:
            found |= output.data
    return found


def test_the_notebook_is_stored_without_outputs():
    stored = json.loads(NOTEBOOK.read_text("utf-8"))
    code = [cell for cell in stored["cells"] if cell["cell_type"] == "code"]
    assert len(code) > 10
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)
    assert all(cell["metadata"] == {} for cell in stored["cells"])
    assert stored["metadata"] == {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    assert [cell["id"] for cell in stored["cells"]] == [f"cell-{i}" for i in range(1, len(stored["cells"]) + 1)]
    assert all(word not in NOTEBOOK.read_text("utf-8") for word in ("/home", "/tmp", "/work", "C:\\\\"))


@pytest.mark.slow
def test_the_notebook_runs_and_shows_its_figures_and_tables(tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    pytest.importorskip("xarray")
    book = nbformat.read(NOTEBOOK, 4)
    nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    cells = [cell for cell in book.cells if cell.cell_type == "code"]
    shown = {cell.source.splitlines()[-1]: outputs_of(cell) for cell in cells}

    assert "image/png" in shown['rf.plot_clouds(runs, measure="pgv")']
    assert sum("image/png" in each for each in shown.values()) == 3
    assert "image/gif" in shown["Image(filename=file)"]
    for cell in cells:  # no figure twice
        assert sum(bool(set(IMAGES) & set(output.get("data", {}))) for output in cell.outputs) <= 1, cell.source

    tables = {name: each["text/html"] for name, each in shown.items() if "<table" in str(each.get("text/html"))}
    for name, title in {
        "frame.modal()": "ModalProperties",
        "suite": "Suite",
        "lossy": "Response",
        "fit": "CloudFits",
    }.items():
        assert f"<caption>{title}</caption>" in tables[name]
    assert len(tables) >= 7  # these and the tables of pandas

    (bar,) = [cell.outputs[0].data["text/html"] for cell in cells if "run_cloud" in cell.source]
    assert "220/220" in bar
    assert (tmp_path / "rocking.gif").stat().st_size > 10_000
