//! The covariance of the angle of noise whose autocovariance is given.
//!
//! With the autocovariance `r` of the rate, `G(n) = −½ τ₀² [n r(0) + 2 Σ (n − l) r(l)]` over all `l` from 1 to `n − 1`. The sums go
//! over cubics through four samples where they follow `r`, and over every sample elsewhere.

/// The largest error of a cubic, relative to `r(0)`. Chosen by hand: the sums over a million lags are then right to 1e-3.
const ERROR: f64 = 1e-9;
/// From this length on, cells are cubics.
const LONG: u64 = 12;

/// Noise with an autocovariance, sampled.
pub(super) struct Covariance<R> {
    autocovariance: R,
    interval_s: f64,
    at_zero: f64,
    cells: Vec<Cell>,
}

/// Lags from a first one on, with what the sums over the lags before it are.
struct Cell {
    first: u64,
    count: u64,
    /// `Σ r(l)` and `Σ l r(l)` over all lags from 1 to before the first.
    before: [f64; 2],
    /// A cubic in the distance from the first; `None` where each lag is summed by itself.
    cubic: Option<[f64; 4]>,
}

impl<R: Fn(f64) -> f64> Covariance<R> {
    /// The autocovariance at lags in seconds.
    pub(super) fn new(autocovariance: R, interval_s: f64) -> Self {
        Self {
            at_zero: autocovariance(0.0),
            autocovariance,
            interval_s,
            cells: Vec::new(),
        }
    }

    /// The generalised covariance at a lag in samples; fractions are cut off.
    pub(super) fn covariance(&mut self, lag: f64) -> f64 {
        let n = lag as u64;
        let [sum, first] = self.sums(n);
        let lag = n as f64;
        let square = self.interval_s * self.interval_s;
        -0.5 * square * (lag * self.at_zero + 2.0 * (lag * sum - first))
    }

    /// `Σ r(l)` and `Σ l r(l)` over all lags from 1 to before `n`.
    fn sums(&mut self, n: u64) -> [f64; 2] {
        while self
            .cells
            .last()
            .is_none_or(|cell| cell.first + cell.count < n)
        {
            let next = self.next();
            self.cells.push(next);
        }
        let at = self.cells.partition_point(|cell| cell.first < n);
        match at.checked_sub(1).and_then(|at| self.cells.get(at)) {
            Some(cell) => self.sums_in(cell, n - cell.first),
            None => [0.0; 2],
        }
    }

    fn at(&self, lag: u64) -> f64 {
        (self.autocovariance)(lag as f64 * self.interval_s)
    }

    /// The sums up to `count` lags after the first of a cell.
    fn sums_in(&self, cell: &Cell, count: u64) -> [f64; 2] {
        let Cell {
            first,
            before: [sum, weighted],
            ..
        } = *cell;
        match &cell.cubic {
            Some([c0, c1, c2, c3]) => {
                // Σ j^k over j from 0 to before `count`.
                let n = count as f64;
                let m = n - 1.0;
                let s1 = 0.5 * m * n;
                let s2 = m * n * (2.0 * n - 1.0) / 6.0;
                let s3 = s1 * s1;
                let s4 = m * n * (2.0 * n - 1.0) * (3.0 * n * n - 3.0 * n - 1.0) / 30.0;
                let own = c0 * n + c1 * s1 + c2 * s2 + c3 * s3;
                let by_distance = c0 * s1 + c1 * s2 + c2 * s3 + c3 * s4;
                [sum + own, weighted + first as f64 * own + by_distance]
            }
            None => (first..first + count).fold([sum, weighted], |[sum, weighted], lag| {
                let value = self.at(lag);
                [sum + value, weighted + lag as f64 * value]
            }),
        }
    }

    /// The cell after the last one: as long as a cubic follows it, at most twice as long as the last one.
    fn next(&self) -> Cell {
        let Some(last) = self.cells.last() else {
            return Cell {
                first: 1,
                count: LONG,
                before: [0.0; 2],
                cubic: None,
            };
        };
        let first = last.first + last.count;
        let before = self.sums_in(last, last.count);
        let mut count = 2 * last.count;
        while count >= LONG {
            if let Some(cubic) = self.cubic(first, count) {
                return Cell {
                    first,
                    count,
                    before,
                    cubic: Some(cubic),
                };
            }
            count /= 2;
        }
        Cell {
            first,
            count: LONG,
            before,
            cubic: None,
        }
    }

    /// The cubic through four of `count` lags, if it goes through two others too.
    fn cubic(&self, first: u64, count: u64) -> Option<[f64; 4]> {
        let step = count / 6;
        let h = (2 * step) as f64;
        let [y0, y1, y2, y3] = [0, 2, 4, 6].map(|at| self.at(first + at * step));
        let (d1, d2, d3) = (y1 - y0, y2 - 2.0 * y1 + y0, y3 - 3.0 * y2 + 3.0 * y1 - y0);
        // Newton's polynomial in j/h, by powers of j.
        let cubic = [
            y0,
            (d1 - 0.5 * d2 + d3 / 3.0) / h,
            (0.5 * d2 - 0.5 * d3) / (h * h),
            d3 / (6.0 * h * h * h),
        ];
        let [c0, c1, c2, c3] = cubic;
        let bar = ERROR * self.at_zero.abs();
        let follows = |at: u64| {
            let j = at as f64;
            let value = c0 + j * (c1 + j * (c2 + j * c3));
            (value - self.at(first + at)).abs() <= bar
        };
        // One of the lags lies between two steps, where a fast oscillation would hide from them.
        (follows(step) && follows(3 * step) && follows(5 * step + step / 2) && follows(count - 1))
            .then_some(cubic)
    }
}
