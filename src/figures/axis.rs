//! An axis: what it shows, from where to where, and with which ticks.

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Label, with markup.
    pub label: String,
    /// Range of what is drawn.
    range: (f64, f64),
    /// Distance of two ticks, in units of what is drawn.
    step: f64,
    /// Power of ten by which values are divided.
    exponent: i32,
    scale: Scale,
}

/// Numbers that ticks at doublings show readably.
const READABLE: (f64, f64) = (0.05, 1e5);

/// Meaning of a length along the axis.
#[derive(Debug, Clone, PartialEq)]
enum Scale {
    /// A difference.
    Linear,
    /// A ratio, in doublings.
    Doublings,
    /// A ratio, in powers of ten.
    Decades,
    /// Nothing: places 0, 1, 2, … have these names.
    Words(Vec<String>),
}

impl Axis {
    /// An axis that includes all values, with round ticks; `from_zero` includes zero.
    pub fn holding(label: &str, values: impl IntoIterator<Item = f64>, from_zero: bool) -> Self {
        let (least, high) = extent(values);
        let low = if from_zero { least.min(0.0) } else { least };
        let (low, high) = if high - low > 1e-12 * high.abs().max(low.abs()) {
            (low, high)
        } else {
            let room = if high == 0.0 { 1.0 } else { 0.25 * high.abs() };
            (low - room, high + room)
        };
        let exponent = exponent_of(low.abs().max(high.abs()));
        let unit = 10f64.powi(exponent);
        // A little air, so that no curve ends in the frame.
        let air = if from_zero { 0.03 } else { 0.08 } * (high - low);
        let below = if from_zero && least > 2.0 * air { 0.0 } else { air };
        let (low, high) = ((low - below) / unit, (high + air) / unit);
        let step = round_step((high - low) / 6.5);
        Self { label: label.to_owned(), range: (low, high), step, exponent, scale: Scale::Linear }
    }

    /// An axis on which a doubling is always the same distance, with a tick at each.
    pub fn of_doublings(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = extent(values);
        let (low, high) = (low.max(f64::MIN_POSITIVE).log2(), high.max(f64::MIN_POSITIVE).log2());
        let step = ((high - low) / 6.0).ceil().max(1.0);
        Self {
            label: label.to_owned(),
            range: (low - 0.5, high + 0.5),
            step,
            exponent: 0,
            scale: Scale::Doublings,
        }
    }

    /// An axis on which a factor of ten is always the same distance, with a tick at each power of ten, or at
    /// doublings where it has one power of ten at most; of values that are not positive it holds none.
    pub fn of_decades(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = extent(values.into_iter().filter(|value| *value > 0.0));
        if low >= READABLE.0 && high <= READABLE.1 && high.log10().floor() <= low.log10().ceil() {
            return Self::of_doublings(label, [low, high]);
        }
        let (low, high) = (low.max(f64::MIN_POSITIVE).log10(), high.max(f64::MIN_POSITIVE).log10());
        let air = 0.06 * (high - low).max(1.0);
        let step = ((high - low) / 6.0).ceil().max(1.0);
        Self {
            label: label.to_owned(),
            range: (low - air, high + air),
            step,
            exponent: 0,
            scale: Scale::Decades,
        }
    }

    /// An axis of places with names instead of numbers; values on it are places.
    pub fn of_words(label: &str, words: Vec<String>) -> Self {
        let last = words.len().saturating_sub(1) as f64;
        Self {
            label: label.to_owned(),
            range: (-0.5, last + 0.5),
            step: 1.0,
            exponent: 0,
            scale: Scale::Words(words),
        }
    }

    /// This axis with room for the key: a share of its length, added at its upper end.
    pub fn with_headroom(mut self, share: f64) -> Self {
        self.range.1 += share * (self.range.1 - self.range.0);
        self
    }

    /// Position at which a value is drawn.
    pub fn drawn(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Doublings => value.max(f64::MIN_POSITIVE).log2(),
            Scale::Decades => value.max(f64::MIN_POSITIVE).log10(),
            Scale::Linear | Scale::Words(_) => self.drawn_length(value),
        }
    }

    /// Drawn length of a difference.
    pub fn drawn_length(&self, difference: f64) -> f64 {
        difference / 10f64.powi(self.exponent)
    }

    /// Range of what is drawn.
    pub fn drawn_range(&self) -> (f64, f64) {
        self.range
    }

    /// Distance of two ticks of what is drawn.
    pub fn drawn_step(&self) -> f64 {
        self.step
    }

    /// The ticks of what is drawn.
    pub fn ticks(&self) -> Vec<f64> {
        let (first, last) = ((self.range.0 / self.step).ceil(), (self.range.1 / self.step).floor());
        let count = (last - first).clamp(0.0, 100.0) as usize;
        (0..=count).map(|index| (first + index as f64) * self.step).collect()
    }

    /// The number at a tick, with no more digits than the ticks need.
    pub fn tick_label(&self, drawn: f64) -> String {
        match &self.scale {
            Scale::Linear => {}
            Scale::Doublings if drawn < 0.0 => return drawn.exp2().to_string(),
            Scale::Doublings => return format!("{:.0}", drawn.exp2()),
            Scale::Decades => return format!("10^{{{:.0}}}", drawn + 0.0).replace('-', "−"),
            Scale::Words(words) => {
                return words.get(drawn.round().max(0.0) as usize).cloned().unwrap_or_default();
            }
        }
        let whole = |digits: &usize| {
            let scaled = self.step * 10f64.powi(*digits as i32);
            (scaled - scaled.round()).abs() < 1e-6
        };
        let digits = (0..9).find(whole).unwrap_or(9);
        let text = format!("{drawn:.digits$}");
        let zero = text.chars().all(|letter| matches!(letter, '-' | '0' | '.'));
        if zero { "0".to_owned() } else { text.replace('-', "−") }
    }

    /// The label with the power of ten that the ticks leave out, before the unit if there is one.
    pub fn full_label(&self) -> String {
        let power = format!("10^{{{}}}", self.exponent).replace("{-", "{−");
        match self.label.strip_suffix(']').and_then(|label| label.split_once(" [")) {
            _ if self.exponent == 0 => self.label.clone(),
            Some((label, unit)) => format!("{label} [{power} {unit}]"),
            None => format!("{}  [{power}]", self.label),
        }
    }
}

/// Minimum and maximum of the finite values; 0 and 1 if there is none.
fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite
        .fold(None, |seen: Option<(f64, f64)>, value| {
            Some(seen.map_or((value, value), |(low, high)| (low.min(value), high.max(value))))
        })
        .unwrap_or((0.0, 1.0))
}

/// The power of ten to leave out of the ticks: none for numbers that read well as they are.
fn exponent_of(greatest: f64) -> i32 {
    if greatest == 0.0 || (0.1..10_000.0).contains(&greatest) {
        0
    } else if (1e-3..0.1).contains(&greatest) {
        -3
    } else {
        greatest.log10().floor() as i32
    }
}

/// Smallest of 1, 2, 2.5, 5 times a power of ten that is not below a length.
fn round_step(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= length * (1.0 - 1e-9))
        .unwrap_or(power)
}
