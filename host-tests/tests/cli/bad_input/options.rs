//! Bad options, and simulations that are impossible.

use super::{
    case::{Case, refused},
    text::good,
};

pub(crate) fn cases() -> Vec<Case> {
    let on_log = table! {
        "--rate 0" => "--rate 0 is impossible";
        "--rate -5" => "--rate -5 is impossible";
        "--rate nan" => "--rate NaN is impossible";
        "--rate inf" => "--rate inf is impossible";
        "--scale -1" => "--scale -1 is impossible";
        "--scale nan" => "--scale NaN is impossible";
        "--scale inf" => "--scale inf is impossible";
        "--rate 1e300" => "--rate 1.000e300 is impossible";
        "--rate 1e-300" => "--rate 1.000e-300 is impossible";
        "--scale 0" => "--scale 0 is impossible";
        "--scale 1e300" => "--scale 1.000e300 is impossible";
        "--columns gw" => "a.csv: there is no column \"gw\"; choose by name from gx, gy, gz or by number";
        "--columns 0" => "there is no column \"0\"";
        "--columns 99999999999999999999" => "there is no column";
        "--columns gx,gx" => "--columns names \"gx\" twice; name every axis and every column once";
        "--columns a=gx,a=gy" => "--columns names \"a\" twice; name every axis and every column once";
        "--columns 4" => "a.csv: there is no column \"4\"; choose by name from gx, gy, gz or by number";
        "--time none" => "there is no column \"none\"";
        "--time gx" => "time";
        "--unit g --sensor gyro" => "is not a unit of a gyro";
        "--topic /imu" => "this kind of log has no topics";
    };
    let of_log = |(options, expected): (&str, &str)| {
        refused("a.csv", good(60), &format!("fit a.csv {options}"), expected)
    };
    let simulated = table! {
        "" => "no preset and no coefficient is given; ";
        "mems --rate 0" => "--rate 0 is impossible; ";
        "mems --rate nan" => "--rate NaN is impossible; ";
        "mems --rate 1e300 --duration 1" => "is impossible";
        "mems --duration 0" => "--duration 0 at 100 Hz is impossible; ";
        "mems --duration -1" => "--duration -1 at 100 Hz is impossible; ";
        "mems --duration inf" => "--duration inf at 100 Hz is impossible; ";
        "mems --duration 1e300" => "is impossible";
        "mems --duration soon" => "--duration \"soon\" is not a length of time";
        "mems --axes 4" => "--axes 4 is impossible";
        "mems --axes 0" => "--axes 0 is impossible; ";
        "mems --scale 0" => "--scale 0 is impossible; ";
        "mems --rate-ramp -1" => "--rate-ramp -1 is impossible; ";
        "mems --scale 1e-300 --duration 1" => "does not fit into a 32-bit count";
        "mems --angle-random-walk nan --duration 1" => "is impossible";
        "--angle-random-walk 1e308 --rate 1e4 --duration 1" => "exceeds the range of numbers";
        "--rate-ramp 1e308 --rate 1 --duration 100" => "exceeds the range of numbers";
        "--quantization 1e308 --duration 1" => "exceeds the range of numbers";
        "mems -o a.txt" => "a.txt: the file's extension is not that of a log; ";
        "mems -o none/a.csv" => "its folder does not exist";
        "mems --effect decimation_filter:width_s=1e9,stages=2" => "is too wide";
        "mems --effect none" => "no such effect";
        "mems --effect sinusoid" => "is missing";
        "mems --effect sinusoid:frequency_hz=nan,amplitude=1" => "; ";
    };
    let simulation = |(options, expected): (&str, &str)| {
        refused("unused", "", &format!("simulate {options}"), expected)
    };
    let mut cases: Vec<Case> = on_log.into_iter().map(of_log).collect();
    cases.extend(simulated.into_iter().map(simulation));
    cases
}
