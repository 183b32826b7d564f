//! The token in the address of a live page.

use crate::error::{Error, ErrorKind, Result};

/// 128 random bits of the operating system, as hexadecimal digits.
#[derive(Clone)]
pub(super) struct Token(String);

impl Token {
    /// Makes a token.
    ///
    /// # Errors
    /// `Usage` if the operating system has no random numbers.
    pub(super) fn random() -> Result<Self> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(|why| {
            Error::new(ErrorKind::Usage, format!("the address of the live page needs random numbers: {why}"))
                .help("leave out --live")
        })?;
        Ok(Self(bytes.iter().map(|byte| format!("{byte:02x}")).collect()))
    }

    /// The text of the token.
    pub(super) fn text(&self) -> &str {
        &self.0
    }

    /// Whether `given` is the token. The time of the comparison does not depend on where they differ.
    pub(super) fn matches(&self, given: &str) -> bool {
        let differ = self.0.bytes().zip(given.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b));
        given.len() == self.0.len() && std::hint::black_box(differ) == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_differ_and_match_themselves_only() {
        let [a, b] = [(), ()].map(|()| Token::random().unwrap());
        assert!(a.text().len() == 32 && a.text() != b.text());
        assert!(a.matches(a.text()) && !a.matches(b.text()) && !a.matches("") && !a.matches(&a.text()[..31]));
        assert!(!a.matches(&format!("{}0", a.text())));
    }
}
