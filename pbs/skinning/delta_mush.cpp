#include "pbs/skinning/delta_mush.hpp"

#include "pbs/geometry/nearest_rotation.hpp"

namespace pbs {

DeltaMush::DeltaMush(const TetMesh& mesh, const DeltaMushOptions& options)
    : options_(options), neighbours_(adjacency_of(mesh.tets, static_cast<int>(mesh.rest.rows()))), rest_(mesh.rest)
{
    smoothed_rest_ = smoothed(mesh.rest);
    delta_ = mesh.rest - smoothed_rest_;
}

void DeltaMush::apply(const Positions& blended, Positions& posed) const
{
    const Positions smooth = smoothed(blended);
    posed.resize(blended.rows(), 3);
    for (int i = 0; i < blended.rows(); ++i) {
        Eigen::Matrix3d frame = covariance(smooth, smoothed_rest_, i);
        if (options_.unsmoothed_share > 0.0) frame += options_.unsmoothed_share * covariance(blended, rest_, i);
        posed.row(i) = smooth.row(i) + (nearest_rotation(frame) * delta_.row(i).transpose()).transpose();
    }
}

Positions DeltaMush::smoothed(Positions positions) const
{
    Positions next = positions;
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
        for (Eigen::Index i = 0; i < positions.rows(); ++i) {
            if (neighbours_.first[i] == neighbours_.first[i + 1]) continue;
            Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
            for (int k = neighbours_.first[i]; k < neighbours_.first[i + 1]; ++k)
                sum += positions.row(neighbours_.neighbour[k]);
            next.row(i) = positions.row(i) +
                          options_.step * (sum / (neighbours_.first[i + 1] - neighbours_.first[i]) - positions.row(i));
        }
        positions.swap(next);
    }
    return positions;
}

// The sum over the neighbours of (posed edge) (rest edge)^T.
Eigen::Matrix3d DeltaMush::covariance(const Positions& posed, const Positions& rest, int vertex) const
{
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int k = neighbours_.first[vertex]; k < neighbours_.first[vertex + 1]; ++k)
        sum += (posed.row(neighbours_.neighbour[k]) - posed.row(vertex)).transpose() *
               (rest.row(neighbours_.neighbour[k]) - rest.row(vertex));
    return sum;
}

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

template <class Scalar>
RefusedRotations<Scalar> PackedRotations<Scalar>::none_yet()
{
    return {0, vertex_.data(), reinterpret_cast<Scalar(*)[9]>(covariance_.data())};
}

template <class Scalar>
void PackedRotations<Scalar>::turn(const RefusedRotations<Scalar>& refused, const std::vector<Scalar>& detail,
                                   std::vector<Scalar>& posed)
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

template std::vector<float> padded_rows(const Positions&, const Vec3&, float);
template std::vector<double> padded_rows(const Positions&, const Vec3&, double);
template class PackedRotations<float>;
template class PackedRotations<double>;

template <class Scalar>
PackedDeltaMush<Scalar>::PackedDeltaMush(const TetMesh& mesh, const DeltaMushOptions& options)
    : refused_(mesh.rest.rows()), options_(options), middle_(middle_of_box(mesh.rest))
{
    const DeltaMush plain(mesh, options);
    first_ = plain.neighbours().first;
    neighbour_ = plain.neighbours().neighbour;
    for (Eigen::Index i = 0; i < mesh.rest.rows(); ++i) {
        const int count = first_[i + 1] - first_[i];
        one_over_.push_back(count > 0 ? Scalar(1) / static_cast<Scalar>(count) : Scalar(0));
    }
    rest_ = padded_rows<Scalar>(mesh.rest, middle_);
    smoothed_rest_ = padded_rows<Scalar>(plain.smoothed_rest(), middle_);
    detail_ = padded_rows<Scalar>(plain.detail(), Vec3::Zero());
    smoothed_.resize(smoothed_rest_.size());
    next_.resize(smoothed_rest_.size());
    posed_.resize(mesh.rest.size());
    blended_.resize(mesh.rest.size());
}

template <class Scalar>
void PackedDeltaMush<Scalar>::apply_rows(const Scalar* blended)
{
    const int vertices = static_cast<int>(one_over_.size());
    for (int i = 0; i < vertices; ++i)
        for (int axis = 0; axis < 3; ++axis) smoothed_[4L * i + axis] = blended[3L * i + axis];
    if (options_.unsmoothed_share > 0.0) unsmoothed_ = smoothed_;
    const NeighbourRows<Scalar> rows{vertices, first_.data(), neighbour_.data(), one_over_.data()};
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
        smooth_points(rows, static_cast<Scalar>(options_.step), smoothed_.data(), next_.data());
        smoothed_.swap(next_);
    }
    RefusedRotations<Scalar> refused = refused_.none_yet();
    const EdgeRows<Scalar> smoothed{smoothed_rest_.data(), smoothed_.data(), Scalar(1)};
    const EdgeRows<Scalar> unsmoothed{rest_.data(), unsmoothed_.data(), static_cast<Scalar>(options_.unsmoothed_share)};
    add_detail(rows, smoothed, unsmoothed, detail_.data(), posed_.data(), refused);
    PackedRotations<Scalar>::turn(refused, detail_, posed_);
}

template <class Scalar>
void PackedDeltaMush<Scalar>::apply(BlendSkinning<Scalar>& skinning, const Pose& pose, Positions& posed)
{
    const Vec3 origin = posed_origin(pose, middle_);
    skinning.linear_rows(pose, origin, blended_.data());
    apply_rows(blended_.data());
    to_world(posed_, origin, posed);
}

template class PackedDeltaMush<float>;
template class PackedDeltaMush<double>;

}  // namespace pbs
