#include "pbs/flesh/flesh_system.hpp"

#include <algorithm>

namespace pbs {
namespace {

// How many columns from `column` on have the same rows below the last of them.
int width_of_supernode(const CholeskyFactor& factor, int column)
{
    const int columns = static_cast<int>(factor.order.size());
    int width = 1;
    while (width < widest_supernode && column + width < columns) {
        const int last = column + width - 1;
        const int entries = factor.first[last + 1] - factor.first[last], next = factor.first[last + 2] - factor.first[last + 1];
        // The rows of a column below its diagonal are among those of the column of the first of them (elimination tree).
        const bool is_parent = entries > 1 && factor.row[factor.first[last] + 1] == last + 1;
        if (!is_parent || entries != next + 1) break;
        ++width;
    }
    return width;
}

}  // namespace

template <typename Scalar>
TriangularSolve<Scalar>::TriangularSolve(const CholeskyFactor& factor, const std::vector<int>& place) : entries_(factor.value.size())
{
    const int columns = static_cast<int>(factor.order.size());
    for (const int row : factor.order) place_.push_back(4u * place[row]);
    for (int column = 0; column < columns;) {
        const int width = width_of_supernode(factor, column);
        const int last = column + width - 1;
        Supernode node{column, width, factor.first[last + 1] - factor.first[last] - 1, below_.size(), values_.size()};
        const auto entry = [&](int row_in_column, int c) { return factor.value[factor.first[column + c] + row_in_column - c]; };
        for (int row = 0; row < width; ++row) {
            for (int c = 0; c < row; ++c) values_.push_back(Scalar(entry(row, c)));
            values_.push_back(Scalar(1.0 / entry(row, row)));
        }
        for (int k = 0; k < node.rows_below; ++k) {
            below_.push_back(4u * factor.row[factor.first[last] + 1 + k]);
            for (int c = 0; c < width; ++c) values_.push_back(Scalar(entry(width + k, c)));
        }
        supernodes_.push_back(node);
        column += width;
    }
    work_ = Rows<Scalar>(static_cast<int>(factor.order.size()));
}

template <typename Scalar>
void TriangularSolve<Scalar>::apply(Scalar* rows)
{
    solve_supernodes(supernodes_.data(), static_cast<int>(supernodes_.size()), below_.data(), values_.data(), place_.data(),
                     static_cast<int>(place_.size()), rows, work_.data());
}

template <typename Scalar>
std::size_t TriangularSolve<Scalar>::bytes() const
{
    return values_.size() * sizeof(Scalar) + below_.size() * sizeof(std::uint32_t) + supernodes_.size() * sizeof(Supernode);
}

void solve_plainly(const CholeskyFactor& factor, const std::vector<int>& place, double* rows, std::vector<double>& work)
{
    const int columns = static_cast<int>(factor.order.size());
    work.resize(3 * columns);
    for (int k = 0; k < columns; ++k)
        for (int axis = 0; axis < 3; ++axis) work[3 * k + axis] = rows[4 * place[factor.order[k]] + axis];
    for (int column = 0; column < columns; ++column) {  // L y = b
        const int first = factor.first[column], end = factor.first[column + 1];
        for (int axis = 0; axis < 3; ++axis) work[3 * column + axis] /= factor.value[first];
        for (int k = first + 1; k < end; ++k)
            for (int axis = 0; axis < 3; ++axis) work[3 * factor.row[k] + axis] -= factor.value[k] * work[3 * column + axis];
    }
    for (int column = columns - 1; column >= 0; --column) {  // L^T x = y
        const int first = factor.first[column], end = factor.first[column + 1];
        for (int k = first + 1; k < end; ++k)
            for (int axis = 0; axis < 3; ++axis) work[3 * column + axis] -= factor.value[k] * work[3 * factor.row[k] + axis];
        for (int axis = 0; axis < 3; ++axis) work[3 * column + axis] /= factor.value[first];
    }
    for (int k = 0; k < columns; ++k)
        for (int axis = 0; axis < 3; ++axis) rows[4 * place[factor.order[k]] + axis] = work[3 * k + axis];
}

template class TriangularSolve<float>;
template class TriangularSolve<double>;

}  // namespace pbs
