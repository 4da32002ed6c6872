//! Memory figures of the operating system; `None` if it does not provide them.

use std::fs::read_to_string;
use std::path::Path;

/// Where control groups are mounted.
const GROUPS: &str = "/sys/fs/cgroup";
/// What version 1 reports as no limit is near the largest number.
const UNLIMITED: u64 = 1 << 60;

/// Bytes that this process can still allocate without swapping: what is free, and within the limits of its control groups (containers)
/// and of its address space (`ulimit -v`).
pub fn available() -> Option<u64> {
    let groups = read_to_string("/proc/self/cgroup").unwrap_or_default();
    let left =
        [field("/proc/meminfo", "MemAvailable:"), left_in_groups(Path::new(GROUPS), &groups), left_in_address_space()];
    left.into_iter().flatten().min()
}

/// What is left within the address space, if that is limited.
fn left_in_address_space() -> Option<u64> {
    let limits = read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(field("/proc/self/status", "VmSize:")?))
}

/// The least that is left in any control group that the process is in, directly or further up; `groups` are the lines of
/// /proc/self/cgroup.
fn left_in_groups(mount: &Path, groups: &str) -> Option<u64> {
    groups.lines().filter_map(|line| left_in_group(mount, line)).min()
}

/// The same for a line `number:controllers:path`; version 2 names no controllers.
fn left_in_group(mount: &Path, line: &str) -> Option<u64> {
    let (controllers, path) = line.split_once(':')?.1.split_once(':')?;
    let (top, files) = match controllers {
        "" => (mount.to_owned(), ["memory.max", "memory.current", "inactive_file"]),
        _ if controllers.split(',').any(|name| name == "memory") => {
            (mount.join("memory"), ["memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"])
        }
        _ => return None,
    };
    let left = |group: &Path| {
        let number = |file: &str| read_to_string(group.join(file)).ok()?.trim().parse::<u64>().ok();
        let limit = number(files[0]).filter(|limit| *limit < UNLIMITED)?;
        // Pages of files that are not in use give way.
        let stat = read_to_string(group.join("memory.stat")).unwrap_or_default();
        let pages = stat.lines().find_map(|line| line.strip_prefix(files[2])?.trim().parse::<u64>().ok());
        Some(limit.saturating_sub(number(files[1])?.saturating_sub(pages.unwrap_or(0))))
    };
    let group = top.join(path.trim_start_matches('/'));
    group.ancestors().take_while(|group| group.starts_with(&top)).filter_map(left).min()
}

/// The resident size of this process, in bytes.
pub fn resident() -> Option<u64> {
    field("/proc/self/status", "VmRSS:")
}

/// The largest resident size of this process so far, in bytes.
pub fn peak() -> Option<u64> {
    field("/proc/self/status", "VmHWM:")
}

/// The value of a line `name  number kB` in one of Linux's /proc files.
fn field(path: &str, name: &str) -> Option<u64> {
    let text = read_to_string(path).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use std::fs::{create_dir_all, write};

    use super::*;

    #[test]
    fn limits_of_all_groups_count() {
        let mount = tempfile::tempdir().unwrap();
        let group = |path: &str, files: &[(&str, &str)]| {
            create_dir_all(mount.path().join(path)).unwrap();
            files.iter().for_each(|(name, text)| write(mount.path().join(path).join(name), text).unwrap());
        };
        let left = |line: &str| left_in_groups(mount.path(), line);
        assert_eq!(left("0::/"), None);
        group("a/b", &[("memory.max", "max\n"), ("memory.current", "5\n")]);
        assert_eq!(left("0::/a/b"), None);
        group(
            "a",
            &[("memory.max", "1000\n"), ("memory.current", "700\n"), ("memory.stat", "anon 500\ninactive_file 100\n")],
        );
        assert_eq!(left("0::/a/b"), Some(400));
        group("a/b", &[("memory.max", "300\n"), ("memory.current", "400\n")]);
        assert_eq!(left("0::/a/b"), Some(0));
        group("memory/c", &[("memory.limit_in_bytes", "90\n"), ("memory.usage_in_bytes", "40\n")]);
        group("memory", &[("memory.limit_in_bytes", "9223372036854771712\n"), ("memory.usage_in_bytes", "40\n")]);
        assert_eq!(left("7:blkio:/c\n4:cpu,memory:/c"), Some(50));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn linux_says_how_much_is_left() {
        assert!(available().is_some_and(|bytes| bytes > 1 << 20));
    }
}
