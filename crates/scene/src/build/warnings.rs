//! What was corrected, ignored or guessed while a scene was read. However odd its files are, the list is short: equal sentences are one
//! with a count, and only the first [`MOST`] different ones are kept.

use std::collections::HashMap;

/// Number of different sentences that are kept.
pub const MOST: usize = 100;

/// Sentences in the order in which they first occurred.
#[derive(Debug, Default)]
pub struct Warnings {
    sentences: Vec<(String, usize)>,
    /// Index of each sentence.
    known: HashMap<String, usize>,
    others: usize,
}

impl Warnings {
    /// Adds a sentence, or counts it again.
    pub fn push(&mut self, sentence: String) {
        if let Some(&index) = self.known.get(&sentence) {
            self.sentences[index].1 += 1;
        } else if self.sentences.len() < MOST {
            self.known.insert(sentence.clone(), self.sentences.len());
            self.sentences.push((sentence, 1));
        } else {
            self.others += 1;
        }
    }

    pub(crate) fn extend(&mut self, sentences: impl IntoIterator<Item = String>) {
        sentences.into_iter().for_each(|sentence| self.push(sentence));
    }

    /// The sentences, and how many more there were.
    pub fn into_list(self) -> Vec<String> {
        let counted = |(sentence, count)| if count > 1 { format!("{sentence} ({count} times)") } else { sentence };
        let others = (self.others > 0).then(|| format!("{} more warnings are not shown", self.others));
        self.sentences.into_iter().map(counted).chain(others).collect()
    }
}
