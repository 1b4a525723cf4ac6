"""Python tells the same as the command line, to the bit."""

import dataclasses
import json
import subprocess

import pytest
from conftest import DATA, FIXTURES, allanite, document, program

import allanite as package

PRESETS = ("mems", "tactical", "fog", "crg20", "vg951")
EFFECTS = (
    None,
    "sinusoid:frequency_hz=7.7,amplitude=0.02",
    "gauss_markov:correlation_time_s=2,rms=0.01",
    "decimation_filter:width_s=0.02,stages=2",
    "low_pass:cutoff_hz=20,poles=1",
    "resonance:frequency_hz=12,quality=20,rms=0.01",
    "thermal:slope=0.01,kelvin=5,period_s=120",
    "random_telegraph:correlation_time_s=3,rms=0.01",
)
# Forty logs: every effect on every preset, in three forms by turns.
LOGS = [(preset, effect) for preset in PRESETS for effect in EFFECTS]


@pytest.mark.parametrize("number", range(len(LOGS)))
def test_forty_logs(number, tmp_path):
    preset, effect = LOGS[number]
    # A temperature is a column, which an array has no name for.
    is_thermal = effect is not None and effect.startswith("thermal")
    form = ("log.csv", "log.csv.gz", "log.npy")[0 if is_thermal else number % 3]
    path = tmp_path / form
    arguments = ["--duration", f"{3 + number % 4}min", "--seed", number, "--axes", 1 + number % 2]
    if effect is not None:
        arguments += ["--effect", effect]
    if number % 5 == 0:
        arguments += ["--scale", "0.0005"]
    allanite("simulate", preset, *arguments, "--output", path)
    record = package.read(path)
    assert record.fit().to_dict() == document("fit", path)
    assert record.diagnose().to_dict() == document("diagnose", path)


def test_there_are_forty_logs():
    assert len(LOGS) >= 40


@pytest.mark.parametrize(
    ("file", "options"),
    [
        ("gyro.ulg", {}),
        ("two-gyros.ulg", {"topic": "sensor_gyro:1"}),
        ("imu-zstd.mcap", {}),
        ("ros1.mcap", {}),
        ("two-imus.mcap", {"topic": "/imu/left"}),
        ("euroc.csv", {}),
        ("euroc.csv", {"sensor": "accel", "from_": "10ms"}),
        ("counts.npy", {"rate": 100, "scale": 0.05, "unit": "rad/s", "columns": {"x": 1}}),
    ],
)
def test_every_reader_and_its_options(file, options):
    path = FIXTURES / file
    words = []
    for name, value in options.items():
        if isinstance(value, dict):
            value = ",".join(f"{axis}={column}" for axis, column in value.items())
        words += [f"--{name.rstrip('_')}", value]
    record = package.read(path, **options)
    assert record.fit().to_dict() == document("fit", path, *words)
    assert record.diagnose().to_dict() == document("diagnose", path, *words)


def test_what_the_command_line_refuses_is_refused_in_its_words():
    path = FIXTURES / "two-imus.mcap"
    with pytest.raises(package.AllaniteError) as refused:
        package.read(path, topic="/board/imu")
    done = subprocess.run([program(), "fit", str(path), "--topic", "/board/imu"], capture_output=True, text=True, check=False)
    assert done.stderr == f"allanite: {str(refused.value).replace('topic=', '--topic')}\n"


def test_curve_files_and_texts():
    path = DATA / "adis16405.json"
    record = package.read(path)
    assert record.fit().to_dict() == document("fit", path)
    diagnosis = record.diagnose()
    assert diagnosis.to_dict() == document("diagnose", path)
    # Only the width of the lines follows the terminal.
    assert str(diagnosis).split() == allanite("diagnose", path).split()
    assert str(record.fit()).split() == allanite("fit", path).split()


def test_options_of_fits_and_diagnoses(three):
    record = package.read(three)
    fit = record.fit(method="ordinary", limits={"N": 0.01, "B": "9°/h"})
    assert fit.to_dict()["axes"][0]["limits"][0]["verdict"]
    command = [three, "--method", "ordinary", "--limit", "N=0.01", "--limit", "B=9°/h", "--json"]
    # Limits end the command with another status, which says what they say.
    done = subprocess.run([program(), "--quiet", "fit", *map(str, command)], capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1, 3)
    assert fit.to_dict() == json.loads(done.stdout)
    low_pass = package.LowPass(cutoff_hz=42, poles=2)
    expected = document("diagnose", three, "--max-effects", 1, "--filter", "low_pass:cutoff_hz=42,poles=2")
    assert record.diagnose(max_effects=1, filter=low_pass).to_dict() == expected


def test_models_are_those_of_compare(hidden):
    model = package.read(hidden).fit().model + package.Sinusoid(7.7, fitted=False) - "rate_ramp"
    expected = document("compare", hidden, "--with", "sinusoid:frequency_hz=7.7", "--without", "rate_ramp")
    assert model.to_dict() == expected


@pytest.mark.parametrize(
    ("effect", "begun", "known"),
    [
        (
            package.DigitalLowPass(cutoff_hz=42, poles=4),
            "digital_low_pass:cutoff_hz~42,poles=4",
            "digital_low_pass:cutoff_hz=42,poles=4",
        ),
        (
            package.OutputLowPass(cutoff_hz=17.3, poles=3),
            "output_low_pass:cutoff_hz~17.3,poles=3",
            "output_low_pass:cutoff_hz=17.3,poles=3",
        ),
        (package.Cascade(cutoff_hz=9.7, stages=3), "cascade:cutoff_hz~9.7,stages=3", "cascade:cutoff_hz=9.7,stages=3"),
        (package.HighPass(cutoff_hz=0.3), "high_pass:cutoff_hz~0.3", "high_pass:cutoff_hz=0.3"),
        (
            package.LowPass(time_constant_s=0.0037, poles=4),
            "low_pass:time_constant_s~0.0037,poles=4",
            "low_pass:time_constant_s=0.0037,poles=4",
        ),
    ],
    ids=lambda one: getattr(one, "NAME", ""),
)
def test_filters_are_those_of_compare_and_diagnose(effect, begun, known, hidden):
    record = package.read(hidden)
    five = record.fit().model
    assert (five + effect).to_dict() == document("compare", hidden, "--with", begun)
    fixed = dataclasses.replace(effect, fitted=False)
    assert (five + fixed).to_dict() == document("compare", hidden, "--with", known)
    expected = document("diagnose", hidden, "--max-effects", 1, "--filter", known)
    assert record.diagnose(max_effects=1, filter=effect).to_dict() == expected


def test_pictures_are_those_of_plot(hidden, tmp_path):
    path = tmp_path / "picture.svg"
    allanite("plot", hidden, "--step", 0, "--output", path)
    assert package.read(hidden).diagnose().plot(step=0).svg == path.read_text()


def test_saved_curves_are_those_of_measure(three, tmp_path):
    allanite("measure", three, "--output", tmp_path / "theirs.json")
    package.read(three).save(tmp_path / "ours.json")
    assert (tmp_path / "ours.json").read_text() == (tmp_path / "theirs.json").read_text()
