//! Records, and the types of their fields.

use std::marker::PhantomData;

use bytemuck::{Pod, Zeroable};

/// A type that a record's field may have.
pub trait DeviceType: Pod {
    /// Declares a variable of this type in C++.
    fn declare(name: &str) -> String;
}

/// A struct with the same layout on both sides. Implemented by the macro `records!`.
pub trait Record: DeviceType {
    /// Its name on both sides.
    const NAME: &'static str;

    /// Its fields in order.
    fn fields() -> Vec<Field>;
}

/// A field of a record.
#[derive(Clone, Debug)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// Its declaration in C++.
    pub declaration: String,
    /// Offset from the record's start in bytes.
    pub offset: usize,
}

/// What the header says of a record.
pub(crate) struct Outline {
    pub(crate) name: &'static str,
    /// Its size in bytes.
    pub(crate) size: usize,
    /// Its alignment in bytes.
    pub(crate) alignment: usize,
    /// Its fields in order.
    pub(crate) fields: Vec<Field>,
}

impl Outline {
    pub(crate) fn of<T: Record>() -> Outline {
        Outline { name: T::NAME, size: size_of::<T>(), alignment: align_of::<T>(), fields: T::fields() }
    }
}

macro_rules! scalar {
    ($($rust:ty => $c:literal),*) => {
        $(impl DeviceType for $rust {
            fn declare(name: &str) -> String {
                format!(concat!($c, " {}"), name)
            }
        })*
    };
}

scalar! {
    f32 => "float", f64 => "double", i32 => "int", u32 => "unsigned", u64 => "unsigned long long",
    u16 => "unsigned short", u8 => "unsigned char"
}

impl<T: DeviceType, const N: usize> DeviceType for [T; N]
where
    [T; N]: Pod,
{
    fn declare(name: &str) -> String {
        T::declare(&format!("{name}[{N}]"))
    }
}

macro_rules! pointer {
    ($(#[$doc:meta])* $name:ident, $qualifier:literal) => {
        $(#[$doc])*
        #[repr(transparent)]
        #[derive(Debug)]
        pub struct $name<T> {
            address: u64,
            target: PhantomData<fn() -> T>,
        }

        impl<T> $name<T> {
            /// The null pointer, for absent data.
            pub const NULL: $name<T> = $name { address: 0, target: PhantomData };

            /// A pointer to a device address.
            pub fn to(address: u64) -> $name<T> {
                $name { address, target: PhantomData }
            }

            /// The device address.
            pub fn address(self) -> u64 {
                self.address
            }
        }

        impl<T> Clone for $name<T> {
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<T> Copy for $name<T> {}

        // SAFETY: an integer and a zero-sized marker, with transparent representation.
        unsafe impl<T: 'static> Zeroable for $name<T> {}
        // SAFETY: as above.
        unsafe impl<T: 'static> Pod for $name<T> {}

        impl<T: DeviceType> DeviceType for $name<T> {
            fn declare(name: &str) -> String {
                format!(concat!($qualifier, "{}"), T::declare(&format!("*{name}")))
            }
        }
    };
}

pointer! {
    /// A device address that kernels read from.
    In, "const "
}
pointer! {
    /// A device address that kernels write to.
    Out, ""
}

/// Declares records: structs without padding, with documented fields.
macro_rules! records {
    ($($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $type:ty,)* })*) => {
        $(
            $(#[$doc])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
            pub struct $name {
                $(#[allow(missing_docs, reason = "the record says it")] $(#[$field_doc])* pub $field: $type,)*
            }

            impl $crate::DeviceType for $name {
                fn declare(name: &str) -> String {
                    format!(concat!(stringify!($name), " {}"), name)
                }
            }

            impl $crate::Record for $name {
                const NAME: &'static str = stringify!($name);

                fn fields() -> Vec<$crate::Field> {
                    vec![$($crate::Field {
                        name: stringify!($field),
                        declaration: <$type as $crate::DeviceType>::declare(stringify!($field)),
                        offset: std::mem::offset_of!($name, $field),
                    }),*]
                }
            }
        )*

        /// The outlines of this module's records, in order.
        pub(crate) fn outlines() -> Vec<$crate::record::Outline> {
            vec![$($crate::record::Outline::of::<$name>()),*]
        }
    };
}

pub(crate) use records;
