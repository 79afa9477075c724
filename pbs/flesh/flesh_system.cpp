#include "pbs/flesh/flesh_system.hpp"

#include "pbs/flesh/packed_flesh.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/packed/rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>

namespace pbs {

// Measured at rest, where all steps are rounding: 0.4 roundings of a bar of 208 vertices in every arithmetic.
template <typename Scalar>
double FleshSystem<Scalar>::smallest_step(const Rows<Scalar>& x, double share, double first) const
{
    constexpr double roundings = 4.0;
    return std::max(share * first, roundings * std::numeric_limits<Scalar>::epsilon() * std::sqrt(dot(x, x)));
}

template double FleshSystem<float>::smallest_step(const Rows<float>&, double, double) const;
template double FleshSystem<double>::smallest_step(const Rows<double>&, double, double) const;

template <typename Scalar, typename Energy>
std::unique_ptr<FleshSystem<Scalar>> make_flesh_system(const TetMesh& mesh, const Energy& energy, const CholeskyFactor& factor,
                                                       Arithmetic arithmetic, int threads)
{
    if constexpr (std::is_same_v<Scalar, double>)
        if (arithmetic == Arithmetic::plain_f64) return std::make_unique<PlainSystem<Energy>>(energy, factor);
    return std::make_unique<PackedSystem<Scalar, Energy>>(mesh, energy, factor, threads);
}

template std::unique_ptr<FleshSystem<float>> make_flesh_system(const TetMesh&, const FleshEnergy&, const CholeskyFactor&, Arithmetic, int);
template std::unique_ptr<FleshSystem<double>> make_flesh_system(const TetMesh&, const FleshEnergy&, const CholeskyFactor&, Arithmetic, int);
template std::unique_ptr<FleshSystem<float>> make_flesh_system(const TetMesh&, const ProjectiveEnergy&, const CholeskyFactor&, Arithmetic,
                                                               int);
template std::unique_ptr<FleshSystem<double>> make_flesh_system(const TetMesh&, const ProjectiveEnergy&, const CholeskyFactor&, Arithmetic,
                                                                int);

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
TriangularSolve<Scalar>::TriangularSolve(const CholeskyFactor& factor, const std::vector<int>& place)
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

template <typename Energy>
PlainSystem<Energy>::PlainSystem(const Energy& energy, const CholeskyFactor& factor)
    : energy_(energy), factor_(factor), place_(static_cast<std::size_t>(energy.hold().size()))
{
    std::iota(place_.begin(), place_.end(), 0);
}

template <typename Energy>
void PlainSystem<Energy>::load(const Positions& x, Rows<double>& rows) const
{
    load_rows(x, place_, Vec3::Zero(), rows);
}

template <typename Energy>
void PlainSystem<Energy>::store(const Rows<double>& rows, Positions& x) const
{
    store_rows(rows, place_, Vec3::Zero(), x);
}

template <typename Energy>
double PlainSystem<Energy>::value_and_gradient(const Rows<double>& x, Rows<double>& gradient)
{
    store(x, x_);
    const double value = energy_.value_and_gradient(x_, centres_, gradient_);
    load(gradient_, gradient);
    return value;
}

template <typename Energy>
void PlainSystem<Energy>::precondition(Rows<double>& residual)
{
    solve_plainly(factor_, place_, residual.data(), work_);
}

template <typename Energy>
double PlainSystem<Energy>::dot(const Rows<double>& a, const Rows<double>& b) const
{
    double sum = 0.0;
    for (int i = 0; i < static_cast<int>(place_.size()); ++i)
        for (int axis = 0; axis < 3; ++axis) sum += a[i][axis] * b[i][axis];
    return sum;
}

template <typename Energy>
void PlainSystem<Energy>::add(double factor, const Rows<double>& a, Rows<double>& to) const
{
    for (int i = 0; i < static_cast<int>(place_.size()); ++i)
        for (int axis = 0; axis < 3; ++axis) to[i][axis] += factor * a[i][axis];
}

template class PlainSystem<FleshEnergy>;
template class PlainSystem<ProjectiveEnergy>;

}  // namespace pbs
