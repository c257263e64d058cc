//! `serve`: a page that follows its file, for this machine alone. A plain TCP client asks.

use crate::desk::Desk;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

/// The program, serving; killed when it is dropped.
struct Served {
    child: Child,
    address: String,
    /// The path with the token.
    path: String,
}

impl Drop for Served {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn serve(desk: &Desk, words: &[&str]) -> Served {
    let mut command = Command::new(env!("CARGO_BIN_EXE_regrasp"));
    command.args(words).current_dir(desk.folder()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = command.spawn().expect("the program was built for this test");
    let mut line = String::new();
    let out = child.stdout.take().expect("it is piped");
    BufReader::new(out).read_line(&mut line).expect("the program says where it is");
    let rest = line.trim().strip_prefix("http://").unwrap_or_else(|| panic!("no address: {line}"));
    let (address, path) = rest.split_once('/').expect("a path");
    Served { child, address: address.to_owned(), path: format!("/{path}") }
}

impl Served {
    fn ask(&self, method: &str, path: &str, host: &str) -> (String, String) {
        let mut stream = TcpStream::connect(&self.address).expect("it listens");
        write!(stream, "{method} {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").expect("it reads");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("it answers");
        let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
        (head.to_owned(), body.to_owned())
    }

    fn get(&self, rest: &str) -> (String, String) {
        self.ask("GET", &format!("{}{rest}", self.path), &self.address)
    }

    /// The first state from now on that satisfies this; asks as the page does, which waits for changes.
    fn state(&self, wanted: impl Fn(&Value) -> bool) -> Value {
        let mut version = -1;
        for _ in 0..1000 {
            let (_, body) = self.get(&format!("state?after={version}"));
            let state: Value = serde_json::from_str(&body).expect("JSON");
            version = state["version"].as_i64().expect("a number");
            if state["doing"] == "" && wanted(&state) {
                return state;
            }
        }
        panic!("the state never came");
    }
}

#[test]
fn the_page_follows_its_file_and_shows_errors_at_their_line() {
    let desk = Desk::new();
    let built_in = "builtin = \"four-finger\"";
    let text = desk.run("scenarios sphere").out;
    assert!(text.contains(built_in));
    let text = text.replace(built_in, "file = \"hand.toml\"");
    desk.write("mine.toml", &text);
    desk.write("hand.toml", desk.run("scenarios four-finger").out);
    let served = serve(&desk, &["serve", "mine.toml", "--no-open"]);
    let first = served.state(|state| state["page"] == 1);
    assert_eq!(first["error"], Value::Null);
    let (head, page) = served.get("page?v=1");
    assert!(head.starts_with("HTTP/1.1 200 OK") && page.contains("id=\"data\""), "{head}");
    assert!(served.get("").1.contains("<iframe"), "the page around it");

    desk.write("mine.toml", text.replace("friction = ", "frction = "));
    let line = 1 + text.lines().position(|line| line.starts_with("friction = ")).expect("it is there");
    let wrong = served.state(|state| !state["error"].is_null());
    assert_eq!((&wrong["page"], &wrong["error"]["line"]), (&1.into(), &line.into()), "{wrong:#}");
    assert_eq!(wrong["error"]["file"], "mine.toml");
    assert!(served.get("page?v=1").1 == page, "the last page stays");

    desk.write("mine.toml", &text);
    assert_eq!(served.state(|state| state["page"] == 2)["error"], Value::Null);
    // A file that the scenario names counts, too.
    desk.write("hand.toml", desk.read("hand.toml") + "\n# a remark\n");
    served.state(|state| state["page"] == 3);
}

#[test]
fn who_does_not_know_the_token_gets_nothing() {
    let desk = Desk::new();
    let served = serve(&desk, &["serve", "sphere", "--no-open"]);
    assert!(served.address.starts_with("127.0.0.1:"), "{}", served.address);
    assert!(served.path.len() == 34 && served.path.ends_with('/'), "{}", served.path);
    let status = |method: &str, path: &str, host: &str| {
        let (head, body) = served.ask(method, path, host);
        assert!(!body.contains("<iframe") || head.contains("200 OK"));
        head.split(' ').nth(1).expect("a number").to_owned()
    };
    let (path, host) = (served.path.as_str(), served.address.as_str());
    assert_eq!(status("GET", path, host), "200");
    let guess = format!("/{}/", "0".repeat(32));
    for (method, path, host, expected) in [
        ("GET", "/", host, "404"),
        ("GET", "/page", host, "404"),
        ("GET", guess.as_str(), host, "404"),
        ("GET", &path[..path.len() - 2], host, "404"),
        ("GET", &format!("{path}../Cargo.toml"), host, "404"),
        ("POST", path, host, "405"),
        // A name elsewhere that was made to point to this machine.
        ("GET", path, "attacker.example", "403"),
        ("GET", path, "attacker.example:80", "403"),
    ] {
        assert_eq!(status(method, path, host), expected, "{method} {path} of {host}");
    }
    let (head, _) = served.get("");
    for part in
        ["Cache-Control: no-store", "Content-Security-Policy: default-src 'none'", "nosniff", "no-referrer"]
    {
        assert!(head.contains(part), "{part}: {head}");
    }
    assert!(!head.to_ascii_lowercase().contains("access-control"), "no other page may read it");
}

#[test]
fn what_is_no_request_is_refused_and_what_never_ends_is_cut() {
    let desk = Desk::new();
    let served = serve(&desk, &["serve", "sphere", "--no-open"]);
    for junk in ["hello\r\n\r\n", "\r\n\r\n", "GET\r\n\r\n", "GET / SPDY/9\r\n\r\n"] {
        let mut stream = TcpStream::connect(&served.address).expect("it listens");
        stream.write_all(junk.as_bytes()).expect("it reads");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("it answers");
        assert!(answer.starts_with("HTTP/1.1 400"), "{junk:?}: {answer}");
    }
    // A head without an end: no more than its first kilobytes are read.
    let mut stream = TcpStream::connect(&served.address).expect("it listens");
    let long = format!("GET / HTTP/1.1\r\nX: {}", "x".repeat(1 << 20));
    // The server may hang up before all of it is sent.
    let _ = stream.write_all(long.as_bytes());
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    assert!(!String::from_utf8_lossy(&answer).contains("200 OK"));
    assert!(served.get("").0.contains("200 OK"), "it still answers others");
}

#[test]
fn a_robots_file_is_shown_as_a_hand() {
    let desk = Desk::new();
    assert_eq!(desk.run("plan sphere -o plan.json").code, 0);
    assert_eq!(desk.run("export plan.json --to urdf").code, 0);
    let served = serve(&desk, &["serve", "plan.hand.urdf", "--no-open"]);
    let state = served.state(|state| state["page"] == 1 || !state["error"].is_null());
    assert_eq!(state["error"], Value::Null);
    assert!(served.get("page").1.contains("fingers"));
}
