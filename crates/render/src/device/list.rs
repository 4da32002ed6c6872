//! Several devices that render one picture together.

use std::fmt;

use super::Device;

/// Several devices: CUDA devices by number, or all that work, and the CPU. Which are listed counts, not in which order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceList {
    /// A bit for each number.
    cuda: u64,
    all: bool,
    cpu: bool,
}

impl DeviceList {
    /// All CUDA devices that work.
    pub const ALL_CUDA: DeviceList = DeviceList { cuda: 0, all: true, cpu: false };

    const NONE: DeviceList = DeviceList { cuda: 0, all: false, cpu: false };

    /// The same with the CPU.
    #[must_use]
    pub fn and_cpu(self) -> DeviceList {
        DeviceList { cpu: true, ..self }
    }

    /// CUDA devices with these numbers; `None` if there is no device of a number, which is 63 at most, or one is listed twice.
    pub fn of_cuda(numbers: &[u32]) -> Option<DeviceList> {
        let list = numbers.iter().try_fold(DeviceList::NONE, |list, &number| list.with_cuda(number));
        list.filter(|list| list.cuda != 0)
    }

    fn with_cuda(self, number: u32) -> Option<DeviceList> {
        let bit = 1_u64.checked_shl(number)?;
        (self.cuda & bit == 0 && !self.all).then_some(DeviceList { cuda: self.cuda | bit, ..self })
    }

    /// Reads `cuda:all`, and lists such as `cuda:0,1`, `cuda:0,cuda:2` and `cuda:all,cpu`.
    pub(super) fn read(words: &str) -> Option<DeviceList> {
        let (mut list, mut follows_number) = (DeviceList::NONE, false);
        for word in words.split(',') {
            let number = word.strip_prefix("cuda:").or(Some(word).filter(|_| follows_number));
            list = match word {
                "cpu" => (!list.cpu).then(|| list.and_cpu())?,
                "cuda:all" => (!list.all && list.cuda == 0).then_some(DeviceList { all: true, ..list })?,
                _ => list.with_cuda(number?.parse().ok()?)?,
            };
            follows_number = word != "cpu" && word != "cuda:all";
        }
        Some(list)
    }

    /// Whether the CPU is one of them.
    pub fn has_cpu(&self) -> bool {
        self.cpu
    }

    /// Whether these are all CUDA devices that work.
    pub fn has_all_cuda(&self) -> bool {
        self.all
    }

    /// The numbers of CUDA devices that are listed.
    pub fn numbers(&self) -> impl Iterator<Item = u32> + use<> {
        let cuda = self.cuda;
        (0..u64::BITS).filter(move |number| cuda >> number & 1 == 1)
    }
}

impl From<DeviceList> for Device {
    fn from(list: DeviceList) -> Device {
        Device::Several(list)
    }
}

impl fmt::Display for DeviceList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers: Vec<String> = self.numbers().map(|number| number.to_string()).collect();
        let cuda = if self.all { "cuda:all".to_owned() } else { format!("cuda:{}", numbers.join(",")) };
        match (self.all || self.cuda != 0, self.cpu) {
            (true, true) => write!(f, "{cuda},cpu"),
            (true, false) => f.write_str(&cuda),
            (false, _) => f.write_str("cpu"),
        }
    }
}
