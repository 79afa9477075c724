#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/packed/lanes.hpp"

#include <type_traits>
#include <utility>

namespace pbs {
namespace {

constexpr int numbers_together = 4 * blocks_together;

template <typename Scalar>
Four<Scalar>& block_at(Scalar* work, std::uint32_t offset)
{
    return *reinterpret_cast<Four<Scalar>*>(work + offset);
}

// The values of two columns in as many rows as there are lanes. values: of the first row of the columns' pair.
template <typename Scalar>
struct ColumnPair {
    Lanes<Scalar> first, second;
};

[[gnu::always_inline]] inline ColumnPair<float> load_pair(const std::uint32_t* values, int /*stride*/, int row)
{
    using Words [[gnu::vector_size(4 * lanes<float>), gnu::may_alias]] = std::uint32_t;
    const Words words = *reinterpret_cast<const Words*>(values + row);
    const auto first = (simd_detail::Row<float>)(words << 16), second = (simd_detail::Row<float>)(words & 0xffff0000u);
    return {reinterpret_cast<const Lanes<float>&>(first), reinterpret_cast<const Lanes<float>&>(second)};
}

[[gnu::always_inline]] inline ColumnPair<double> load_pair(const double* values, int stride, int row)
{
    return {load(values + row), load(values + stride + row)};
}

// From one pair of columns to the next.
template <typename Scalar>
constexpr int step_of_pair(int stride)
{
    return std::is_same_v<Scalar, float> ? stride : 2 * stride;
}

// As many numbers as there are lanes, from number `first` of the blocks on, a multiple of their number.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> gather_blocks(Scalar* work, const std::uint32_t* block, int first)
{
    if constexpr (lanes<Scalar> < 4) {
        return Lanes<Scalar>([&](auto lane) { return work[block[(first + lane) / 4] + (first + lane) % 4]; });
    } else {
        const auto row =
            simd_detail::side_by_side<Scalar>([&](int lane) { return block_at(work, block[(first + lane) / 4]); });
        return reinterpret_cast<const Lanes<Scalar>&>(row);
    }
}

template <typename Scalar, std::size_t... k>
[[gnu::always_inline]] inline void add_row(const simd_detail::Row<Scalar>& row, Scalar* work,
                                           const std::uint32_t* block, std::index_sequence<k...>)
{
    ((block_at(work, block[k]) += simd_detail::block<k, Scalar>(row)), ...);
}

template <typename Scalar>
[[gnu::always_inline]] inline void add_to_blocks(const Lanes<Scalar>& numbers, Scalar* work, const std::uint32_t* block,
                                                 int first)
{
    if constexpr (lanes<Scalar> < 4)
        for (int lane = 0; lane < lanes<Scalar>; ++lane)
            work[block[(first + lane) / 4] + (first + lane) % 4] += numbers[lane];
    else
        add_row<Scalar>(reinterpret_cast<const simd_detail::Row<Scalar>&>(numbers), work, block + first / 4,
                        std::make_index_sequence<lanes<Scalar> / 4>());
}

// Adds P b to the blocks, where b are those of the columns, which are zeroed before.
template <typename Scalar>
void substitute_forward(const Panel& panel, const std::uint32_t* block, const PanelValue<Scalar>* values, Scalar* work)
{
    Scalar b[widest_panel];
    b[panel.columns() - 1] = Scalar(0);
    for (int k = 0; k < panel.column_blocks; ++k) {
        Four<Scalar>& columns = block_at(work, block[k]);
        for (int axis = 0; axis < 3; ++axis) b[3 * k + axis] = columns[axis];
        columns = Four<Scalar>{};
    }
    const int stride = 4 * panel.blocks, step = step_of_pair<Scalar>(stride);
    for (int row = 0; row < stride; row += lanes<Scalar>) {
        Lanes<Scalar> sums[2] = {Scalar(0), Scalar(0)};  // each sum waits for its last addition
        for (int c = 0; c < panel.columns(); c += 2) {
            const ColumnPair<Scalar> pair = load_pair(values + c / 2 * step, stride, row);
            sums[0] += Lanes<Scalar>(b[c]) * pair.first;
            sums[1] += Lanes<Scalar>(b[c + 1]) * pair.second;
        }
        add_to_blocks<Scalar>(sums[0] + sums[1], work, block, row);
    }
}

// The columns' blocks become P^T times all blocks.
template <typename Scalar>
void substitute_backward(const Panel& panel, const std::uint32_t* block, const PanelValue<Scalar>* values, Scalar* work,
                         Scalar* scratch)
{
    const int stride = 4 * panel.blocks, step = step_of_pair<Scalar>(stride);
    for (int row = 0; row < stride; row += lanes<Scalar>) store(gather_blocks(work, block, row), scratch + row);
    Scalar x[widest_panel];
    for (int c = 0; c < panel.columns(); c += 2, values += step) {
        Lanes<Scalar> sums[2] = {Scalar(0), Scalar(0)};
        for (int row = 0; row < stride; row += lanes<Scalar>) {
            const Lanes<Scalar> rows = load(scratch + row);
            const ColumnPair<Scalar> pair = load_pair(values, stride, row);
            sums[0] += rows * pair.first;
            sums[1] += rows * pair.second;
        }
        for (int k = 0; k < 2; ++k) x[c + k] = std::experimental::reduce(sums[k]);
    }
    for (int k = 0; k < panel.column_blocks; ++k)
        block_at(work, block[k]) = Four<Scalar>{x[3 * k], x[3 * k + 1], x[3 * k + 2], Scalar(0)};
}

}  // namespace

static_assert(numbers_together % lanes<float> == 0 && numbers_together % lanes<double> == 0);

template <typename Scalar>
void solve_panels(const Panel* panels, int count, const std::uint32_t* block, const PanelValue<Scalar>* values,
                  Scalar* work, Scalar* scratch)
{
    for (const Panel* panel = panels; panel != panels + count; ++panel)
        substitute_forward<Scalar>(*panel, block + panel->first_block, values + panel->first_value, work);
    for (const Panel* panel = panels + count; panel-- != panels;)
        substitute_backward<Scalar>(*panel, block + panel->first_block, values + panel->first_value, work, scratch);
}

template <typename Scalar>
void turn_back(const Scalar* rotations, const std::uint32_t* place, int vertices, const Scalar* rows, Scalar* turned)
{
    for (int k = 0; k < vertices; ++k, rotations += 12, turned += 4) {
        const Four<Scalar> row = load_four(rows + place[k]);
        Four<Scalar> result{};
        for (int axis = 0; axis < 3; ++axis) {
            const Four<Scalar> products = load_four(rotations + 4 * axis) * row;
            result[axis] = products[0] + products[1] + products[2];
        }
        store_four<Scalar>(result, turned);
    }
}

template <typename Scalar>
void turn(const Scalar* rotations, const std::uint32_t* place, int vertices, const Scalar* turned, Scalar* rows)
{
    for (int k = 0; k < vertices; ++k, rotations += 12, turned += 4)
        store_four<Scalar>(turned[0] * load_four(rotations) + turned[1] * load_four(rotations + 4) +
                               turned[2] * load_four(rotations + 8),
                           rows + place[k]);
}

template void solve_panels(const Panel*, int, const std::uint32_t*, const std::uint32_t*, float*, float*);
template void solve_panels(const Panel*, int, const std::uint32_t*, const double*, double*, double*);
template void turn_back(const float*, const std::uint32_t*, int, const float*, float*);
template void turn_back(const double*, const std::uint32_t*, int, const double*, double*);
template void turn(const float*, const std::uint32_t*, int, const float*, float*);
template void turn(const double*, const std::uint32_t*, int, const double*, double*);

}  // namespace pbs
