//! From the interrupt that reads a sample to the loop that accumulates it.

use heapless::spsc::{Consumer, Producer, Queue};

/// A sample on its way, and what was lost before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Queued<T> {
    /// The sample.
    pub sample: T,
    /// Samples lost just before this one: nonzero calls for a `gap()`.
    pub lost: u32,
}

/// The interrupt's end of a queue.
///
/// A full queue takes no sample: the loss is counted, and told with the next sample that finds room, so
/// that it is known where in the record it lies.
pub struct Sender<'a, T> {
    producer: Producer<'a, Queued<T>>,
    lost: u32,
}

/// The main loop's end of a queue.
pub struct Receiver<'a, T> {
    consumer: Consumer<'a, Queued<T>>,
    lost: u64,
}

/// Both ends of a queue, which holds one sample less than `N`. No lock, and nothing that blocks.
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
    /// Hands a sample over; `false` if it is lost for want of room.
    pub fn send(&mut self, sample: T) -> bool {
        let lost = self.lost;
        let sent = self.producer.enqueue(Queued { sample, lost }).is_ok();
        self.lost = if sent { 0 } else { lost.saturating_add(1) };
        sent
    }

    /// The interrupt missed samples by itself: an overrun of the sensor, a failed read.
    pub fn missed(&mut self, samples: u32) {
        self.lost = self.lost.saturating_add(samples);
    }

    /// Samples lost that no later one has told of yet.
    pub fn untold(&self) -> u32 {
        self.lost
    }
}

impl<T> Receiver<'_, T> {
    /// The next sample, in the order in which they were sent.
    pub fn receive(&mut self) -> Option<Queued<T>> {
        let queued = self.consumer.dequeue()?;
        self.lost = self.lost.saturating_add(u64::from(queued.lost));
        Some(queued)
    }

    /// Samples lost before those that were received.
    pub fn lost(&self) -> u64 {
        self.lost
    }
}
