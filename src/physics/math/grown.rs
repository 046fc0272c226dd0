//! Lists that merged contacts extend.

use std::ops::{Index, IndexMut};
use std::sync::Arc;

/// A list with a common part and additions of its own: a copy costs as much as the additions.
#[derive(Debug, Clone)]
pub(crate) struct Grown<T> {
    base: Arc<[T]>,
    more: Vec<T>,
}

impl<T> Grown<T> {
    pub(crate) fn len(&self) -> usize {
        self.base.len() + self.more.len()
    }

    pub(crate) fn push(&mut self, value: T) {
        self.more.push(value);
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &T> {
        self.base.iter().chain(&self.more)
    }

    /// The common part.
    pub(crate) fn base(&self) -> &[T] {
        &self.base
    }
}

impl<T> From<Vec<T>> for Grown<T> {
    fn from(base: Vec<T>) -> Self {
        Self { base: base.into(), more: Vec::new() }
    }
}

impl<T> FromIterator<T> for Grown<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        values.into_iter().collect::<Vec<T>>().into()
    }
}

impl<T> Index<usize> for Grown<T> {
    type Output = T;

    fn index(&self, i: usize) -> &T {
        match self.base.get(i) {
            Some(value) => value,
            None => &self.more[i - self.base.len()],
        }
    }
}

/// Only additions change.
impl<T> IndexMut<usize> for Grown<T> {
    fn index_mut(&mut self, i: usize) -> &mut T {
        &mut self.more[i - self.base.len()]
    }
}
