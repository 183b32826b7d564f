//! Ranks: processes or threads that compute one simulation together, and what they exchange.
//!
//! Every rank builds the neighbour lists and adds up the pairs of its own slabs. Whoever computes a slab, its sums have the same
//! bits, so the results have as well.

#[cfg(feature = "mpi")]
mod mpi;
mod threads;

use std::{
    fmt,
    ops::Range,
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};

use bytemuck::Pod;
#[cfg(feature = "mpi")]
pub use mpi::World;

use crate::{
    error::{Error, ErrorKind, Result},
    math::simd::{LANES, LaneRow},
};

/// Rows that each rank gives in one exchange, so that the buffers stay small.
const BLOCK: usize = 1 << 13;

/// How ranks exchange words of 32 bits. All ranks make the same calls in the same order.
trait Exchange: fmt::Debug + Send + Sync {
    /// Number of this rank, from 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn count(&self) -> usize;

    /// Where the rank runs: equal for ranks that share the processors.
    fn place(&self) -> String;

    /// Gathers the words of all ranks in `all`, in the order of their numbers: `counts[r]` of rank r, of this one `own`.
    fn gather(&self, own: &[u32], counts: &[usize], all: &mut [u32]);

    /// Sends words to the rank `to` and receives as many as `into` has from the rank `from`, where there are such ranks.
    fn pass(&self, out: (Option<usize>, &[u32]), into: (Option<usize>, &mut [u32]));

    /// Ends all ranks at once with an exit code.
    fn abort(&self, code: i32) -> !;
}

/// Words of a double.
pub(crate) fn words_of(x: f64) -> [u32; 2] {
    [x.to_bits() as u32, (x.to_bits() >> 32) as u32]
}

/// The double of two words.
pub(crate) fn from_words(low: u32, high: u32) -> f64 {
    f64::from_bits(u64::from(low) | u64::from(high) << 32)
}

/// The doubles of pairs of words.
pub(crate) fn doubles(words: &[u32]) -> impl Iterator<Item = f64> {
    words.chunks_exact(2).map(|pair| from_words(pair[0], pair[1]))
}

/// What a rank has exchanged with others so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Traffic {
    /// Received from other ranks, B.
    pub bytes: u64,
    /// Time in exchanges, the wait for slower ranks included.
    pub time: Duration,
}

/// The ranks of a simulation, as one of them knows them. A single rank has nobody to exchange with.
#[derive(Clone, Debug, Default)]
pub struct Ranks(Option<Arc<Group>>);

#[derive(Debug)]
struct Group {
    exchange: Box<dyn Exchange>,
    traffic: Mutex<Traffic>,
}

/// The part of a rank of items that the ranks share: `first` and those after it, of `count` in all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RankPart {
    pub(crate) first: usize,
    pub(crate) count: usize,
}

/// The ranks of a simulation, and the part of its water that this one has at the set-up; without a part it has all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WaterShare<'a> {
    pub(crate) ranks: &'a Ranks,
    pub(crate) part: Option<RankPart>,
}

/// Another rank, if there is one, and the range of the items that pass to it or from it.
type RankItems = (Option<usize>, Range<usize>);

impl Ranks {
    fn new(exchange: impl Exchange + 'static) -> Self {
        if exchange.count() < 2 {
            return Self::default();
        }
        Self(Some(Arc::new(Group { exchange: Box::new(exchange), traffic: Mutex::default() })))
    }

    /// `count` ranks in this process. Each belongs to a thread of its own, with its own thread pool.
    pub fn in_threads(count: usize) -> Vec<Self> {
        threads::group(count).into_iter().map(Self::new).collect()
    }

    /// Number of this rank, from 0.
    pub fn rank(&self) -> usize {
        self.0.as_ref().map_or(0, |group| group.exchange.rank())
    }

    /// Number of ranks.
    pub fn count(&self) -> usize {
        self.0.as_ref().map_or(1, |group| group.exchange.count())
    }

    /// These ranks, each of which has all water at the set-up.
    pub(crate) fn with_all_water(&self) -> WaterShare<'_> {
        WaterShare { ranks: self, part: None }
    }

    /// What this rank has exchanged so far.
    pub fn traffic(&self) -> Traffic {
        let read = |group: &Arc<Group>| *group.traffic.lock().unwrap_or_else(PoisonError::into_inner);
        self.0.as_ref().map(read).unwrap_or_default()
    }

    /// How many ranks, this one included, share the processors of this one.
    pub fn sharing_processors(&self) -> usize {
        let Some(group) = &self.0 else { return 1 };
        let own = group.exchange.place();
        self.gather_bytes(own.as_bytes()).iter().filter(|place| **place == own.as_bytes()).count()
    }

    /// Ends all ranks at once with an exit code. Does nothing for a single rank.
    pub fn abort(&self, code: i32) {
        if let Some(group) = &self.0 {
            group.exchange.abort(code);
        }
    }

    /// The bytes that each rank gives, in the order of the ranks.
    pub(crate) fn gather_bytes(&self, own: &[u8]) -> Vec<Vec<u8>> {
        if self.0.is_none() {
            return vec![own.to_vec()];
        }
        let lengths: Vec<usize> = self.gather_words([own.len() as u32]).into_iter().map(|[n]| n as usize).collect();
        let words: Vec<u32> = own.chunks(4).map(word).collect();
        let counts: Vec<usize> = lengths.iter().map(|n| n.div_ceil(4)).collect();
        let mut all = vec![0; counts.iter().sum()];
        self.gather(&words, &counts, &mut all);
        let mut bytes = all.into_iter().map(u32::to_le_bytes);
        let part = |&n: &usize| {
            let mut part: Vec<u8> = bytes.by_ref().take(n.div_ceil(4)).flatten().collect();
            part.truncate(n);
            part
        };
        lengths.iter().map(part).collect()
    }

    /// The `N` words that each rank gives, in the order of the ranks.
    pub(crate) fn gather_words<const N: usize>(&self, own: [u32; N]) -> Vec<[u32; N]> {
        let mut all = vec![0; N * self.count()];
        self.gather(&own, &vec![N; self.count()], &mut all);
        all.chunks_exact(N).map(|words| std::array::from_fn(|k| words[k])).collect()
    }

    /// The words of all ranks in their order; each gives as many.
    pub(crate) fn gather_lists(&self, own: &[u32]) -> Vec<u32> {
        let mut all = vec![0; own.len() * self.count()];
        self.gather(own, &vec![own.len(); self.count()], &mut all);
        all
    }

    /// The number that each rank gives.
    pub(crate) fn counts(&self, own: usize) -> Vec<usize> {
        self.gather_words([own as u32]).into_iter().map(|[n]| n as usize).collect()
    }

    /// Which items a rank has if it has so many, and the ranks before it the ones before.
    pub(crate) fn part(&self, own: usize) -> RankPart {
        let counts = self.counts(own);
        RankPart { first: counts[..self.rank()].iter().sum(), count: counts.iter().sum() }
    }

    /// The items of all ranks, in the order of the ranks.
    pub(crate) fn concat<T: Pod>(&self, own: Vec<T>) -> Vec<T> {
        if self.0.is_none() {
            return own;
        }
        let all = self.gather_bytes(bytemuck::cast_slice(&own));
        all.iter().flat_map(|bytes| bytemuck::pod_collect_to_vec::<u8, T>(bytes)).collect()
    }

    /// The largest of the numbers that the ranks give, none of which is NaN.
    pub(crate) fn max(&self, own: f64) -> f64 {
        self.gather_words(words_of(own)).into_iter().fold(own, |most, [low, high]| most.max(from_words(low, high)))
    }

    /// What all ranks have prepared, if all could and `digest` gives the same text for each.
    ///
    /// # Errors
    /// This rank's own error; `Usage` if another rank failed or has something else, with its number.
    pub(crate) fn agree<T>(&self, prepared: Result<T>, digest: impl Fn(&T) -> String) -> Result<T> {
        if self.count() == 1 {
            return prepared;
        }
        let own =
            prepared.as_ref().map_or_else(|error| format!("!{error}"), |prepared| format!("={}", digest(prepared)));
        let all = self.gather_bytes(own.as_bytes());
        let prepared = prepared?;
        for (rank, text) in all.iter().enumerate() {
            let text = String::from_utf8_lossy(text);
            if let Some(why) = text.strip_prefix('!') {
                return Err(Error::new(ErrorKind::Usage, format!("rank {rank} cannot begin: {why}")));
            }
            if text.as_bytes() != all[0] {
                let what = format!("rank {rank} has another program, scene or file than rank 0");
                return Err(Error::new(ErrorKind::Usage, what)
                    .help("start the same program on a file system that all machines share"));
            }
        }
        Ok(prepared)
    }

    /// Completes `rows`, of which each rank has filled its own of the `parts`.
    pub(crate) fn share_rows(&self, rows: &mut [LaneRow], parts: &[Range<usize>]) {
        let pack = |row: &LaneRow| row.0.map(f32::to_bits);
        self.share(rows, parts, pack, |words: [u32; LANES]| LaneRow(words.map(f32::from_bits)));
    }

    /// Completes `numbers`, of which each rank has filled its own of the `parts`.
    pub(crate) fn share_numbers(&self, numbers: &mut [u32], parts: &[Range<usize>]) {
        self.share(numbers, parts, |n| [*n], |[n]| n);
    }

    /// Completes `numbers`, of which each rank has filled its own of the `parts`.
    pub(crate) fn share_doubles(&self, numbers: &mut [f64], parts: &[Range<usize>]) {
        self.share(numbers, parts, |x| words_of(*x), |[low, high]| from_words(low, high));
    }

    /// Adds up the `numbers` of all ranks.
    pub(crate) fn add_numbers(&self, numbers: &mut [u32]) {
        for block in numbers.chunks_mut(BLOCK) {
            let mut all = vec![0; self.count() * block.len()];
            self.gather(block, &vec![block.len(); self.count()], &mut all);
            for (k, number) in block.iter_mut().enumerate() {
                *number = all.iter().skip(k).step_by(all.len() / self.count()).sum();
            }
        }
    }

    /// Completes `items`, each of `N` words.
    fn share<T, const N: usize>(
        &self,
        items: &mut [T],
        parts: &[Range<usize>],
        pack: impl Fn(&T) -> [u32; N],
        unpack: impl Fn([u32; N]) -> T,
    ) {
        let (own, counts): (_, Vec<usize>) = (self.rank(), parts.iter().map(Range::len).collect());
        let give = |items: &&mut [T], k: usize, words: &mut Vec<u32>| words.extend(pack(&items[parts[own].start + k]));
        let take = |items: &mut &mut [T], rank: usize, k: usize, words: &[u32]| {
            items[parts[rank].start + k] = unpack(std::array::from_fn(|n| words[n]));
        };
        self.share_items(&mut { items }, (&counts, N), give, take);
    }

    /// Gives each rank the items that others have, each of `width` words: rank r has `counts[r]`. `give` appends the words of this
    /// rank's k-th item, `take` gets the number of another rank, k and the words. Both work on `data`.
    pub(crate) fn share_items<C>(
        &self,
        data: &mut C,
        (counts, width): (&[usize], usize),
        mut give: impl FnMut(&C, usize, &mut Vec<u32>),
        mut take: impl FnMut(&mut C, usize, usize, &[u32]),
    ) {
        if self.0.is_none() {
            return;
        }
        let (own, most) = (self.rank(), counts.iter().copied().max().unwrap_or(0));
        let (mut words, mut all) = (Vec::new(), Vec::new());
        for start in (0..most).step_by(BLOCK) {
            let block = |count: usize| start.min(count)..count.min(start + BLOCK);
            words.clear();
            block(counts[own]).for_each(|k| give(data, k, &mut words));
            let lengths: Vec<usize> = counts.iter().map(|&count| width * block(count).len()).collect();
            all.resize(lengths.iter().sum(), 0);
            self.gather(&words, &lengths, &mut all);
            let mut rest = &all[..];
            for (rank, (&count, &length)) in counts.iter().zip(&lengths).enumerate() {
                let (these, later) = rest.split_at(length);
                rest = later;
                if rank != own {
                    let items = block(count).zip(these.chunks_exact(width));
                    items.for_each(|(k, words)| take(data, rank, k, words));
                }
            }
        }
    }

    /// Sends `out` to the rank `to` and receives `into` from the rank `from`, where there are such ranks.
    pub(crate) fn pass(&self, (to, out): (Option<usize>, &[u32]), (from, into): (Option<usize>, &mut [u32])) {
        let Some(group) = &self.0 else { return };
        let (start, bytes) = (Instant::now(), if from.is_some() { 4 * into.len() as u64 } else { 0 });
        group.exchange.pass((to, out), (from, into));
        group.count(start, bytes);
    }

    /// Sends the items `out` of `data` to the rank `to` and receives the items `into` from the rank `from`, if these ranks exist, a block
    /// at a time. An item has `width` words: `give` appends them, `take` stores those of a received item.
    pub(crate) fn pass_items<C>(
        &self,
        data: &mut C,
        ((to, out), (from, into)): (RankItems, RankItems),
        width: usize,
        give: impl Fn(&C, usize, &mut Vec<u32>),
        take: impl Fn(&mut C, usize, &[u32]),
    ) {
        let block = (BLOCK / width).max(1);
        let part = |items: &Range<usize>, start: usize| {
            (items.start + start).min(items.end)..(items.start + start + block).min(items.end)
        };
        let out = if to.is_some() { out } else { 0..0 };
        let into = if from.is_some() { into } else { 0..0 };
        let (mut given, mut taken) = (Vec::new(), Vec::new());
        for start in (0..out.len().max(into.len())).step_by(block) {
            let (out, into) = (part(&out, start), part(&into, start));
            given.clear();
            out.clone().for_each(|i| give(data, i, &mut given));
            taken.resize(width * into.len(), 0);
            self.pass((to.filter(|_| !out.is_empty()), &given), (from.filter(|_| !into.is_empty()), &mut taken));
            into.zip(taken.chunks_exact(width)).for_each(|(i, words)| take(data, i, words));
        }
    }

    fn gather(&self, own: &[u32], counts: &[usize], all: &mut [u32]) {
        let Some(group) = &self.0 else { return all.copy_from_slice(own) };
        let start = Instant::now();
        group.exchange.gather(own, counts, all);
        group.count(start, 4 * (all.len() - own.len()) as u64);
    }
}

impl Group {
    /// Counts an exchange that began at `start`.
    fn count(&self, start: Instant, bytes: u64) {
        let mut traffic = self.traffic.lock().unwrap_or_else(PoisonError::into_inner);
        traffic.time += start.elapsed();
        traffic.bytes += bytes;
    }
}

/// Up to four bytes as a word.
fn word(bytes: &[u8]) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|k| bytes.get(k).copied().unwrap_or(0)))
}

/// The part of a rank of `count` items, in equal parts.
pub(crate) fn equal_part(count: usize, ranks: &Ranks) -> Range<usize> {
    let end = |rank: usize| (count as u128 * rank as u128 / ranks.count() as u128) as usize;
    end(ranks.rank())..end(ranks.rank() + 1)
}

/// Consecutive parts of `weights`, one for each of `count` ranks, of about equal weight. They cover everything.
pub(crate) fn equal_parts(weights: &[u64], count: usize) -> Vec<Range<usize>> {
    let total = weights.iter().sum::<u64>().max(1) as u128;
    let (mut before, mut parts) = (0u128, vec![0..0; count]);
    for (i, &weight) in weights.iter().enumerate() {
        // The middle of an item decides whose it is.
        let middle = 2 * before + u128::from(weight);
        let owner = ((middle * count as u128 / (2 * total)) as usize).min(count - 1);
        let part = &mut parts[owner];
        part.start = if part.start == part.end { i } else { part.start };
        part.end = i + 1;
        before += u128::from(weight);
    }
    let mut end = 0;
    for part in &mut parts {
        if part.start == part.end {
            *part = end..end;
        }
        end = part.end;
    }
    parts
}

#[cfg(test)]
#[path = "../../tests/unit/ranks.rs"]
mod tests;
