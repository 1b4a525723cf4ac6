//! Recognises tables in which each row has the values of one sensor, and leaves the columns of the others empty.

use super::columns::Columns;
use crate::{
    Options,
    failure::{Failure, Place},
    unit::Sensor,
};
use csv::ByteRecord;
use std::path::Path;

/// The rows of another sensor are at least this share of all rows. Fewer rows without a value are lost samples. It is the
/// share with which a log is refused for these.
const LEAST: f64 = 0.1;

/// The fewest rows that tell sensors apart.
const LEAST_ROWS: usize = 16;

/// Which columns have a value in the first rows of a table.
#[derive(Debug)]
pub(super) struct Filled {
    /// By column, whether each row has a value.
    columns: Vec<Vec<bool>>,
    rows: usize,
}

impl Filled {
    pub(super) fn of_rows(rows: &[ByteRecord], width: usize) -> Self {
        let column = |column: usize| {
            let fields = rows.iter().map(|row| row.get(column).unwrap_or_default());
            fields.map(|field| !field.trim_ascii().is_empty()).collect()
        };
        Self {
            columns: (0..width).map(column).collect(),
            rows: rows.len(),
        }
    }

    /// The first column of the axes, if other rows have the values of another sensor and none of these. The axes are those that
    /// the options or the names of the columns tell.
    ///
    /// # Errors
    /// When neither tells of which columns the rows are to be read.
    pub(super) fn column_of_axes(
        &self,
        columns: &Columns,
        path: &Path,
        options: &Options,
    ) -> Result<Option<usize>, Failure> {
        let groups = self.groups();
        if self.rows < LEAST_ROWS || groups.len() < 2 {
            return Ok(None);
        }
        let axes: Vec<usize> = match &options.columns {
            Some(choices) => {
                let axes = columns.chosen(path, choices)?;
                axes.into_iter().map(|axis| axis.column).collect()
            }
            None => {
                let wanted = options.sensor.or(options.unit.map(|unit| unit.sensor()));
                let sensors = [Sensor::Gyro, Sensor::Accelerometer];
                let wanted = sensors
                    .into_iter()
                    .filter(|sensor| wanted.is_none_or(|one| one == *sensor));
                let mut named = wanted.map(|sensor| columns.axes_of(sensor));
                named.find(|axes| !axes.is_empty()).unwrap_or_default()
            }
        };
        match axes.first() {
            Some(&first) => Ok(self.has_others(first, &groups).then_some(first)),
            None => Err(self.choice(columns, path, &groups)),
        }
    }

    /// The columns that are not filled in all rows, by the rows in which they are: each group with at least two neighbours.
    fn groups(&self) -> Vec<Vec<usize>> {
        let is_partly = |column: &usize| {
            let empty = self.columns[*column]
                .iter()
                .filter(|filled| !**filled)
                .count();
            let share = empty as f64 / self.rows.max(1) as f64;
            (LEAST..=1.0 - f64::EPSILON).contains(&share)
        };
        let partly: Vec<usize> = (0..self.columns.len()).filter(is_partly).collect();
        let are_alike = |one: &usize, other: &usize| self.columns[*one] == self.columns[*other];
        partly.chunk_by(are_alike).map(<[usize]>::to_vec).collect()
    }

    /// Whether many rows have no value in a column, and one in columns of another group that is empty beside this column.
    fn has_others(&self, column: usize, groups: &[Vec<usize>]) -> bool {
        let least = LEAST * self.rows as f64;
        let own = &self.columns[column];
        let others = groups.iter().filter(|group| !group.contains(&column));
        let count = |is: &dyn Fn(bool, bool) -> bool, other: usize| {
            let pairs = own.iter().zip(&self.columns[other]);
            pairs.filter(|(own, other)| is(**own, **other)).count() as f64
        };
        let mut firsts = others.map(|group| group[0]);
        firsts.any(|other| {
            count(&|own, other| !own && other, other) >= least
                && count(&|own, other| own && !other, other) >= least
        })
    }

    /// The failure to know of which columns the rows are to be read.
    fn choice(&self, columns: &Columns, path: &Path, groups: &[Vec<usize>]) -> Failure {
        let lists: Vec<String> = groups.iter().map(|group| columns.list(group)).collect();
        let option = |group: &Vec<usize>| {
            let axes = group.iter().zip(["gx", "gy", "gz"]);
            let axes: Vec<String> = axes
                .map(|(column, axis)| format!("{axis}={}", column + 1))
                .collect();
            format!("--columns {}", axes.join(","))
        };
        let options: Vec<String> = groups.iter().map(option).collect();
        Place::file(path).failure(
            format!(
                "each row has the values of one sensor: {}",
                lists.join("; or ")
            ),
            format!("choose with {}", options.join(" or ")),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::Look;

    /// The column of the axes of a table of these names, in whose rows `x` stands for a value.
    fn found(
        names: Option<&str>,
        rows: [&str; 2],
        options: &Options,
    ) -> Result<Option<usize>, String> {
        let record = |row: usize| {
            let fields = rows[row % 2]
                .chars()
                .map(|c| if c == 'x' { "1.5" } else { "" });
            ByteRecord::from(fields.collect::<Vec<_>>())
        };
        let records: Vec<ByteRecord> = (0..40).map(record).collect();
        let columns = Columns {
            names: names.map(|names| names.split(',').map(str::to_owned).collect()),
            looks: vec![Look::Number; 7],
            heads: vec![Vec::new(); 7],
            longer: Vec::new(),
            tags: Vec::new(),
            defined: Vec::new(),
            said: String::new(),
        };
        let filled = Filled::of_rows(&records, 7);
        filled
            .column_of_axes(&columns, Path::new("a.csv"), options)
            .map_err(|failure| failure.to_string())
    }

    #[test]
    fn rows_of_another_sensor_have_no_values_of_the_axes() {
        let names = Some("t,ax,ay,az,gx,gy,gz");
        let none = Options::default();
        let chosen = Options {
            columns: Some(vec!["gx=2".parse().unwrap()]),
            ..Options::default()
        };
        let turns = ["xxxx---", "x---xxx"];
        assert_eq!(found(names, turns, &none), Ok(Some(4)));
        // Where all other columns have a value as well, samples are lost.
        assert_eq!(found(names, ["xxxx---", "xxxxxxx"], &none), Ok(None));
        assert_eq!(found(names, ["xxxxxxx", "xxxxxxx"], &none), Ok(None));
        assert_eq!(found(None, turns, &chosen), Ok(Some(1)));
        assert_eq!(
            found(None, turns, &none),
            Err(
                "a.csv: each row has the values of one sensor: column 2, column 3, column 4; or column 5, column 6, \
                 column 7; choose with --columns gx=2,gy=3,gz=4 or --columns gx=5,gy=6,gz=7"
                    .into()
            )
        );
    }
}
