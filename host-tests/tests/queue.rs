//! Samples on their way from an interrupt are either delivered or counted as lost, with their
//! place.

use allanite::queue::{self, Queued};
use heapless::spsc::Queue;
use proptest::prelude::*;

proptest! {
    #[test]
    fn every_loss_in_a_queue_is_reported_with_its_place(
        bursts in proptest::collection::vec((0_usize..12, 0_usize..12, 0_u32..3), 1..60),
    ) {
        let mut queue = Queue::<Queued<u32>, 8>::new();
        let (mut sender, mut receiver) = queue::split(&mut queue);
        let (mut sent, mut expected, mut received) = (0, 0, 0_u64);
        for (sends, takes, missed) in bursts {
            for _ in 0..sends {
                sender.send(sent);
                sent += 1;
            }
            sender.missed(missed);
            sent += missed;
            for _ in 0..takes {
                let Some(Queued { sample, lost }) = receiver.receive() else { break };
                prop_assert_eq!(sample, expected + lost);
                expected = sample + 1;
                received += 1;
            }
        }
        while let Some(Queued { sample, lost }) = receiver.receive() {
            prop_assert_eq!(sample, expected + lost);
            expected = sample + 1;
            received += 1;
        }
        prop_assert_eq!(received + receiver.lost() + u64::from(sender.untold()), u64::from(sent));
    }
}
