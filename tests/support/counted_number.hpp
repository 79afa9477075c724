// A number that counts its operations, for formulae that are written for any type of numbers (pbs/geometry/rotation_formula.hpp).
//   Counted::operations = 0;
//   formula(Counted(1.0));
//   EXPECT_EQ(Counted::operations, 691);
#pragma once

#include "pbs/geometry/rotation_formula.hpp"

#include <cmath>

namespace test_support {

struct Counted {
    Counted(double a = 0.0) : value(a) {}
    double value;
    static inline int operations = 0;

    static Counted counted(double result)
    {
        ++operations;
        return result;
    }
    friend Counted operator+(Counted a, Counted b) { return counted(a.value + b.value); }
    friend Counted operator-(Counted a, Counted b) { return counted(a.value - b.value); }
    friend Counted operator*(Counted a, Counted b) { return counted(a.value * b.value); }
    friend Counted operator/(Counted a, Counted b) { return counted(a.value / b.value); }
    Counted operator-() const { return -value; }
};

}  // namespace test_support

template <>
struct pbs::NumberFunctions<test_support::Counted> {
    using Counted = test_support::Counted;
    static Counted of(double a) { return a; }
    static Counted root(Counted a) { return Counted::counted(std::sqrt(a.value)); }
    static Counted magnitude(Counted a) { return std::abs(a.value); }
    static Counted larger(Counted a, Counted b) { return a.value < b.value ? b : a; }
    static Counted where_less(Counted a, Counted b, Counted then, Counted otherwise) { return a.value < b.value ? then : otherwise; }
    static bool any_less(Counted a, Counted b) { return a.value < b.value; }
};
