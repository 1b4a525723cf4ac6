//! The sources of counts. Each of them gives bytes, which a thread of its own reads.

use allanite_log::failure::{Failure, one_line};
use std::{
    io::{self, ErrorKind, Read},
    sync::mpsc::{Receiver, SyncSender, sync_channel},
    thread,
    time::Duration,
};

/// Largest number of bytes read at a time. Chosen by hand.
const CHUNK: usize = 1 << 16;

/// Number of chunks that may wait to be accumulated. Chosen by hand.
const WAITING: usize = 64;

/// Longest wait for a serial port before it is read again. Chosen by hand.
const PORT_TIMEOUT: Duration = Duration::from_millis(100);

/// A source of lines of counts.
#[derive(Clone, Debug)]
pub(super) enum Source {
    /// Standard input.
    StandardInput,
    /// A serial port, read from the beginning of the next line on.
    SerialPort {
        /// Its name.
        port: String,
        /// Bits per second.
        baud: u32,
    },
}

/// A message of a source.
pub(super) enum Received {
    /// The next bytes.
    Bytes(Vec<u8>),
    /// The failure that ended the source. A source whose input has ended closes the channel without a
    /// message.
    Failure(Failure),
}

impl Source {
    /// Opens the source and reads it in a thread of its own.
    ///
    /// # Errors
    /// When the serial port cannot be opened.
    pub(super) fn listen(self) -> Result<Receiver<Received>, Failure> {
        let (sender, receiver) = sync_channel(WAITING);
        match self {
            Self::StandardInput => {
                thread::spawn(move || pass_on(io::stdin().lock(), "standard input", &sender));
            }
            Self::SerialPort { port, baud } => {
                let opened = serialport::new(&port, baud).timeout(PORT_TIMEOUT).open();
                let opened = opened.map_err(|error| {
                    Failure::option(
                        format!("--port {}: {error}", one_line(&port)),
                        "check the name, the cable and the permission",
                    )
                })?;
                // A port is usually opened in the middle of a line, which is left out.
                let lines = FromNextLine {
                    source: opened,
                    begun: false,
                };
                thread::spawn(move || pass_on(lines, &port, &sender));
            }
        }
        Ok(receiver)
    }
}

/// Reads the source to its end, or until the receiver has gone.
fn pass_on(mut source: impl Read, name: &str, sender: &SyncSender<Received>) {
    let mut chunk = vec![0; CHUNK];
    loop {
        let received = match source.read(&mut chunk) {
            Ok(0) => return,
            Ok(length) => Received::Bytes(chunk[..length].to_vec()),
            Err(error) if matches!(error.kind(), ErrorKind::Interrupted | ErrorKind::TimedOut) => {
                continue;
            }
            Err(error) => Received::Failure(Failure::option(
                format!("{}: {error}", one_line(name)),
                "check the cable; the samples received so far are kept",
            )),
        };
        let last = matches!(received, Received::Failure(_));
        if sender.send(received).is_err() || last {
            return;
        }
    }
}

/// A reader that leaves out everything up to the first line break.
struct FromNextLine<R> {
    source: R,
    begun: bool,
}

impl<R: Read> Read for FromNextLine<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let length = self.source.read(buffer)?;
            if self.begun || length == 0 {
                return Ok(length);
            }
            let Some(end) = buffer[..length].iter().position(|&byte| byte == b'\n') else {
                continue;
            };
            self.begun = true;
            buffer.copy_within(end + 1..length, 0);
            if end + 1 < length {
                return Ok(length - end - 1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn port_is_read_from_the_next_line_on_for_pieces_of_any_length() {
        let text = b"23,4\n1,2\n3,4\n";
        for piece in 1..=text.len() {
            let pieces = text.chunks(piece).map(<[u8]>::to_vec);
            let source = pieces.fold(Box::new(io::empty()) as Box<dyn Read>, |before, piece| {
                Box::new(before.chain(io::Cursor::new(piece)))
            });
            let mut lines = FromNextLine {
                source,
                begun: false,
            };
            let mut rest = String::new();
            lines.read_to_string(&mut rest).unwrap();
            assert_eq!(rest, "1,2\n3,4\n", "pieces of {piece}");
        }
    }
}
