//! The system's package manager, and the right to use it.

use std::ffi::OsStr;

use super::programs::succeeds;
use crate::link::QEMU;

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
    Root,
    /// Through `sudo` without a password.
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

    /// The command that brings its lists up to date, where that is a command of its own.
    pub fn update(self, rights: Rights) -> Option<Vec<String>> {
        (self == Manager::Apt).then(|| rights.command("apt-get -q update"))
    }

    /// The command that installs QEMU for Arm and removes nothing.
    pub fn install(self, rights: Rights) -> Vec<String> {
        match self {
            Manager::Apt => {
                rights.command(&format!("apt-get -q install -y --no-remove --no-install-recommends {QEMU}"))
            }
            Manager::Dnf => rights.command(&format!("dnf install -y {QEMU}")),
            Manager::Pacman => rights.command(&format!("pacman -S --noconfirm --needed {QEMU}")),
            // as root it refuses
            Manager::Brew => Rights::Root.command("brew install qemu"),
        }
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
    pub fn suffice(self, manager: Manager) -> bool {
        self != Rights::None || manager == Manager::Brew
    }

    /// A command as root.
    fn command(self, line: &str) -> Vec<String> {
        let prefix: &[&str] = match self {
            Rights::Root => &[],
            Rights::Sudo => &["sudo", "-n"],
            Rights::None => &["sudo"],
        };
        prefix.iter().copied().chain(line.split(' ')).map(String::from).collect()
    }
}

/// Actions of `apt-get`, from its own dry run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trial {
    /// Packages that it would add.
    pub added: Vec<String>,
    /// Packages that it would bring up to date.
    pub upgraded: Vec<String>,
    /// Packages that it would remove.
    pub removed: Vec<String>,
}

impl Trial {
    /// Read from what `apt-get --simulate` prints in English.
    pub fn read(text: &str) -> Self {
        let listed = |heading: &str| {
            let after = text.lines().skip_while(|line| *line != heading).skip(1);
            let names = after.take_while(|line| line.starts_with(' ')).flat_map(str::split_whitespace);
            names.map(String::from).collect()
        };
        Trial {
            added: listed("The following NEW packages will be installed:"),
            upgraded: listed("The following packages will be upgraded:"),
            removed: listed("The following packages will be REMOVED:"),
        }
    }

    /// Added packages, in a line.
    pub fn sentence(&self) -> String {
        let upgraded = match self.upgraded.as_slice() {
            [] => String::new(),
            names => format!("; it upgrades {}", names.join(", ")),
        };
        format!("apt-get adds {} packages and removes none: {}{upgraded}", self.added.len(), self.added.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::{Manager, Rights, Trial};

    #[test]
    fn the_command_to_type_fits_the_system_and_the_rights() {
        let line = |manager: Manager, rights| manager.install(rights).join(" ");
        let apt = "apt-get -q install -y --no-remove --no-install-recommends qemu-system-arm";
        assert_eq!(line(Manager::Apt, Rights::Root), apt);
        assert_eq!(Manager::Apt.update(Rights::None).unwrap().join(" "), "sudo apt-get -q update");
        assert_eq!(line(Manager::Dnf, Rights::Sudo), "sudo -n dnf install -y qemu-system-arm");
        assert_eq!(line(Manager::Pacman, Rights::None), "sudo pacman -S --noconfirm --needed qemu-system-arm");
        assert_eq!(line(Manager::Brew, Rights::None), "brew install qemu");
    }

    #[test]
    fn the_first_manager_that_is_installed_is_taken() {
        assert_eq!(Manager::find(|program| program == "dnf" || program == "brew"), Some(Manager::Dnf));
        assert_eq!(Manager::find(|_| false), None);
        assert!(Rights::None.suffice(Manager::Brew) && !Rights::None.suffice(Manager::Apt));
    }

    /// `apt-get -s --no-remove install qemu-system-arm` on Debian 12 with `qemu-utils` from its backports, shortened.
    #[test]
    fn a_trial_names_what_is_added_and_what_would_be_removed() {
        let trial = Trial::read(
            "Reading package lists...\n\
             The following additional packages will be installed:\n  libfdt1 qemu-system-common\n\
             Suggested packages:\n  samba vde2\n\
             The following packages will be REMOVED:\n  qemu-utils\n\
             The following NEW packages will be installed:\n  libfdt1 qemu-system-arm\n  qemu-system-common\n\
             0 upgraded, 3 newly installed, 1 to remove and 132 not upgraded.\n\
             E: Packages need to be removed but remove is disabled.\n",
        );
        assert_eq!(trial.removed, ["qemu-utils"]);
        assert!(trial.upgraded.is_empty());
        let sentence = "apt-get adds 3 packages and removes none: libfdt1, qemu-system-arm, qemu-system-common";
        assert_eq!(trial.sentence(), sentence);
    }
}
