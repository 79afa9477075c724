// The projections of pbs/constraints in every lane at once: twins of bind.hpp, stretch.hpp and volume.hpp, line by line.
// A lane whose constraint has no gradient stays, as there. For kernels alone.
#pragma once

#include "pbs/packed/lanes.hpp"

#include <limits>

namespace pbs {

// A vector in every lane.
template <typename Scalar>
struct LaneVector {
    Lanes<Scalar> x, y, z;
};

template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> operator-(const Vertices<Scalar>& a, const Vertices<Scalar>& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> operator+(const LaneVector<Scalar>& a, const LaneVector<Scalar>& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> dot(const LaneVector<Scalar>& a, const LaneVector<Scalar>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> cross(const LaneVector<Scalar>& a, const LaneVector<Scalar>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// p += factor * g; w stays.
template <typename Scalar>
[[gnu::always_inline]] inline void add(const Lanes<Scalar>& factor, const LaneVector<Scalar>& g, Vertices<Scalar>& p)
{
    p.x += factor * g.x;
    p.y += factor * g.y;
    p.z += factor * g.z;
}

// Zero where the denominator is not above `least`.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> quotient(const Lanes<Scalar>& numerator, const Lanes<Scalar>& denominator,
                                                     const Lanes<Scalar>& least = Scalar(0))
{
    Lanes<Scalar> result = numerator / denominator;
    where(!(denominator > least), result) = Scalar(0);
    return result;
}

template <typename Scalar>
[[gnu::always_inline]] inline double sum_of_lanes(const Lanes<Scalar>& lanes_to_add)
{
    double total = 0.0;
    for (int lane = 0; lane < lanes<Scalar>; ++lane) total += double(lanes_to_add[lane]);
    return total;
}

template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> length(const LaneVector<Scalar>& a)
{
    return sqrt(dot(a, a));
}

// q: posed bind points; k: stiffness, zero where the vertex is pinned.
template <typename Scalar>
[[gnu::always_inline]] inline void project_bind(const Lanes<Scalar>& rest_distance, const Lanes<Scalar>& k, const Vertices<Scalar>& q,
                                                Vertices<Scalar>& p)
{
    const LaneVector<Scalar> from_q = p - q;
    const Lanes<Scalar> distance = length(from_q);
    const Lanes<Scalar> C = distance - rest_distance;
    add(-quotient(k * C, distance), from_q, p);
}

// k_w: stiffness over w1 + w2, zero where both are pinned.
template <typename Scalar>
[[gnu::always_inline]] inline void project_stretch(const Lanes<Scalar>& rest_length, const Lanes<Scalar>& k_w, Vertices<Scalar>& p1,
                                                   Vertices<Scalar>& p2)
{
    const LaneVector<Scalar> p12 = p1 - p2;
    const Lanes<Scalar> l = length(p12);
    const Lanes<Scalar> C = l - rest_length;         // Eq. 10
    const Lanes<Scalar> k_s = quotient(k_w * C, l);  // s of Eq. 9
    add(-p1.w * k_s, p12, p1);                       // Eq. 8
    add(p2.w * k_s, p12, p2);
}

// With n = 6 g and 6 C the sixths of Eq. 11-14 cancel. six_rest_volume: 6 V0 [m^3].
template <typename Scalar>
[[gnu::always_inline]] inline void project_volume(const Lanes<Scalar>& six_rest_volume, const Lanes<Scalar>& k, Vertices<Scalar>& p1,
                                                  Vertices<Scalar>& p2, Vertices<Scalar>& p3, Vertices<Scalar>& p4)
{
    const LaneVector<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const LaneVector<Scalar> n4 = cross(p21, p31);
    const Lanes<Scalar> six_C = dot(n4, p41) - six_rest_volume;  // Eq. 11
    const LaneVector<Scalar> n2 = cross(p31, p41);
    const LaneVector<Scalar> n3 = cross(p41, p21);
    const LaneVector<Scalar> minus_n1 = n2 + n3 + n4;  // Eq. 15
    const Lanes<Scalar> denominator = p1.w * dot(minus_n1, minus_n1) + p2.w * dot(n2, n2) + p3.w * dot(n3, n3) + p4.w * dot(n4, n4);
    const Lanes<Scalar> longest2 = max(dot(p21, p21), max(dot(p31, p31), dot(p41, p41)));
    const Lanes<Scalar> rounding = Scalar(4) * std::numeric_limits<Scalar>::epsilon() * longest2;  // of n; see volume.hpp
    const Lanes<Scalar> k_s =
        quotient(k * six_C, denominator, Lanes<Scalar>(rounding * rounding * (p1.w + p2.w + p3.w + p4.w)));  // s of Eq. 21
    add(k_s * p1.w, minus_n1, p1);                                                                           // Eq. 8
    add(-k_s * p2.w, n2, p2);
    add(-k_s * p3.w, n3, p3);
    add(-k_s * p4.w, n4, p4);
}

}  // namespace pbs
