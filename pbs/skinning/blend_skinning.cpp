#include "pbs/skinning/blend.hpp"

#include <type_traits>
#include <utility>

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

// The points of vertices whose rows are their own are blended from `transforms`.
template <class Scalar, class Transform>
void move_points(const PackedWeights<Scalar>& packed, const PaddedMatrix<Scalar>* matrices, BlendRows<Scalar> own,
                 const Transform* transforms, const Scalar* rest, Scalar* posed)
{
    const int* first_row = own.first;
    for (const VertexStretch& stretch : packed.stretches) {
        const int n = stretch.last - stretch.first, *matrix = &packed.matrix[stretch.first];
        const Scalar* from = rest + 3L * stretch.first;
        Scalar* to = posed + 3L * stretch.first;
        switch (stretch.kind) {
            case VertexStretch::Kind::one_matrix:
                transform_points(n, matrices[*matrix], from, to);
                break;
            case VertexStretch::Kind::matrix_each:
                transform_points(n, matrix, matrices, from, to);
                break;
            case VertexStretch::Kind::own_rows:
                own.n = n;
                own.first = first_row + stretch.own_row;
                blend_points(own, transforms, from, to);
        }
    }
}

}  // namespace

template <class Scalar>
BlendSkinning<Scalar>::BlendSkinning(const Positions& rest, const Weights& weights)
    : packed_(pack_weights<Scalar>(weights)), middle_(middle_of<Scalar>(rest)), rest_(rest.size() + 1)
{
    Eigen::Map<Rows>(rest_.data(), rest.rows(), 3) = (rest.rowwise() - middle_.transpose()).template cast<Scalar>();
    matrices_.resize(packed_.bones + packed_.shared.rows());
    dual_quaternions_.resize(packed_.turned_bones.size());
    placed_.resize(packed_.bones);
}

template <class Scalar>
void BlendSkinning<Scalar>::place_bones(const Pose& pose, const Vec3& origin)
{
    for (int j = 0; j < packed_.bones; ++j) {
        placed_[j].linear() = pose[j].linear();
        placed_[j].translation() = pose[j] * middle_ - origin;
        Eigen::Map<Eigen::Matrix<Scalar, 4, 4>> matrix(matrices_[j].numbers);
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
        Eigen::Map<Eigen::Matrix<Scalar, 8, 1>> turned(dual_quaternions_[i].numbers);
        turned = (side * bone).template cast<Scalar>();
    }
}

template <class Scalar>
void BlendSkinning<Scalar>::linear_rows(const Pose& pose, const Vec3& origin, Scalar* posed)
{
    place_bones(pose, origin);
    const PaddedMatrix<Scalar>* bones = matrices_.data();
    blend_matrices(raw(packed_.shared, packed_.shared.bone), bones, matrices_.data() + packed_.bones);
    move_points(packed_, bones, raw(packed_.own, packed_.own.bone), bones, rest_.data(), posed);
}

template <class Scalar>
void BlendSkinning<Scalar>::dual_quaternion_rows(const Pose& pose, const Vec3& origin, Scalar* posed)
{
    place_bones(pose, origin);
    place_turned_bones();
    const PackedDualQuaternion<Scalar>* bones = dual_quaternions_.data();
    blend_matrices(raw(packed_.shared, packed_.shared.turned_bone), bones, matrices_.data() + packed_.bones);
    move_points(packed_, std::as_const(matrices_).data(), raw(packed_.own, packed_.own.turned_bone), bones, rest_.data(), posed);
}

// double writes world coordinates directly; float blends about the middle of the body, and the result is moved there in double.
template <class Scalar>
template <class Blend>
void BlendSkinning<Scalar>::blend_in_world(const Pose& pose, Positions& posed, const Blend& blend)
{
    posed.resize(vertices(), 3);
    if constexpr (std::is_same_v<Scalar, double>) {
        blend(Vec3(Vec3::Zero()), posed.data());
    } else {
        const Vec3 origin = pose.empty() ? middle_ : pose[0] * middle_;
        posed_.resize(rest_.size() - 1);
        blend(origin, posed_.data());
        posed = Eigen::Map<const Rows>(posed_.data(), vertices(), 3).template cast<double>().rowwise() + origin.transpose();
    }
}

template <class Scalar>
void BlendSkinning<Scalar>::linear(const Pose& pose, Positions& posed)
{
    blend_in_world(pose, posed, [&](const Vec3& origin, Scalar* rows) { linear_rows(pose, origin, rows); });
}

template <class Scalar>
void BlendSkinning<Scalar>::dual_quaternion(const Pose& pose, Positions& posed)
{
    blend_in_world(pose, posed, [&](const Vec3& origin, Scalar* rows) { dual_quaternion_rows(pose, origin, rows); });
}

template class BlendSkinning<float>;
template class BlendSkinning<double>;

}  // namespace pbs
