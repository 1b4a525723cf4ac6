//! The canvas of a terminal plot: a grid of characters, each with eight braille dots.

/// The dots of a character's two columns from top to bottom, as bits of the Unicode block at U+2800.
const DOTS: [[u8; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// The cells, row by row from the top. Positions are shares of the width and the height, from the lower
/// left.
pub(super) struct Canvas {
    columns: usize,
    rows: usize,
    dots: Vec<u8>,
    /// Characters that cover the dots.
    marks: Vec<Option<char>>,
}

impl Canvas {
    pub(super) fn new(columns: usize, rows: usize) -> Self {
        Self {
            columns,
            rows,
            dots: vec![0; columns * rows],
            marks: vec![None; columns * rows],
        }
    }

    /// The row, counted from the top, at a share of the height.
    pub(super) fn row(&self, up: f64) -> usize {
        place(1.0 - up, self.rows)
    }

    /// Puts a character into a column, at a share of the height.
    pub(super) fn mark(&mut self, column: usize, up: f64, mark: char) {
        let row = self.row(up);
        if column < self.columns {
            self.marks[row * self.columns + column] = Some(mark);
        }
    }

    /// Draws a horizontal rule over the width.
    pub(super) fn rule(&mut self, row: usize) {
        self.marks[row * self.columns..(row + 1) * self.columns].fill(Some('─'));
    }

    /// Draws a vertical line in a column.
    pub(super) fn stem(&mut self, column: usize, from: f64, to: f64) {
        let (one, other) = (self.row(from), self.row(to));
        for row in one.min(other)..=one.max(other) {
            if column < self.columns {
                self.marks[row * self.columns + column] = Some('│');
            }
        }
    }

    /// Draws a line of dots. A place that is not a number has none, and one far outside is taken for one just outside.
    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64)) {
        let near = |(across, up): (f64, f64)| (across.clamp(-1.0, 2.0), up.clamp(-1.0, 2.0));
        let (from, to) = (near(from), near(to));
        if [from.0, from.1, to.0, to.1]
            .iter()
            .any(|share| share.is_nan())
        {
            return;
        }
        let (wide, high) = (2 * self.columns, 4 * self.rows);
        let steps = ((to.0 - from.0).abs() * wide as f64).max((to.1 - from.1).abs() * high as f64);
        let steps = steps.ceil().max(1.0) as usize;
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            let x = place(from.0 + share * (to.0 - from.0), wide);
            let y = place(1.0 - from.1 - share * (to.1 - from.1), high);
            self.dots[y / 4 * self.columns + x / 2] |= DOTS[x % 2][y % 4];
        }
    }

    /// The rows, top to bottom.
    pub(super) fn rows(&self) -> impl Iterator<Item = Vec<char>> + '_ {
        let cell = |at: usize| match (self.marks[at], self.dots[at]) {
            (Some(mark), _) => mark,
            (None, 0) => ' ',
            (None, dots) => char::from_u32(0x2800 + u32::from(dots)).unwrap_or(' '),
        };
        let row = move |row: usize| (row * self.columns..(row + 1) * self.columns).map(cell);
        (0..self.rows).map(move |at| row(at).collect())
    }
}

/// The index of a share among so many places; shares outside 0 to 1 are at the ends.
fn place(share: f64, places: usize) -> usize {
    (share.clamp(0.0, 1.0) * (places - 1) as f64).round() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_to_places_that_are_far_outside_or_no_numbers_end() {
        let mut canvas = Canvas::new(4, 2);
        for far in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e300, -1e12] {
            canvas.line((0.0, 0.5), (1.0, far));
            canvas.line((0.0, far), (far, 0.5));
        }
        assert_eq!(canvas.rows().count(), 2);
    }

    #[test]
    fn line_from_corner_to_corner_is_a_diagonal_of_dots_under_marks() {
        let mut canvas = Canvas::new(4, 2);
        canvas.line((0.0, 1.0), (1.0, 0.0));
        canvas.mark(3, 0.0, '●');
        let rows: Vec<String> = canvas.rows().map(|row| row.into_iter().collect()).collect();
        assert_eq!(rows, ["⠑⢄  ", "  ⠑●"]);
    }

    #[test]
    fn stems_reach_from_the_rule_to_the_value() {
        let mut canvas = Canvas::new(3, 5);
        canvas.rule(canvas.row(0.5));
        canvas.stem(1, 0.5, 1.0);
        let rows: Vec<String> = canvas.rows().map(|row| row.into_iter().collect()).collect();
        assert_eq!(rows, [" │ ", " │ ", "─│─", "   ", "   "]);
    }
}
