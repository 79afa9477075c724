#include "pbs/skinning/delta_mush.hpp"

#include "pbs/geometry/nearest_rotation.hpp"

namespace pbs {

template <class Scalar>
std::vector<Scalar> padded_rows(const Positions& points, const Vec3& origin, Scalar fourth)
{
    std::vector<Scalar> rows;
    rows.reserve(4 * points.rows());
    for (const auto& point : points.rowwise()) {
        for (int axis = 0; axis < 3; ++axis) rows.push_back(static_cast<Scalar>(point(axis) - origin(axis)));
        rows.push_back(fourth);
    }
    return rows;
}

Vec3 middle_of_box(const Positions& points)
{
    if (points.rows() == 0) return Vec3::Zero();
    return 0.5 * (points.colwise().minCoeff() + points.colwise().maxCoeff()).transpose();
}

Vec3 posed_origin(const Pose& pose, const Vec3& middle)
{
    return pose.empty() ? middle : pose[0] * middle;
}

template <class Scalar>
void to_world(const std::vector<Scalar>& rows, const Vec3& origin, Positions& positions)
{
    using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>;
    const Eigen::Index vertices = static_cast<Eigen::Index>(rows.size() / 3);
    positions = Eigen::Map<const Rows>(rows.data(), vertices, 3).template cast<double>().rowwise() + origin.transpose();
}

template <class Scalar>
RefusedRotations<Scalar> PackedRotations<Scalar>::none_yet()
{
    return {0, vertex_.data(), reinterpret_cast<Scalar(*)[9]>(covariance_.data())};
}

template <class Scalar>
void PackedRotations<Scalar>::turn(const RefusedRotations<Scalar>& refused, const std::vector<Scalar>& detail, std::vector<Scalar>& posed)
{
    using Rows = Eigen::Matrix<Scalar, 3, 3, Eigen::RowMajor>;
    using Row = Eigen::Matrix<Scalar, 3, 1>;
    for (int i = 0; i < refused.n; ++i) {
        const int v = refused.vertex[i];
        const Eigen::Matrix3d covariance = Eigen::Map<const Rows>(refused.covariance[i]).template cast<double>();
        const Vec3 own = Eigen::Map<const Row>(&detail[4L * v]).template cast<double>();
        Eigen::Map<Row>(&posed[3L * v]) += (nearest_rotation(covariance) * own).template cast<Scalar>();
    }
}

#define PBS_PACKED_ROTATIONS(Scalar)                                                 \
    template std::vector<Scalar> padded_rows(const Positions&, const Vec3&, Scalar); \
    template void to_world(const std::vector<Scalar>&, const Vec3&, Positions&);     \
    template class PackedRotations<Scalar>;
PBS_PACKED_ROTATIONS(float)
PBS_PACKED_ROTATIONS(double)

}  // namespace pbs
