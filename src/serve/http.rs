//! A small server for one page on this machine: the loopback address, GET alone, and a token in the path.

use super::live::Live;
use crate::Failure;
use regrasp::api::Interrupt;
use std::collections::hash_map::RandomState;
use std::hash::{BuildHasher, Hasher};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

/// The page that holds the other: it asks for changes, and shows errors.
const SHELL: &str = include_str!("shell.html");

/// A request's head may be this long (bytes), and take this long.
const LONGEST: u64 = 16 << 10;
const PATIENCE: Duration = Duration::from_secs(5);
/// More connections at once than this are refused: a browser opens about six.
const MOST: usize = 32;
/// Between two looks for a new connection, or for the end.
const STEP: Duration = Duration::from_millis(10);

/// What pages may do: nothing that leaves this machine. They hold their scripts and styles within.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' blob: data:; style-src 'unsafe-inline'; \
    img-src data: blob:; media-src blob:; worker-src blob:; connect-src 'self' data: blob:; \
    frame-src 'self'; frame-ancestors 'self'; base-uri 'none'; form-action 'none'";

/// A listener on the loopback address.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    token: String,
}

/// What a browser asks for.
#[derive(Debug, PartialEq, Eq)]
struct Request {
    method: String,
    target: String,
    host: String,
}

impl Server {
    /// Listens on a port of the loopback address; 0 takes any that is free.
    pub fn bind(port: u16) -> Result<Self, Failure> {
        let listen = || {
            let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
            listener.set_nonblocking(true)?;
            let address = listener.local_addr()?;
            Ok(Self { listener, address, token: token() })
        };
        listen().map_err(|error: io::Error| {
            Failure::bad_input(format!("cannot listen on 127.0.0.1:{port}: {error}; give another `--port`"))
        })
    }

    /// Where the page is. Who does not know the token gets nothing.
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.token)
    }

    /// Answers until `stop` says so.
    pub fn serve(&self, live: &Live, stop: &(dyn Interrupt + Sync)) {
        let open = AtomicUsize::new(0);
        thread::scope(|scope| {
            while !stop.interrupted() {
                let Ok((stream, _)) = self.listener.accept() else {
                    thread::sleep(STEP);
                    continue;
                };
                if open.load(Ordering::Relaxed) >= MOST {
                    continue;
                }
                open.fetch_add(1, Ordering::Relaxed);
                let open = &open;
                let answer = move || {
                    // A browser that goes away is no failure.
                    let _ = self.answer(stream, live, stop);
                    open.fetch_sub(1, Ordering::Relaxed);
                };
                if thread::Builder::new().spawn_scoped(scope, answer).is_err() {
                    open.fetch_sub(1, Ordering::Relaxed);
                }
            }
        });
    }

    fn answer(&self, stream: TcpStream, live: &Live, stop: &dyn Interrupt) -> io::Result<()> {
        stream.set_nonblocking(false)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let Some(request) = read(&stream)? else {
            return reply(&stream, "400 Bad Request", "text/plain", "");
        };
        // A page elsewhere whose name was made to point here would send that name.
        let port = self.address.port();
        if ![format!("127.0.0.1:{port}"), format!("localhost:{port}")].contains(&request.host) {
            return reply(&stream, "403 Forbidden", "text/plain", "this server is for its own machine\n");
        }
        if request.method != "GET" {
            return reply(&stream, "405 Method Not Allowed", "text/plain", "");
        }
        let begin = format!("/{}/", self.token);
        let rest = request.target.get(..begin.len()).filter(|head| same(head, &begin));
        let (path, query) = match rest.map(|_| request.target[begin.len()..].split_once('?')) {
            Some(Some((path, query))) => (path, query),
            Some(None) => (&request.target[begin.len()..], ""),
            None => return reply(&stream, "404 Not Found", "text/plain", ""),
        };
        match path {
            "" => reply(&stream, "200 OK", "text/html", SHELL),
            "page" => reply(&stream, "200 OK", "text/html", &live.page()),
            "state" => {
                let after = query.strip_prefix("after=").and_then(|number| number.parse().ok());
                let state = live.state_after(after.unwrap_or(0), stop);
                reply(&stream, "200 OK", "application/json", &state.to_string())
            }
            _ => reply(&stream, "404 Not Found", "text/plain", ""),
        }
    }
}

/// Reads a request's head; `None` where it is none.
fn read(stream: &TcpStream) -> io::Result<Option<Request>> {
    let mut lines = BufReader::new(stream.take(LONGEST)).lines();
    let first = lines.next().transpose()?.unwrap_or_default();
    let mut words = first.split(' ');
    let (Some(method), Some(target), Some("HTTP/1.1" | "HTTP/1.0")) =
        (words.next(), words.next(), words.next())
    else {
        return Ok(None);
    };
    let mut host = String::new();
    for line in lines {
        let line = line?;
        if line.is_empty() {
            return Ok(Some(Request { method: method.into(), target: target.into(), host }));
        }
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("host")
        {
            host = value.trim().to_owned();
        }
    }
    Ok(None)
}

fn reply(mut stream: &TcpStream, status: &str, kind: &str, body: &str) -> io::Result<()> {
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {length}\r\n\
         Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
         Cross-Origin-Resource-Policy: same-origin\r\nContent-Security-Policy: {POLICY}\r\n\
         Connection: close\r\n\r\n{body}"
    )?;
    stream.flush()
}

/// Whether two texts are equal, in a time that does not tell where they first differ.
fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |all, (a, b)| all | (a ^ b)) == 0
}

/// 128 bits that nobody can guess, in hexadecimal: what the system's random keys make of two numbers.
fn token() -> String {
    let part = |number: u64| {
        let mut hasher = RandomState::new().build_hasher();
        hasher.write_u64(number);
        hasher.finish()
    };
    format!("{:016x}{:016x}", part(1), part(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_long_and_never_the_same() {
        let tokens = [token(), token(), token()];
        assert!(tokens.iter().all(|token| token.len() == 32));
        assert!(tokens[0] != tokens[1] && tokens[1] != tokens[2]);
        assert!(same("abc", "abc") && !same("abc", "abd") && !same("abc", "abcd"));
    }
}
