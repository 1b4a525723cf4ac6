//! Queries in this process.

use crate::logs::{Fleet, RATE_HZ, Row, SCALE, found, random, write, write_columns};
use allanite::{diagnosis::Verdict, integrity::Reason};
use allanite_fleet::cluster::local;
use allanite_host::interface::{
    Record,
    options::{Fitting, Search},
};
use allanite_log::{pieces::Pieces, unit::Unit};
use datafusion::{
    arrow::{
        array::{Array, ArrayRef, AsArray, Int32Array, Int64Array, RecordBatch},
        datatypes::{Float64Type, Int64Type},
    },
    error::DataFusionError,
    prelude::{ParquetReadOptions, SessionConfig, SessionContext},
};
use rand::RngExt as _;
use std::{path::Path, sync::Arc};

/// The verdict on an axis that is not valid, whatever the reason is.
const INVALID: Verdict = Verdict::Invalid(Reason::Spiked {
    spikes: 0,
    percent: 0,
});

pub(crate) const STATES: &str = "SELECT device, axis, allan_state(start, counts, rate, scale) AS state FROM logs GROUP BY device, axis ORDER BY device, axis";

pub(crate) async fn session(
    tables: &[(&str, &Path)],
    partitions: usize,
    rows: usize,
) -> SessionContext {
    let settings = SessionConfig::new()
        .with_target_partitions(partitions)
        .with_batch_size(rows);
    let session = local(settings).unwrap();
    for (name, path) in tables {
        let path = path.to_str().unwrap();
        session
            .register_parquet(*name, path, ParquetReadOptions::default())
            .await
            .unwrap();
    }
    session
}

pub(crate) async fn asked(
    session: &SessionContext,
    query: &str,
) -> Result<Vec<RecordBatch>, DataFusionError> {
    session.sql(query).await?.collect().await
}

#[tokio::test]
async fn no_partition_changes_a_byte() {
    let expected = Fleet::SMALL.states();
    for (partitions, rows) in [(1, 8192), (2, 16), (7, 8192), (64, 3)] {
        let mut random = random(partitions as u64);
        let folder = tempfile::tempdir().unwrap();
        let lengths = match partitions {
            1 => Fleet::SMALL.rows(|| Fleet::SMALL.samples),
            2 => Fleet::SMALL.rows(|| 5000),
            _ => Fleet::SMALL.rows(|| random.random_range(1..4000)),
        };
        write(
            folder.path(),
            lengths,
            partitions,
            if partitions == 7 { 3 } else { 1000 },
            &mut random,
        );
        let session = session(&[("logs", folder.path())], partitions, rows).await;
        assert_eq!(
            found(&asked(&session, STATES).await.unwrap()),
            expected,
            "{partitions} partitions"
        );

        // The states of each part, merged from a column.
        let parts = STATES.replace(
            "GROUP BY device, axis",
            "GROUP BY device, axis, start / 5000",
        );
        let merged = format!(
            "SELECT device, axis, allan_merge(state) AS state FROM ({parts}) GROUP BY device, axis ORDER BY device, axis"
        );
        assert_eq!(
            found(&asked(&session, &merged).await.unwrap()),
            expected,
            "{partitions} partitions, merged"
        );
        // Without groups, and with a filter of the aggregate.
        let one = "SELECT 'd1' AS device, 'x' AS axis, allan_state(start, counts, rate, scale) \
                   FILTER (WHERE device = 'd1' AND axis = 'x') AS state FROM logs";
        assert_eq!(found(&asked(&session, one).await.unwrap()), expected[2..3]);
        let each = "SELECT device, axis, allan_state(start, counts, rate, scale) FILTER (WHERE device <> 'd1') AS state \
                    FROM logs GROUP BY device, axis ORDER BY device, axis";
        let each = asked(&session, each).await.unwrap();
        let nothing = each
            .iter()
            .map(|batch| batch.column(2).null_count())
            .sum::<usize>();
        assert_eq!(nothing, 2, "a group without rows has no state");
    }
}

#[tokio::test]
async fn one_sample_a_row_gives_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let counts = Fleet::SMALL.counts(1, 1);
    let mut order: Vec<usize> = (0..counts.len()).collect();
    let mut random = random(5);
    for at in (1..order.len()).rev() {
        order.swap(at, random.random_range(0..=at));
    }
    for (number, part) in order.chunks(9_000).enumerate() {
        let numbers: Int64Array = part.iter().map(|&at| at as i64).collect();
        let counts: Int32Array = part.iter().map(|&at| counts[at]).collect();
        let columns: [(&str, ArrayRef); 2] =
            [("number", Arc::new(numbers)), ("count", Arc::new(counts))];
        write_columns(
            &folder.path().join(format!("{number}.parquet")),
            columns,
            1000,
        );
    }
    let session = session(&[("samples", folder.path())], 3, 8192).await;
    let query = "SELECT 'd1' AS device, 'y' AS axis, allan_state_of_samples(number, count, 200.0, 0.01) AS state FROM samples";
    assert_eq!(
        found(&asked(&session, query).await.unwrap()),
        Fleet::SMALL.states()[3..4]
    );
}

#[tokio::test]
async fn coefficients_and_diagnoses_are_those_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    write(
        folder.path(),
        Fleet::SMALL.rows(|| 3000),
        3,
        100,
        &mut random(1),
    );
    let session = session(&[("logs", folder.path())], 2, 16).await;
    let query = format!(
        "SELECT device, axis, allan_samples(state) AS samples, fit, fit['N'] AS n, fit['N_upper'] AS upper, fit['chi2'] AS chi2, \
         found['verdict'] AS verdict FROM (SELECT device, axis, state, allan_fit(state, 'deg/s') AS fit, \
         allan_diagnose(state, 'deg/s') AS found FROM ({STATES})) ORDER BY device, axis"
    );
    let rows = asked(&session, &query).await.unwrap();
    let rows = datafusion::arrow::compute::concat_batches(&rows[0].schema(), &rows).unwrap();
    let number = |name: &str, at: usize| {
        rows.column_by_name(name)
            .unwrap()
            .as_primitive::<Float64Type>()
            .value(at)
    };
    for (at, (device, axis, state)) in Fleet::SMALL.states().into_iter().enumerate() {
        let axes = [("gyro".to_owned(), Pieces::from_bytes(&state).unwrap())];
        let record = Record::of_pieces(&axes, Unit::DegreesPerSecond).unwrap();
        let fits = record.fit(&Fitting::default()).unwrap();
        let fit: serde_json::Value = serde_json::from_str(&fits.json().unwrap()).unwrap();
        let white = &fit["axes"][0]["coefficients"][1];
        assert_eq!(white["symbol"], "N");
        assert_eq!(
            number("n", at),
            white["value"].as_f64().unwrap(),
            "{device} {axis}"
        );
        assert_eq!(number("upper", at), white["upper"].as_f64().unwrap());
        assert_eq!(number("chi2", at), fit["axes"][0]["chi2"].as_f64().unwrap());
        let samples = rows
            .column_by_name("samples")
            .unwrap()
            .as_primitive::<Int64Type>();
        assert_eq!(samples.value(at), 40_000);
        let diagnosis = record
            .diagnose(&Search::default(), &mut |_| true)
            .unwrap()
            .json()
            .unwrap();
        let diagnosis: serde_json::Value = serde_json::from_str(&diagnosis).unwrap();
        let verdict = rows.column_by_name("verdict").unwrap().as_string::<i32>();
        assert_eq!(verdict.value(at), diagnosis["axes"][0]["verdict"]);
    }
    // N is that of the uniform noise that was written.
    let truth = SCALE * (2.0 * 70.0 + 1.0) / 12.0_f64.sqrt() / RATE_HZ.sqrt();
    let last = number("n", 5);
    assert!((last / truth - 1.0).abs() < 0.05, "{last} for {truth}");
}

#[tokio::test]
async fn what_is_not_one_record_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut rows = Fleet::SMALL.rows(|| 20_000);
    rows.push(rows[0].clone());
    write(folder.path(), rows, 2, 100, &mut random(1));
    let session = session(&[("logs", folder.path())], 2, 16).await;
    let twice = asked(&session, STATES).await.unwrap_err().to_string();
    assert!(twice.contains("samples 0 to 19999 come twice"), "{twice}");
    // Without the axis whose samples come twice.
    let states = STATES.replace("FROM logs", "FROM logs WHERE device = 'd1'");
    for (query, message) in [
        (
            states.replace("rate,", "CASE WHEN start > 0 THEN rate ELSE 2 * rate END,"),
            "has the rate",
        ),
        (
            states.replace("start,", "start - 1,"),
            "sample -1 has a negative number",
        ),
        (
            states.replace("start,", "NULL,"),
            "a row has no number, rate or scale",
        ),
        (states.replace("rate,", "0 * rate,"), "rate"),
        (
            states.replace("counts,", "device,"),
            "counts of allan_state is a list of whole numbers",
        ),
        (
            states.replace(", rate", ""),
            "allan_state takes 4 arguments and not 3",
        ),
        (
            states.replace("(start", "(DISTINCT start"),
            "allan_state takes no DISTINCT",
        ),
        (
            "SELECT allan_samples('text')".to_owned(),
            "state of allan_samples is the bytes of a state",
        ),
        (
            "SELECT allan_fit(arrow_cast('abc', 'Binary'), 'deg/s')".to_owned(),
            "not the bytes of the pieces",
        ),
    ] {
        let error = match asked(&session, &query).await {
            Ok(_) => panic!("{query} is answered"),
            Err(error) => error.to_string(),
        };
        assert!(error.contains(message), "{query}: {error}");
    }
}

#[tokio::test]
async fn lost_samples_are_gaps() {
    let folder = tempfile::tempdir().unwrap();
    let row = Row {
        device: "a".to_owned(),
        axis: "x",
        start: 10,
        counts: vec![Some(1), None, Some(3), Some(4)],
    };
    write(folder.path(), vec![row], 1, 10, &mut random(1));
    let session = session(&[("logs", folder.path())], 1, 16).await;
    let states = found(&asked(&session, STATES).await.unwrap());
    let pieces = Pieces::from_bytes(&states[0].2).unwrap();
    assert_eq!(pieces.stretches().collect::<Vec<_>>(), [10..11, 12..14]);
}

#[tokio::test]
async fn narrow_counts_and_missing_states_are_taken() {
    let session = session(&[], 1, 16).await;
    let query = "SELECT 'd' AS device, 'x' AS axis, allan_merge(state) AS state FROM (\
                 SELECT allan_state(0, arrow_cast(make_array(1, 2, 3), 'List(Int16)'), 200, 0.01) AS state \
                 UNION ALL SELECT allan_state(3, make_array(4, 5), 200, 0.01) UNION ALL SELECT NULL)";
    let states = found(&asked(&session, query).await.unwrap());
    let mut pieces = Pieces::new(RATE_HZ, SCALE).unwrap();
    pieces.push(0, &[1, 2, 3, 4, 5]).unwrap();
    assert_eq!(states[0].2, pieces.to_bytes().unwrap());
    let wide = "SELECT allan_state(0, make_array(5000000000), 200, 0.01)";
    let error = asked(&session, wide).await.unwrap_err().to_string();
    assert!(error.contains("5000000000"), "{error}");
}

#[tokio::test]
async fn samples_that_hang_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut rows = Fleet::SMALL.rows(|| 1000);
    for row in &mut rows {
        if row.device == "d1" && (5000..7000).contains(&row.start) {
            row.counts.fill(Some(40));
        }
    }
    write(folder.path(), rows, 3, 10, &mut random(1));
    let session = session(&[("logs", folder.path())], 2, 16).await;
    let query = format!(
        "SELECT fit['invalid'] AS invalid, found['verdict'] AS verdict FROM (SELECT device, axis, \
         allan_fit(state, 'deg/s') AS fit, allan_diagnose(state, 'deg/s') AS found FROM ({STATES})) ORDER BY device, axis"
    );
    let rows = asked(&session, &query).await.unwrap();
    let rows = datafusion::arrow::compute::concat_batches(&rows[0].schema(), &rows).unwrap();
    let [invalid, verdict] = [0, 1].map(|column| rows.column(column).as_string::<i32>());
    for row in 0..6 {
        let hangs = [2, 3].contains(&row);
        assert_eq!(invalid.is_valid(row), hangs);
        assert_eq!(verdict.value(row) == INVALID.name(), hangs);
        assert!(!hangs || invalid.value(row).contains("stuck values"));
    }
}

#[tokio::test]
async fn an_axis_that_cannot_be_fitted_is_a_row_and_a_wrong_unit_an_error() {
    let session = session(&[], 1, 16).await;
    let of = |counts: &str, unit: &str| {
        format!(
            "SELECT fit['invalid'] AS invalid, fit['N'] AS n, found['conclusion'] AS conclusion FROM (SELECT \
             allan_fit(state, '{unit}') AS fit, allan_diagnose(state, '{unit}') AS found FROM \
             (SELECT allan_state(0, {counts}, 200, 0.01) AS state))"
        )
    };
    for (counts, said) in [
        ("make_array(1, 2)", "a fit needs two octaves"),
        ("array_repeat(5, 5000)", "the counts never change"),
    ] {
        let rows = asked(&session, &of(counts, "deg/s")).await.unwrap();
        let [invalid, conclusion] = [0, 2].map(|column| rows[0].column(column).as_string::<i32>());
        assert!(invalid.value(0).contains(said) && conclusion.value(0).contains(said));
        assert!(rows[0].column(1).is_null(0));
        let error = asked(&session, &of(counts, "furlong")).await.unwrap_err();
        assert!(error.to_string().contains("furlong"), "{error}");
    }
}
