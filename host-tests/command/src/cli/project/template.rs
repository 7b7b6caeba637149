//! The templates, compiled into the program.

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment};
use serde::Serialize;

macro_rules! templates {
    ($($name:literal)+) => {
        /// Name and text of each.
        const TEMPLATES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../../templates/", $name, ".jinja")))),+];
    };
}

templates! {
    "lib.rs" "machine.rs"
    "new/Cargo.toml" "new/README.md" "new/build.rs" "new/closed_loop.rs" "new/config.toml" "new/firmware.rs"
    "new/generic.rs" "new/main.rs" "new/memory.x" "new/nucleo_g474re.rs" "new/qemu.rs" "new/simulated.rs"
    "c/Cargo.toml" "c/Makefile" "c/README.md" "c/c.rs" "c/config-version.cmake" "c/config.cmake" "c/header.h"
    "c/header.hpp" "c/library.json" "c/library.properties" "c/main.c" "c/make" "c/pack.pdsc" "c/qemu/memory.ld"
    "c/qemu/startup.c" "c/zephyr/CMakeLists.txt" "c/zephyr/Kconfig" "c/zephyr/module.yml"
    "fmu/controller.rs" "fmu/fmi.rs" "fmu/modelDescription.xml" "fmu/plant.rs"
}

/// Fills a template.
///
/// # Panics
/// Where a template is wrong, which the tests show: the templates are part of the program.
pub fn fill(template: &str, values: &impl Serialize) -> String {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::None);
    environment.set_undefined_behavior(minijinja::UndefinedBehavior::Strict);
    for &(name, text) in TEMPLATES {
        environment.add_template(name, text).expect("a template of a project is not well-formed");
    }
    let template = environment.get_template(template).expect("the project's template is compiled in");
    // the last line's end is left out
    template.render(Serde(values)).expect("a template of a project lacks an input") + "\n"
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    #[test]
    fn a_template_is_filled_without_escaping() {
        let values = json!({
            "crate": "roll", "upper": "ROLL", "flags": "-mcpu=cortex-m4 && -mthumb",
        });
        assert!(super::fill("c/make", &values).contains("ROLL_CORE := -mcpu=cortex-m4 && -mthumb\n"));
    }
}
