//! A queue that leads from the interrupt that reads samples to the loop that accumulates them.

use heapless::spsc::{Consumer, Producer, Queue};

/// A sample on its way, with the number of samples that were lost before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Queued<T> {
    /// The sample.
    pub sample: T,
    /// The number of samples lost just before this one. If it is not 0, call `gap()` before adding the
    /// sample.
    pub lost: u32,
}

/// The interrupt's end of a queue.
///
/// A full queue takes no sample. The loss is counted and reported with the next sample that finds room,
/// so that its place in the record is known.
pub struct Sender<'a, T> {
    producer: Producer<'a, Queued<T>>,
    lost: u32,
}

/// The main loop's end of a queue.
pub struct Receiver<'a, T> {
    consumer: Consumer<'a, Queued<T>>,
    lost: u64,
}

/// Splits a queue into its two ends. A queue holds one sample less than `N`. It has no lock, and
/// nothing blocks.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, queue::{self, Queued}};
/// use heapless::spsc::Queue;
///
/// let mut queue = Queue::<Queued<i32>, 4>::new();
/// let (mut interrupt, mut main_loop) = queue::split(&mut queue);
/// for count in 0..5 {
///     interrupt.send(count); // 3 and 4 find no room
/// }
/// let mut gyro = Accumulator::<8>::new();
/// let mut take = || while let Some(Queued { sample, lost }) = main_loop.receive() {
///     if lost > 0 {
///         gyro.gap();
///     }
///     gyro.push(sample);
/// };
/// take();
/// interrupt.send(5);
/// take();
/// assert_eq!((gyro.samples(), main_loop.lost()), (4, 2));
/// ```
pub fn split<T, const N: usize>(
    queue: &mut Queue<Queued<T>, N>,
) -> (Sender<'_, T>, Receiver<'_, T>) {
    let (producer, consumer) = queue.split();
    (Sender { producer, lost: 0 }, Receiver { consumer, lost: 0 })
}

impl<T> Sender<'_, T> {
    /// Hands a sample over. Returns `false` if the sample is lost because there is no room.
    pub fn send(&mut self, sample: T) -> bool {
        let lost = self.lost;
        let sent = self.producer.enqueue(Queued { sample, lost }).is_ok();
        self.lost = if sent { 0 } else { lost.saturating_add(1) };
        sent
    }

    /// Counts samples that the interrupt itself missed, by an overrun of the sensor or a failed read.
    pub fn missed(&mut self, samples: u32) {
        self.lost = self.lost.saturating_add(samples);
    }

    /// The number of lost samples that no later sample has reported yet.
    pub fn untold(&self) -> u32 {
        self.lost
    }
}

impl<T> Receiver<'_, T> {
    /// The next sample, in the order in which samples were sent; `None` if the queue is empty.
    pub fn receive(&mut self) -> Option<Queued<T>> {
        let queued = self.consumer.dequeue()?;
        self.lost = self.lost.saturating_add(u64::from(queued.lost));
        Some(queued)
    }

    /// The number of samples that were lost before those that were received.
    pub fn lost(&self) -> u64 {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    extern crate std;
    use std::thread;

    /// Sends numbered samples from one thread and receives them in another. Every sample comes, or is counted as lost
    /// at its place.
    fn exchange<const N: usize>(samples: u32) {
        let mut queue = Queue::<Queued<u32>, N>::new();
        let (mut sender, mut receiver) = split(&mut queue);
        let (mut next, mut received) = (0, 0);
        let mut take = |receiver: &mut Receiver<'_, u32>| {
            let Some(Queued { sample, lost }) = receiver.receive() else {
                return false;
            };
            assert_eq!(sample, next + lost);
            next = sample + 1;
            received += 1;
            true
        };
        let untold = thread::scope(|scope| {
            let sending = scope.spawn(move || {
                for sample in 0..samples {
                    // Some samples are missed by the interrupt itself.
                    if sample % 7 == 5 {
                        sender.missed(1);
                    } else {
                        sender.send(sample);
                    }
                    if sample % 3 == 0 {
                        thread::yield_now();
                    }
                }
                sender.untold()
            });
            while !sending.is_finished() {
                if !take(&mut receiver) {
                    thread::yield_now();
                }
            }
            sending.join().expect("the interrupt does not panic")
        });
        while take(&mut receiver) {}
        assert_eq!(next + untold, samples);
        assert_eq!(
            received + receiver.lost() + u64::from(untold),
            samples.into()
        );
    }

    /// Under Miri, each seed is another order of the threads' steps and of the values that a weak memory may show.
    #[test]
    fn two_threads_lose_no_sample_without_its_place() {
        let samples = if cfg!(miri) { 24 } else { 100_000 };
        exchange::<2>(samples);
        exchange::<4>(samples);
    }
}
