//! An order within an aggregate changes nothing.

use crate::{
    logs::{Fleet, found, random, write},
    queries::{STATES, asked, session},
};

/// DataFusion 55 hands the columns of an ORDER BY within an aggregate to its `update_batch` as well, unless it says that the order
/// does not matter, and sorts each part for itself.
#[tokio::test]
async fn an_order_within_an_aggregate_changes_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let lengths = Fleet::SMALL.rows(|| 700);
    write(folder.path(), lengths, 3, 1000, &mut random(8));
    let session = session(&[("logs", folder.path())], 3, 64).await;
    let expected = Fleet::SMALL.states();
    for order in ["start", "start DESC", "device, counts DESC"] {
        let ordered = STATES.replace("rate, scale)", &format!("rate, scale ORDER BY {order})"));
        assert_ne!(ordered, STATES);
        let states = asked(&session, &ordered).await.unwrap();
        assert_eq!(found(&states), expected, "{order}");

        let parts = STATES.replace(
            "GROUP BY device, axis",
            "GROUP BY device, axis, start / 5000",
        );
        let merged = format!(
            "SELECT device, axis, allan_merge(state ORDER BY state) AS state FROM ({parts}) GROUP BY device, axis ORDER BY device, axis"
        );
        let merged = asked(&session, &merged).await.unwrap();
        assert_eq!(found(&merged), expected, "{order}, merged");
    }
}
