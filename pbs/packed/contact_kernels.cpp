#include "pbs/packed/lanes.hpp"

#include <limits>

namespace pbs {
namespace {

// By libstdc++'s own conversion: the standard one has only single lanes, whose loop takes as long as the comparison.
template <typename Mask>
[[gnu::always_inline]] inline unsigned bits_of(const Mask& mask)
{
    static_assert(16 % Mask::size() == 0);
    return static_cast<unsigned>(mask.__to_bitset().to_ulong());
}

}  // namespace

template <typename Scalar>
auto ContactKernels<Scalar>::box_of(const std::uint32_t* begin, const std::uint32_t* end, const Scalar* x) -> Box
{
    constexpr Scalar far = std::numeric_limits<Scalar>::max();
    Four<Scalar> low = {far, far, far, far}, high = -low;
    for (; begin < end; ++begin) {
        const Four<Scalar> point = load_four(x + *begin);
        low = point < low ? point : low;
        high = point > high ? point : high;
    }
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
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
void ContactKernels<Scalar>::find_points(const std::uint32_t* begin, const std::uint32_t* end, const Scalar* x,
                                         Boxes& points)
{
    constexpr Scalar none = std::numeric_limits<Scalar>::quiet_NaN();
    const auto count = static_cast<int>(end - begin);
    for (int k = 0; k < at_once; ++k)
        for (int axis = 0; axis < 3; ++axis)
            points.low[axis][k] = points.high[axis][k] = k < count ? x[begin[k] + axis] : none;
}

template <typename Scalar>
unsigned ContactKernels<Scalar>::that_meet(const Boxes& boxes, const Box& box)
{
    unsigned bits = 0;
    for (int k = 0; k < at_once; k += lanes<Scalar>) {
        const auto meet = [&](int axis) {
            return (load(&boxes.low[axis][k]) <= box.high[axis]) && (load(&boxes.high[axis][k]) >= box.low[axis]);
        };
        bits |= bits_of(meet(0) && meet(1) && meet(2)) << k;
    }
    return bits;
}

template <typename Scalar>
void ContactKernels<Scalar>::find_coordinates(const Corners& corners, const Scalar* x, Coordinates& tets)
{
    for (int k = 0; k < at_once; k += lanes<Scalar>) {
        const Vertices<Scalar> first = gather(x, &corners.offset[0][k]);
        LaneVector<Scalar> edge[3];
        for (int i = 0; i < 3; ++i) edge[i] = gather(x, &corners.offset[i + 1][k]) - first;
        const auto store_vector = [k](const auto& vector, Scalar(&to)[3][at_once]) {
            store<Scalar>(vector.x, &to[0][k]);
            store<Scalar>(vector.y, &to[1][k]);
            store<Scalar>(vector.z, &to[2][k]);
        };
        store_vector(first, tets.first);
        for (int i = 0; i < 3; ++i) store_vector(cross(edge[(i + 1) % 3], edge[(i + 2) % 3]), tets.inverse[i]);
        store<Scalar>(dot(edge[0], cross(edge[1], edge[2])), &tets.volume[k]);
    }
}

template <typename Scalar>
void ContactKernels<Scalar>::find_tets_around(const Coordinates& tets, const Corners& corners,
                                              const std::uint32_t* begin, const std::uint32_t* end, const Scalar* x,
                                              unsigned* bits)
{
    for (; begin < end; ++begin, ++bits) {
        unsigned around = 0, own = 0;
        for (int k = 0; k < at_once; k += lanes<Scalar>) {
            Lanes<Scalar> d[3], beta[3];
            for (int axis = 0; axis < 3; ++axis) d[axis] = x[*begin + axis] - load(&tets.first[axis][k]);
            for (int i = 0; i < 3; ++i) {
                const auto& row = tets.inverse[i];
                beta[i] = load(&row[0][k]) * d[0] + load(&row[1][k]) * d[1] + load(&row[2][k]) * d[2];
            }
            const Lanes<Scalar> volume = load(&tets.volume[k]), first = volume - (beta[0] + beta[1] + beta[2]);
            const auto is_inside =
                beta[0] >= Scalar(0) && beta[1] >= Scalar(0) && beta[2] >= Scalar(0) && first >= Scalar(0);
            around |= bits_of(is_inside && volume > Scalar(0)) << k;
        }
        for (int k = 0; k < at_once; k += lanes<std::uint32_t>) {
            const auto is = [&](int corner) { return load(&corners.offset[corner][k]) == *begin; };
            own |= bits_of(is(0) || is(1) || is(2) || is(3)) << k;
        }
        *bits = around & ~own;
    }
}

template struct ContactKernels<float>;
template struct ContactKernels<double>;

}  // namespace pbs
