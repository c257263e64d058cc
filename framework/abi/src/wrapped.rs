//! One wrapper for all roles and services: it passes every call on, and something happens around it.
//!
//! Guards and meters differ in what happens ([`Around`]). What is passed on stands in two tables, one of the
//! roles and one of the services.

use regrasp_api::{CallError, LoneFinger};

/// What happens around the calls of an object.
pub trait Around {
    /// A call that can fail.
    fn call<R>(&self, call: impl FnOnce() -> Result<R, CallError>) -> Result<R, CallError>;

    /// A call that returns a plain value; `harmless` may take its place.
    fn value<R>(&self, call: impl FnOnce() -> R, harmless: impl FnOnce() -> R) -> R;

    /// A question whose answer is always the same, and costs next to nothing.
    fn constant<R>(&self, call: impl FnOnce() -> R, harmless: impl FnOnce() -> R) -> R {
        self.value(call, harmless)
    }

    /// A finger among resting bodies that a call has given: its calls are to be wrapped as well.
    fn lone_finger<'a>(&'a self, finger: Box<dyn LoneFinger + 'a>) -> Box<dyn LoneFinger + 'a>;
}

/// An object of a role or a service, owned or borrowed, with something around each of its calls.
#[derive(Clone, Copy, Debug)]
pub struct Wrapped<A, O> {
    pub(crate) around: A,
    pub(crate) object: O,
}

impl<A, O> Wrapped<A, O> {
    /// `object` with `around` around its calls.
    pub fn new(around: A, object: O) -> Self {
        Self { around, object }
    }
}

/// Implements a trait for [`Wrapped`] objects of it, from its methods: each can fail (`call`), or says what
/// is harmless in place of its value; what needs more than that is written by hand.
macro_rules! passed_on {
    ($trait:ident: [$($bound:tt)*] {
        $(fn $method:ident(&$self:ident $(, $arg:ident: $type:ty)*) -> $answer:ty
            as $kind:ident $(($harmless:expr))?;)+
    } $({$($by_hand:tt)*})?) => {
        impl<A: $crate::wrapped::Around $($bound)*, O: std::ops::Deref $($bound)*> $trait
            for $crate::wrapped::Wrapped<A, O>
        where
            O::Target: $trait,
        {
            $(fn $method(&$self $(, $arg: $type)*) -> $answer {
                $self.around.$kind(|| $self.object.$method($($arg),*) $(, || $harmless)?)
            })+

            $($($by_hand)*)?
        }
    };
}
pub(crate) use passed_on;
