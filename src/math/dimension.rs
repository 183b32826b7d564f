//! Calls from generic functions to functions that are compiled once.

use std::any::Any;

/// Calls `in_2d` or `in_3d`, the one that takes an `A` and returns a `T`; `None` if neither does.
///
/// The generic functions that a program calls are compiled again with the program, and so are all functions that they call.
/// Therefore a large function with a number of dimensions `D` calls a function that is not generic: that one is compiled with the
/// library only.
pub(crate) fn in_dimension<A: 'static, T: 'static, A2: 'static, T2: 'static, A3: 'static, T3: 'static>(
    argument: A,
    in_2d: impl FnOnce(A2) -> T2,
    in_3d: impl FnOnce(A3) -> T3,
) -> Option<T> {
    fn same<A: 'static, B: 'static>(value: &mut Option<A>) -> Option<B> {
        (value as &mut dyn Any).downcast_mut::<Option<B>>()?.take()
    }
    fn call<A: 'static, T: 'static, B: 'static, U: 'static>(
        argument: &mut Option<A>,
        function: impl FnOnce(B) -> U,
    ) -> Option<T> {
        (&None::<T> as &dyn Any).downcast_ref::<Option<U>>()?;
        same(&mut Some(function(same(argument)?)))
    }
    let mut argument = Some(argument);
    call(&mut argument, in_2d).or_else(|| call(&mut argument, in_3d))
}
