//! Mirror images of a surface on a grid.

use super::half_space::HalfSpace;

impl HalfSpace {
    /// Writes the values of a surface to its three mirror images.
    pub(crate) fn mirror<T: Copy>(&self, field: &mut [T]) {
        let ([rows, columns], width) = (self.own(), self.columns());
        for row in field[..rows * width].chunks_mut(width) {
            (0..columns).for_each(|k| row[width - 1 - k] = row[k]);
        }
        for row in rows..self.rows() {
            let from = (self.rows() - 1 - row) * width;
            field.copy_within(from..from + width, row * width);
        }
    }
}
