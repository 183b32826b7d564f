//! VTK's XML files of unstructured grids (.vtu): points with their fields, and cells.
//!
//! The writer appends all arrays as raw bytes, compressed by zlib. The reader accepts these files, and files of earlier
//! program versions, in which each element contains its compressed array in base 64.

use std::{
    io::{self, Cursor, Read, Seek, SeekFrom, Write},
    ops::Range,
};

use flate2::{Compression, read::ZlibDecoder, write::ZlibEncoder};
use roxmltree::{Document, Node};

use super::base64;

/// Uncompressed size of a block, bytes; each block is compressed separately.
const BLOCK: usize = 1 << 16;

/// VTK's number of a cell that is one point.
const VERTEX: u8 = 1;

/// Name of the array with the coordinates of the points.
const POINTS: &str = "Points";

/// Name of the array with the points of the cells.
const CONNECTIVITY: &str = "connectivity";

/// First bytes of the element that precedes the appended arrays.
const APPENDED: &[u8] = b"<AppendedData";

/// Text between the description of the grid and its arrays.
const START: &str = "<AppendedData encoding=\"raw\">\n_";

/// Text after the arrays.
const END: &[u8] = b"\n</AppendedData>\n</VTKFile>\n";

/// The values of an array.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Values {
    /// Single precision.
    F32(Vec<f32>),
    /// Unsigned integers.
    U32(Vec<u32>),
    /// Signed integers.
    I64(Vec<i64>),
    /// Bytes.
    U8(Vec<u8>),
}

/// An array with its name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DataArray {
    /// Name of the array, without characters that XML reserves.
    pub name: String,
    /// Number of components per point or cell.
    pub components: usize,
    /// All values, point by point.
    pub values: Values,
}

/// Uses the pieces of an array in order.
type PieceUser<'u> = &'u mut dyn FnMut(&Values);

/// An array that is written a piece at a time, so that no more of it is in memory.
pub(crate) struct ArrayPieces<'a> {
    name: String,
    components: usize,
    /// No values of the type of the array.
    kind: Values,
    /// Number of values.
    count: usize,
    /// Gives the pieces in order.
    give: Box<dyn FnOnce(PieceUser<'_>) + 'a>,
}

/// Cells of one type.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cells {
    /// Indices of the points of each cell, cell by cell.
    pub connectivity: Vec<i64>,
    /// Number of points per cell.
    pub points_per_cell: usize,
    /// VTK's number of the cell type: 1 is a vertex, 5 is a triangle.
    pub cell_type: u8,
}

impl DataArray {
    /// Makes an array of single precision.
    pub(crate) fn new(name: &str, components: usize, values: Vec<f32>) -> Self {
        Self { name: name.into(), components, values: Values::F32(values) }
    }
}

impl<'a> ArrayPieces<'a> {
    /// An array of `count` values of the type of `kind`, with `components` per point or cell. `give` gives the pieces in order.
    pub(crate) fn new(
        (name, components): (&str, usize),
        (kind, count): (Values, usize),
        give: impl FnOnce(PieceUser<'_>) + 'a,
    ) -> Self {
        Self { name: name.into(), components, kind, count, give: Box::new(give) }
    }

    /// The beginning of the XML element, to which the offset of the values is appended.
    fn element(&self) -> String {
        // The format's default is one component; meshio turns an array that states this number into a column.
        let components = match self.components {
            1 => String::new(),
            components => format!(" NumberOfComponents=\"{components}\""),
        };
        let (name, kind) = (&self.name, self.kind.type_name());
        format!("<DataArray type=\"{kind}\" Name=\"{name}\"{components} format=\"appended\" offset=\"")
    }

    /// An array with one value for each cell or point of `count`: `of` gives those of a range.
    pub(crate) fn computed(name: &str, kind: Values, count: usize, of: impl Fn(Range<usize>) -> Values + 'a) -> Self {
        let piece = BLOCK / kind.size();
        Self::new((name, 1), (kind, count), move |use_piece| {
            for start in (0..count).step_by(piece) {
                use_piece(&of(start..count.min(start + piece)));
            }
        })
    }
}

impl From<DataArray> for ArrayPieces<'_> {
    fn from(DataArray { name, components, values }: DataArray) -> Self {
        Self::new((&name, components), (values.none(), values.len()), move |use_piece| use_piece(&values))
    }
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::F32(x) => x.len(),
            Self::U32(x) => x.len(),
            Self::I64(x) => x.len(),
            Self::U8(x) => x.len(),
        }
    }

    fn type_name(&self) -> &'static str {
        match self {
            Self::F32(_) => "Float32",
            Self::U32(_) => "UInt32",
            Self::I64(_) => "Int64",
            Self::U8(_) => "UInt8",
        }
    }

    /// No values of the same type.
    fn none(&self) -> Self {
        match self {
            Self::F32(_) => Self::F32(Vec::new()),
            Self::U32(_) => Self::U32(Vec::new()),
            Self::I64(_) => Self::I64(Vec::new()),
            Self::U8(_) => Self::U8(Vec::new()),
        }
    }

    /// Size of a value, B.
    fn size(&self) -> usize {
        match self {
            Self::F32(_) | Self::U32(_) => 4,
            Self::I64(_) => 8,
            Self::U8(_) => 1,
        }
    }

    /// Adds the values to an array in compressed form.
    fn add_to(&self, blocks: &mut Blocks<impl Write>) {
        match self {
            Self::F32(x) => x.iter().for_each(|x| blocks.add(x.to_le_bytes())),
            Self::U32(x) => x.iter().for_each(|x| blocks.add(x.to_le_bytes())),
            Self::I64(x) => x.iter().for_each(|x| blocks.add(x.to_le_bytes())),
            Self::U8(x) => x.iter().for_each(|x| blocks.add([*x])),
        }
    }

    /// Reads the values of the type that VTK calls `type_name` from little-endian `bytes`.
    fn from_bytes(type_name: &str, bytes: &[u8]) -> Result<Self, String> {
        match type_name {
            "Float32" => numbers(bytes, f32::from_le_bytes).map(Self::F32),
            "UInt32" => numbers(bytes, u32::from_le_bytes).map(Self::U32),
            "Int64" | "UInt64" => numbers(bytes, i64::from_le_bytes).map(Self::I64),
            "UInt8" => Some(Self::U8(bytes.to_vec())),
            other => return Err(format!("it has an array of {other}")),
        }
        .ok_or_else(|| "an array ends within a number".into())
    }
}

/// Returns the numbers in `bytes`, or `None` if the last number is incomplete.
fn numbers<T, const N: usize>(bytes: &[u8], of: fn([u8; N]) -> T) -> Option<Vec<T>> {
    let (whole, rest) = bytes.as_chunks::<N>();
    rest.is_empty().then(|| whole.iter().map(|bytes| of(*bytes)).collect())
}

/// The compressed blocks of an array.
struct Blocks<W> {
    file: W,
    /// Bytes of a block that is not full yet.
    raw: Vec<u8>,
    /// The last block in compressed form.
    compressed: Vec<u8>,
    /// Compressed size of each block, B.
    sizes: Vec<usize>,
    outcome: io::Result<()>,
}

impl<W: Write> Blocks<W> {
    /// Adds the bytes of a value; blocks have a whole number of values.
    fn add<const N: usize>(&mut self, bytes: [u8; N]) {
        self.raw.extend(bytes);
        if self.raw.len() == BLOCK {
            self.close();
        }
    }

    /// Compresses the bytes gathered and writes them, unless an error came before.
    fn close(&mut self) {
        self.compressed.clear();
        let mut encoder = ZlibEncoder::new(&mut self.compressed, Compression::fast());
        let compressed = encoder.write_all(&self.raw).and_then(|()| encoder.finish().map(drop));
        if self.outcome.is_ok() {
            self.outcome = compressed.and_then(|()| self.file.write_all(&self.compressed));
        }
        self.sizes.push(self.compressed.len());
        self.raw.clear();
    }
}

/// Writes a header and the compressed blocks of `array`; returns their size, B. Takes all values, even after an error. Header of
/// 64-bit entries: number of blocks, bytes per block, bytes of an incomplete last block or 0, and compressed bytes of each block.
fn append_blocks(array: ArrayPieces<'_>, file: &mut (impl Write + Seek)) -> io::Result<u64> {
    let bytes = array.count * array.kind.size();
    let header = [bytes.div_ceil(BLOCK), BLOCK, bytes % BLOCK];
    let header_size = (header.len() + header[0]) * 8;
    // The sizes of the blocks are known after them.
    let outcome = file.seek_relative(header_size as i64);
    let (raw, compressed) = (Vec::with_capacity(BLOCK), Vec::with_capacity(BLOCK));
    let mut blocks = Blocks { file: &mut *file, raw, compressed, sizes: Vec::new(), outcome };
    (array.give)(&mut |piece| piece.add_to(&mut blocks));
    if !blocks.raw.is_empty() {
        blocks.close();
    }
    let Blocks { sizes, outcome, .. } = blocks;
    outcome?;
    let blocks_size = sizes.iter().sum::<usize>();
    file.seek_relative(-((header_size + blocks_size) as i64))?;
    let words: Vec<u8> = header.iter().chain(&sizes).flat_map(|word| (*word as u64).to_le_bytes()).collect();
    file.write_all(&words)?;
    file.seek_relative(blocks_size as i64)?;
    Ok((header_size + blocks_size) as u64)
}

/// Returns the file of a grid: `points` with three coordinates each (m), `cells`, and fields of the points.
///
/// # Errors
/// Errors of the compression only, which writes to memory.
pub(crate) fn write(points: Vec<f32>, cells: Cells, fields: Vec<DataArray>) -> io::Result<Vec<u8>> {
    let Cells { connectivity, points_per_cell, cell_type } = cells;
    let connectivity = DataArray { name: CONNECTIVITY.into(), components: 1, values: Values::I64(connectivity) };
    let points = DataArray::new(POINTS, 3, points).into();
    let fields = fields.into_iter().map(ArrayPieces::from).collect();
    let mut file = Cursor::new(Vec::new());
    write_grid(&mut file, points, (connectivity.into(), points_per_cell, cell_type), fields)?;
    Ok(file.into_inner())
}

/// Writes the `file` of a grid with a vertex at each of the `points`, three coordinates each (m), and fields of the points, block
/// by block. Returns its size, B.
///
/// # Errors
/// Errors of the file. All values are taken first, because the other ranks send theirs in any case.
pub(crate) fn write_vertices<'a>(
    file: &mut (impl Write + Seek),
    count: usize,
    points: impl FnOnce(PieceUser<'_>) + 'a,
    fields: Vec<ArrayPieces<'a>>,
) -> io::Result<u64> {
    let points = ArrayPieces::new((POINTS, 3), (Values::F32(Vec::new()), 3 * count), points);
    let numbers = |range: Range<usize>| Values::I64(range.map(|i| i as i64).collect());
    let connectivity = ArrayPieces::computed(CONNECTIVITY, Values::I64(Vec::new()), count, numbers);
    write_grid(file, points, (connectivity, 1, VERTEX), fields)
}

/// Writes the `file` of a grid: `points`, the points of each cell and their number, the type of the cells, and fields of the
/// points. Returns its size, B.
fn write_grid(
    file: &mut (impl Write + Seek),
    points: ArrayPieces<'_>,
    (connectivity, points_per_cell, cell_type): (ArrayPieces<'_>, usize, u8),
    fields: Vec<ArrayPieces<'_>>,
) -> io::Result<u64> {
    let (point_count, cell_count) = (points.count / 3, connectivity.count / points_per_cell);
    let name_of =
        |components: usize| fields.iter().find(|field| field.components == components).map(|field| &field.name);
    // ParaView and similar readers display these fields by default.
    let shown = [("Scalars", name_of(1)), ("Vectors", name_of(3))];
    let shown = shown.into_iter().filter_map(|(kind, name)| Some(format!(" {kind}=\"{}\"", name?)));
    let beginning = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{point_count}\" NumberOfCells=\"{cell_count}\">\n<PointData{}>\n",
        shown.collect::<String>()
    );
    let offset = |range: Range<usize>| Values::I64(range.map(|i| ((i + 1) * points_per_cell) as i64).collect());
    let kind = |range: Range<usize>| Values::U8(vec![cell_type; range.len()]);
    let offsets_of_cells = ArrayPieces::computed("offsets", Values::I64(Vec::new()), cell_count, offset);
    let types = ArrayPieces::computed("types", Values::U8(Vec::new()), cell_count, kind);
    let field_count = fields.len();
    let arrays: Vec<_> = fields.into_iter().chain([points, connectivity, offsets_of_cells, types]).collect();
    let elements: Vec<String> = arrays.iter().map(ArrayPieces::element).collect();
    let text = |offsets: &[u64]| {
        let elements: Vec<String> =
            elements.iter().zip(offsets).map(|(element, offset)| format!("{element}{offset}\"/>\n")).collect();
        let (fields, rest) = elements.split_at(field_count);
        let (points, cells) = rest.split_at(1);
        let [fields, points, cells] = [fields, points, cells].map(<[String]>::concat);
        format!(
            "{beginning}{fields}</PointData>\n<Points>\n{points}</Points>\n<Cells>\n{cells}</Cells>\n</Piece>\n</UnstructuredGrid>\n"
        )
    };
    // The offsets are known only after the arrays: blanks pad the description to its length with the largest offsets.
    let space = text(&vec![u64::MAX; arrays.len()]).len();
    let start = (space + START.len()) as u64;
    let mut outcome = file.seek(SeekFrom::Start(start)).map(drop);
    // The data of the last element come first: meshio 5.3 reads wrong offsets if the arrays are in the order of their
    // elements.
    let (mut size, mut offsets) = (0, vec![0; arrays.len()]);
    for (offset, array) in offsets.iter_mut().zip(arrays).rev() {
        *offset = size;
        outcome = outcome.and(append_blocks(array, file).map(|bytes| size += bytes));
    }
    outcome?;
    file.write_all(END)?;
    file.seek(SeekFrom::Start(0))?;
    write!(file, "{:space$}{START}", text(&offsets))?;
    Ok(start + size + END.len() as u64)
}

/// Returns the coordinates of the points in a `file`, three for each point, and the fields of the points. The function
/// does not read cells.
///
/// # Errors
/// The reason, if `file` is not a complete file of this program.
pub(crate) fn read_points(file: &[u8]) -> Result<(Vec<f32>, Vec<DataArray>), String> {
    let (mut points, mut fields) = (None, Vec::new());
    for (parent, array) in read_arrays(file, &["Points", "PointData"])? {
        match (parent.as_str(), array) {
            ("Points", DataArray { components: 3, values: Values::F32(x), .. }) => points = Some(x),
            ("Points", _) => return Err("its points have not three coordinates in single precision".into()),
            (_, field) => fields.push(field),
        }
    }
    Ok((points.ok_or("it has no points")?, fields))
}

/// Returns the points of all cells in a .vtu `file`, cell by cell.
pub(crate) fn read_connectivity(file: &[u8]) -> Result<Vec<i64>, String> {
    let arrays = read_arrays(file, &["Cells"])?.into_iter();
    let mut cells = arrays.filter_map(|(_, array)| match array {
        DataArray { name, values: Values::I64(points), .. } if name == "connectivity" => Some(points),
        _ => None,
    });
    cells.next().ok_or_else(|| "it has no cells".into())
}

/// Returns the arrays in the elements of a `file` with a name in `parents`, each with the name of its element.
fn read_arrays(file: &[u8], parents: &[&str]) -> Result<Vec<(String, DataArray)>, String> {
    let (text, appended) = split(file)?;
    let document = Document::parse(&text).map_err(|why| why.to_string())?;
    let root = document.root_element();
    let says = |name: &str, value: &str| root.attribute(name) == Some(value);
    if !root.has_tag_name("VTKFile") || !says("type", "UnstructuredGrid") {
        return Err("it is no unstructured grid of VTK".into());
    }
    if !says("byte_order", "LittleEndian") || !says("compressor", "vtkZLibDataCompressor") {
        return Err("its arrays are not little-endian and compressed by zlib".into());
    }
    let word = if says("header_type", "UInt64") { 8 } else { 4 };
    let piece = root.descendants().find(|node| node.has_tag_name("Piece")).ok_or("it has no piece")?;
    let points: usize = attribute(piece, "NumberOfPoints")?;
    let mut arrays = Vec::new();
    for parent in piece.children().filter(|node| parents.contains(&node.tag_name().name())) {
        for node in parent.children().filter(|node| node.has_tag_name("DataArray")) {
            let name = node.attribute("Name").unwrap_or_default().to_string();
            let components =
                node.attribute("NumberOfComponents").map_or(Ok(1), |_| attribute(node, "NumberOfComponents"))?;
            let bytes = match node.attribute("format") {
                Some("appended") => {
                    let from = attribute::<usize>(node, "offset")?;
                    decompress(appended.get(from..).unwrap_or_default(), word)
                }
                Some("binary") => from_text(node.text().unwrap_or_default(), word)
                    .and_then(|(header, blocks)| decompress(&[header, blocks].concat(), word)),
                _ => None,
            };
            let bytes = bytes.ok_or_else(|| format!("the array \"{name}\" is damaged"))?;
            let values = Values::from_bytes(node.attribute("type").unwrap_or_default(), &bytes)?;
            if parent.tag_name().name() != "Cells" && Some(values.len()) != points.checked_mul(components) {
                return Err(format!("the array \"{name}\" has not {components} numbers for each of {points} points"));
            }
            arrays.push((parent.tag_name().name().to_string(), DataArray { name, components, values }));
        }
    }
    Ok(arrays)
}

/// Divides a `file` into its XML without the appended arrays, and the appended arrays.
fn split(file: &[u8]) -> Result<(String, &[u8]), String> {
    let cut = || "it is cut short".to_string();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).map_err(|_| "it is no text".to_string());
    let body = file.trim_ascii_end().strip_suffix(b"</VTKFile>").ok_or_else(cut)?;
    let Some(from) = body.windows(APPENDED.len()).position(|bytes| bytes == APPENDED) else {
        return Ok((text(file)?, &[]));
    };
    let tag = body[from..].iter().position(|byte| *byte == b'>').map_or(body.len(), |end| from + end + 1);
    if !body[from..tag].ends_with(b"encoding=\"raw\">") {
        return Err("its appended arrays are not raw bytes".into());
    }
    let data = body[tag..].trim_ascii_start().strip_prefix(b"_").ok_or_else(cut)?;
    let data = data.trim_ascii_end().strip_suffix(b"</AppendedData>").ok_or_else(cut)?;
    Ok((text(&body[..from])? + "</VTKFile>", data))
}

/// Returns an attribute that is a number.
fn attribute<T: std::str::FromStr>(node: Node<'_, '_>, name: &str) -> Result<T, String> {
    let number = node.attribute(name).and_then(|text| text.parse().ok());
    number.ok_or_else(|| format!("{name} of {} is no number", node.tag_name().name()))
}

/// Returns the header and the blocks of an array in base 64, which are encoded one after the other. Header entries have
/// `word` bytes.
fn from_text(text: &str, word: usize) -> Option<(Vec<u8>, Vec<u8>)> {
    let text = text.trim().as_bytes();
    // Eight bytes need twelve base-64 digits.
    let blocks = header_words(&base64::decode(text.get(..12)?)?, word).next()?;
    let digits = blocks.checked_add(3)?.checked_mul(word)?.div_ceil(3).checked_mul(4)?;
    Some((base64::decode(text.get(..digits)?)?, base64::decode(&text[digits..])?))
}

/// Returns the entries of a header, with `word` bytes each.
fn header_words(bytes: &[u8], word: usize) -> impl Iterator<Item = usize> {
    bytes.chunks_exact(word).map(|bytes| bytes.iter().rev().fold(0, |number, byte| number << 8 | usize::from(*byte)))
}

/// Decompresses an array at the start of `data`, in the format of [`append_blocks`].
fn decompress(data: &[u8], word: usize) -> Option<Vec<u8>> {
    let mut fixed = header_words(data, word);
    let (blocks, block, partial) = (fixed.next()?, fixed.next()?, fixed.next()?);
    let mut rest = data.get(blocks.checked_add(3)?.checked_mul(word)?..)?;
    let mut bytes = Vec::new();
    for (number, size) in header_words(data, word).skip(3).take(blocks).enumerate() {
        let expected = if number + 1 == blocks && partial > 0 { partial } else { block };
        let (own, after) = rest.split_at_checked(size)?;
        let before = bytes.len();
        // An additional byte would show that the block is longer than the header states.
        ZlibDecoder::new(own).take((expected as u64).saturating_add(1)).read_to_end(&mut bytes).ok()?;
        if bytes.len() - before != expected {
            return None;
        }
        rest = after;
    }
    Some(bytes)
}

#[cfg(test)]
#[path = "../../tests/unit/output/vtu.rs"]
mod tests;
