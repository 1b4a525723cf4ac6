//! The cores that the images run on in QEMU.

/// A core on a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Core {
    /// The name of the core.
    pub name: &'static str,
    /// The target that images are built for.
    pub target: &'static str,
    /// The program of the emulator.
    pub qemu: &'static str,
    /// QEMU's name of the board.
    pub machine: &'static str,
    /// QEMU's name of the core.
    pub cpu: &'static str,
    /// The symbol that selects the board in `memory.x`, or `None` for the default board.
    pub board: Option<&'static str>,
    /// Whether the core has only 16 KiB of RAM. It then has room for fewer octaves and for no
    /// diagnosis.
    pub small: bool,
    /// The precision of its computations.
    pub precision: Precision,
}

/// The precision of curves, fits and diagnoses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Single precision, the library's default.
    Single,
    /// Double precision, the library's feature `double`.
    Double,
}

impl Precision {
    /// Both precisions.
    pub const ALL: [Self; 2] = [Self::Single, Self::Double];

    /// The name of the precision.
    pub fn name(self) -> &'static str {
        match self {
            Self::Double => "double",
            Self::Single => "single",
        }
    }

    /// The arguments of cargo that select the precision.
    pub fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Single => &[],
            Self::Double => &["--features", "double"],
        }
    }
}

impl Core {
    /// The same core with another precision.
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

/// Shows the core with its precision.
impl std::fmt::Display for Core {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, {} precision", self.name, self.precision.name())
    }
}

/// The emulator of Arm's cores.
const QEMU_ARM: &str = "qemu-system-arm";

/// The core that figures refer to, unless another one is named.
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

/// A core of another architecture than Arm.
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

/// Every core. They include cores with hardware for single precision, for no floats, and for double
/// precision, and cores with 4 MiB and with 16 KiB of RAM.
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
