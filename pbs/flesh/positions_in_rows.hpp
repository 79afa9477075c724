// Positions as the rows of a solver: in its order of memory and relative to an origin, or as they are.
//   load_rows(x, order.new_of_old, origin, rows);
//   store_rows(rows, order.new_of_old, origin, x);
#pragma once

#include "pbs/flesh/rows.hpp"
#include "pbs/geometry/types.hpp"

namespace pbs {

// place: the row of each vertex, #V. x [m], #V x 3. The fourth number of a row stays.
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

// The mean of the centres c_i, weighted by a_i, the fourth number of each row: an origin near the body. Zero where nothing holds it.
template <typename Scalar>
Vec3 mean_centre(const Positions& centres, const std::vector<int>& place, const Rows<Scalar>& held)
{
    Vec3 mean = Vec3::Zero();
    double hold = 0.0;
    for (Eigen::Index i = 0; i < centres.rows(); ++i) {
        const double a = double(held[place[i]][3]);
        mean += a * centres.row(i).transpose();
        hold += a;
    }
    if (hold > 0.0) mean /= hold;
    return mean;
}

}  // namespace pbs
