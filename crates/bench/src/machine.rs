//! Where and when a suite runs. Unknown facts are empty or 0.

use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use lightmesh::render::{DeviceReport, devices};

use crate::{Gpu, Machine, Program};

impl Machine {
    /// This machine, with the GPUs whose device names (`cuda:0`) are in `used`.
    pub fn here(used: &[String]) -> Machine {
        let reports = devices();
        let cpu = reports.iter().find(|report| report.device == "cpu").map(|report| report.name.clone());
        let gpus = reports.iter().filter(|report| report.device != "cpu" && used.contains(&report.device)).map(gpu);
        Machine {
            cpu: cpu.unwrap_or_default(),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            memory_bytes: main_memory().unwrap_or(0),
            os: operating_system(),
            gpus: gpus.collect(),
        }
    }
}

impl Program {
    /// This program, run by `command`.
    pub fn this(command: &str) -> Program {
        Program {
            name: "lightmesh".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: commit().map(str::to_owned),
            command: command.to_owned(),
        }
    }
}

fn gpu(report: &DeviceReport) -> Gpu {
    let driver = report.driver_cuda_version.as_deref().map_or_else(String::new, |version| format!("CUDA {version}"));
    Gpu { name: report.name.clone(), memory_bytes: report.memory_bytes.unwrap_or(0), driver }
}

/// The commit from which the program was built, if it is known.
pub fn commit() -> Option<&'static str> {
    option_env!("LIGHTMESH_COMMIT").filter(|commit| !commit.is_empty())
}

/// Bytes of main memory, on Linux.
fn main_memory() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kilobytes)
}

/// The system's name and, on Linux, the distribution's.
fn operating_system() -> String {
    let text = fs::read_to_string("/etc/os-release").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("PRETTY_NAME="));
    name.map_or_else(
        || std::env::consts::OS.to_owned(),
        |name| format!("{}, {}", std::env::consts::OS, name.trim_matches('"')),
    )
}

/// The time now in UTC, as in 2026-01-31T12:00:00Z.
pub(crate) fn utc_now() -> String {
    utc(SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()))
}

/// UTC time from seconds since 1970. Days are converted to a Gregorian date by eras of 400 years that begin in March, so that the
/// leap day comes last (Hinnant: *chrono-Compatible Low-Level Date Algorithms*).
fn utc(seconds: u64) -> String {
    const DAY: u64 = 86_400;
    const DAYS_OF_ERA: u64 = 146_097;
    const FROM_YEAR_0_TO_1970: u64 = 719_468;
    let (days, second) = (seconds / DAY + FROM_YEAR_0_TO_1970, seconds % DAY);
    let (era, day) = (days / DAYS_OF_ERA, days % DAYS_OF_ERA);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = 400 * era + year + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}Z", second / 3600, second / 60 % 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_become_dates() {
        assert_eq!(utc(0), "1970-01-01T00:00:00Z");
        assert_eq!(utc(951_782_399), "2000-02-28T23:59:59Z");
        assert_eq!(utc(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(utc(1_735_689_599), "2024-12-31T23:59:59Z");
        assert_eq!(utc(4_107_542_400), "2100-03-01T00:00:00Z");
    }

    #[test]
    fn this_machine_has_a_processor() {
        let machine = Machine::here(&["cpu".to_owned()]);
        assert!(machine.threads > 0 && !machine.cpu.is_empty() && !machine.os.is_empty() && machine.gpus.is_empty());
    }
}
