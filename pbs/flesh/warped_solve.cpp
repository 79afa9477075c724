#include "pbs/flesh/warped_solve.hpp"

#include "pbs/geometry/input_error.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <bit>
#include <string>
#include <type_traits>
#include <utility>

namespace pbs {
namespace {

// A number of column c and this row of a panel.
void set_value(std::uint32_t* values, int stride, int c, int row, double number)
{
    // to the nearest
    const std::uint32_t upper_half = (std::bit_cast<std::uint32_t>(static_cast<float>(number)) + 0x8000u) >> 16;
    values[c / 2 * stride + row] |= c % 2 == 0 ? upper_half : upper_half << 16;
}

void set_value(double* values, int stride, int c, int row, double number)
{
    values[c * stride + row] = number;
}

// Consecutive columns of the factor with their rows: those of the columns themselves, and those below the last of them.
struct Columns {
    int first, width;
    std::size_t entries;  // of the factor
};

int rows_below(const CholeskyFactor& factor, const Columns& columns)
{
    const int last = columns.first + columns.width - 1;
    return factor.first[last + 1] - factor.first[last] - 1;
}

// Supernodes, where one that is followed by its parent is merged with it if the zeros that this adds take no longer
// than another panel.
std::vector<Columns> merged_supernodes(const CholeskyFactor& factor)
{
    constexpr std::size_t zeros_of_a_panel = 200;  // of 1, 200, 400 and 800 the quickest on three bodies
    const auto size = [&](const Columns& columns) {
        return static_cast<std::size_t>(columns.width) * (columns.width + rows_below(factor, columns));
    };
    std::vector<Columns> merged;
    for (int column = 0; column < static_cast<int>(factor.order.size());) {
        const int width = width_of_supernode(factor, column, widest_panel);
        Columns next{column, width, static_cast<std::size_t>(factor.first[column + width] - factor.first[column])};
        column += width;
        while (!merged.empty()) {
            const Columns& child = merged.back();
            const int last = child.first + child.width - 1;
            const bool is_parent = rows_below(factor, child) > 0 && factor.row[factor.first[last] + 1] == next.first;
            const Columns both{child.first, child.width + next.width, child.entries + next.entries};
            if (!is_parent || both.width > widest_panel || size(both) > size(child) + size(next) + zeros_of_a_panel)
                break;
            next = both;
            merged.pop_back();
        }
        merged.push_back(next);
    }
    return merged;
}

// L of the columns: the triangle, and the rows below.
Eigen::MatrixXd dense(const CholeskyFactor& factor, const Columns& columns)
{
    const int end = columns.first + columns.width;
    const auto below_begin = factor.row.begin() + factor.first[end - 1] + 1,
               below_end = factor.row.begin() + factor.first[end];
    Eigen::MatrixXd L = Eigen::MatrixXd::Zero(columns.width + (below_end - below_begin), columns.width);
    for (int c = 0; c < columns.width; ++c)
        for (int entry = factor.first[columns.first + c]; entry < factor.first[columns.first + c + 1]; ++entry) {
            const int row = factor.row[entry];
            const auto place = row < end
                                   ? row - columns.first
                                   : columns.width + (std::lower_bound(below_begin, below_end, row) - below_begin);
            L(place, c) = factor.value[entry];
        }
    return L;
}

}  // namespace

template <typename Scalar>
WarpedSolve<Scalar>::WarpedSolve(const TetMesh& mesh, const FleshEnergy& energy, const std::vector<int>& order,
                                 const std::vector<int>& place, bool packed)
    : order_(order), rotations_(3 * static_cast<int>(order.size())), turned_(static_cast<int>(order.size()) + 1)
{
    constexpr double regular = 1e-9;  // holds a part of the body that no spring holds
    Eigen::SparseMatrix<double> stiffness = flesh_hessian(energy, mesh.rest);
    for (Eigen::Index row = 0; row < stiffness.rows(); ++row) {
        double& diagonal = stiffness.coeffRef(row, row);
        diagonal = diagonal > 0.0 ? (1.0 + regular) * diagonal : 1.0;  // 1: a vertex without tets
    }
    std::vector<int> order_of_rows;
    for (const int vertex : order) {
        place_.push_back(4u * place[vertex]);
        for (int axis = 0; axis < 3; ++axis) order_of_rows.push_back(3 * vertex + axis);
    }
    CholeskyFactor factor = cholesky_factor(stiffness, order_of_rows);
    if (!factor.usable())
        throw InputError("flesh", 0, "stiffness at rest", std::to_string(order.size()) + " vertices",
                         "expected tets whose stiffness is positive definite in double; are some of them flat?");
    entries_ = factor.value.size();
    if (packed)
        make_panels(factor);
    else
        plain_ = std::move(factor);
}

template <typename Scalar>
void WarpedSolve<Scalar>::make_panels(const CholeskyFactor& factor)
{
    const std::vector<Columns> supernodes = merged_supernodes(factor);
    constexpr int columns_of_a_value = std::is_same_v<Scalar, float> ? 2 : 1;
    std::size_t numbers = 0;
    int most_blocks = 0;
    for (const Columns& columns : supernodes) {
        const int end = columns.first + columns.width, below = rows_below(factor, columns);
        const std::size_t first_block = blocks_.size();
        for (int row = columns.first; row < end; row += 3) blocks_.push_back(4u * (row / 3));
        for (int k = 0; k < below; k += 3) blocks_.push_back(4u * (factor.row[factor.first[end - 1] + 1 + k] / 3));
        while ((blocks_.size() - first_block) % blocks_together != 0)
            blocks_.push_back(4u * static_cast<std::uint32_t>(order_.size()));
        const int blocks = static_cast<int>(blocks_.size() - first_block);
        panels_.push_back({columns.width / 3, blocks, first_block, numbers});
        numbers += 4 * static_cast<std::size_t>(blocks) * panels_.back().columns() / columns_of_a_value;
        most_blocks = std::max(most_blocks, blocks);
    }
    values_ = Rows<PanelValue<Scalar>>(static_cast<int>(numbers / 4));
    scratch_ = Rows<Scalar>(most_blocks);
    for (std::size_t p = 0; p < panels_.size(); ++p) {
        Eigen::MatrixXd panel = dense(factor, supernodes[p]);
        const Eigen::Index width = panel.cols();
        const Eigen::MatrixXd inverse =
            panel.topRows(width).triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(width, width));
        panel.bottomRows(panel.rows() - width) *= -inverse;
        panel.topRows(width) = inverse;
        PanelValue<Scalar>* values = values_.data() + panels_[p].first_value;
        for (int c = 0; c < width; ++c)
            for (int row = 0; row < panel.rows(); ++row)
                set_value(values, 4 * panels_[p].blocks, c, row / 3 * 4 + row % 3, panel(row, c));
    }
}

template <typename Scalar>
void WarpedSolve<Scalar>::set_rotations(const std::vector<Eigen::Matrix3d>& rotations)
{
    Scalar* to = rotations_.data();
    for (const int vertex : order_)
        for (int column = 0; column < 3; ++column, to += 4)
            for (int axis = 0; axis < 3; ++axis) to[axis] = Scalar(rotations[vertex](axis, column));
}

template <typename Scalar>
void WarpedSolve<Scalar>::apply(Rows<Scalar>& rows)
{
    const int vertices = static_cast<int>(order_.size());
    turn_back(rotations_.data(), place_.data(), vertices, rows.data(), turned_.data());
    if (plain_.usable()) {
        Eigen::VectorXd b(3 * vertices);
        for (int k = 0; k < vertices; ++k)
            for (int axis = 0; axis < 3; ++axis) b(3 * order_[k] + axis) = turned_[k][axis];
        const Eigen::VectorXd solution = solve_plainly(plain_, b);
        for (int k = 0; k < vertices; ++k)
            for (int axis = 0; axis < 3; ++axis) turned_[k][axis] = Scalar(solution(3 * order_[k] + axis));
    } else {
        // of the panels' further rows, which a frame that is not finite would spoil
        std::fill_n(turned_[vertices], 4, Scalar(0));
        solve_panels(panels_.data(), static_cast<int>(panels_.size()), blocks_.data(), values_.data(), turned_.data(),
                     scratch_.data());
    }
    turn(rotations_.data(), place_.data(), vertices, turned_.data(), rows.data());
}

template class WarpedSolve<float>;
template class WarpedSolve<double>;

}  // namespace pbs
