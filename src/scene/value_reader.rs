//! Deserializes the values of a scene.
//!
//! The deserializer of `toml` also reads dates and positions, so that the compiler generates the code of each type of a scene
//! three times. This deserializer reads only the kinds of values that a scene has.

use std::{borrow::Cow, fmt, ops::Range};

use serde::{
    Deserializer,
    de::{
        self, DeserializeSeed, EnumAccess, Error as _, IntoDeserializer, MapAccess, SeqAccess, Unexpected,
        VariantAccess, Visitor, value::CowStrDeserializer,
    },
    forward_to_deserialize_any,
};
use toml::{
    Spanned,
    de::{DeArray, DeTable, DeValue},
};

/// Why a value could not be read, and the bytes of the text that it concerns.
#[derive(Debug)]
pub(super) struct ReadError {
    /// What is wrong, in the words of serde.
    pub message: String,
    /// Where the key or the value was written.
    pub span: Option<Range<usize>>,
}

impl ReadError {
    /// The error at `span`, unless it has a place already.
    fn at(mut self, span: &Range<usize>) -> Self {
        self.span.get_or_insert_with(|| span.clone());
        self
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ReadError {}

impl de::Error for ReadError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { message: message.to_string(), span: None }
    }
}

/// One value and its place in the text.
pub(super) struct ValueReader<'de> {
    value: DeValue<'de>,
    span: Range<usize>,
}

impl<'de> From<Spanned<DeTable<'de>>> for ValueReader<'de> {
    fn from(root: Spanned<DeTable<'de>>) -> Self {
        Self { span: root.span(), value: DeValue::Table(root.into_inner()) }
    }
}

impl<'de> From<Spanned<DeValue<'de>>> for ValueReader<'de> {
    fn from(value: Spanned<DeValue<'de>>) -> Self {
        Self { span: value.span(), value: value.into_inner() }
    }
}

impl<'de> ValueReader<'de> {
    fn visit<V: Visitor<'de>>(value: DeValue<'de>, visitor: V) -> Result<V::Value, ReadError> {
        match value {
            DeValue::String(Cow::Owned(text)) => visitor.visit_string(text),
            DeValue::String(Cow::Borrowed(text)) => visitor.visit_borrowed_str(text),
            DeValue::Integer(number) => {
                let (text, radix) = (number.as_str(), number.radix());
                match (i64::from_str_radix(text, radix), u64::from_str_radix(text, radix)) {
                    (Ok(number), _) => visitor.visit_i64(number),
                    (_, Ok(number)) => visitor.visit_u64(number),
                    _ => Err(ReadError::custom("integer number overflowed")),
                }
            }
            DeValue::Float(number) => match number.as_str().parse() {
                Ok(number) => visitor.visit_f64(number),
                Err(_) => Err(ReadError::custom("not a number")),
            },
            DeValue::Boolean(truth) => visitor.visit_bool(truth),
            DeValue::Datetime(_) => Err(ReadError::invalid_type(Unexpected::Other("a date"), &visitor)),
            DeValue::Array(items) => visitor.visit_seq(Items(items.into_iter())),
            DeValue::Table(table) => visitor.visit_map(Entries { entries: table.into_iter(), value: None }),
        }
    }
}

impl<'de> Deserializer<'de> for ValueReader<'de> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        Self::visit(self.value, visitor).map_err(|e| e.at(&self.span))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let choice = match self.value {
            DeValue::String(word) => Ok(Choice { word: Spanned::new(self.span.clone(), word), value: None }),
            DeValue::Table(table) if table.len() == 1 => {
                let entry = table.into_iter().next();
                let choice = entry.map(|(word, value)| Choice { word, value: Some(value.into()) });
                choice.ok_or_else(|| ReadError::custom("wanted exactly 1 element, found 0 elements"))
            }
            DeValue::Table(_) => Err(ReadError::custom("wanted exactly 1 element")),
            other => Err(ReadError::invalid_type(unexpected(&other), &"a word, or a table with one key")),
        };
        choice.and_then(|choice| visitor.visit_enum(choice)).map_err(|e| e.at(&self.span))
    }

    /// A derived visitor would also take a list of the fields, in their order and without their names. Only a place may be written as
    /// the list of its coordinates.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        match &self.value {
            DeValue::Array(_) if name != "PlacementConfig" => {
                Err(ReadError::invalid_type(Unexpected::Seq, &visitor).at(&self.span))
            }
            DeValue::Array(items) if !(2..=3).contains(&items.len()) => {
                let what = format!("a place is a list of 2 numbers in 2-D and of 3 in 3-D, not of {}", items.len());
                Err(ReadError::custom(what).at(&self.span))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    /// A derived visitor would leave out what follows the last of its items.
    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value, ReadError> {
        match &self.value {
            DeValue::Array(items) if items.len() > len => {
                Err(ReadError::invalid_length(items.len(), &visitor).at(&self.span))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple_struct map
        identifier ignored_any
    }
}

/// The items of a list.
struct Items<'de>(<DeArray<'de> as IntoIterator>::IntoIter);

impl<'de> SeqAccess<'de> for Items<'de> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, ReadError> {
        self.0.next().map(|item| seed.deserialize(ValueReader::from(item))).transpose()
    }
}

/// The entries of a table.
struct Entries<'de> {
    entries: <DeTable<'de> as IntoIterator>::IntoIter,
    /// The value of the key that was read last.
    value: Option<Spanned<DeValue<'de>>>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        let Some((key, value)) = self.entries.next() else { return Ok(None) };
        self.value = Some(value);
        read_word(seed, key).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        let value = self.value.take().ok_or_else(|| ReadError::custom("a value was read before its key"))?;
        let span = value.span();
        seed.deserialize(ValueReader::from(value)).map_err(|e| e.at(&span))
    }
}

/// A choice by its word, with a value if it is written as a table.
struct Choice<'de> {
    word: Spanned<Cow<'de, str>>,
    value: Option<ValueReader<'de>>,
}

impl<'de> EnumAccess<'de> for Choice<'de> {
    type Error = ReadError;
    type Variant = ChosenValue<'de>;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, ChosenValue<'de>), ReadError> {
        Ok((read_word(seed, self.word)?, ChosenValue(self.value)))
    }
}

/// The value of a choice.
struct ChosenValue<'de>(Option<ValueReader<'de>>);

impl<'de> ChosenValue<'de> {
    /// The value, which must be there.
    fn given(self, expected: &str) -> Result<ValueReader<'de>, ReadError> {
        self.0.ok_or_else(|| ReadError::invalid_type(Unexpected::UnitVariant, &expected))
    }
}

impl<'de> VariantAccess<'de> for ChosenValue<'de> {
    type Error = ReadError;

    fn unit_variant(self) -> Result<(), ReadError> {
        match self.0 {
            None => Ok(()),
            Some(ValueReader { value: DeValue::Table(table), .. }) if table.is_empty() => Ok(()),
            Some(ValueReader { span, .. }) => Err(ReadError::custom("expected empty table").at(&span)),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, ReadError> {
        seed.deserialize(self.given("newtype variant")?)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _len: usize, visitor: V) -> Result<V::Value, ReadError> {
        self.given("tuple variant")?.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let value = self.given("struct variant")?;
        if let DeValue::Table(table) = &value.value
            && let Some(key) = table.keys().find(|key| !fields.contains(&key.get_ref().as_ref()))
        {
            return Err(ReadError::unknown_field(key.get_ref(), fields).at(&key.span()));
        }
        value.deserialize_struct("", fields, visitor)
    }
}

/// Returns the description of a value that is neither a word nor a table.
fn unexpected<'a>(value: &'a DeValue) -> Unexpected<'a> {
    match value {
        DeValue::Integer(number) => Unexpected::Other(number.as_str()),
        DeValue::Float(number) => Unexpected::Other(number.as_str()),
        DeValue::Boolean(truth) => Unexpected::Bool(*truth),
        DeValue::Array(_) => Unexpected::Seq,
        DeValue::Datetime(_) => Unexpected::Other("a date"),
        DeValue::String(word) => Unexpected::Str(word),
        DeValue::Table(_) => Unexpected::Map,
    }
}

/// Reads the name of a key or of a choice.
fn read_word<'de, S: DeserializeSeed<'de>>(seed: S, word: Spanned<Cow<'de, str>>) -> Result<S::Value, ReadError> {
    let span = word.span();
    let reader: CowStrDeserializer<'de, ReadError> = word.into_inner().into_deserializer();
    seed.deserialize(reader).map_err(|e| e.at(&span))
}
