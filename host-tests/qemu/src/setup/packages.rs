//! The system's package manager, and the right to use it.

use std::ffi::OsStr;

use super::succeeds;

/// A package manager that has QEMU for Arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manager {
    /// Debian, Ubuntu.
    Apt,
    /// Fedora, RHEL.
    Dnf,
    /// Arch.
    Pacman,
    /// macOS, as the user.
    Brew,
}

/// How root's commands can be run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rights {
    /// This is root.
    Root,
    /// Through `sudo`, which asks for no password.
    Sudo,
    /// Not without the user.
    None,
}

impl Manager {
    /// The first that is installed.
    pub fn find(has: impl Fn(&str) -> bool) -> Option<Self> {
        let all =
            [("apt-get", Manager::Apt), ("dnf", Manager::Dnf), ("pacman", Manager::Pacman), ("brew", Manager::Brew)];
        all.into_iter().find(|(program, _)| has(program)).map(|(_, manager)| manager)
    }

    /// The commands that install QEMU for Arm.
    pub fn install_qemu(self, rights: Rights) -> Vec<Vec<String>> {
        let lines: &[&str] = match self {
            Manager::Apt => &["apt-get update", "apt-get install -y --no-install-recommends qemu-system-arm"],
            Manager::Dnf => &["dnf install -y qemu-system-arm"],
            Manager::Pacman => &["pacman -S --noconfirm --needed qemu-system-arm"],
            Manager::Brew => &["brew install qemu"],
        };
        let prefix: &[&str] = match (self, rights) {
            (Manager::Brew, _) | (_, Rights::Root) => &[],
            (_, Rights::Sudo) => &["sudo", "-n"],
            (_, Rights::None) => &["sudo"],
        };
        let command = |line: &&str| prefix.iter().copied().chain(line.split(' ')).map(String::from).collect();
        lines.iter().map(command).collect()
    }
}

impl Rights {
    /// Those of this process.
    pub fn find() -> Self {
        if rustix::process::geteuid().is_root() {
            Rights::Root
        } else if succeeds(OsStr::new("sudo"), &["-n", "true"]) {
            Rights::Sudo
        } else {
            Rights::None
        }
    }

    /// Whether they are enough for a manager to install without the user.
    pub fn suffice(self, manager: Option<Manager>) -> bool {
        self != Rights::None || manager == Some(Manager::Brew)
    }
}

#[cfg(test)]
mod tests {
    use super::{Manager, Rights};

    #[test]
    fn the_command_to_type_fits_the_system_and_the_rights() {
        let line = |manager: Manager, rights| {
            let commands = manager.install_qemu(rights);
            commands.iter().map(|command| command.join(" ")).collect::<Vec<_>>().join(" && ")
        };
        let apt = "apt-get update && apt-get install -y --no-install-recommends qemu-system-arm";
        assert_eq!(line(Manager::Apt, Rights::Root), apt);
        assert_eq!(line(Manager::Dnf, Rights::Sudo), "sudo -n dnf install -y qemu-system-arm");
        assert_eq!(line(Manager::Pacman, Rights::None), "sudo pacman -S --noconfirm --needed qemu-system-arm");
        assert_eq!(line(Manager::Brew, Rights::None), "brew install qemu");
    }

    #[test]
    fn the_first_manager_that_is_installed_is_taken() {
        assert_eq!(Manager::find(|program| program == "dnf" || program == "brew"), Some(Manager::Dnf));
        assert_eq!(Manager::find(|_| false), None);
        assert!(Rights::None.suffice(Some(Manager::Brew)) && !Rights::None.suffice(Some(Manager::Apt)));
    }
}
