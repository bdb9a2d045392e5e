//! Values that are costly to make, of which those that were used last are kept.

use std::sync::{Arc, Mutex, PoisonError};

/// Values that are kept: those of a window and of the one before it.
const KEPT: usize = 2;

/// The values that were used last, by their keys.
#[derive(Debug)]
pub(crate) struct Recent<K, V>(Mutex<Vec<(K, Arc<V>)>>);

impl<K, V> Default for Recent<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: PartialEq, V> Recent<K, V> {
    /// The value of a key, which is made if it is not kept. Others wait meanwhile.
    pub(crate) fn get_or_make(&self, key: K, make: impl FnOnce() -> V) -> Arc<V> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let at = kept.iter().position(|(own, _)| *own == key);
        let entry = at.map_or_else(|| (key, Arc::new(make())), |at| kept.remove(at));
        let value = Arc::clone(&entry.1);
        if kept.len() >= KEPT {
            kept.remove(0);
        }
        kept.push(entry);
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_last_are_kept() {
        let recent = Recent::default();
        let made = |key: u32| {
            let mut is_made = false;
            let value = recent.get_or_make(key, || {
                is_made = true;
                key
            });
            assert_eq!(*value, key);
            is_made
        };
        // 2 is the older one when 3 comes.
        let calls = [1, 2, 1, 3, 1, 2].map(made);
        assert_eq!(calls, [true, true, false, true, false, true]);
    }
}
