//! The server of the live pages of a run.

use std::{
    io,
    net::{Ipv4Addr, TcpListener, TcpStream},
    path::Path,
    sync::{
        Arc, OnceLock,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use serde_json::{Value, json};

use super::{
    LiveState,
    http::{self, Refusal, Request},
    token::Token,
};
use crate::{
    error::{Error, ErrorKind, Result},
    output::manifest::RunStatus,
    report::{
        self,
        live::{FeedPosition, LiveRun},
    },
    run::{Control, RunOutcome, RunRequest},
};

/// Most connections at one time, with the thread that accepts them.
const MOST_CONNECTIONS: usize = 17;

/// From one event to the next, at least; and from one sign of life to the next while nothing happens.
const TICK: Duration = Duration::from_millis(250);
const SIGN_OF_LIFE: Duration = Duration::from_secs(10);

/// Longest time that the end of a run waits for its pages to hear of it.
const FAREWELL: Duration = Duration::from_secs(3);

/// The server of the live pages; clones are the same server.
#[derive(Clone)]
pub struct LiveServer(Arc<Server>);

struct Server {
    listener: TcpListener,
    port: u16,
    token: Token,
    state: Arc<LiveState>,
    /// The run, once it has begun.
    run: OnceLock<LiveRun>,
    connections: AtomicUsize,
    closed: AtomicBool,
}

impl LiveServer {
    /// Takes `port` of the loopback address, or any free one if it is 0. Nothing is answered yet.
    ///
    /// # Errors
    /// `Usage` if the port is taken or not allowed, or if there is no token.
    pub fn bind(port: u16, state: LiveState) -> Result<Self> {
        let listen = || {
            let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
            let port = listener.local_addr()?.port();
            Ok((listener, port))
        };
        let (listener, port) = listen().map_err(|why: io::Error| {
            let help = match why.kind() {
                io::ErrorKind::AddrInUse => "another program has it: choose another port, or leave it to --live alone",
                io::ErrorKind::PermissionDenied => "choose a port from 1024 on, or leave it to --live alone",
                _ => "leave the choice to --live alone, or run without it",
            };
            Error::new(ErrorKind::Usage, format!("port {port} of 127.0.0.1 cannot serve the live page: {why}"))
                .help(help)
        })?;
        let (token, state) = (Token::random()?, Arc::new(state));
        let (run, connections, closed) = Default::default();
        Ok(Self(Arc::new(Server { listener, port, token, state, run, connections, closed })))
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.0.port, self.0.token.text())
    }

    /// What the server shares with the run.
    pub(super) fn state(&self) -> Arc<LiveState> {
        self.0.state.clone()
    }

    /// Answers from now on for the run in `folder`.
    ///
    /// # Errors
    /// If no thread can be started.
    pub(super) fn serve(&self, folder: &Path) -> io::Result<()> {
        if self.0.run.set(LiveRun::new(folder)).is_err() {
            return Ok(());
        }
        // The end of the run waits for this thread too, and so for connections that it has not accepted yet.
        let place = ConnectionCount::add(self.0.clone());
        thread::Builder::new().name("live page".into()).spawn(move || place.server.accept()).map(|_| ())
    }

    /// Tells the pages how the run ended, and where its report is if it is `reported`, and stops answering.
    pub fn close(&self, outcome: &Result<RunOutcome>, reported: bool) {
        let server = &self.0;
        let report = server.run.get().map(|run| run.folder().join(report::REPORT_FILE)).filter(|path| path.exists());
        let (status, why) = match outcome {
            Ok(outcome) if outcome.manifest.status == RunStatus::Finished => ("finished", None),
            Ok(_) => ("interrupted", None),
            Err(why) => ("failed", Some(why.to_string())),
        };
        let end = json!({ "status": status, "error": why, "report": report.filter(|_| reported) });
        server.state.change(|now| now.ended = Some(end));
        server.closed.store(true, Ordering::Relaxed);
        if server.run.get().is_none() {
            return;
        }
        // The connections that wait are accepted still; the last one wakes the thread that accepts them.
        let _ = server.listener.set_nonblocking(true);
        drop(TcpStream::connect((Ipv4Addr::LOCALHOST, server.port)));
        let until = Instant::now() + FAREWELL;
        while server.connections.load(Ordering::Relaxed) > 0 && Instant::now() < until {
            thread::sleep(Duration::from_millis(10));
        }
    }
}

/// A connection, or the thread that accepts them, that counts as long as this exists.
struct ConnectionCount {
    server: Arc<Server>,
    number: usize,
}

impl ConnectionCount {
    fn add(server: Arc<Server>) -> Self {
        let number = server.connections.fetch_add(1, Ordering::Relaxed) + 1;
        Self { server, number }
    }
}

impl Drop for ConnectionCount {
    fn drop(&mut self) {
        self.server.connections.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Server {
    /// Accepts connections, each for one request in a thread of its own, until the run has ended and none waits.
    fn accept(self: &Arc<Self>) {
        loop {
            let accepted = self.listener.accept().and_then(|(stream, _)| {
                // Some systems hand the listener's mode on.
                stream.set_nonblocking(false)?;
                Ok(stream)
            });
            let Ok(mut stream) = accepted else {
                if self.closed.load(Ordering::Relaxed) {
                    return;
                }
                thread::sleep(TICK);
                continue;
            };
            let place = ConnectionCount::add(self.clone());
            if place.number > MOST_CONNECTIONS {
                let _ = http::answer(&mut stream, 503, "text/plain", "too many connections\n");
                continue;
            }
            let answer = move || {
                // Whoever does not take the answer goes without.
                let _ = place.server.converse(&mut stream);
            };
            // Without a thread the connection is closed.
            let _ = thread::Builder::new().name("live page request".into()).spawn(answer);
        }
    }

    /// Reads a request and answers it.
    fn converse(&self, stream: &mut TcpStream) -> io::Result<()> {
        let request = match Request::read(stream) {
            Ok(request) => request,
            Err(Some(refusal)) => return http::refuse(stream, &refusal),
            Err(None) => return Ok(()),
        };
        let Some(run) = self.run.get() else { return Ok(()) };
        if let Err(refusal) = self.admit(&request) {
            return http::refuse(stream, &refusal);
        }
        match (request.method.as_str(), request.path.as_str()) {
            ("GET", "/") => self.page(run, stream),
            ("GET", "/events") => self.events(run, &request, stream),
            ("POST", path) => match self.act(path, &request.body) {
                Ok(state) => http::answer(stream, 200, "application/json", &state.to_string()),
                Err(refusal) => http::refuse(stream, &refusal),
            },
            (_, "/" | "/events" | "/pause" | "/resume" | "/checkpoint" | "/set") => {
                http::refuse(stream, &Refusal(405, "this address has another method"))
            }
            _ => http::refuse(stream, &NOT_FOUND),
        }
    }

    /// Refuses a request for another host, from another origin, or without the token.
    fn admit(&self, request: &Request) -> std::result::Result<(), Refusal> {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        let host = request.header("host").unwrap_or_default();
        if !hosts.iter().any(|own| own == host) {
            return Err(Refusal(403, "this host is not served here"));
        }
        if request.header("origin").is_some_and(|origin| origin.strip_prefix("http://") != Some(host)) {
            return Err(Refusal(403, "pages of other origins may not ask"));
        }
        match request.query("token").is_some_and(|given| self.token.matches(given)) {
            true => Ok(()),
            false => Err(Refusal(403, "the token of the address is missing or wrong")),
        }
    }

    /// Answers with the page of the run so far.
    fn page(&self, run: &LiveRun, stream: &mut TcpStream) -> io::Result<()> {
        let data = {
            let now = self.state.lock();
            json!({ "state": now.to_json(), "rollbacks": now.rollbacks })
        };
        match run.page(data) {
            Ok(page) => http::answer(stream, 200, "text/html", &page),
            Err(why) => http::answer(stream, 500, "text/plain", &format!("the page cannot be made: {why}\n")),
        }
    }

    /// Sends what happens from the position on that the request names, until the run ends.
    fn events(&self, run: &LiveRun, request: &Request, stream: &mut TcpStream) -> io::Result<()> {
        let from = request.header("last-event-id").or(request.query("from")).unwrap_or_default();
        let parsed = from.split_once('.').and_then(|(n, rest)| Some((n.parse().ok()?, rest.parse().ok()?)));
        let Some((rollbacks, mut position)): Option<(usize, FeedPosition)> = parsed else {
            return http::refuse(stream, &Refusal(400, "the position in the run is missing or malformed"));
        };
        http::begin_events(stream)?;
        let (mut shown, mut sent) = (Value::Null, Instant::now());
        loop {
            let (state, count, ended) = {
                let now = self.state.lock();
                (now.to_json(), now.rollbacks, now.ended.clone())
            };
            let added = if count == rollbacks { run.increment(&mut position).map_err(io::Error::other)? } else { None };
            let id = format!("{rollbacks}.{position}");
            let Some(added) = added else { return http::send_event(stream, "reload", &id, "{}") };
            if !added.is_empty() || state != shown {
                let data = json!({ "state": state, "added": added });
                http::send_event(stream, "tick", &id, &data.to_string())?;
                (shown, sent) = (state, Instant::now());
            } else if sent.elapsed() > SIGN_OF_LIFE {
                http::send_comment(stream)?;
                sent = Instant::now();
            }
            match ended {
                _ if added.more => {}
                Some(end) => return http::send_event(stream, "end", &id, &end.to_string()),
                None => self.state.wait(TICK),
            }
        }
    }

    /// Does what a button or a control asks for, and returns the state of the run.
    fn act(&self, path: &str, body: &[u8]) -> std::result::Result<Value, Refusal> {
        let mut now = self.state.lock();
        if now.ended.is_some() {
            return Err(Refusal(409, "the run has ended"));
        }
        match path {
            "/pause" => now.paused = true,
            "/resume" => now.paused = false,
            "/checkpoint" => now.request(RunRequest::Checkpoint),
            "/set" => {
                let request = set_request(&now.controls, body)?;
                now.request(request);
            }
            _ => return Err(NOT_FOUND),
        }
        self.state.changed.notify_all();
        Ok(now.to_json())
    }
}

/// Returns what `body` asks for: an object with the `key` of a control and its `value`.
fn set_request(controls: &[Control], body: &[u8]) -> std::result::Result<RunRequest, Refusal> {
    let body: Value = serde_json::from_slice(body).map_err(|_| Refusal(400, "the body is no JSON"))?;
    let control = controls.iter().position(|control| body["key"] == control.plan.key);
    let control = control.ok_or(Refusal(400, "the scene has no such [[control]]"))?;
    let plan = &controls[control].plan;
    match body["value"].as_f64() {
        Some(value) if (plan.min..=plan.max).contains(&value) => Ok(RunRequest::Set { control, value }),
        _ => Err(Refusal(400, "the value is no number from min to max of the control")),
    }
}

const NOT_FOUND: Refusal = Refusal(404, "there is nothing here");
