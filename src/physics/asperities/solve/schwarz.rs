//! Approximate inverse of the Jacobian, by groups of contacts.
//!
//! Restricted additive Schwarz method (Cai & Sarkis, SIAM J. Sci. Comput. 21:792, 1999): contacts are divided
//! into small groups. Each is solved with the contacts around it, and the solution for the group itself is
//! kept. The response of a contact is determined by its neighbours, which lose what it gains.

use crate::asperities::contact::problem::Problem;
use crate::asperities::contact::state::{State, Status};
use crate::asperities::field::{Tangent, places_in};
use crate::math::dense::Lu;
use crate::math::gmres::Preconditioner;
use crate::math::vector::in_strands;
use multiversion::multiversion;

/// An approximate inverse that serves several solutions: it only makes them short.
#[derive(Debug, Default)]
pub(super) struct LocalInverse {
    /// Contacts that it is for.
    index: Vec<usize>,
    groups: Vec<Group>,
    partition: Partition,
    /// Number of contacts when they were divided.
    divided: usize,
    /// Solutions so far.
    solutions: usize,
    lu: Lu,
}

/// Number of partial sums in the product of a row.
const STRANDS: usize = 16;

/// Length of a row that is filled up with zeros to whole passes.
fn padded(length: usize) -> usize {
    length.next_multiple_of(STRANDS)
}

/// A group of contacts and its rows of the inverse.
#[derive(Debug, Clone, Default)]
struct Group {
    /// Asperity numbers, ascending.
    members: Vec<usize>,
    /// Contacts that were solved together for it, ascending; its members are among them.
    near: Vec<usize>,
    /// Row of each member, over `near`; with zeros to whole passes.
    values: Vec<f32>,
    /// Centre of the members, and the largest distance of a contact in `near` \[m\].
    centre: [f64; 2],
    reach: f64,
    /// Number of the solution for which it was computed; none if a contact next to it has come or gone since.
    solution: Option<usize>,
    /// Positions of `members` and `near` among the contacts.
    rows: Vec<u32>,
    columns: Vec<u32>,
}

impl LocalInverse {
    /// Begins a solution.
    pub(super) fn begin(&mut self) {
        self.solutions += 1;
    }

    /// An approximate inverse of a tangent and a diagonal at the contacts of a state; none for a dense one,
    /// whose products cost little.
    pub(super) fn of(
        &mut self,
        problem: &Problem,
        state: &State,
        tangent: &Tangent,
        diagonal: &[f64],
    ) -> Option<&dyn Preconditioner> {
        if tangent.is_exact() {
            self.groups.clear();
            return None;
        }
        let same = !self.groups.is_empty() && self.index == state.contacts;
        if !same {
            self.follow(problem, state);
        }
        let jacobian = Jacobian { problem, state, tangent, diagonal };
        let renewed = problem.numerics.solver.groups.solutions;
        for group in &mut self.groups {
            if group.solution.is_none_or(|solution| self.solutions >= solution + renewed) {
                group.compute(&jacobian, &mut self.lu);
                group.solution = Some(self.solutions);
            } else if !same {
                group.place(state);
            }
        }
        Some(self)
    }

    /// Enters the contacts that have come and gone into the groups.
    fn follow(&mut self, problem: &Problem, state: &State) {
        let growth = state.contacts.len() as f64 / self.divided.max(1) as f64;
        let ratio = problem.numerics.solver.groups.count_ratio;
        if self.groups.is_empty() || !(1.0 / ratio..ratio).contains(&growth) {
            self.divide(problem, state);
            return;
        }
        let before = std::mem::replace(&mut self.index, state.contacts.clone());
        let only_in = |these: &[usize], others: &[usize]| -> Vec<usize> {
            these
                .iter()
                .zip(places_in(these, others))
                .filter(|(_, at)| at.is_none())
                .map(|(i, _)| *i)
                .collect()
        };
        for i in only_in(&before, &state.contacts) {
            for group in self.groups.iter_mut().filter(|group| group.near.binary_search(&i).is_ok()) {
                group.members.retain(|member| *member != i);
                group.solution = None;
            }
        }
        for i in only_in(&state.contacts, &before) {
            let place = problem.place(i);
            let own = self.partition.group(place);
            let members = &mut self.groups[own].members;
            let at = members.partition_point(|member| *member < i);
            members.insert(at, i);
            for (k, group) in self.groups.iter_mut().enumerate() {
                if k == own || problem.neighbours.distance(place, &group.centre) <= group.reach {
                    group.solution = None;
                }
            }
        }
    }

    /// Divides all contacts into groups.
    fn divide(&mut self, problem: &Problem, state: &State) {
        self.index.clone_from(&state.contacts);
        self.divided = state.contacts.len();
        let mut places: Vec<[f64; 2]> = state.contacts.iter().map(|i| *problem.place(*i)).collect();
        self.partition = Partition::of(&mut places, problem.numerics.solver.groups.contacts);
        self.groups = vec![Group::default(); self.partition.groups];
        for &i in &state.contacts {
            self.groups[self.partition.group(problem.place(i))].members.push(i);
        }
    }
}

impl Preconditioner for LocalInverse {
    fn apply(&self, x: &[f64], y: &mut [f64]) {
        apply(&self.groups, x, y);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn apply(groups: &[Group], x: &[f64], y: &mut [f64]) {
    let mut near = Vec::new();
    for group in groups {
        near.clear();
        near.extend(group.columns.iter().map(|k| x[*k as usize]));
        near.resize(padded(near.len()), 0.0);
        for (k, values) in group.rows.iter().zip(group.values.chunks(near.len().max(1))) {
            y[*k as usize] = in_strands::<STRANDS, _>(values, &near);
        }
    }
}

/// Division of the square by bisection of the contacts across the longer side.
#[derive(Debug, Default)]
struct Partition {
    nodes: Vec<Node>,
    /// Number of groups.
    groups: usize,
}

#[derive(Debug, Clone, Copy)]
enum Node {
    /// Places whose coordinate is below a value are in the first node, others in the second.
    Halves {
        along: usize,
        value: f64,
        nodes: [usize; 2],
    },
    Group(usize),
}

impl Partition {
    /// Division of places into groups of at most `size`.
    fn of(places: &mut [[f64; 2]], size: usize) -> Self {
        let mut found = Self::default();
        found.add(places, size);
        found
    }

    /// Adds the node of some places; its number is returned.
    fn add(&mut self, places: &mut [[f64; 2]], size: usize) -> usize {
        let number = self.nodes.len();
        self.nodes.push(Node::Group(self.groups));
        if places.len() <= size {
            self.groups += 1;
            return number;
        }
        let span = |along: usize| {
            let ends = places
                .iter()
                .map(|p| p[along])
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (p.min(low), p.max(high)));
            ends.1 - ends.0
        };
        let along = usize::from(span(1) > span(0));
        let middle = places.len() / 2;
        let (low, at, high) = places.select_nth_unstable_by(middle, |u, v| u[along].total_cmp(&v[along]));
        // The middle one belongs to the upper half, which its own node need not know.
        let value = at[along];
        let nodes = [self.add(low, size), self.add(high, size)];
        self.nodes[number] = Node::Halves { along, value, nodes };
        number
    }

    /// Group of a place.
    fn group(&self, place: &[f64; 2]) -> usize {
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Group(group) => return group,
                Node::Halves { along, value, nodes } => node = nodes[usize::from(place[along] >= value)],
            }
        }
    }
}

/// Jacobian at the contacts of a state.
struct Jacobian<'a> {
    problem: &'a Problem,
    state: &'a State,
    tangent: &'a Tangent,
    diagonal: &'a [f64],
}

impl Group {
    /// Computes the rows.
    fn compute(&mut self, jacobian: &Jacobian<'_>, lu: &mut Lu) {
        let Jacobian { problem, state, .. } = jacobian;
        if self.members.is_empty() {
            *self = Self::default();
            return;
        }
        let count = self.members.len() as f64;
        self.centre =
            [0, 1].map(|along| self.members.iter().map(|i| problem.place(*i)[along]).sum::<f64>() / count);
        let near = problem.neighbours.nearest(
            &self.centre,
            problem.numerics.solver.groups.solved_together,
            state.contacts.len(),
            |i| state.status[i] == Status::Contact,
        );
        self.near.clear();
        self.near.extend(near.iter().map(|(_, i)| *i).chain(self.members.iter().copied()));
        self.near.sort_unstable();
        self.near.dedup();
        self.place(state);
        let apart: Vec<[f64; 2]> =
            self.near.iter().map(|i| problem.neighbours.apart(problem.place(*i), &self.centre)).collect();
        self.reach = apart.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
        lu.factor(&jacobian.transposed(&self.near, &self.columns, &apart), self.near.len());
        let columns = self.members.len();
        let mut unit = vec![0.0; self.near.len() * columns];
        for (column, at) in places_in(&self.members, &self.near).enumerate() {
            if let Some(at) = at {
                unit[at * columns + column] = 1.0;
            }
        }
        lu.solve_all(&mut unit, columns);
        self.values.clear();
        for column in 0..columns {
            self.values.extend(unit.iter().skip(column).step_by(columns).map(|v| *v as f32));
            self.values.resize(padded(self.values.len()), 0.0);
        }
    }

    /// Finds the positions of the contacts.
    fn place(&mut self, state: &State) {
        let at = |i: &usize| state.contacts.binary_search(i).map_or(0, |at| at as u32);
        self.rows.clear();
        self.rows.extend(self.members.iter().map(at));
        self.columns.clear();
        self.columns.extend(self.near.iter().map(at));
    }
}

impl Jacobian<'_> {
    /// Its part for some contacts, column by column: their numbers, their positions among all, and their
    /// places relative to a centre \[m\].
    fn transposed(&self, contacts: &[usize], at: &[u32], apart: &[[f64; 2]]) -> Vec<f64> {
        let Self { problem, state, tangent, diagonal } = self;
        let n = contacts.len();
        let columns = [0, 1].map(|along| apart.iter().map(|place| place[along]).collect::<Vec<f64>>());
        let (mut matrix, mut distances) = (vec![0.0; n * n], vec![0.0; n]);
        for (k, ((i, at), line)) in contacts.iter().zip(at).zip(matrix.chunks_mut(n)).enumerate() {
            let (asperity, a) = (&problem.asperities[*i], state.radius[*i]);
            // Image fields are nearly the same for all of them.
            let images = tangent.own(*at as usize);
            let slope = problem.material.compliance() * asperity.load_slope(a);
            fields_of_load(&columns, k, [slope, images], &mut distances, line);
            for (by, r) in line
                .iter_mut()
                .zip(&distances)
                .filter(|(_, r)| **r <= problem.numerics.solver.groups.point_load_distance * a)
            {
                *by = problem.spot_field(asperity, *r, a).1 + images;
            }
            line[k] = diagonal[*at as usize] + images;
        }
        matrix
    }
}

/// `slope/r + images` at each place, and the distance r from the place of number `from`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn fields_of_load(
    [x, y]: &[Vec<f64>; 2],
    from: usize,
    [slope, images]: [f64; 2],
    distances: &mut [f64],
    fields: &mut [f64],
) {
    for ((x_at, y_at), (r, field)) in x.iter().zip(y).zip(distances.iter_mut().zip(fields)) {
        let (dx, dy) = (x_at - x[from], y_at - y[from]);
        *r = (dx * dx + dy * dy).sqrt();
        *field = slope / *r + images;
    }
}
