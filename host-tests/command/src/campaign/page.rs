//! The page of a campaign.

use super::draw::Draw;
use super::figure::Figure;
use super::statistics::quantile;
use super::summary::Summary;
use crate::machine_file::factor::Factor;
use driveline_report::chart::{Curve, Lines};
use driveline_report::{Figure as Drawing, Key, Sheet};

/// The errors on the page.
const ERRORS: [Figure; 3] = [Figure::ShaftTorque, Figure::LoadSpeed, Figure::LoadTorque];

/// Points of a plot of draws; more would only lie on one another.
const POINTS: usize = 1_000;

impl Summary {
    /// The page as HTML.
    pub fn page(&self) -> String {
        Sheet {
            name: self.variant.split('/').next().unwrap_or_default().to_owned(),
            kicker: "machines within their tolerances".to_owned(),
            summary: "The library's own code in closed loop with the full solver, over machines drawn from the \
                      tolerances of one design. Encoder, inverter and timing have their errors too."
                .to_owned(),
            facts: self.facts(),
            figures: std::iter::once(self.errors()).chain(ERRORS.iter().filter_map(|&f| self.strongest(f))).collect(),
            tables: self.tables(),
        }
        .page()
    }

    /// The errors over the share of draws that are not worse.
    fn errors(&self) -> Drawing {
        let shares: Vec<f64> = (1..=99).map(f64::from).collect();
        let curve = |(at, &figure): (usize, &Figure)| {
            let mut values: Vec<f64> = self.drawn.found(figure).into_iter().map(|(_, value)| value).collect();
            values.sort_by(f64::total_cmp);
            let class = format!("s{at}");
            Curve { class, values: shares.iter().map(|share| 100.0 * quantile(&values, share / 100.0)).collect() }
        };
        let lines = Lines {
            label: "Errors over the share of draws".to_owned(),
            along: "draws that are not worse, %".to_owned(),
            across: "rms error, % of rated".to_owned(),
            places: shares.clone(),
            curves: ERRORS.iter().enumerate().map(curve).collect(),
            marks: vec![(50.0, "median".to_owned()), (90.0, "90 %".to_owned())],
            logarithmic: true,
            ..Lines::default()
        };
        let text = "Torques of rated torque, speeds of rated speed.";
        let legend = ERRORS.iter().enumerate().map(|(at, f)| Key::curve(f.name(), format!("s{at}")));
        Drawing::new("Errors of the estimates", text, legend.collect(), vec![lines.draw()])
    }

    /// An error over its strongest factor.
    fn strongest(&self, figure: Figure) -> Option<Drawing> {
        let influence = self.influences.iter().find(|influence| influence.figure == figure.name())?;
        let factor = Factor::named(influence.factor)?;
        let (low, high) = *self.tolerances.get(influence.factor)?;
        let point =
            |(draw, y): (&Draw, f64)| (draw.value(factor), 100.0 * y, "s0".to_owned(), format!("draw {}", draw.number));
        let points = self.drawn.found(figure).into_iter().take(POINTS).map(point);
        let title = format!("{} over {}", figure.name(), factor.name());
        let lines = Lines {
            label: title.clone(),
            along: format!("{}, {}", factor.name(), factor.unit()),
            across: "% of rated".to_owned(),
            places: vec![low, high],
            points: points.collect(),
            ..Lines::default()
        };
        let text = "The factor that matters most to it. A point is a draw.";
        Some(Drawing::new(title, text, Vec::new(), vec![lines.draw()]))
    }
}
