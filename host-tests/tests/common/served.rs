//! The server of `explore`, and requests to it.

use host_tests::program::{command, piped, signal};
use std::{
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    path::Path,
    process::Child,
    time::Duration,
};

/// A server that ends with this value.
pub(crate) struct Served {
    process: Child,
    /// The address of the page.
    pub(crate) url: String,
}

/// The answer to a request.
pub(crate) struct Answer {
    pub(crate) status: u16,
    headers: Vec<(String, String)>,
    pub(crate) body: String,
}

impl Answer {
    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        let mut headers = self.headers.iter();
        let named = headers.find(|(other, _)| other.eq_ignore_ascii_case(name));
        named.map(|(_, value)| value.as_str())
    }
}

impl Served {
    /// Starts `explore` with these arguments and waits for its address.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let arguments = [&["explore"], arguments].concat();
        let mut process = piped(&mut command(Path::new("."), &arguments));
        let mut line = String::new();
        let output = process.stdout.as_mut().unwrap();
        BufReader::new(output).read_line(&mut line).unwrap();
        let url = line.trim().to_owned();
        assert!(url.starts_with("http://127.0.0.1:"), "{url}");
        Self { process, url }
    }

    /// The host and the port, as in the header `Host`.
    pub(crate) fn host(&self) -> String {
        self.url.split('/').nth(2).unwrap().to_owned()
    }

    pub(crate) fn port(&self) -> u16 {
        self.host().split(':').nth(1).unwrap().parse().unwrap()
    }

    pub(crate) fn token(&self) -> &str {
        self.url.split('/').nth(3).unwrap()
    }

    /// Asks a question as the page does.
    pub(crate) fn post(&self, name: &str, body: &str) -> Answer {
        let path = format!("/{}/{name}", self.token());
        self.request("POST", &path, &[("Host", &self.host())], body)
    }

    /// Sends a request with these headers.
    pub(crate) fn request(
        &self,
        method: &str,
        path: &str,
        headers: &[(&str, &str)],
        body: &str,
    ) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port())).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        let headers: String = headers
            .iter()
            .map(|(name, value)| format!("{name}: {value}\r\n"))
            .collect();
        let length = body.len();
        let request = format!(
            "{method} {path} HTTP/1.1\r\n{headers}Connection: close\r\nContent-Length: {length}\r\n\r\n{body}"
        );
        // The server may answer before it has read all of a body that is too long.
        let _ = stream.write_all(request.as_bytes());
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let answer = String::from_utf8(answer).unwrap();
        let (head, body) = answer
            .split_once("\r\n\r\n")
            .unwrap_or_else(|| panic!("{method} {path}: {answer:?}"));
        let mut lines = head.lines();
        let status = lines
            .next()
            .unwrap()
            .split(' ')
            .nth(1)
            .unwrap()
            .parse()
            .unwrap();
        let headers = lines.filter_map(|line| line.split_once(": "));
        let headers: Vec<_> = headers
            .map(|(name, value)| (name.to_owned(), value.to_owned()))
            .collect();
        let mut answer = Answer {
            status,
            headers,
            body: body.to_owned(),
        };
        if answer.header("Transfer-Encoding") == Some("chunked") {
            answer.body = unchunked(body);
        }
        answer
    }

    /// Interrupts the server as Ctrl-C does, and returns what it wrote to standard error.
    pub(crate) fn end(mut self) -> String {
        signal(&self.process, "INT");
        let mut errors = String::new();
        self.process
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut errors)
            .unwrap();
        let status = self.process.wait().unwrap();
        // By the convention of shells, 130 is the status of a program that was interrupted.
        assert_eq!(status.code(), Some(130));
        errors
    }
}

/// A body that was sent in chunks, each after its length in hexadecimal digits.
fn unchunked(mut body: &str) -> String {
    let mut whole = String::new();
    while let Some((length, rest)) = body.split_once("\r\n") {
        let length = usize::from_str_radix(length, 16).unwrap();
        whole.push_str(&rest[..length]);
        body = rest[length..].trim_start_matches("\r\n");
    }
    whole
}

impl Drop for Served {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
