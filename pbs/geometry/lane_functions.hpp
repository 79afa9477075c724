// The functions that formulae without a branch need (rotation_formula.hpp, local_shape_formula.hpp), for a number in each lane of a
// register. For the kernels' translation units alone, as packed/lanes.hpp.
#pragma once

#include "pbs/geometry/rotation_formula.hpp"

#include <experimental/simd>

namespace pbs {

template <class Scalar>
struct NumberFunctions<std::experimental::native_simd<Scalar>> {
    using Number = std::experimental::native_simd<Scalar>;
    [[gnu::always_inline]] static Number of(double a) { return Number(static_cast<Scalar>(a)); }
    [[gnu::always_inline]] static Number root(Number a) { return std::experimental::sqrt(a); }
    [[gnu::always_inline]] static Number magnitude(Number a) { return std::experimental::abs(a); }
    [[gnu::always_inline]] static Number larger(Number a, Number b) { return where_less(a, b, b, a); }
    [[gnu::always_inline]] static Number where_less(Number a, Number b, Number then, Number otherwise)
    {
        std::experimental::where(a < b, otherwise) = then;
        return otherwise;
    }
    [[gnu::always_inline]] static bool any_less(Number a, Number b) { return std::experimental::any_of(a < b); }
};

}  // namespace pbs
