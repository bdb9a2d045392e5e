//! Memory that is left to this process: by the machine, by its control groups, and by its own limits.

use std::fs;
use std::hint::black_box;
use std::path::Path;

use crate::error::{Error, Result};

/// Bytes of `arrays` arrays of the cells of a grid as transforms keep them: whole blocks of columns, at lengths that are
/// products of small primes. Together they are a fifth more than the cells.
pub(crate) fn memory_of(shape: [usize; 2], arrays: usize) -> u64 {
    let [nx, ny] = shape.map(|n| n as u64);
    (nx + 1) * (ny + 8) * 8 * arrays as u64 * 6 / 5
}

/// Bytes from which on a reservation is tried, which takes ten microseconds, as long as a plan on 16 × 16 cells.
const TRIED: u64 = 1 << 20;

/// Bytes from which on the system is asked what is left, which takes a tenth of a millisecond.
const ASKED: u64 = 64 << 20;

/// Bytes for stacks of threads and small arrays beside those that are counted. From the sizes of blocks up to 32 MiB that
/// are given back, glibc concludes how to manage others.
const BESIDE: u64 = 40 << 20;

/// Returns an error where this process has less than `needed` bytes left for a grid of `shape`, and some for what is not
/// counted. Small ones are not looked at.
///
/// What the system says is not all: how much it grants is tried, by a reservation that is given back at once.
pub(crate) fn check_memory(shape: [usize; 2], needed: u64) -> Result<()> {
    match too_little(needed) {
        Some([needed, available]) => Err(Error::Memory { shape, needed, available }),
        None => Ok(()),
    }
}

/// `needed` bytes and some for what is not counted, and the bytes that are available where these are less.
pub(crate) fn too_little(needed: u64) -> Option<[u64; 2]> {
    if needed < TRIED {
        return None;
    }
    let is_large = needed >= ASKED;
    let needed = needed.saturating_add(BESIDE);
    let left = is_large.then(|| left(Path::new("/"))).flatten();
    let available = left.filter(|left| *left < needed);
    let granted = || (!is_granted(needed)).then(|| largest_granted(needed));
    available.or_else(granted).map(|available| [needed, available])
}

/// Whether an allocation of so many bytes succeeds. Nothing is written to them, so that they cost nothing.
fn is_granted(bytes: u64) -> bool {
    let mut reserved = Vec::<u8>::new();
    let bytes = usize::try_from(bytes).unwrap_or(usize::MAX);
    // An allocation that is not looked at may be left out by the compiler.
    black_box(&mut reserved).try_reserve_exact(bytes).is_ok()
}

/// The largest part of `bytes` that is granted, to an eighth of it.
fn largest_granted(bytes: u64) -> u64 {
    let halves = (0..u64::BITS).map(|k| bytes >> k);
    let parts = halves.flat_map(|half| (8..16).rev().map(move |part| half / 16 * part));
    parts.take_while(|&part| part > 0).find(|&part| is_granted(part)).unwrap_or(0)
}

/// Bytes that are left to this process as far as files below `root` and the machine say; `None` where nothing does.
fn left(root: &Path) -> Option<u64> {
    let mut system = sysinfo::System::new();
    system.refresh_memory();
    let machine = Some(system.available_memory()).filter(|&bytes| bytes > 0);
    machine.into_iter().chain(groups(root)).chain(limits(root)).min()
}

/// What the control groups of this process leave, each by its limit on memory.
///
/// Within a container, the mounted tree may be that of the container's group alone. Groups of the process that are not
/// found in it are passed over, so that its root remains.
fn groups(root: &Path) -> Option<u64> {
    let listed = fs::read_to_string(root.join("proc/self/cgroup")).ok()?;
    let mounted = root.join("sys/fs/cgroup");
    let left = listed.lines().flat_map(|line| {
        // Number of the hierarchy, controllers, path of the group.
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, path) = (parts.next().unwrap_or(""), parts.next().unwrap_or(""));
        let (trees, files): (&[&str], _) = match controllers {
            "" => (&["", "unified"], ["memory.max", "memory.current", "inactive_file"]),
            _ if controllers.split(',').any(|name| name == "memory") => (
                &["memory"],
                ["memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"],
            ),
            _ => (&[], [""; 3]),
        };
        let path = Path::new(path.trim_start_matches('/'));
        let groups = trees.iter().flat_map(|tree| {
            let tree = mounted.join(tree);
            path.ancestors().map(move |group| tree.join(group))
        });
        groups.filter_map(|group| left_by_group(&group, files)).collect::<Vec<_>>()
    });
    left.min()
}

/// What one control group leaves of its limit. Memory of files that were not used lately is given back where it is needed.
fn left_by_group(group: &Path, [limit, usage, idle]: [&str; 3]) -> Option<u64> {
    let read = |name: &str| fs::read_to_string(group.join(name)).ok();
    let limit: u64 = read(limit)?.trim().parse().ok()?;
    let usage: u64 = read(usage)?.trim().parse().ok()?;
    let idle = read("memory.stat").and_then(|table| entry(&table, idle)).unwrap_or(0);
    Some(limit.saturating_sub(usage.saturating_sub(idle)))
}

/// What the limits of this process leave: `RLIMIT_AS` and `RLIMIT_DATA`, as `ulimit -v` and `ulimit -d` set them.
fn limits(root: &Path) -> Option<u64> {
    let read = |name: &str| fs::read_to_string(root.join("proc/self").join(name)).ok();
    let (limits, status) = (read("limits")?, read("status")?);
    let pairs = [("Max address space", "VmSize:"), ("Max data size", "VmData:")];
    let left = pairs.into_iter().filter_map(|(limit, used)| {
        let kibibytes = entry(&status, used)?;
        Some(entry(&limits, limit)?.saturating_sub(kibibytes << 10))
    });
    left.min()
}

/// The number that follows `name` in a line of a table; `None` where no number does, as in "unlimited".
fn entry(table: &str, name: &str) -> Option<u64> {
    let mut rest = table.lines().filter_map(|line| line.strip_prefix(name));
    let rest = rest.find(|rest| rest.starts_with(char::is_whitespace))?;
    rest.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;

    use super::{check_memory, groups, is_granted, largest_granted, left, limits};
    use crate::error::Error;

    /// A folder of files with these contents, in place of the root of the system.
    fn system(name: &str, files: &[(&str, &str)]) -> std::io::Result<PathBuf> {
        let root = std::env::temp_dir().join(format!("nacre-{name}-{}", std::process::id()));
        for (path, content) in files {
            let path = root.join(path);
            fs::create_dir_all(path.parent().unwrap_or(&root))?;
            fs::write(path, content)?;
        }
        Ok(root)
    }

    #[test]
    fn the_narrowest_group_above_the_process_counts() -> std::io::Result<()> {
        let root = system(
            "v2",
            &[
                ("proc/self/cgroup", "0::/job/step\n"),
                ("sys/fs/cgroup/job/memory.max", "1000\n"),
                ("sys/fs/cgroup/job/memory.current", "900\n"),
                ("sys/fs/cgroup/job/memory.stat", "anon 200\ninactive_file 600\n"),
                ("sys/fs/cgroup/job/step/memory.max", "max\n"),
                ("sys/fs/cgroup/job/step/memory.current", "300\n"),
            ],
        )?;
        assert_eq!(groups(&root), Some(700));
        assert_eq!(left(&root), Some(700));
        fs::write(root.join("sys/fs/cgroup/job/step/memory.max"), "350")?;
        assert_eq!(groups(&root), Some(50));
        fs::write(root.join("sys/fs/cgroup/job/step/memory.max"), "250")?;
        assert_eq!(groups(&root), Some(0));
        fs::remove_dir_all(root)
    }

    #[test]
    fn within_a_container_its_own_group_counts() -> std::io::Result<()> {
        let root = system(
            "v1",
            &[
                ("proc/self/cgroup", "5:cpu,memory:/docker/0123\n4:pids:/docker/0123\n0::/\n"),
                ("sys/fs/cgroup/memory/memory.limit_in_bytes", "5000\n"),
                ("sys/fs/cgroup/memory/memory.usage_in_bytes", "4000\n"),
                ("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 30\n"),
            ],
        )?;
        assert_eq!(groups(&root), Some(1030));
        fs::remove_dir_all(root)
    }

    #[test]
    fn limits_of_the_process_count() -> std::io::Result<()> {
        let table = |data: &str, space: &str| {
            format!(
                "Limit           Soft Limit   Hard Limit   Units\n\
                 Max data size   {data}       unlimited    bytes\n\
                 Max address space         {space}     unlimited            bytes\n"
            )
        };
        let files = |limits: &str| {
            let status = "Name:\tx\nVmSize:\t    4 kB\nVmData:\t    1 kB\n";
            system("limits", &[("proc/self/limits", limits), ("proc/self/status", status)])
        };
        for (data, space, expected) in [
            ("unlimited", "unlimited", None),
            ("unlimited", "8192", Some(4096)),
            ("2024", "8192", Some(1000)),
            ("unlimited", "100", Some(0)),
        ] {
            assert_eq!(limits(&files(&table(data, space))?), expected);
        }
        fs::remove_dir_all(files("")?)
    }

    #[test]
    fn what_is_not_granted_is_an_error() {
        let whole = 1 << 62;
        assert!(is_granted(1 << 20) && !is_granted(whole));
        assert!((1 << 20..whole).contains(&largest_granted(whole)));
        assert!(check_memory([2, 2], 1 << 20).is_ok());
        let refused = check_memory([2, 2], whole);
        let is_told = |error: &Error| match error {
            Error::Memory { needed, available, .. } => *needed > whole && available < needed,
            _ => false,
        };
        assert!(refused.is_err_and(|error| is_told(&error)));
    }
}
