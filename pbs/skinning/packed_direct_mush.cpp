#include "pbs/skinning/direct_delta_mush.hpp"

#include <algorithm>

namespace pbs {
namespace {

template <class Scalar>
BoneMoments<Scalar> packed(const DirectDeltaMush::Moments& of, double alpha)
{
    BoneMoments<Scalar> result = {};
    int entry = 0;
    for (int a = 0; a < 3; ++a) {
        result.first[a] = static_cast<Scalar>(of.first(a));
        result.share[a] = static_cast<Scalar>((1.0 - alpha) * of.first(a));
        for (int b = a; b < 3; ++b) result.second[entry++] = static_cast<Scalar>(of.second(a, b));
    }
    result.weight = static_cast<Scalar>(of.weight);
    result.bone = of.bone;
    return result;
}

}  // namespace

template <class Scalar>
PackedDirectMush<Scalar>::PackedDirectMush(const TetMesh& mesh, const Weights& weights, const DirectDeltaMushOptions& options)
    : posed_(mesh.rest.size()), refused_(mesh.rest.rows()), middle_(middle_of_box(mesh.rest))
{
    const DirectDeltaMush plain(mesh, weights, options);
    first_ = plain.first();
    int bones = 0;
    for (const DirectDeltaMush::Moments& of : plain.moments()) {
        moments_.push_back(packed<Scalar>(of, options.alpha));
        bones = std::max(bones, of.bone + 1);
    }
    bones_.resize(bones);
    centre_ = padded_rows<Scalar>(plain.centre(), middle_, 1);
    detail_ = padded_rows<Scalar>(plain.detail(), Vec3::Zero());
}

template <class Scalar>
const std::vector<Scalar>& PackedDirectMush<Scalar>::apply_rows(const Pose& pose, const Vec3& origin)
{
    for (std::size_t bone = 0; bone < bones_.size(); ++bone) {
        Eigen::Isometry3d placed = pose[bone];
        placed.translation() = pose[bone] * middle_ - origin;
        Eigen::Map<Eigen::Matrix<Scalar, 4, 4>> matrix(bones_[bone].numbers);
        matrix = placed.matrix().template cast<Scalar>();
    }
    const MomentRows<Scalar> rows{static_cast<int>(first_.size()) - 1, first_.data(), moments_.data(), centre_.data(), detail_.data()};
    RefusedRotations<Scalar> refused = refused_.none_yet();
    move_by_moments(rows, bones_.data(), posed_.data(), refused);
    PackedRotations<Scalar>::turn(refused, detail_, posed_);
    return posed_;
}

template <class Scalar>
void PackedDirectMush<Scalar>::apply(const Pose& pose, Positions& posed)
{
    const Vec3 origin = posed_origin(pose, middle_);
    to_world(apply_rows(pose, origin), origin, posed);
}

template class PackedDirectMush<float>;
template class PackedDirectMush<double>;

}  // namespace pbs
