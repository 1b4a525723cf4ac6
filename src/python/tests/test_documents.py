"""What the documents show runs and is true."""

import pathlib
import re

import pytest
from conftest import ROOT

PYTHON = ROOT / "src/python"


def blocks(path):
    """The blocks of Python in a page."""
    return re.findall(r"^```python\n(.*?)^```", path.read_text(), re.S | re.M)


@pytest.mark.parametrize("page", ["README.md", "src/python/README.md"])
def test_three_lines_find_the_hidden_effect(page, monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    first = blocks(ROOT / page)[0]
    assert len(first.strip().splitlines()) == 3
    exec(first, {})
    assert "decimation filter" in capsys.readouterr().out


def test_every_block_of_the_readme_runs_in_order(monkeypatch, tmp_path, hidden):
    monkeypatch.chdir(ROOT)
    scope = {}
    page = blocks(PYTHON / "README.md")
    assert len(page) >= 4
    for block in page:
        exec(block, scope)


def test_the_notebook_runs():
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    notebook = nbformat.read(PYTHON / "examples/hidden_effect.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(PYTHON)}}).execute()
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    pages = [output["data"]["text/html"] for cell in code for output in cell.outputs if "text/html" in output.get("data", {})]
    assert sum("<svg" in page for page in pages) >= 3
    printed = "".join(output.get("text", "") for cell in code for output in cell.outputs)
    assert "five terms + sinusoid: χ²" in printed and " → " in printed
    assert not any(cell.outputs for cell in nbformat.read(pathlib.Path(PYTHON / "examples/hidden_effect.ipynb"), as_version=4).cells if cell.cell_type == "code")
