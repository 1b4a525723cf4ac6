"""Reads what `export` wrote by the parsers of the programs that it is for: consumers.py FOLDER

The folder has a file for each format, named after it, beside model.json. A line of JSON is printed for each number that a
program takes: the format, the parser, the name of the number, what the parser read, and what the model says it should be.
"""

import json
import math
import sys
from pathlib import Path

folder = Path(sys.argv[1])
axis = json.loads((folder / "json").read_text())["axes"][0]
density, walk, rate = axis["noise_density"], axis["random_walk_alone"], axis["rate_hz"]


def tell(form, parser, name, read, expected):
    print(json.dumps({"format": form, "parser": parser, "name": name, "read": float(read), "expected": expected}))


def safe_yaml(form):
    import yaml

    return yaml.safe_load((folder / form).read_text())


# A node of OpenCV does not keep its storage alive.
storages = []


def opencv(form):
    import cv2

    storages.append(cv2.FileStorage(str(folder / form), cv2.FILE_STORAGE_READ))
    return storages[-1].root()


# Kalibr and rosparam read by PyYAML.
node = safe_yaml("kalibr")
tell("kalibr", "PyYAML", "gyroscope_noise_density", node["gyroscope_noise_density"], density)
tell("kalibr", "PyYAML", "gyroscope_random_walk", node["gyroscope_random_walk"], walk)
node = safe_yaml("lio-sam")["lio_sam"]
tell("lio-sam", "PyYAML", "imuGyrNoise", node["imuGyrNoise"], density)
tell("lio-sam", "PyYAML", "imuGyrBiasN", node["imuGyrBiasN"], walk)

# KF-GINS reads by yaml-cpp, which has no Python.
node = safe_yaml("kf-gins")["imunoise"]
tell("kf-gins", "PyYAML", "arw", node["arw"][0], math.degrees(density) * 60)
process = axis["processes"][0]
tell("kf-gins", "PyYAML", "gbstd", node["gbstd"][0], math.degrees(process["sigma"]) * 3600)
tell("kf-gins", "PyYAML", "corrtime", node["corrtime"], process["correlation_time_s"] / 3600)

# OpenVINS and VINS-Fusion read by OpenCV.
node = opencv("openvins").getNode("imu0")
tell("openvins", "OpenCV", "gyroscope_noise_density", node.getNode("gyroscope_noise_density").real(), density)
tell("openvins", "OpenCV", "gyroscope_random_walk", node.getNode("gyroscope_random_walk").real(), walk)
node = opencv("vins-fusion")
tell("vins-fusion", "OpenCV", "gyr_n", node.getNode("gyr_n").real(), density * math.sqrt(2 * rate))
tell("vins-fusion", "OpenCV", "gyr_w", node.getNode("gyr_w").real(), walk * math.sqrt(rate))

# GTSAM runs the function.
import gtsam

space = {}
exec((folder / "gtsam").read_text(), space)
params = gtsam.PreintegrationCombinedParams.MakeSharedU(9.81)
space["set_gyro_noise"](params)
tell("gtsam", "gtsam", "getGyroscopeCovariance", params.getGyroscopeCovariance()[1, 1], density**2)
tell("gtsam", "gtsam", "getBiasOmegaCovariance", params.getBiasOmegaCovariance()[2, 2], walk**2)

# A message of ROS with the matrix, written and read as a subscriber would.
import numpy as np
from rosbags.typesys import Stores, get_typestore

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
for place in (0, 4, 8):
    tell("ros", "rosbags", f"angular_velocity_covariance[{place}]",
         read.angular_velocity_covariance[place], density**2 * rate)

# Parameter files of the autopilots, by what MAVProxy reads them with.
from pymavlink.mavparm import MAVParmDict

for form, noise, bias, interval in [
    ("px4", "EKF2_GYR_NOISE", "EKF2_GYR_B_NOISE", 0.01),
    ("ardupilot", "EK3_GYRO_P_NSE", "EK3_GBIAS_P_NSE", 0.012),
]:
    values = MAVParmDict()
    # The lines of QGroundControl have the numbers of vehicle and component before the name and the type behind the value.
    lines = (folder / form).read_text().splitlines()
    if form == "px4":
        lines = [" ".join(line.split()[2:4]) for line in lines if line and not line.startswith("#")]
    plain = folder / f"{form}.parm"
    plain.write_text("\n".join(lines) + "\n")
    # It prints as it reads, and no line of that begins with a brace.
    values.load(str(plain))
    tell(form, "pymavlink", noise, values[noise], density / math.sqrt(interval))
    tell(form, "pymavlink", bias, values[bias], walk / math.sqrt(interval))
