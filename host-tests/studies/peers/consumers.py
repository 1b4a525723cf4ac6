"""Reads what `export` wrote by the parsers of the programs that it is for: consumers.py FOLDER

The folder has two folders with a file for each format, named after it. Those in `long` have all numbers of a gyro and an
accelerometer, and those in `short` lack the accelerometer, and have a bound for the random walk. A line of JSON is printed for each number
that a program takes: the format, the parser, the name of the number, what the parser read or what it takes instead, and
what the model or the file says that it should be.
"""

import json
import math
import sys
from pathlib import Path
from xml.etree import ElementTree

import cv2
import gtsam
import numpy as np
import yaml
from pymavlink.mavparm import MAVParmDict
from rosbags.typesys import Stores, get_typestore

folder = Path(sys.argv[1])
axes = json.loads((folder / "long" / "json").read_text())["axes"]
assert len(axes) == 3
densities = [axis["noise_density"] for axis in axes]
walks = [axis["random_walk_alone"] for axis in axes]
rate = axes[0]["rate_hz"]
# The third axis shows no walk, and has the bound of its curve. A number for all axes is the largest one.
assert axes[2]["random_walk"] is None and walks[2] == axes[2]["overbound"]["random_walk"] < 0.2 * walks[0], walks
density, walk = max(densities), max(walks)
short = json.loads((folder / "short" / "json").read_text())["axes"][0]
short_density, short_walk = short["noise_density"], short["random_walk_alone"]
assert short["random_walk"] is None and short_walk == short["overbound"]["random_walk"]


def tell(form, parser, name, read, expected):
    print(json.dumps({"format": form, "parser": parser, "name": name, "read": float(read), "expected": float(expected)}))


def text(record, form):
    return (folder / record / form).read_text()


def says(form, default):
    """The file itself names what the program takes for a number that is left out."""
    assert default in text("short", form), f"{form} does not say: {default}"


def safe_yaml(form, record="long"):
    return yaml.safe_load(text(record, form))


# A node of OpenCV does not keep its storage alive.
storages = []


def opencv(form, record="long"):
    storages.append(cv2.FileStorage(str(folder / record / form), cv2.FILE_STORAGE_READ))
    return storages[-1].root()


# Kalibr, rosparam and FAST-LIO's node read by PyYAML or yaml-cpp. Kalibr has the accelerometer as it is.
node = safe_yaml("kalibr")
acceleration, acceleration_walk = node["accelerometer_noise_density"], node["accelerometer_random_walk"]
# The accelerometer was simulated with as much noise in m/s² as the gyro in °/s.
assert abs(acceleration / math.degrees(density) - 1) < 0.1, acceleration
tell("kalibr", "PyYAML", "gyroscope_noise_density", node["gyroscope_noise_density"], density)
tell("kalibr", "PyYAML", "gyroscope_random_walk", node["gyroscope_random_walk"], walk)
tell("kalibr", "PyYAML", "update_rate", node["update_rate"], rate)
node = safe_yaml("kalibr", "short")
assert set(node) == {"gyroscope_noise_density", "gyroscope_random_walk", "rostopic", "update_rate"}, node
tell("kalibr", "PyYAML", "gyroscope_noise_density, short", node["gyroscope_noise_density"], short_density)
tell("kalibr", "PyYAML", "gyroscope_random_walk, short", node["gyroscope_random_walk"], short_walk)
says("kalibr", "Kalibr then stops")

node = safe_yaml("lio-sam")["lio_sam"]
tell("lio-sam", "PyYAML", "imuGyrNoise", node["imuGyrNoise"], density)
tell("lio-sam", "PyYAML", "imuGyrBiasN", node["imuGyrBiasN"], walk)
tell("lio-sam", "PyYAML", "imuAccNoise", node["imuAccNoise"], acceleration)
tell("lio-sam", "PyYAML", "imuAccBiasN", node["imuAccBiasN"], acceleration_walk)
assert set(safe_yaml("lio-sam", "short")["lio_sam"]) == {"imuTopic", "imuGyrNoise", "imuGyrBiasN"}
says("lio-sam", "LIO-SAM then takes 2e-4")

node = safe_yaml("fast-lio")["mapping"]
tell("fast-lio", "PyYAML", "gyr_cov", node["gyr_cov"], density**2 * rate)
tell("fast-lio", "PyYAML", "b_gyr_cov", node["b_gyr_cov"], walk**2 * rate)
tell("fast-lio", "PyYAML", "acc_cov", node["acc_cov"], acceleration**2 * rate)
tell("fast-lio", "PyYAML", "b_acc_cov", node["b_acc_cov"], acceleration_walk**2 * rate)
assert set(safe_yaml("fast-lio", "short")["mapping"]) == {"gyr_cov", "b_gyr_cov"}
says("fast-lio", "FAST-LIO then takes 1e-4")

# KF-GINS reads by yaml-cpp, which has no Python.
node = safe_yaml("kf-gins")["imunoise"]
hours = axes[0]["samples"] / rate / 3600
per_walk = math.sqrt(hours * 1800)
for place in range(3):
    tell("kf-gins", "PyYAML", f"arw[{place}]", node["arw"][place], math.degrees(densities[place]) * 60)
    tell("kf-gins", "PyYAML", f"vrw[{place}]", node["vrw"][place], acceleration * 60)
    tell("kf-gins", "PyYAML", f"abstd[{place}]", node["abstd"][place], acceleration_walk * per_walk * 1e5)
    tell("kf-gins", "PyYAML", f"gbstd[{place}]", node["gbstd"][place],
         math.degrees(walks[place]) * per_walk * 3600)
tell("kf-gins", "PyYAML", "corrtime", node["corrtime"], hours)
assert set(safe_yaml("kf-gins", "short")["imunoise"]) == {"arw", "gbstd", "corrtime"}
says("kf-gins", "KF-GINS then stops")

# OpenVINS, VINS-Fusion and ORB-SLAM3 read by OpenCV. A number that is left out is 0 to it; OpenVINS and ORB-SLAM3 look for
# the node first.
node = opencv("openvins").getNode("imu0")
for name, expected in [
    ("gyroscope_noise_density", density),
    ("gyroscope_random_walk", walk),
    ("accelerometer_noise_density", acceleration),
    ("accelerometer_random_walk", acceleration_walk),
]:
    tell("openvins", "OpenCV", name, node.getNode(name).real(), expected)
assert opencv("openvins", "short").getNode("imu0").getNode("accelerometer_random_walk").empty()
says("openvins", "OpenVINS then stops")
node, left_out = opencv("vins-fusion"), opencv("vins-fusion", "short")
for name, expected, factor in [("gyr_n", density, 2), ("gyr_w", walk, 1), ("acc_n", acceleration, 2),
                               ("acc_w", acceleration_walk, 1)]:
    tell("vins-fusion", "OpenCV", name, node.getNode(name).real(), expected * math.sqrt(factor * rate))
    if name.startswith("acc"):
        tell("vins-fusion", "OpenCV", f"{name}, left out", left_out.getNode(name).real(), 0)
says("vins-fusion", "VINS-Fusion then takes 0")
node, left_out = opencv("orb-slam3"), opencv("orb-slam3", "short")
for name, expected in [("NoiseGyro", density), ("GyroWalk", walk), ("NoiseAcc", acceleration), ("AccWalk", acceleration_walk),
                       ("Frequency", rate)]:
    number = node.getNode(f"IMU.{name}")
    assert number.isReal(), name
    tell("orb-slam3", "OpenCV", f"IMU.{name}", number.real(), expected)
assert left_out.getNode("IMU.AccWalk").empty() and not left_out.getNode("IMU.GyroWalk").empty()
says("orb-slam3", "ORB-SLAM3 then stops")


# GTSAM runs the functions, and integrates a second at rest.
def gtsam_functions(record):
    space = {}
    exec(text(record, "gtsam"), space)
    return space


def attitude(params, interval=0.01):
    preintegrated = gtsam.PreintegratedCombinedMeasurements(params, gtsam.imuBias.ConstantBias())
    for _ in range(round(1 / interval)):
        preintegrated.integrateMeasurement(np.array([0, 0, 9.81]), np.zeros(3), interval)
    return np.sqrt(np.diag(preintegrated.preintMeasCov())[:3])


functions = gtsam_functions("long")
params = gtsam.PreintegrationCombinedParams.MakeSharedU(9.81)
functions["set_gyro_noise"](params)
functions["set_accelerometer_noise"](params)
for place in range(3):
    of_axis = [("getGyroscopeCovariance", densities[place]), ("getBiasOmegaCovariance", walks[place]),
               ("getAccelerometerCovariance", acceleration), ("getBiasAccCovariance", acceleration_walk)]
    for name, expected in of_axis:
        tell("gtsam", "gtsam", f"{name}[{place}]", getattr(params, name)()[place, place], expected**2)
    # The attitude after a second is uncertain by the white noise and a third of the walk.
    spread = math.hypot(densities[place], walks[place] / math.sqrt(3))
    assert abs(attitude(params)[place] / spread - 1) < 0.01
functions = gtsam_functions("short")
params = gtsam.PreintegrationCombinedParams.MakeSharedU(9.81)
try:
    functions["set_accelerometer_noise"](params)
except TypeError as error:
    assert "noise_density" in str(error) and "random_walk" in str(error), error
else:
    raise AssertionError("the accelerometer is left at its default")
# What a covariance is that nobody sets.
for name in ["getGyroscopeCovariance", "getBiasOmegaCovariance", "getAccelerometerCovariance", "getBiasAccCovariance"]:
    tell("gtsam", "gtsam", f"{name}, left out", getattr(params, name)()[0, 0], 1)
assert attitude(params)[0] > 0.5
functions["set_gyro_noise"](params)
functions["set_accelerometer_noise"](params, noise_density=1e-3, random_walk=1e-5)
tell("gtsam", "gtsam", "getBiasAccCovariance, by the argument", params.getBiasAccCovariance()[1, 1], 1e-10)
tell("gtsam", "gtsam", "getBiasOmegaCovariance, short", params.getBiasOmegaCovariance()[1, 1], short_walk**2)
tell("gtsam", "gtsam", "getGyroscopeCovariance, short", params.getGyroscopeCovariance()[1, 1], short_density**2)
says("gtsam", "unset, gtsam takes 1")

# A message of ROS with the matrix, written and read as a subscriber would.
store = get_typestore(Stores.ROS2_HUMBLE)
message = {name: store.types[f"{package}/msg/{name}"] for package, name in [
    ("std_msgs", "Header"), ("builtin_interfaces", "Time"), ("geometry_msgs", "Quaternion"),
    ("geometry_msgs", "Vector3"), ("sensor_msgs", "Imu")]}
matrix = np.array(safe_yaml("ros")["angular_velocity_covariance"], dtype=np.float64)
zero = message["Vector3"](x=0.0, y=0.0, z=0.0)
unknown = np.full(9, -1.0)
imu = message["Imu"](
    header=message["Header"](stamp=message["Time"](sec=0, nanosec=0), frame_id="imu"),
    orientation=message["Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0),
    orientation_covariance=unknown,
    angular_velocity=zero,
    angular_velocity_covariance=matrix,
    linear_acceleration=zero,
    linear_acceleration_covariance=unknown,
)
read = store.deserialize_cdr(store.serialize_cdr(imu, "sensor_msgs/msg/Imu"), "sensor_msgs/msg/Imu")
for place in range(3):
    tell("ros", "rosbags", f"angular_velocity_covariance[{4 * place}]",
         read.angular_velocity_covariance[4 * place], densities[place]**2 * rate)


# Parameter files of the autopilots, by what MAVProxy reads them with.
def parameters(form, record):
    # The lines of QGroundControl have the numbers of vehicle and component before the name and the type behind the value.
    lines = text(record, form).splitlines()
    if form == "px4":
        lines = [" ".join(line.split()[2:4]) for line in lines if line and not line.startswith("#")]
    plain = folder / record / f"{form}.parm"
    plain.write_text("\n".join(lines) + "\n")
    values = MAVParmDict()
    # It prints as it reads, and no line of that begins with a brace.
    assert values.load(str(plain))
    return values


for form, names, interval in [
    ("px4", ["EKF2_GYR_NOISE", "EKF2_GYR_B_NOISE", "EKF2_ACC_NOISE", "EKF2_ACC_B_NOISE"], 0.01),
    ("ardupilot", ["EK3_GYRO_P_NSE", "EK3_GBIAS_P_NSE", "EK3_ACC_P_NSE", "EK3_ABIAS_P_NSE"], 0.012),
]:
    values = parameters(form, "long")
    assert set(values) == set(names), dict(values)
    for name, expected in zip(names, [density, walk, acceleration, acceleration_walk]):
        tell(form, "pymavlink", name, values[name], expected / math.sqrt(interval))
    # A parameter that is left out is not touched.
    assert set(parameters(form, "short")) == set(names[:2])
    says(form, {"px4": "its default is 0.003", "ardupilot": "its default is 0.02"}[form])

# MATLAB reads JSON.
part = json.loads(text("long", "matlab"))["gyro"]
for place in range(3):
    tell("matlab", "json", f"NoiseDensity[{place}]", part["Gyroscope"]["NoiseDensity"][place], densities[place])
tell("matlab", "json", "Accelerometer.NoiseDensity", part["Accelerometer"]["NoiseDensity"], acceleration)
tell("matlab", "json", "Accelerometer.RandomWalk", part["Accelerometer"]["RandomWalk"], acceleration_walk)
part = json.loads(text("short", "matlab"))["gyro"]
assert set(part) == {"Gyroscope"} and "RandomWalk" not in part["Gyroscope"], part
says("matlab", "A property that is left out is zero in MATLAB")

# Gazebo adds white noise to each sample, and a process that is driven by dynamic_bias_stddev.
root = ElementTree.fromstring(text("long", "sdf"))
assert root.get("version") == "1.7" and root.find("model").get("name") == "gyro"
sensor = root.find("model/link/sensor[@type='imu']")
tell("sdf", "ElementTree", "update_rate", sensor.find("update_rate").text, rate)
for place, axis in enumerate("xyz"):
    noise = sensor.find(f"imu/angular_velocity/{axis}/noise[@type='gaussian']")
    tell("sdf", "ElementTree", f"angular_velocity.{axis}.stddev", noise.find("stddev").text, densities[place] * math.sqrt(rate))
    noise = sensor.find(f"imu/linear_acceleration/{axis}/noise[@type='gaussian']")
    assert abs(float(noise.find("stddev").text) / (acceleration * math.sqrt(rate)) - 1) < 0.1
    assert float(noise.find("dynamic_bias_stddev").text) > 0 and float(noise.find("dynamic_bias_correlation_time").text) > 1
noise = ElementTree.fromstring(text("short", "sdf")).find(".//angular_velocity/x/noise")
assert [one.tag for one in noise if one.tag is not ElementTree.Comment] == ["stddev"]
says("sdf", "Gazebo then takes 0")
