//! The small part of HTTP/1.1 that a live page needs: one request for each connection, with limits on size and time.

use std::{
    io::{self, Read, Write},
    net::{Shutdown, TcpStream},
    time::{Duration, Instant},
};

/// Largest head and largest body of a request, bytes.
const MOST_HEAD: usize = 8 << 10;
const MOST_BODY: usize = 4 << 10;

/// Longest time for a request to arrive, and for a part of an answer to be taken.
const ARRIVAL: Duration = Duration::from_secs(5);
const TAKING: Duration = Duration::from_secs(10);

/// Most bytes that are read of a refused request, so that its sender gets the answer, and the longest time for that.
const LEFT_OVER: u64 = 64 << 10;
const LEFT_OVER_TIME: Duration = Duration::from_millis(200);

/// Header lines of every answer. The page is one file with its scripts inside, and asks its own origin only.
const HEADERS: &str = "Cache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\nX-Frame-Options: DENY\r\n\
    Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
    img-src data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\
    Connection: close\r\n";

/// A request.
#[derive(Debug, PartialEq)]
pub(super) struct Request {
    pub(super) method: String,
    /// The path without the query.
    pub(super) path: String,
    query: String,
    headers: Vec<(String, String)>,
    pub(super) body: Vec<u8>,
}

/// Why a request is refused: the status and a reason for the reader.
#[derive(Debug, PartialEq)]
pub(super) struct Refusal(pub(super) u16, pub(super) &'static str);

impl Request {
    /// Reads a request.
    ///
    /// # Errors
    /// A refusal if it is too large, too slow, or no HTTP; `None` if the other side is gone.
    pub(super) fn read(stream: &mut TcpStream) -> Result<Self, Option<Refusal>> {
        let until = Instant::now() + ARRIVAL;
        let mut bytes = Vec::new();
        let end = loop {
            if let Some(end) = bytes.windows(4).position(|four| four == b"\r\n\r\n") {
                break end;
            }
            if bytes.len() > MOST_HEAD {
                return Err(Some(Refusal(431, "the head of the request is too large")));
            }
            read_some(stream, until, &mut bytes)?;
        };
        let malformed = || Some(Refusal(400, "this is no HTTP request"));
        if end > MOST_HEAD {
            return Err(Some(Refusal(431, "the head of the request is too large")));
        }
        let head = std::str::from_utf8(&bytes[..end]).map_err(|_| malformed())?;
        let mut request = Self::parse(head).ok_or_else(malformed)?;
        if request.header("transfer-encoding").is_some() {
            return Err(Some(Refusal(411, "the body needs a Content-Length")));
        }
        let length = request.header("content-length").map_or(Ok(0), str::parse).map_err(|_| malformed())?;
        if length > MOST_BODY {
            return Err(Some(Refusal(413, "the body of the request is too large")));
        }
        request.body = bytes.split_off(end + 4);
        while request.body.len() < length {
            read_some(stream, until, &mut request.body)?;
        }
        request.body.truncate(length);
        Ok(request)
    }

    /// Parses the head of a request.
    fn parse(head: &str) -> Option<Self> {
        let mut lines = head.split("\r\n");
        let mut first = lines.next()?.split(' ');
        let (method, target, version) = (first.next()?, first.next()?, first.next()?);
        if first.next().is_some() || !target.starts_with('/') || !["HTTP/1.1", "HTTP/1.0"].contains(&version) {
            return None;
        }
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let header = |line: &str| {
            let (name, value) = line.split_once(':')?;
            let is_name = !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b"-_".contains(&b));
            is_name.then(|| (name.to_ascii_lowercase(), value.trim().to_string()))
        };
        let headers: Vec<_> = lines.map(header).collect::<Option<_>>()?;
        let hosts = headers.iter().filter(|(name, _)| name == "host").count();
        let [method, path, query] = [method, path, query].map(String::from);
        (hosts == 1).then_some(Self { method, path, query, headers, body: Vec::new() })
    }

    /// The value of the header `name`, in lower case.
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The value of `name` in the query. Values of this server need no escapes.
    pub(super) fn query(&self, name: &str) -> Option<&str> {
        self.query.split('&').find_map(|pair| pair.split_once('=').filter(|(known, _)| *known == name)).map(|(_, x)| x)
    }
}

/// Appends what has arrived to `bytes`; waits for it at most `until` then.
fn read_some(stream: &mut TcpStream, until: Instant, bytes: &mut Vec<u8>) -> Result<(), Option<Refusal>> {
    let left = until.saturating_duration_since(Instant::now());
    let mut part = [0; 1024];
    let read = match left.is_zero() {
        true => Err(io::ErrorKind::TimedOut.into()),
        false => stream.set_read_timeout(Some(left)).and_then(|()| stream.read(&mut part)),
    };
    match read {
        Ok(0) => Err(None),
        Ok(n) => {
            bytes.extend_from_slice(&part[..n]);
            Ok(())
        }
        Err(why) if why.kind() == io::ErrorKind::Interrupted => Ok(()),
        Err(why) if matches!(why.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
            Err(Some(Refusal(408, "the request took too long")))
        }
        Err(_) => Err(None),
    }
}

/// Answers with a status and a text of a `kind`, such as `text/html`.
///
/// # Errors
/// If the other side does not take it in time.
pub(super) fn answer(stream: &mut TcpStream, status: u16, kind: &str, text: &str) -> io::Result<()> {
    let head = format!(
        "HTTP/1.1 {status} {}\r\n{HEADERS}Content-Type: {kind}; charset=utf-8\r\nContent-Length: {}\r\n\r\n",
        reason(status),
        text.len()
    );
    stream.set_write_timeout(Some(TAKING))?;
    stream.write_all(head.as_bytes())?;
    stream.write_all(text.as_bytes())
}

/// Answers with a refusal, and reads a little of what is left of the request.
///
/// # Errors
/// As [`answer`].
pub(super) fn refuse(stream: &mut TcpStream, Refusal(status, why): &Refusal) -> io::Result<()> {
    answer(stream, *status, "text/plain", &format!("{why}\n"))?;
    stream.shutdown(Shutdown::Write)?;
    stream.set_read_timeout(Some(LEFT_OVER_TIME))?;
    io::copy(&mut stream.take(LEFT_OVER), &mut io::sink()).map(|_| ())
}

/// Begins a stream of events.
///
/// # Errors
/// As [`answer`].
pub(super) fn begin_events(stream: &mut TcpStream) -> io::Result<()> {
    stream.set_write_timeout(Some(TAKING))?;
    let head = format!("HTTP/1.1 200 OK\r\n{HEADERS}Content-Type: text/event-stream\r\n\r\nretry: 1000\n\n");
    stream.write_all(head.as_bytes())
}

/// Sends an event with the identifier `id`, by which a browser goes on after an interruption.
///
/// # Errors
/// As [`answer`].
pub(super) fn send_event(stream: &mut TcpStream, kind: &str, id: &str, data: &str) -> io::Result<()> {
    stream.write_all(format!("event: {kind}\nid: {id}\ndata: {data}\n\n").as_bytes())
}

/// Sends a comment, so that both sides know that the other is there.
///
/// # Errors
/// As [`answer`].
pub(super) fn send_comment(stream: &mut TcpStream) -> io::Result<()> {
    stream.write_all(b":\n\n")
}

fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        409 => "Conflict",
        411 => "Length Required",
        413 => "Content Too Large",
        431 => "Request Header Fields Too Large",
        503 => "Service Unavailable",
        _ => "Internal Server Error",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_is_parsed_and_a_malformed_one_is_none() {
        let head = "POST /pause?token=ab&from=1.2 HTTP/1.1\r\nHost: 127.0.0.1:80\r\nOrigin:  http://x ";
        let request = Request::parse(head).unwrap();
        assert_eq!((request.method.as_str(), request.path.as_str()), ("POST", "/pause"));
        assert_eq!(
            [request.query("token"), request.query("from"), request.query("x")],
            [Some("ab"), Some("1.2"), None]
        );
        assert_eq!([request.header("host"), request.header("origin")], [Some("127.0.0.1:80"), Some("http://x")]);
        let malformed = [
            "",
            "GET /",
            "GET / HTTP/2\r\nHost: a",
            "GET http://a/ HTTP/1.1\r\nHost: a",
            "GET / HTTP/1.1",
            "GET / HTTP/1.1\r\nHost: a\r\nHost: b",
            "GET / HTTP/1.1\r\nHost: a\r\n folded",
        ];
        assert!(malformed.iter().all(|head| Request::parse(head).is_none()));
    }
}
