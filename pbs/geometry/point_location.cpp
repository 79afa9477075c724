#include "pbs/geometry/point_location.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pbs {
namespace {

constexpr double on_face = 1e-10;  // of a barycentric coordinate: some 1e5 roundings of a well-shaped tet

Vec3 barycentric_in(const TetMesh& mesh, Eigen::Index tet, const Vec3& point)
{
    const auto corner = [&](int c) -> Vec3 { return mesh.rest.row(mesh.tets(tet, c)); };
    Eigen::Matrix3d edges;
    edges << corner(1) - corner(0), corner(2) - corner(0), corner(3) - corner(0);
    return edges.inverse() * (point - corner(0));
}

}  // namespace

PointLocation::PointLocation(const TetMesh& mesh) : mesh_(mesh), low_(mesh.rest.colwise().minCoeff())
{
    const Vec3 size = mesh.rest.colwise().maxCoeff().transpose() - low_;
    const double cell_m = std::cbrt(size.prod() / static_cast<double>(mesh.tets.rows()));  // about one cell a tet
    for (int axis = 0; axis < 3; ++axis) cells_(axis) = std::clamp(static_cast<int>(size(axis) / cell_m), 1, 1000);
    cell_size_m_ = size.cwiseQuotient(cells_.cast<double>());

    first_.assign(cells_.prod() + 1, 0);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) for_each_cell_of_tet(t, [&](int cell) { ++first_[cell + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    tet_in_cell_.resize(first_.back());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for_each_cell_of_tet(t, [&](int cell) { tet_in_cell_[next[cell]++] = static_cast<int>(t); });
}

PointLocation::Cell PointLocation::cell_of(const Vec3& point) const
{
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
        const double place = std::floor((point(axis) - low_(axis)) / cell_size_m_(axis));
        cell(axis) = static_cast<int>(std::clamp(place, 0.0, cells_(axis) - 1.0));
    }
    return cell;
}

template <typename Visit>
void PointLocation::for_each_cell_of_tet(Eigen::Index tet, Visit visit) const
{
    Vec3 low = mesh_.rest.row(mesh_.tets(tet, 0)), high = low;
    for (int corner = 1; corner < 4; ++corner) {
        const Vec3 point = mesh_.rest.row(mesh_.tets(tet, corner));
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    const Vec3 margin = on_face * (high - low);  // so that a point taken for on the face is looked for here
    const Cell first = cell_of(low - margin), last = cell_of(high + margin);
    for (int k = first(2); k <= last(2); ++k)
        for (int j = first(1); j <= last(1); ++j)
            for (int i = first(0); i <= last(0); ++i) visit(index_of({i, j, k}));
}

Location PointLocation::locate(const Vec3& point) const
{
    if (!point.allFinite()) return {};
    const int cell = index_of(cell_of(point));
    for (int k = first_[cell]; k < first_[cell + 1]; ++k) {
        const Vec3 barycentric = barycentric_in(mesh_, tet_in_cell_[k], point);
        if (std::min(barycentric.minCoeff(), 1.0 - barycentric.sum()) >= -on_face) return {tet_in_cell_[k], barycentric};
    }
    return {};
}

}  // namespace pbs
