//! Reading of the scans whose side a load in newtons needs.

use std::collections::HashMap;

use super::fault::Faults;
use super::settings::documents;
use super::sides::{Unread, collapsed};
use super::{Spec, SpecErrors};
use crate::lengths::SAME_SIZE;
use crate::model::MeasuredSurface;

/// Side of the square of a scan \[m\], or the problem and the help.
pub type SideReader<'a> = &'a dyn Fn(&MeasuredSurface) -> Result<f64, (String, String)>;

/// The sides of the points whose scans have not been read.
pub(super) fn of_scans(
    spec: &Spec,
    (text, file, settings): (&str, &str, &[String]),
    reader: SideReader<'_>,
) -> Result<Vec<f64>, SpecErrors> {
    let mut faults = Faults::new(text, file).with(documents(settings));
    let mut known: HashMap<String, Option<f64>> = HashMap::new();
    let mut sides = Vec::with_capacity(spec.unread.len());
    for Unread { case, at } in &spec.unread {
        let Some(surface) = spec.cases.get(*case).and_then(|case| case.params.surface.measured()) else {
            continue;
        };
        let side = known.entry(format!("{surface:?}")).or_insert_with(|| {
            let refused = |(problem, help)| faults.add(at, problem, Some(help));
            common_side(surface, reader).map_err(refused).ok()
        });
        sides.extend(*side);
    }
    faults.finish(Some(collapsed(sides))).map_err(|errors| errors.with(settings))
}

/// The side that all scans of a surface have \[m\]: the smallest one.
fn common_side(surface: &MeasuredSurface, reader: SideReader<'_>) -> Result<f64, (String, String)> {
    let scans = (0..surface.names().len() as u32).map(|number| surface.scan(number));
    let read = |scan: MeasuredSurface| {
        reader(&scan).map_err(|(problem, help)| {
            (format!("`cycle.max_force_n` needs the size of the scan \"{}\": {problem}", scan.file), help)
        })
    };
    let sides = scans.map(read).collect::<Result<Vec<f64>, _>>()?;
    let least = sides.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = sides.iter().copied().fold(0.0, f64::max);
    if largest <= least * (1.0 + SAME_SIZE) {
        return Ok(least);
    }
    let problem = format!(
        "one force is two loads F/(E* A0): the sides of the scans of a case are from {least:.4e} m to \
         {largest:.4e} m"
    );
    let help = "give cycle.max_pressure_pa = F/A0, scans of equal size, or each scan as a case of a \
                [[sweep]] over surface.file";
    Err((problem, help.to_owned()))
}
