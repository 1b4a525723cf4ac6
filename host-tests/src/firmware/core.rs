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
    /// What it computes in.
    pub precision: Precision,
}

/// What curves, fits and diagnoses are computed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Single precision, the library's default.
    Single,
    /// Double precision, the library's feature `double`.
    Double,
}

impl Precision {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Single, Self::Double];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Double => "double",
            Self::Single => "single",
        }
    }

    /// Arguments of cargo that choose it.
    pub fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Single => &[],
            Self::Double => &["--features", "double"],
        }
    }
}

impl Core {
    /// The same with another precision.
    #[must_use]
    pub const fn with(self, precision: Precision) -> Self {
        Self { precision, ..self }
    }

    /// Every core with either precision.
    pub fn all() -> impl Iterator<Item = Self> {
        let cores = |precision| CORES.map(|core| core.with(precision));
        Precision::ALL.into_iter().flat_map(cores)
    }
}

/// With its precision.
impl std::fmt::Display for Core {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, {} precision", self.name, self.precision.name())
    }
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
    precision: Precision::Single,
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
    precision: Precision::Single,
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
        precision: Precision::Single,
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
