//! The keys of a scene that the options of a command give.

use super::KeyValue;
use crate::{
    error::{Error, ErrorKind, Result},
    scene::current_key,
};

/// A key that an option gives.
struct GivenKey {
    /// The option as typed.
    option: String,
    /// Whether the option is `--set`, of which several may fill the parts of one section.
    is_set: bool,
    key: String,
    value: String,
}

/// The keys that the options of a command give, each with one value.
#[derive(Default)]
pub(super) struct GivenKeys(Vec<GivenKey>);

impl GivenKeys {
    /// The keys of `--set`.
    pub(super) fn of_set(sets: &[KeyValue]) -> Self {
        let given = |(key, value): &KeyValue| GivenKey {
            option: format!("--set {key}={value}"),
            is_set: true,
            key: key.clone(),
            value: value.clone(),
        };
        Self(sets.iter().map(given).collect())
    }

    /// These keys and `key`, to which an option gives the value `value`. `option` is its text in front of the value.
    pub(super) fn and(mut self, option: &str, key: &str, value: Option<String>) -> Self {
        let given = |value: String| GivenKey {
            option: format!("{option}{}", value.trim_matches('"')),
            is_set: false,
            key: key.into(),
            value,
        };
        self.0.extend(value.map(given));
        self
    }

    /// Returns the keys with their values.
    ///
    /// # Errors
    /// `Usage` if two options give one key different values, or if one of them replaces what the other one gives.
    pub(super) fn overrides(self) -> Result<Vec<KeyValue>> {
        for (i, later) in self.0.iter().enumerate() {
            if let Some(earlier) = self.0[..i].iter().find(|earlier| contradict(earlier, later)) {
                let what = format!("\"{}\" is given twice: {} and {}", later.key, earlier.option, later.option);
                return Err(Error::new(ErrorKind::Usage, what).help("leave one of the two out"));
            }
        }
        Ok(self.0.into_iter().map(|given| (given.key, given.value)).collect())
    }
}

/// Whether the value of one key contradicts that of the other. A later `--set` may change a part of what an earlier one gives.
fn contradict(earlier: &GivenKey, later: &GivenKey) -> bool {
    let [first, second] = [earlier, later].map(|given| current_key(&given.key));
    let is_part = |part: &str, of: &str| part.strip_prefix(of).is_some_and(|rest| rest.starts_with('.'));
    let number = |given: &GivenKey| given.value.parse::<f64>().ok();
    let plain = |given: &GivenKey| given.value.trim_matches('"').to_string();
    let is_same = plain(earlier) == plain(later) || number(earlier).is_some_and(|x| Some(x) == number(later));
    let refines = is_part(&second, &first) && !(earlier.is_set && later.is_set);
    (first == second && !is_same) || is_part(&first, &second) || refines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sets(pairs: &[(&str, &str)]) -> GivenKeys {
        let pairs: Vec<KeyValue> = pairs.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        GivenKeys::of_set(&pairs)
    }

    fn refusal(given: GivenKeys) -> String {
        given.overrides().unwrap_err().to_string()
    }

    #[test]
    fn a_key_with_two_values_is_refused_with_both_options() {
        let told = refusal(sets(&[("until", "1")]).and("--until ", "until", Some("2.0".into())));
        assert!(told.contains("\"until\" is given twice: --set until=1 and --until 2.0"), "{told}");
        assert!(told.contains("leave one of the two out"), "{told}");
        refusal(sets(&[("until", "1"), ("until", "2")]));
        // By its former name, too.
        refusal(sets(&[("scatter", "0.1"), ("jitter", "0.2")]));
        sets(&[("until", "1")]).and("--until ", "until", Some("1.0".into())).overrides().unwrap();
        assert_eq!(sets(&[("dp", "0.1")]).and("--until ", "until", None).overrides().unwrap().len(), 1);
    }

    #[test]
    fn an_option_that_replaces_a_part_of_another_is_refused() {
        refusal(sets(&[("frames", "off")]).and("--frames ", "frames.every", Some("0.1".into())));
        refusal(sets(&[("frames.every", "0.1")]).and("--frames ", "frames", Some("off".into())));
        refusal(sets(&[("frames.every", "0.1"), ("frames", "off")]));
        // The second changes a part of what the first gives.
        sets(&[("frames", "{ every = 0.1 }"), ("frames.fields", "[]")]).overrides().unwrap();
    }
}
