//! `modelDescription.xml` of an FMU, of FMI 2.0 or 3.0, as far as co-simulation of scalars needs it.

use roxmltree::{Document, Node};

/// Version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// 2.0
    Two,
    /// 3.0
    Three,
}

/// A unit: a value is `factor` times it plus `offset` in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    pub name: String,
    factor: f64,
    offset: f64,
    /// Exponents of kg, m, s, A, K, mol, cd; the radian has none.
    exponents: [i32; 7],
}

impl Unit {
    /// A value in it, in SI units.
    pub fn to_si(&self, value: f64) -> f64 {
        if self.is_si() { value } else { value * self.factor + self.offset }
    }

    /// A value in SI units, in it.
    pub fn of_si(&self, value: f64) -> f64 {
        if self.is_si() { value } else { (value - self.offset) / self.factor }
    }

    /// Kept as it is: not even the sign of a zero changes.
    fn is_si(&self) -> bool {
        self.factor == 1.0 && self.offset == 0.0
    }
}

/// A quantity of the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// N m
    Torque,
    /// rad/s
    Speed,
    /// rad
    Angle,
}

impl Quantity {
    const fn exponents(self) -> [i32; 7] {
        match self {
            Self::Torque => [1, 2, -2, 0, 0, 0, 0],
            Self::Speed => [0, 0, -1, 0, 0, 0, 0],
            Self::Angle => [0; 7],
        }
    }

    /// Name and SI unit.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Torque => "a torque (N m)",
            Self::Speed => "an angular speed (rad/s)",
            Self::Angle => "an angle (rad)",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    pub name: String,
    /// Value reference.
    pub reference: u32,
    /// `input`, `output`, `parameter`, `local` and others.
    pub causality: String,
    /// Type: `Float64` for a `Real` of FMI 2.0.
    pub kind: String,
    /// Start value of a scalar number.
    pub start: Option<f64>,
    /// Unit, where one is declared.
    pub unit: Option<Unit>,
    /// Whether it is an array.
    pub is_array: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Version of the standard.
    pub version: Version,
    /// Name of the model.
    pub model: String,
    /// Name of the shared library.
    pub identifier: String,
    /// Token that its library expects: `instantiationToken`, or `guid`.
    pub token: String,
    /// `fixedInternalStepSize` (s).
    pub step: Option<f64>,
    pub variables: Vec<Variable>,
}

fn number<T: std::str::FromStr>(node: Node<'_, '_>, name: &str) -> Option<T> {
    node.attribute(name)?.trim().parse().ok()
}

fn unit(node: Node<'_, '_>) -> Option<Unit> {
    let name = node.attribute("name")?.to_owned();
    let base = node.children().find(|child| child.has_tag_name("BaseUnit"))?;
    let exponents = ["kg", "m", "s", "A", "K", "mol", "cd"].map(|of| number(base, of).unwrap_or(0));
    let [factor, offset] = [("factor", 1.0), ("offset", 0.0)].map(|(of, usual)| number(base, of).unwrap_or(usual));
    Some(Unit { name, factor, offset, exponents })
}

impl Description {
    /// Reads the text of the file.
    pub fn read(text: &str) -> Result<Self, String> {
        let document = Document::parse(text).map_err(|error| format!("modelDescription.xml is no XML: {error}"))?;
        let root = document.root_element();
        let version = match root.attribute("fmiVersion").unwrap_or_default() {
            version if version.starts_with("2.") => Version::Two,
            version if version.starts_with("3.") => Version::Three,
            other => return Err(format!("it is an FMU of FMI `{other}`, expected 2.0 or 3.0")),
        };
        let of_root = |name: &str| root.attribute(name).unwrap_or_default().to_owned();
        let interface = root.children().find(|child| child.has_tag_name("CoSimulation"));
        let interface = interface.ok_or("it has no interface for co-simulation; export it with one")?;
        let token = of_root(if version == Version::Two { "guid" } else { "instantiationToken" });
        let units: Vec<Unit> = root.descendants().filter(|node| node.has_tag_name("Unit")).filter_map(unit).collect();
        let mut description = Self {
            version,
            model: of_root("modelName"),
            identifier: interface.attribute("modelIdentifier").unwrap_or_default().to_owned(),
            token,
            step: number(interface, "fixedInternalStepSize"),
            variables: Vec::new(),
        };
        // the unit of a declared type
        let type_unit = |name: &str| {
            let of = |node: &Node<'_, '_>| node.attribute("name") == Some(name);
            let mut types = root.descendants();
            types
                .find(|node| (node.has_tag_name("SimpleType") || node.has_tag_name("Float64Type")) && of(node))
                .and_then(|node| {
                    node.attribute("unit")
                        .or_else(|| node.first_element_child().and_then(|real| real.attribute("unit")))
                })
        };
        let listed = root.children().find(|child| child.has_tag_name("ModelVariables"));
        for node in listed.into_iter().flat_map(|listed| listed.children()).filter(Node::is_element) {
            // of FMI 2.0, the type is the element within
            let of_two = node.children().find(Node::is_element).filter(|_| version == Version::Two);
            let typed = of_two.unwrap_or(node);
            let named = typed.attribute("unit").or_else(|| typed.attribute("declaredType").and_then(type_unit));
            let (Some(name), Some(reference)) = (node.attribute("name"), number(node, "valueReference")) else {
                continue;
            };
            let kind =
                if version == Version::Two && typed.has_tag_name("Real") { "Float64" } else { typed.tag_name().name() };
            let variable = Variable {
                name: name.to_owned(),
                reference,
                causality: node.attribute("causality").unwrap_or("local").to_owned(),
                kind: kind.to_owned(),
                start: number(typed, "start"),
                unit: named.and_then(|name| units.iter().find(|unit| unit.name == name).cloned()),
                is_array: node.children().any(|child| child.has_tag_name("Dimension")),
            };
            let others = node
                .children()
                .filter(|child| child.has_tag_name("Alias"))
                .filter_map(|alias| Some(Variable { name: alias.attribute("name")?.to_owned(), ..variable.clone() }));
            let others: Vec<Variable> = others.collect();
            description.variables.extend(std::iter::once(variable).chain(others));
        }
        Ok(description)
    }

    /// The scalar number of this name.
    ///
    /// # Errors
    /// A sentence: there is none, with those of `causality` that there are; it has another type.
    pub fn scalar(&self, name: &str, causality: &str) -> Result<&Variable, String> {
        let Some(variable) = self.variables.iter().find(|variable| variable.name == name) else {
            let those = self.scalars().filter(|variable| variable.causality == causality);
            let those: Vec<&str> = those.map(|variable| &*variable.name).take(12).collect();
            let there = if those.is_empty() { "none".to_owned() } else { those.join(", ") };
            return Err(format!(
                "`{}` has no variable `{name}`; each {causality} that is a number: {there}",
                self.model
            ));
        };
        if variable.is_array || variable.kind != "Float64" {
            let what = if variable.is_array { "an array" } else { &*variable.kind };
            let expected = if self.version == Version::Two { "Real" } else { "Float64" };
            return Err(format!("`{name}` of `{}` is {what}, expected a scalar of type {expected}", self.model));
        }
        Ok(variable)
    }

    /// The scalar number of this name, which has the unit of a quantity, or none.
    pub fn signal(&self, name: &str, causality: &str, quantity: Quantity) -> Result<&Variable, String> {
        let variable = self.scalar(name, causality)?;
        if causality == "input" && variable.causality != "input" {
            return Err(format!(
                "`{name}` of `{}` is of causality {}, expected an input",
                self.model, variable.causality
            ));
        }
        match &variable.unit {
            Some(unit) if unit.exponents != quantity.exponents() => {
                Err(format!("`{name}` of `{}` is in {}, expected {}", self.model, unit.name, quantity.name()))
            }
            _ => Ok(variable),
        }
    }

    /// All scalar numbers.
    pub fn scalars(&self) -> impl Iterator<Item = &Variable> {
        self.variables.iter().filter(|variable| variable.kind == "Float64" && !variable.is_array)
    }
}

#[cfg(test)]
mod tests {
    use super::{Description, Quantity, Version};

    /// After the examples of FMI 2.0.4 (2.2) and of FMI 3.0.2 (2.4).
    const TWO: &str = r#"<fmiModelDescription fmiVersion="2.0" modelName="Spin" guid="{8c4e}">
        <CoSimulation modelIdentifier="spin"/>
        <UnitDefinitions>
          <Unit name="rpm"><BaseUnit s="-1" rad="1" factor="0.10471975511965977"/></Unit>
        </UnitDefinitions>
        <TypeDefinitions><SimpleType name="Speed"><Real unit="rpm"/></SimpleType></TypeDefinitions>
        <ModelVariables>
          <ScalarVariable name="w" valueReference="7" causality="output"><Real declaredType="Speed"/></ScalarVariable>
          <ScalarVariable name="n" valueReference="8" causality="input"><Integer start="3"/></ScalarVariable>
        </ModelVariables></fmiModelDescription>"#;
    const THREE: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="Spin" instantiationToken="{8c4e}">
        <CoSimulation modelIdentifier="spin" fixedInternalStepSize="1e-3"/>
        <UnitDefinitions><Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit></UnitDefinitions>
        <ModelVariables>
          <Float64 name="tau" valueReference="1" causality="input" start="2.5" unit="N.m">
            <Alias name="torque"/>
          </Float64>
          <Float64 name="x" valueReference="2" causality="input" start="1 2"><Dimension start="2"/></Float64>
        </ModelVariables></fmiModelDescription>"#;

    #[test]
    fn units_of_types_and_other_names_of_variables_are_found() {
        let two = Description::read(TWO).unwrap();
        assert_eq!((two.version, &*two.token), (Version::Two, "{8c4e}"));
        let speed = two.signal("w", "output", Quantity::Speed).unwrap();
        // 60 r/min are a turn a second
        let si = speed.unit.as_ref().unwrap().to_si(60.0);
        assert!((si - std::f64::consts::TAU).abs() < 1e-15 && speed.reference == 7, "{si}");
        let three = Description::read(THREE).unwrap();
        assert_eq!((three.version, three.step), (Version::Three, Some(1e-3)));
        let torque = three.signal("torque", "input", Quantity::Torque).unwrap();
        assert_eq!((torque.reference, torque.start), (1, Some(2.5)));
    }

    #[test]
    fn a_variable_that_does_not_fit_is_named_with_what_was_expected() {
        let [two, three] = [TWO, THREE].map(|text| Description::read(text).unwrap());
        let wrong = [
            (two.signal("w", "output", Quantity::Torque), "`w` of `Spin` is in rpm, expected a torque (N m)"),
            (two.signal("w", "input", Quantity::Speed), "`w` of `Spin` is of causality output, expected an input"),
            (two.scalar("n", "input"), "`n` of `Spin` is Integer, expected a scalar of type Real"),
            (two.scalar("phi", "output"), "`Spin` has no variable `phi`; each output that is a number: w"),
            (three.scalar("x", "input"), "`x` of `Spin` is an array, expected a scalar of type Float64"),
        ];
        for (found, sentence) in wrong {
            assert_eq!(found.unwrap_err(), sentence);
        }
        for (text, sentence) in [
            ("<a", "is no XML"),
            ("<fmiModelDescription fmiVersion='1.0'/>", "FMI `1.0`, expected 2.0 or 3.0"),
            ("<fmiModelDescription fmiVersion='3.0'/>", "no interface for co-simulation"),
        ] {
            assert!(Description::read(text).unwrap_err().contains(sentence));
        }
    }
}
