//! The charts of several runs as one.

use super::{Chart, Panel};
use crate::drawing::body_color;

/// Charts that are not drawn over the same.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[error("{first} is drawn over {over}, and {other} over {over_other}")]
pub struct MixedTimes {
    first: String,
    over: String,
    other: String,
    over_other: String,
}

/// The charts of some runs, each with the run's name, with all curves of a panel in one; known answers that all share
/// are there once.
///
/// # Errors
/// They are drawn over different times.
///
/// # Panics
/// There are none.
pub fn together(charts: Vec<(String, Chart)>) -> Result<Chart, MixedTimes> {
    let (first, begun) = charts[0].clone();
    if let Some((other, chart)) = charts.iter().find(|(_, chart)| chart.over != begun.over) {
        let (over, over_other) = (begun.over, chart.over.clone());
        return Err(MixedTimes { first, over, other: other.clone(), over_other });
    }
    let title =
        if charts.iter().all(|(_, chart)| chart.title == begun.title) { begun.title } else { String::new() };
    let captions = charts.iter().filter(|(_, chart)| !chart.caption.is_empty());
    let captions: Vec<String> = captions.map(|(run, chart)| format!("{run}: {}", chart.caption)).collect();
    // Curves of a run in a panel: one, and its colour can be that of the run.
    let most = charts.iter().flat_map(|(_, chart)| &chart.panels).map(own_curves).max().unwrap_or(1).max(1);
    let mut panels: Vec<Panel> = Vec::new();
    for (number, (run, chart)) in charts.into_iter().enumerate() {
        for panel in chart.panels {
            let place =
                panels.iter().position(|known| (&known.name, known.unit) == (&panel.name, panel.unit));
            let place = place.unwrap_or_else(|| {
                panels.push(Panel { curves: Vec::new(), ..panel.clone() });
                panels.len() - 1
            });
            let curves = &mut panels[place].curves;
            let mut own = 0;
            for mut curve in panel.curves {
                if curve.dashed {
                    if curves.contains(&curve) {
                        continue;
                    }
                } else {
                    curve.color = body_color(number * most + own);
                    own += 1;
                }
                let is_shared = curve.dashed && number == 0;
                if !is_shared {
                    curve.label = format!("{run}: {}", curve.label);
                }
                curves.push(curve);
            }
        }
    }
    Ok(Chart { title, over: begun.over, panels, caption: captions.join("\n") })
}

/// How many curves of a panel are results.
fn own_curves(panel: &Panel) -> usize {
    panel.curves.iter().filter(|curve| !curve.dashed).count()
}

#[cfg(test)]
mod tests {
    use super::super::Curve;
    use super::*;

    fn chart(end: f64) -> Chart {
        let curve = |label: &str, dashed: bool, end: f64| Curve {
            label: label.to_owned(),
            color: [0.2; 3],
            dashed,
            points: vec![[0.0, 0.0], [1.0, end]],
        };
        let curves = vec![curve("ball x", false, end), curve("exact", true, 2.0)];
        Chart {
            title: "A ball".to_owned(),
            over: "time [s]".to_owned(),
            panels: vec![Panel { name: "position".to_owned(), unit: "m", curves }],
            caption: format!("over {end}"),
        }
    }

    #[test]
    fn runs_share_panels_and_known_answers() {
        let all = together(vec![("a".to_owned(), chart(1.8)), ("b".to_owned(), chart(1.9))]).unwrap();
        assert_eq!((all.title.as_str(), all.panels.len()), ("A ball", 1));
        let labels: Vec<&str> = all.panels[0].curves.iter().map(|curve| curve.label.as_str()).collect();
        assert_eq!(labels, ["a: ball x", "exact", "b: ball x"]);
        assert_ne!(all.panels[0].curves[0].color, all.panels[0].curves[2].color);
        assert_eq!(all.caption, "a: over 1.8\nb: over 1.9");
    }

    #[test]
    fn runs_over_different_times_are_refused() {
        let other = Chart { over: "time / (d/c)".to_owned(), ..chart(1.0) };
        let error = together(vec![("a".to_owned(), chart(1.0)), ("b".to_owned(), other)]).unwrap_err();
        assert_eq!(error.to_string(), "a is drawn over time [s], and b over time / (d/c)");
    }
}
