//! Constants as they appear in the header.

/// A constant as it appears in the header.
pub(crate) struct Constant {
    pub(crate) name: &'static str,
    /// Its documentation, line by line.
    pub(crate) docs: &'static [&'static str],
    /// Its value in C++.
    pub(crate) literal: String,
}

impl Constant {
    pub(crate) fn new<T: Literal>(name: &'static str, docs: &'static [&'static str], value: T) -> Constant {
        Constant { name, docs, literal: value.literal() }
    }
}

/// A number that C++ reads as the same bits.
pub(crate) trait Literal {
    fn literal(self) -> String;
}

impl Literal for u32 {
    fn literal(self) -> String {
        // Bit patterns are easier to read in hexadecimal.
        if self < 1 << 16 { format!("{self}u") } else { format!("{self:#010x}u") }
    }
}

impl Literal for i32 {
    fn literal(self) -> String {
        format!("{self}")
    }
}

impl Literal for u64 {
    fn literal(self) -> String {
        format!("{self:#018x}ull")
    }
}

impl Literal for f32 {
    fn literal(self) -> String {
        // Every f32 but zero is a normal number as f64.
        f64::from(self).literal() + "f"
    }
}

impl Literal for f64 {
    fn literal(self) -> String {
        let bits = self.to_bits();
        let (sign, exponent) = (if bits >> 63 == 0 { "" } else { "-" }, (bits >> 52 & 0x7ff) as i32 - 1023);
        let fraction = format!("{:013x}", bits & ((1 << 52) - 1));
        let digits = fraction.trim_end_matches('0');
        let point = if digits.is_empty() { "" } else { "." };
        format!("{sign}0x1{point}{digits}p{exponent}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_are_written_with_all_their_bits() {
        assert_eq!(
            [8.0f32, -1.0, 0.75, 1e-30].map(Literal::literal),
            ["0x1p3f", "-0x1p0f", "0x1.8p-1f", "0x1.4484cp-100f"]
        );
        assert_eq!(f32::from_bits(1).literal(), "0x1p-149f");
        assert_eq!(f64::MAX.literal(), "0x1.fffffffffffffp1023");
    }

    #[test]
    fn whole_numbers_have_their_type() {
        assert_eq!([7u32, u32::MAX].map(Literal::literal), ["7u", "0xffffffffu"]);
        assert_eq!((16i32.literal(), 5u64.literal()), ("16".to_owned(), "0x0000000000000005ull".to_owned()));
    }
}
