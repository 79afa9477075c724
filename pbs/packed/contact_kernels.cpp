#include "pbs/packed/lanes.hpp"

#include <limits>

namespace pbs {
namespace {

template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> load_any(const Scalar* from)
{
    return Lanes<Scalar>(from, std::experimental::element_aligned);
}

// By libstdc++'s own conversion: the standard one has only single lanes, whose loop takes as long as the comparison.
template <typename Mask>
[[gnu::always_inline]] inline unsigned bits_of(const Mask& mask)
{
    static_assert(16 % Mask::size() == 0);
    return static_cast<unsigned>(mask.__to_bitset().to_ulong());
}

}  // namespace

template <typename Scalar>
auto ContactKernels<Scalar>::box_of(const int* begin, const int* end, const Scalar* x) -> Box
{
    constexpr Scalar far = std::numeric_limits<Scalar>::max();
    Box box{{far, far, far}, {-far, -far, -far}};
    for (; begin < end; ++begin)
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar value = x[*begin + axis];
            if (value < box.low[axis]) box.low[axis] = value;
            if (value > box.high[axis]) box.high[axis] = value;
        }
    return box;
}

template <typename Scalar>
auto ContactKernels<Scalar>::box_around(const Boxes& boxes) -> Box
{
    constexpr Scalar far = std::numeric_limits<Scalar>::max();
    Box box{{far, far, far}, {-far, -far, -far}};
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < at_once; ++k) {
            if (boxes.low[axis][k] < box.low[axis]) box.low[axis] = boxes.low[axis][k];
            if (boxes.high[axis][k] > box.high[axis]) box.high[axis] = boxes.high[axis][k];
        }
    return box;
}

template <typename Scalar>
auto ContactKernels<Scalar>::points_of(const int* begin, const int* end, const Scalar* x) -> Boxes
{
    const auto count = static_cast<int>(end - begin);
    Boxes points;
    for (int k = 0; k < at_once; ++k)
        for (int axis = 0; axis < 3; ++axis) points.low[axis][k] = points.high[axis][k] = x[begin[k < count ? k : count - 1] + axis];
    return points;
}

template <typename Scalar>
unsigned ContactKernels<Scalar>::that_meet(const Boxes& boxes, const Box& box)
{
    unsigned bits = 0;
    for (int k = 0; k < at_once; k += lanes<Scalar>) {
        const auto meet = [&](int axis) {
            return (load_any(&boxes.low[axis][k]) <= box.high[axis]) && (load_any(&boxes.high[axis][k]) >= box.low[axis]);
        };
        bits |= bits_of(meet(0) && meet(1) && meet(2)) << k;
    }
    return bits;
}

template <typename Scalar>
void ContactKernels<Scalar>::find_coordinates(const Corners& corners, const Scalar* x, Coordinates& tets)
{
    Scalar e[3][3][at_once];  // edge, axis, tet
    for (int k = 0; k < at_once; ++k)
        for (int axis = 0; axis < 3; ++axis) tets.first[axis][k] = x[corners.offset[0][k] + axis];
    for (int edge = 0; edge < 3; ++edge)
        for (int k = 0; k < at_once; ++k)
            for (int axis = 0; axis < 3; ++axis) e[edge][axis][k] = x[corners.offset[edge + 1][k] + axis] - tets.first[axis][k];
    for (int edge = 0; edge < 3; ++edge)
        for (int axis = 0; axis < 3; ++axis) {
            const auto &a = e[(edge + 1) % 3], &b = e[(edge + 2) % 3];
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            for (int k = 0; k < at_once; ++k) tets.inverse[edge][axis][k] = a[next][k] * b[last][k] - a[last][k] * b[next][k];
        }
    const auto& row = tets.inverse[0];
    for (int k = 0; k < at_once; ++k) tets.volume[k] = e[0][0][k] * row[0][k] + e[0][1][k] * row[1][k] + e[0][2][k] * row[2][k];
}

template <typename Scalar>
unsigned ContactKernels<Scalar>::tets_around(const Coordinates& tets, const Corners& corners, int vertex, const Scalar* x)
{
    unsigned bits = 0;
    for (int k = 0; k < at_once; k += lanes<Scalar>) {
        Lanes<Scalar> d[3], beta[3];
        for (int axis = 0; axis < 3; ++axis) d[axis] = x[vertex + axis] - load_any(&tets.first[axis][k]);
        for (int i = 0; i < 3; ++i) {
            const auto& row = tets.inverse[i];
            beta[i] = load_any(&row[0][k]) * d[0] + load_any(&row[1][k]) * d[1] + load_any(&row[2][k]) * d[2];
        }
        const Lanes<Scalar> volume = load_any(&tets.volume[k]), first = volume - (beta[0] + beta[1] + beta[2]);
        const auto is_inside = beta[0] >= Scalar(0) && beta[1] >= Scalar(0) && beta[2] >= Scalar(0) && first >= Scalar(0);
        bits |= bits_of(is_inside && volume > Scalar(0)) << k;
    }
    unsigned own = 0;
    for (int k = 0; k < at_once; k += lanes<int>) {
        const auto is = [&](int corner) { return load_any(&corners.offset[corner][k]) == vertex; };
        own |= bits_of(is(0) || is(1) || is(2) || is(3)) << k;
    }
    return bits & ~own;
}

template struct ContactKernels<float>;
template struct ContactKernels<double>;

}  // namespace pbs
