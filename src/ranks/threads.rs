//! Ranks that are threads of one process: they exchange over channels.

use std::sync::{
    Mutex, PoisonError,
    mpsc::{Receiver, Sender, channel},
};

use super::Exchange;

/// One rank: its channels to and from every other.
#[derive(Debug)]
pub(super) struct ThreadRank {
    rank: usize,
    to: Vec<Sender<Vec<u32>>>,
    from: Mutex<Vec<Receiver<Vec<u32>>>>,
}

/// `count` ranks, each connected with all.
pub(super) fn group(count: usize) -> Vec<ThreadRank> {
    let mut to: Vec<Vec<_>> = (0..count).map(|_| Vec::with_capacity(count)).collect();
    let mut from: Vec<Vec<_>> = (0..count).map(|_| Vec::with_capacity(count)).collect();
    for sender in &mut to {
        for receiver in &mut from {
            let (one, other) = channel();
            sender.push(one);
            receiver.push(other);
        }
    }
    let ranks = to.into_iter().zip(from).enumerate();
    ranks.map(|(rank, (to, from))| ThreadRank { rank, to, from: Mutex::new(from) }).collect()
}

impl Exchange for ThreadRank {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.to.len()
    }

    fn place(&self) -> String {
        "this process".into()
    }

    fn gather(&self, own: &[u32], counts: &[usize], all: &mut [u32]) {
        for (rank, to) in self.to.iter().enumerate() {
            if rank != self.rank && to.send(own.to_vec()).is_err() {
                panic!("rank {rank} has ended");
            }
        }
        let from = self.from.lock().unwrap_or_else(PoisonError::into_inner);
        let mut rest = all;
        for (rank, (from, &count)) in from.iter().zip(counts).enumerate() {
            let (part, later) = rest.split_at_mut(count);
            rest = later;
            if rank == self.rank {
                part.copy_from_slice(own);
            } else {
                match from.recv() {
                    Ok(words) => part.copy_from_slice(&words),
                    Err(_) => panic!("rank {rank} has ended"),
                }
            }
        }
    }

    fn pass(&self, (to, out): (Option<usize>, &[u32]), (from, into): (Option<usize>, &mut [u32])) {
        if let Some(rank) = to
            && self.to[rank].send(out.to_vec()).is_err()
        {
            panic!("rank {rank} has ended");
        }
        if let Some(rank) = from {
            match self.from.lock().unwrap_or_else(PoisonError::into_inner)[rank].recv() {
                Ok(words) => into.copy_from_slice(&words),
                Err(_) => panic!("rank {rank} has ended"),
            }
        }
    }

    fn abort(&self, code: i32) -> ! {
        panic!("rank {} ended with code {code}", self.rank)
    }
}
