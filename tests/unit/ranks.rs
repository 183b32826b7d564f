use super::*;

/// What each of `count` ranks returns.
fn on_ranks<T: Send>(count: usize, work: impl Fn(Ranks) -> T + Sync) -> Vec<T> {
    std::thread::scope(|scope| {
        let threads: Vec<_> = Ranks::in_threads(count).into_iter().map(|ranks| scope.spawn(|| work(ranks))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    })
}

/// The exchange takes parts of any length: none, and several blocks.
#[test]
fn every_rank_has_all_rows_after_they_are_shared() {
    let parts = [0..5, 5..5, 5..2 * BLOCK + 7];
    let row = |i: usize| LaneRow(std::array::from_fn(|l| (8 * i + l) as f32));
    let right = on_ranks(3, |ranks| {
        let mut rows = vec![LaneRow::default(); 2 * BLOCK + 9];
        for i in parts[ranks.rank()].clone() {
            rows[i] = row(i);
        }
        ranks.share_rows(&mut rows, &parts);
        let shared = rows[..2 * BLOCK + 7].iter().enumerate().all(|(i, got)| got.0 == row(i).0);
        shared && rows[2 * BLOCK + 7..].iter().all(|got| got.0 == [0.0; LANES])
    });
    assert_eq!(right, [true; 3]);
}

#[test]
fn bytes_are_gathered_in_the_order_of_the_ranks() {
    let texts = ["", "four", "eleven char"];
    let all = on_ranks(3, |ranks| ranks.gather_bytes(texts[ranks.rank()].as_bytes()));
    assert!(all.iter().all(|all| *all == texts.map(|text| text.as_bytes().to_vec())));
    assert_eq!(Ranks::default().gather_bytes(b"alone"), [b"alone"]);
}

#[test]
fn a_rank_counts_what_it_receives() {
    let traffic = on_ranks(3, |ranks| {
        ranks.gather_words([1, 2]);
        ranks.traffic().bytes
    });
    assert_eq!(traffic, [16; 3], "two words of four bytes from each of two others");
}

/// Each rank gets the items of the next one, of which there are none, one, and several blocks.
#[test]
fn items_pass_to_the_rank_before() {
    let lengths = [0, 1, 2 * BLOCK + 5];
    let right = on_ranks(3, |ranks| {
        let rank = ranks.rank();
        let mut numbers: Vec<[u32; 2]> = (0..lengths[rank] as u32).map(|i| [rank as u32, i]).collect();
        let own = numbers.len();
        let (before, after) = (rank.checked_sub(1), Some(rank + 1).filter(|&rank| rank < 3));
        numbers.resize(own + after.map_or(0, |after| lengths[after]), [9; 2]);
        let passed = ((before, 0..own), (after, own..numbers.len()));
        let give = |numbers: &Vec<[u32; 2]>, i: usize, words: &mut Vec<u32>| words.extend(numbers[i]);
        let take = |numbers: &mut Vec<[u32; 2]>, i: usize, words: &[u32]| numbers[i].copy_from_slice(words);
        ranks.pass_items(&mut numbers, passed, 2, give, take);
        (0u32..).zip(&numbers[own..]).all(|(i, got)| *got == [rank as u32 + 1, i])
    });
    assert_eq!(right, [true; 3]);
}

/// The parts follow one another, cover everything, and differ by less than an item from equal ones.
#[test]
fn parts_have_equal_weight_within_an_item() {
    for weights in [vec![1; 10], vec![5, 0, 0, 1, 9, 2, 2, 2], vec![0; 4], vec![7], (0..100).collect()] {
        for count in 1..6 {
            let parts = equal_parts(&weights, count);
            assert_eq!((parts.len(), parts[0].start, parts[count - 1].end), (count, 0, weights.len()));
            assert!(parts.windows(2).all(|pair| pair[0].end == pair[1].start));
            let weight = |part: &Range<usize>| weights[part.clone()].iter().sum::<u64>() as f64;
            let (total, most) = (weight(&(0..weights.len())), weights.iter().max().copied().unwrap_or(0) as f64);
            let fair = total / count as f64;
            assert!(parts.iter().all(|part| (weight(part) - fair).abs() <= most), "{weights:?}: {parts:?}");
        }
    }
}
