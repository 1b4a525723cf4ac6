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

/// One operation on a queue: by the interrupt, or by the main loop.
#[derive(Clone, Copy, Debug)]
enum Operation {
    Send,
    Miss,
    Receive,
}

/// The operations of a schedule. The interrupt may come between any two of the main loop's, so that every
/// order of operations is a possible schedule.
const OPERATIONS: [Operation; 3] = [Operation::Send, Operation::Miss, Operation::Receive];

/// Plays a schedule on a queue with room for `N − 1` samples, and compares every answer with a list of what was
/// sent.
fn play<const N: usize>(schedule: impl Iterator<Item = Operation> + Clone) {
    let mut queue = Queue::<Queued<u32>, N>::new();
    let (mut sender, mut receiver) = queue::split(&mut queue);
    // The samples that found room. Each sample is its own number among all that were sent or missed.
    let mut waiting = std::collections::VecDeque::new();
    let (mut made, mut next, mut lost) = (0, 0, 0);
    for operation in schedule.clone() {
        match operation {
            Operation::Send => {
                let has_room = waiting.len() < N - 1;
                assert_eq!(sender.send(made), has_room);
                if has_room {
                    waiting.push_back(made);
                }
                made += 1;
            }
            Operation::Miss => {
                sender.missed(1);
                made += 1;
            }
            Operation::Receive => {
                let sample = waiting.pop_front();
                let expected = sample.map(|sample| Queued {
                    sample,
                    lost: sample - next,
                });
                assert_eq!(
                    receiver.receive(),
                    expected,
                    "{:?}",
                    Vec::from_iter(schedule)
                );
                if let Some(Queued {
                    sample,
                    lost: before,
                }) = expected
                {
                    next = sample + 1;
                    lost += u64::from(before);
                }
            }
        }
        let last = waiting.back().map_or(next, |sample| sample + 1);
        assert_eq!((receiver.lost(), sender.untold()), (lost, made - last));
    }
}

#[test]
fn every_schedule_of_interrupt_and_main_loop_reports_every_loss() {
    const LENGTH: u32 = 12;
    // Miri, which looks for races and undefined behaviour, takes a thousand times as long.
    let length = if cfg!(miri) { 5 } else { LENGTH };
    for number in 0..3_usize.pow(length) {
        let schedule = (0..length).map(|place| OPERATIONS[number / 3_usize.pow(place) % 3]);
        play::<2>(schedule.clone());
        play::<4>(schedule);
    }
}
