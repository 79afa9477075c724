// An array of rows x, y, z and one more number, as the kernels need it: 64 bytes aligned, and whole blocks of sixteen
// rows.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <numeric>
#include <utility>
#include <vector>

namespace pbs {

inline constexpr int rows_of_block = 16;

template <typename Scalar>
class Rows {
public:
    Rows() = default;
    explicit Rows(int rows) : blocks_((rows + rows_of_block - 1) / rows_of_block, Block{}) {}  // zeros

    Scalar* data() { return blocks_.empty() ? nullptr : blocks_.front().numbers; }
    const Scalar* data() const { return blocks_.empty() ? nullptr : blocks_.front().numbers; }
    Scalar* operator[](int row) { return data() + 4 * row; }
    const Scalar* operator[](int row) const { return data() + 4 * row; }
    int size() const { return static_cast<int>(blocks_.size()) * rows_of_block; }

private:
    struct alignas(64) Block {
        Scalar numbers[4 * rows_of_block];
    };
    std::vector<Block> blocks_;
};

// Positions of the mesh as rows of the kernels, relative to an origin, and back. place: the row of each vertex, #V.
template <typename Scalar>
void load_rows(const Positions& x, const std::vector<int>& place, const Vec3& origin, Rows<Scalar>& rows)
{
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        for (int axis = 0; axis < 3; ++axis) rows[place[i]][axis] = Scalar(x(i, axis) - origin(axis));
}

template <typename Scalar>
void store_rows(const Rows<Scalar>& rows, const std::vector<int>& place, const Vec3& origin, Positions& x)
{
    x.resize(static_cast<Eigen::Index>(place.size()), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        for (int axis = 0; axis < 3; ++axis) x(i, axis) = double(rows[place[i]][axis]) + origin(axis);
}

// Loads the centres c_i of the hold, whose stiffness a_i is the fourth number of each row already, relative to their
// mean weighted by a_i. Returns that mean [m]; zero where nothing is held.
template <typename Scalar>
Vec3 load_held_centres(const Positions& centres, const std::vector<int>& place, Rows<Scalar>& rows)
{
    Vec3 origin = Vec3::Zero();
    double hold = 0.0;
    for (Eigen::Index i = 0; i < centres.rows(); ++i) {
        const double a = double(rows[place[i]][3]);
        origin += a * centres.row(i).transpose();
        hold += a;
    }
    if (hold > 0.0) origin /= hold;
    load_rows(centres, place, origin, rows);
    return origin;
}

// Solvers on rows have in common where the rows of the vertices lie, and the origin to which positions are relative.
template <typename Scalar>
class RowSystem {
public:
    virtual ~RowSystem() = default;

    // zeros, of vertices and what the kernels need behind them
    virtual Rows<Scalar> rows() const { return Rows<Scalar>(rows_); }
    void load(const Positions& x, Rows<Scalar>& rows) const { load_rows(x, place_, origin_, rows); }
    void store(const Rows<Scalar>& rows, Positions& x) const { store_rows(rows, place_, origin_, x); }
    const std::vector<int>& place() const { return place_; }  // the row of each vertex, #V

protected:
    RowSystem(std::vector<int> place, int rows) : place_(std::move(place)), rows_(rows) {}
    // plain
    explicit RowSystem(int vertices) : place_(vertices), rows_(vertices) { std::iota(place_.begin(), place_.end(), 0); }

    std::vector<int> place_;
    int rows_;
    Vec3 origin_ = Vec3::Zero();
};

}  // namespace pbs
