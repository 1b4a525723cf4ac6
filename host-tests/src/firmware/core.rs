//! The cores that the images run on, as QEMU has them.

/// A core, on a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Core {
    /// Its name.
    pub name: &'static str,
    /// What images are built for.
    pub target: &'static str,
    /// QEMU's name of the board.
    pub machine: &'static str,
    /// QEMU's name of the core.
    pub cpu: &'static str,
    /// The symbol by which `memory.x` knows the board, if it is not the usual one.
    pub board: Option<&'static str>,
}

/// The core that figures are of, where no other is named.
pub const CORTEX_M4F: Core = Core {
    name: "Cortex-M4F",
    target: "thumbv7em-none-eabihf",
    machine: "mps2-an386",
    cpu: "cortex-m4",
    board: None,
};

/// Every core: with hardware for single precision, for none, for double; with 4 MiB of RAM, and with
/// 16 KiB.
pub const CORES: [Core; 6] = [
    Core {
        name: "Cortex-M0",
        target: "thumbv6m-none-eabi",
        machine: "microbit",
        cpu: "cortex-m0",
        board: Some("_board_microbit"),
    },
    Core {
        name: "Cortex-M3",
        target: "thumbv7m-none-eabi",
        machine: "mps2-an385",
        cpu: "cortex-m3",
        board: None,
    },
    Core {
        name: "Cortex-M4",
        target: "thumbv7em-none-eabi",
        ..CORTEX_M4F
    },
    CORTEX_M4F,
    Core {
        name: "Cortex-M7",
        machine: "mps2-an500",
        cpu: "cortex-m7",
        ..CORTEX_M4F
    },
    Core {
        name: "Cortex-M33",
        target: "thumbv8m.main-none-eabihf",
        machine: "mps2-an505",
        cpu: "cortex-m33",
        board: Some("_board_an505"),
    },
];
