"""What the program prints as JSON is valid by the schemas that it prints."""

import copy
import json
import subprocess

import jsonschema
import pytest
from conftest import DATA, allanite, program

GYRO = DATA / "adis16405.json"
LOT = ["--limit", "N=0.33°/√h", "--limit", "B=58°/h"]


def printed(*arguments):
    """The document of a command, whatever its limits or another file say."""
    command = [program(), "--quiet", *map(str, arguments)]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=False).stdout)


def validator(command):
    schema = json.loads(allanite("schema", command))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """Logs without and with a line, and one whose mean changes by a step."""
    folder = tmp_path_factory.mktemp("logs")
    plain, line, step = (folder / f"{name}.csv" for name in ("plain", "line", "step"))
    sinusoid = ["--effect", "sinusoid:frequency_hz=7.7,amplitude=0.05"]
    for path, more in [(plain, []), (line, sinusoid)]:
        allanite("simulate", "mems", "--duration", "200", "--seed", "2", *more, "--output", path)
    head, *rows = plain.read_text().splitlines()
    half = len(rows) // 2
    step.write_text("\n".join([head, *rows[:half], *(str(float(row) + 0.03) for row in rows[half:])]))
    return plain, line, step


@pytest.mark.parametrize("command", ["fit", "compare", "diagnose"])
def test_documents_of_logs_and_curves_are_valid(command, logs, tmp_path):
    schema = validator(command)
    plain, line, step = logs
    more = [["--limit", "N=1", "--limit", "K=1e-9", line], ["--method", "ordinary", line]] if command == "fit" else []
    for files in [[GYRO], [line], [step], [plain, tmp_path / "missing.csv", line], *more]:
        schema.validate(printed(command, "--json", *files))


def test_documents_of_a_lot_are_valid(tmp_path):
    schema = validator("lot")
    lot = DATA / "lot"
    for files in [[lot / "now", "--earlier", lot / "before"], [lot / "now/SN-0001.bin"], [lot / "now"]]:
        schema.validate(printed("lot", "--json", *LOT, *files))


def test_documents_of_certificates_are_valid():
    schema = validator("decode")
    files = sorted((DATA / "lot/now").glob("*.bin"))[:5]
    document = printed("decode", "--json", *files)
    assert len(document["records"]) == 5
    schema.validate(document)


def test_another_document_is_not_valid(logs):
    """A schema that every document satisfies would say nothing."""
    schema = validator("diagnose")
    document = printed("diagnose", "--json", logs[1])
    axis = document["axes"][0]
    # These are there only if there is something to say.
    optional = {"filter", "spectrum", "lines", "combs"}
    assert len(axis.keys() - optional) >= 11
    for name in axis:
        less, other = copy.deepcopy(document), copy.deepcopy(document)
        del less["axes"][0][name]
        assert schema.is_valid(less) == (name in optional), name
        other["axes"][0][name] = {"another": "type"}
        assert not schema.is_valid(other), name
