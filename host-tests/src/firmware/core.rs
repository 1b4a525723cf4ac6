//! The cores that the images run on, as QEMU has them.

/// A core, on a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Core {
    /// Its name.
    pub name: &'static str,
    /// What images are built for.
    pub target: &'static str,
    /// The emulator.
    pub qemu: &'static str,
    /// QEMU's name of the board.
    pub machine: &'static str,
    /// QEMU's name of the core.
    pub cpu: &'static str,
    /// The symbol by which `memory.x` knows the board, if it is not the usual one.
    pub board: Option<&'static str>,
    /// Whether it has so little RAM, 16 KiB, that it fits fewer octaves and does not diagnose.
    pub small: bool,
}

/// The emulator of Arm's cores.
const QEMU_ARM: &str = "qemu-system-arm";

/// The core that figures are of, where no other is named.
pub const CORTEX_M4F: Core = Core {
    name: "Cortex-M4F",
    target: "thumbv7em-none-eabihf",
    qemu: QEMU_ARM,
    machine: "mps2-an386",
    cpu: "cortex-m4",
    board: None,
    small: false,
};

/// The core of another architecture.
pub const RISCV: Core = Core {
    name: "RISC-V RV32IMC",
    target: "riscv32imc-unknown-none-elf",
    qemu: "qemu-system-riscv32",
    machine: "virt",
    cpu: "rv32",
    board: Some("_board_virt"),
    small: false,
};

/// Every core: with hardware for single precision, for none, for double; with 4 MiB of RAM, and with
/// 16 KiB.
pub const CORES: [Core; 7] = [
    Core {
        name: "Cortex-M0",
        target: "thumbv6m-none-eabi",
        qemu: QEMU_ARM,
        machine: "microbit",
        cpu: "cortex-m0",
        board: Some("_board_microbit"),
        small: true,
    },
    Core {
        name: "Cortex-M3",
        target: "thumbv7m-none-eabi",
        machine: "mps2-an385",
        cpu: "cortex-m3",
        ..CORTEX_M4F
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
        ..CORTEX_M4F
    },
    RISCV,
];
