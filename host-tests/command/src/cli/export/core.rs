//! The cores that a library is built for.

use clap::ValueEnum;
use driveline_qemu::setup::Need;
use serde::Serialize;

use crate::cli::project::Number;

/// A core.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Core {
    /// Cortex-M0+
    M0plus,
    /// Cortex-M3
    M3,
    /// Cortex-M4F
    M4f,
    /// Cortex-M7 with an FPU of single precision
    M7,
    /// Cortex-M33 with an FPU
    M33,
    /// This computer, for tests and simulations
    Host,
}

/// A core of Arm as build systems name it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Arm {
    /// Arduino's folder of precompiled libraries: core, and FPU with its calls.
    pub folder: &'static str,
    /// What it depends on in Zephyr's Kconfig.
    kconfig: &'static str,
    /// FPU in a CMSIS-Pack.
    dfpu: &'static str,
    /// The machine of QEMU that the example runs on.
    #[serde(skip)]
    pub qemu: Qemu,
}

/// A machine of QEMU.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Qemu {
    machine: &'static str,
    /// Origins of flash and RAM.
    flash: &'static str,
    ram: &'static str,
}

impl Qemu {
    const fn new(machine: &'static str) -> Self {
        Self { machine, flash: "0x00000000", ram: "0x20000000" }
    }
}

impl Core {
    /// As build systems name it; none for this computer.
    pub const fn arm(self) -> Option<Arm> {
        let (folder, kconfig, dfpu, qemu) = match self {
            // QEMU has no Cortex-M0+; a Cortex-M3 has all its instructions
            Core::M0plus => ("cortex-m0plus", "CPU_CORTEX_M0PLUS", "NO_FPU", Qemu::new("mps2-an385")),
            Core::M3 => ("cortex-m3", "CPU_CORTEX_M3", "NO_FPU", Qemu::new("mps2-an385")),
            Core::M4f => ("cortex-m4/fpv4-sp-d16-hard", "CPU_CORTEX_M4 && FPU", "SP_FPU", Qemu::new("mps2-an386")),
            Core::M7 => ("cortex-m7/fpv5-sp-d16-hard", "CPU_CORTEX_M7 && FPU", "SP_FPU", Qemu::new("mps2-an500")),
            Core::M33 => (
                "cortex-m33/fpv5-sp-d16-hard",
                "CPU_CORTEX_M33 && FPU",
                "SP_FPU",
                // the secure side's addresses
                Qemu { machine: "mps2-an505", flash: "0x10000000", ram: "0x38000000" },
            ),
            Core::Host => return None,
        };
        Some(Arm { folder, kconfig, dfpu, qemu })
    }

    /// The core, as `--core` names it.
    pub fn key(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Core::M0plus => "Cortex-M0+",
            Core::M3 => "Cortex-M3",
            Core::M4f => "Cortex-M4F",
            Core::M7 => "Cortex-M7",
            Core::M33 => "Cortex-M33",
            Core::Host => "computer",
        }
    }

    /// The compiler's target; none for this computer.
    pub const fn target(self) -> Option<&'static str> {
        match self {
            Core::M0plus => Some("thumbv6m-none-eabi"),
            Core::M3 => Some("thumbv7m-none-eabi"),
            Core::M4f | Core::M7 => Some("thumbv7em-none-eabihf"),
            Core::M33 => Some("thumbv8m.main-none-eabihf"),
            Core::Host => None,
        }
    }

    /// Flags of a C compiler that make code for it with the same calls.
    pub const fn flags(self) -> &'static str {
        match self {
            Core::M0plus => "-mcpu=cortex-m0plus -mthumb",
            Core::M3 => "-mcpu=cortex-m3 -mthumb",
            Core::M4f => "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16",
            Core::M7 => "-mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-sp-d16",
            Core::M33 => "-mcpu=cortex-m33 -mthumb -mfloat-abi=hard -mfpu=fpv5-sp-d16",
            Core::Host => "",
        }
    }

    /// The number that it calculates in fastest.
    pub const fn number(self) -> Number {
        if matches!(self, Core::M0plus | Core::M3) { Number::Fixed } else { Number::Single }
    }

    /// What is needed to build for it.
    pub fn needs(self) -> Vec<Need> {
        self.target().map(Need::Target).into_iter().collect()
    }
}
