"""The program to compare with, and logs that it simulates."""

import json
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
FIXTURES = ROOT / "host-tests/tests/fixtures"
DATA = ROOT / "host-tests/data"


def program():
    return os.environ.get("ALLANITE", str(ROOT / "target/release/allanite"))


def allanite(*arguments):
    """What the command line prints."""
    command = [program(), "--quiet", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{command}: {done.stderr}"
    return done.stdout


def document(*arguments):
    """The document that the command line prints."""
    return json.loads(allanite(*arguments, "--json"))


@pytest.fixture(scope="session")
def hidden(tmp_path_factory):
    """A log of a gyro with a sinusoid of 7.7 Hz."""
    path = tmp_path_factory.mktemp("hidden") / "log.npy"
    effect = "sinusoid:frequency_hz=7.7,amplitude=0.02"
    allanite("simulate", "mems", "--duration", "20min", "--seed", "3", "--effect", effect, "--output", path)
    return path


@pytest.fixture(scope="session")
def three(tmp_path_factory):
    """A log of three axes in counts."""
    path = tmp_path_factory.mktemp("three") / "log.csv"
    allanite("simulate", "mems", "--duration", "5min", "--axes", "3", "--scale", "0.001", "--output", path)
    return path
