#include "pbs/skinning/blend_skinning.hpp"

#include "pbs/skinning/blend_kernels.hpp"

#include <type_traits>

namespace pbs {
namespace {

template <class Scalar>
Vec3 middle_of(const Positions& rest)
{
    if (std::is_same_v<Scalar, double> || rest.rows() == 0) return Vec3::Zero();
    return 0.5 * (rest.colwise().minCoeff() + rest.colwise().maxCoeff()).transpose();
}

// real and dual part of a rigid transform's unit dual quaternion: x, y, z, w each
using DualQuaternion = Eigen::Matrix<double, 8, 1>;

DualQuaternion dual_quaternion_of(const Eigen::Isometry3d& transform)
{
    const Eigen::Quaterniond rotation = Eigen::Quaterniond(transform.linear()).normalized();
    const Vec3 half = 0.5 * transform.translation();
    DualQuaternion both;
    both << rotation.coeffs(), (Eigen::Quaterniond(0.0, half.x(), half.y(), half.z()) * rotation).coeffs();
    return both;
}

template <class Scalar>
BlendRows<Scalar> raw(const WeightRows<Scalar>& rows, const std::vector<int>& transform)
{
    return {rows.rows(), rows.first.data(), transform.data(), rows.weight.data()};
}

template <class Scalar>
BlendRows<Scalar> raw(const WeightRows<Scalar>& rows, const std::vector<int>& transform, const VertexStretch& stretch)
{
    return {stretch.last - stretch.first, rows.first.data() + stretch.own_row, transform.data(), rows.weight.data()};
}

// blend(stretch, rest, posed) for the stretches of blended vertices; the others are moved by their matrices.
template <class Scalar, class Blend>
void move_points(const PackedWeights<Scalar>& packed, const Scalar* matrices, const Scalar* rest, Scalar* posed, const Blend& blend)
{
    for (const VertexStretch& stretch : packed.stretches) {
        const long start = 3L * stretch.first;
        if (stretch.own_row >= 0)
            blend(stretch, rest + start, posed + start);
        else
            transform_points(stretch.last - stretch.first, packed.matrix.data() + stretch.first, matrices, rest + start, posed + start);
    }
}

}  // namespace

template <class Scalar>
BlendSkinning<Scalar>::BlendSkinning(const Positions& rest, const Weights& weights)
    : packed_(pack_weights<Scalar>(weights)), middle_(middle_of<Scalar>(rest)), rest_(rest.size())
{
    Eigen::Map<Rows>(rest_.data(), rest.rows(), 3) = (rest.rowwise() - middle_.transpose()).template cast<Scalar>();
    matrices_.resize(16 * (packed_.bones + packed_.shared.rows()));
    dual_quaternions_.resize(8 * packed_.turned_bones.size());
    placed_.resize(packed_.bones);
}

template <class Scalar>
void BlendSkinning<Scalar>::place_bones(const Pose& pose, const Vec3& origin)
{
    for (int j = 0; j < packed_.bones; ++j) {
        placed_[j].linear() = pose[j].linear();
        placed_[j].translation() = pose[j] * middle_ - origin;
        Eigen::Map<Eigen::Matrix<Scalar, 4, 4>> matrix(&matrices_[16 * j]);
        matrix = placed_[j].matrix().template cast<Scalar>();
    }
}

template <class Scalar>
void BlendSkinning<Scalar>::place_turned_bones()
{
    std::vector<DualQuaternion> bones;
    for (const Eigen::Isometry3d& transform : placed_) bones.push_back(dual_quaternion_of(transform));
    for (std::size_t i = 0; i < packed_.turned_bones.size(); ++i) {
        const DualQuaternion &bone = bones[packed_.turned_bones[i].bone], &pivot = bones[packed_.turned_bones[i].pivot];
        const double side = bone.head<4>().dot(pivot.head<4>()) < 0.0 ? -1.0 : 1.0;
        Eigen::Map<Eigen::Matrix<Scalar, 8, 1>> turned(&dual_quaternions_[8 * i]);
        turned = (side * bone).template cast<Scalar>();
    }
}

template <class Scalar>
void BlendSkinning<Scalar>::linear(const Pose& pose, const Vec3& origin, Scalar* posed)
{
    place_bones(pose, origin);
    Scalar* matrices = matrices_.data();
    blend_matrices_linear(raw(packed_.shared, packed_.shared.bone), matrices, matrices + 16 * packed_.bones);
    move_points(packed_, matrices, rest_.data(), posed, [&](const VertexStretch& stretch, const Scalar* from, Scalar* to) {
        blend_points_linear(raw(packed_.own, packed_.own.bone, stretch), matrices, from, to);
    });
}

template <class Scalar>
void BlendSkinning<Scalar>::dual_quaternion(const Pose& pose, const Vec3& origin, Scalar* posed)
{
    place_bones(pose, origin);
    place_turned_bones();
    Scalar *matrices = matrices_.data(), *dual_quaternions = dual_quaternions_.data();
    blend_matrices_dual(raw(packed_.shared, packed_.shared.turned_bone), dual_quaternions, matrices + 16 * packed_.bones);
    move_points(packed_, matrices, rest_.data(), posed, [&](const VertexStretch& stretch, const Scalar* from, Scalar* to) {
        blend_points_dual(raw(packed_.own, packed_.own.turned_bone, stretch), dual_quaternions, from, to);
    });
}

// double writes where it is asked to, in world coordinates; float blends about the middle and is carried there in double.
template <class Scalar>
template <class Blend>
void BlendSkinning<Scalar>::blend_in_world(const Pose& pose, Positions& posed, const Blend& blend)
{
    posed.resize(vertices(), 3);
    if constexpr (std::is_same_v<Scalar, double>) {
        blend(Vec3(Vec3::Zero()), posed.data());
    } else {
        const Vec3 origin = pose.empty() ? middle_ : pose[0] * middle_;
        posed_.resize(rest_.size());
        blend(origin, posed_.data());
        posed = Eigen::Map<const Rows>(posed_.data(), vertices(), 3).template cast<double>().rowwise() + origin.transpose();
    }
}

template <class Scalar>
void BlendSkinning<Scalar>::linear(const Pose& pose, Positions& posed)
{
    blend_in_world(pose, posed, [&](const Vec3& origin, Scalar* rows) { linear(pose, origin, rows); });
}

template <class Scalar>
void BlendSkinning<Scalar>::dual_quaternion(const Pose& pose, Positions& posed)
{
    blend_in_world(pose, posed, [&](const Vec3& origin, Scalar* rows) { dual_quaternion(pose, origin, rows); });
}

template class BlendSkinning<float>;
template class BlendSkinning<double>;

}  // namespace pbs
