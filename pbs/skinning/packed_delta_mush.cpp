#include "pbs/skinning/delta_mush.hpp"

namespace pbs {

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
    const NeighbourRows<Scalar> rows{vertices, first_.data(), neighbour_.data(), one_over_.data()};
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
        smooth_points(rows, static_cast<Scalar>(options_.step), smoothed_.data(), next_.data());
        smoothed_.swap(next_);
    }
    RefusedRotations<Scalar> refused = refused_.none_yet();
    add_detail(rows, smoothed_rest_.data(), smoothed_.data(), detail_.data(), posed_.data(), refused);
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
