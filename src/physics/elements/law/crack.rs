//! Law of the band-limited crack for one work of adhesion.

use super::table::{NODES_PER_UNIT, TABLE_SPACING, Table};
use super::{Bond, Front, WALL_STIFFNESS};
use std::sync::Arc;

/// Law of the band-limited crack for one work of adhesion.
#[derive(Debug, Clone)]
pub struct Crack {
    /// Unit of the gap, ℓ/dx, and dx/ℓ.
    pub(super) unit: f64,
    inverse_unit: f64,
    pub(super) table: Arc<Table>,
}

/// Step φ at a point.
#[derive(Debug, Clone, Copy, Default)]
pub struct Profile {
    /// The step, from 1 inside contact to 0 outside.
    pub(crate) value: f64,
    /// Its first and second derivative to the gap \[1/dx, 1/dx²\].
    pub(crate) rate: f64,
    pub(crate) bend: f64,
    /// Slope of the tension of a straight front in excess of that of the law \[E*/dx\].
    pub(crate) excess: f64,
}

impl Profile {
    /// Inside contact.
    pub(super) const INSIDE: Self = Self { value: 1.0, rate: 0.0, bend: 0.0, excess: 0.0 };
}

impl Crack {
    /// Law for the work of adhesion `work` in E* dx.
    pub(super) fn new(work: f64, front: &Front) -> Self {
        let unit = work.sqrt();
        Self { unit, inverse_unit: 1.0 / unit, table: Table::of(front) }
    }

    /// Maximum tension \[E*\].
    pub(super) fn strength(&self) -> f64 {
        let table = &self.table;
        if table.line.is_some() {
            table.strength * self.unit
        } else {
            self.at(table.peak * self.unit).tension
        }
    }

    /// Factor `2λΔγ` of the tension by the curvature of the front \[E* dx\].
    pub(super) fn line_factor(&self) -> f64 {
        self.table.line.as_ref().map_or(0.0, |line| 2.0 * line.factor * self.unit * self.unit)
    }

    /// First and last gap at which the step φ of the line tension changes \[dx\].
    #[inline(always)]
    pub(crate) fn steep_gaps(&self) -> [f64; 2] {
        let onset = self.table.onset;
        self.table.line.as_ref().map_or([onset; 2], |line| line.steep).map(|gap| gap * self.unit)
    }

    #[inline(always)]
    pub(crate) fn at(&self, gap: f64) -> Bond {
        let (unit, table) = (self.unit, &*self.table);
        let g = gap * self.inverse_unit;
        let cubic = table.nodes.cubic(g - table.onset);
        let spring = Bond {
            energy: unit * unit * (0.5 * WALL_STIFFNESS * g * g - table.depth),
            tension: WALL_STIFFNESS * gap,
            slope: WALL_STIFFNESS,
        };
        let beyond = Bond {
            energy: unit * unit * (cubic.third[0] + TABLE_SPACING * cubic.t * cubic.mean()),
            tension: unit * cubic.value(),
            slope: cubic.slope() * NODES_PER_UNIT,
        };
        let is_spring = g < table.onset;
        let either = |inside, outside| if is_spring { inside } else { outside };
        Bond {
            energy: either(spring.energy, beyond.energy),
            tension: either(spring.tension, beyond.tension),
            slope: either(spring.slope, beyond.slope),
        }
    }

    /// Step φ at a bonded point and its derivatives.
    #[inline(always)]
    pub(crate) fn profile(&self, gap: f64) -> Profile {
        let Some(line) = &self.table.line else { return Profile::default() };
        let g = gap * self.inverse_unit;
        let cubic = line.nodes.cubic(g - self.table.onset);
        let per_gap = NODES_PER_UNIT * self.inverse_unit;
        let is_inside = g < self.table.onset;
        let either = |inside, outside| if is_inside { inside } else { outside };
        Profile {
            value: either(1.0, cubic.value()),
            rate: either(0.0, cubic.slope() * per_gap),
            bend: either(0.0, cubic.bend() * per_gap * per_gap),
            excess: either(0.0, cubic.third[0] + cubic.t * (cubic.third[1] - cubic.third[0])),
        }
    }
}
