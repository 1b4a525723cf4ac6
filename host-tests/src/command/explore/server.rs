//! The server of the page. It listens on the loopback address only, and answers nobody who does not know its token.

use super::{
    arguments::Arguments,
    session::{Reply, Session},
};
use crate::{
    command::output::progress,
    failure::{Failure, report},
};
use socket2::SockRef;
use std::{
    io::{Read, Write},
    net::{Ipv4Addr, TcpListener},
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};
use tiny_http::{Header, Method, Request, Response, Server};

/// The longest body of a question, in bytes. Chosen by hand: a question of eight effects takes less than a thousand.
const LONGEST: u64 = 1 << 16;

/// The number of requests that are answered at once. Chosen by hand: the page has at most three on their way.
const AT_ONCE: usize = 16;

/// The stack of a thread that fits a model. Chosen by hand, as large as that of the main thread.
const STACK: usize = 8 << 20;

/// The address and the token of a server.
struct Door {
    port: u16,
    token: String,
}

/// Runs the command until it is interrupted.
pub(in crate::command) fn run(
    arguments: &Arguments,
    output: &mut impl Write,
) -> Result<(), Failure> {
    let session = Session::read(arguments)?;
    let fail = |error: &dyn std::fmt::Display| {
        let what = format!("the page cannot be served: {error}");
        Failure::option(what, "allow the program to listen on 127.0.0.1")
    };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).map_err(|error| fail(&error))?;
    // Connections inherit this. Otherwise the end of every answer waits for the browser to confirm its beginning, which
    // takes 44 ms (Nagle's algorithm, RFC 896).
    let undelayed = SockRef::from(&listener).set_tcp_nodelay(true);
    undelayed.map_err(|error| fail(&error))?;
    let server = Server::from_listener(listener, None).map_err(|error| fail(&error))?;
    let address = server
        .server_addr()
        .to_ip()
        .ok_or_else(|| fail(&"no address"))?;
    let door = Door {
        port: address.port(),
        token: random().map_err(|error| fail(&error))?,
    };
    let url = format!("http://{address}/{}/", door.token);
    writeln!(output, "{url}")
        .and_then(|()| output.flush())
        .map_err(|error| Failure::standard_output(&error))?;
    if arguments.open {
        if let Err(error) = open::that_detached(&url) {
            report(format_args!(
                "no browser could be opened ({error}); open the address above"
            ));
        }
    } else if !progress::is_quiet() {
        report("open this address in a browser of this computer; Ctrl-C ends it");
    }
    serve(&server, &door, &session);
    Ok(())
}

/// Answers requests, each in a thread of its own, so that a diagnosis holds up no fit.
fn serve(server: &Server, door: &Door, session: &Session) {
    let busy = AtomicUsize::new(0);
    thread::scope(|scope| {
        for request in server.incoming_requests() {
            if busy.load(Ordering::Acquire) >= AT_ONCE {
                // Who does not wait for an answer learns nothing from a failure to give one.
                let _ = request.respond(Response::empty(503));
                continue;
            }
            busy.fetch_add(1, Ordering::AcqRel);
            let busy = &busy;
            let answer = move || {
                door.answer(session, request);
                busy.fetch_sub(1, Ordering::AcqRel);
            };
            let thread = thread::Builder::new().stack_size(STACK);
            if thread.spawn_scoped(scope, answer).is_err() {
                busy.fetch_sub(1, Ordering::AcqRel);
            }
        }
    });
}

impl Door {
    /// Answers a request. One without the token, for another host or from another page gets nothing.
    fn answer(&self, session: &Session, mut request: Request) {
        let path = self.inside(&request).map(str::to_owned);
        let Some(path) = path.filter(|_| self.is_own(&request)) else {
            let _ = request.respond(Response::empty(403));
            return;
        };
        let nonce = random().unwrap_or_default();
        let reply = match (request.method(), path.as_str()) {
            (Method::Get, "") => session.page(&nonce),
            (Method::Post, name) if Session::knows(name) => {
                let mut body = Vec::new();
                let read = request.as_reader().take(LONGEST + 1).read_to_end(&mut body);
                match read {
                    Ok(length) if length as u64 <= LONGEST => session.ask(name, &body),
                    _ => empty(413),
                }
            }
            (_, "") => empty(405),
            (_, name) if Session::knows(name) => empty(405),
            _ => empty(404),
        };
        let mut response = Response::from_data(reply.body).with_status_code(reply.status);
        for (name, value) in headers(reply.kind, &nonce) {
            if let Ok(header) = Header::from_bytes(name, value) {
                response.add_header(header);
            }
        }
        let _ = request.respond(response);
    }

    /// What follows the token in the path of a request; `None` if the token is not there.
    fn inside<'r>(&self, request: &'r Request) -> Option<&'r str> {
        let (token, path) = request.url().strip_prefix('/')?.split_once('/')?;
        is_same(token.as_bytes(), self.token.as_bytes()).then_some(path)
    }

    /// Whether a request names this computer as its host, and comes from no other page. A name that was made to lead to
    /// the loopback address is refused.
    fn is_own(&self, request: &Request) -> bool {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        let mut named = values(request, "Host");
        let host = named.next().filter(|_| named.next().is_none());
        let is_here =
            host.is_some_and(|host| hosts.iter().any(|own| host.eq_ignore_ascii_case(own)));
        let mut origins = values(request, "Origin");
        let is_own = |origin: &str| {
            let origin = origin.strip_prefix("http://");
            origin.is_some_and(|origin| hosts.iter().any(|own| origin.eq_ignore_ascii_case(own)))
        };
        is_here && origins.all(is_own)
    }
}

/// The values of a header.
fn values<'r>(request: &'r Request, name: &'static str) -> impl Iterator<Item = &'r str> {
    let headers = request
        .headers()
        .iter()
        .filter(move |header| header.field.equiv(name));
    headers.map(|header| header.value.as_str())
}

fn empty(status: u16) -> Reply {
    Reply {
        status,
        kind: "text/plain; charset=utf-8",
        body: Vec::new(),
    }
}

/// The headers of every reply. The page loads nothing, sends questions to its own server only, and is in no frame.
fn headers(kind: &str, nonce: &str) -> [(&'static str, String); 6] {
    let policy = format!(
        "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; connect-src 'self'; \
         img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    );
    [
        ("Content-Type", kind.to_owned()),
        ("Content-Security-Policy", policy),
        ("Cache-Control", "no-store".into()),
        ("X-Content-Type-Options", "nosniff".into()),
        ("Referrer-Policy", "no-referrer".into()),
        ("Cross-Origin-Resource-Policy", "same-origin".into()),
    ]
}

/// Whether two texts are the same. The time that it takes does not tell where they differ.
fn is_same(one: &[u8], other: &[u8]) -> bool {
    let pairs = one.iter().zip(other);
    one.len() == other.len() && pairs.fold(0, |all, (a, b)| all | (a ^ b)) == 0
}

/// 128 random bits as hexadecimal digits.
fn random() -> Result<String, getrandom::Error> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}
