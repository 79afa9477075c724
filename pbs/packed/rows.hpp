// An array of rows x, y, z and one more number, as the kernels need it: 64 bytes aligned, and whole blocks of sixteen rows.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

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

// Positions of the mesh as rows of the kernels (rows.hpp), relative to an origin, and back. place: the row of each vertex, #V.
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

// Row i is vertex i.
inline void load_rows(const Positions& x, Rows<double>& rows)
{
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        for (int axis = 0; axis < 3; ++axis) rows[static_cast<int>(i)][axis] = x(i, axis);
}

inline void store_rows(const Rows<double>& rows, Eigen::Index vertices, Positions& x)
{
    x.resize(vertices, 3);
    for (Eigen::Index i = 0; i < vertices; ++i)
        for (int axis = 0; axis < 3; ++axis) x(i, axis) = rows[static_cast<int>(i)][axis];
}

// Loads the centres c_i of the hold, whose stiffness a_i is the fourth number of each row already, relative to their mean weighted by a_i.
// Returns that mean [m]; zero where nothing is held.
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

}  // namespace pbs
