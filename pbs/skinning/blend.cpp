#include "pbs/skinning/blend.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>

namespace pbs {
namespace {

// Real and dual part of a rigid transform's unit dual quaternion: x, y, z, w each.
using DualQuaternion = Eigen::Matrix<double, 8, 1>;

DualQuaternion dual_quaternion_of(const Eigen::Isometry3d& transform)
{
    const Eigen::Quaterniond rotation = Eigen::Quaterniond(transform.linear()).normalized();
    const Vec3 half = 0.5 * transform.translation();
    DualQuaternion both;
    both << rotation.coeffs(), (Eigen::Quaterniond(0.0, half.x(), half.y(), half.z()) * rotation).coeffs();
    return both;
}

// Rotation and translation of a blended, not yet unit, dual quaternion (Kavan 2007, Algorithm 1).
Vec3 transform_point(const DualQuaternion& blended, const Vec3& point)
{
    const Eigen::Vector4d real = blended.head<4>(), dual = blended.tail<4>();
    const double length = real.norm();
    const Vec3 r = real.head<3>() / length, d = dual.head<3>() / length;
    const double r_w = real(3) / length, d_w = dual(3) / length;
    return point + 2.0 * r.cross(r.cross(point) + r_w * point) + 2.0 * (r_w * d - d_w * r + r.cross(d));
}

// q and -q are the same rotation: every bone is taken on the side of the vertex's heaviest bone.
DualQuaternion blend(const std::vector<DualQuaternion>& bones, const Weights& weights, int vertex)
{
    const int first = weights.first[vertex], last = weights.first[vertex + 1];
    const auto heaviest =
        std::max_element(weights.weight.begin() + first, weights.weight.begin() + last) - weights.weight.begin();
    const DualQuaternion& pivot = bones[weights.bone[heaviest]];
    DualQuaternion sum = DualQuaternion::Zero();
    for (int entry = first; entry < last; ++entry) {
        const DualQuaternion& bone = bones[weights.bone[entry]];
        sum += (bone.head<4>().dot(pivot.head<4>()) < 0.0 ? -weights.weight[entry] : weights.weight[entry]) * bone;
    }
    return sum;
}

std::span<const int> bones_of(const Weights& weights, int vertex)
{
    return {weights.bone.data() + weights.first[vertex], weights.bone.data() + weights.first[vertex + 1]};
}

std::span<const double> weights_of(const Weights& weights, int vertex)
{
    return {weights.weight.data() + weights.first[vertex], weights.weight.data() + weights.first[vertex + 1]};
}

Weights without_zeros(const Weights& weights)
{
    Weights kept{{0}, {}, {}};
    for (int vertex = 0; vertex < weights.vertices(); ++vertex) {
        for (int entry = weights.first[vertex]; entry < weights.first[vertex + 1]; ++entry)
            if (weights.weight[entry] != 0.0) kept.add(weights.bone[entry], weights.weight[entry]);
        kept.end_vertex();
    }
    return kept;
}

bool is_rigid(const Weights& weights, int vertex)
{
    return std::ranges::equal(weights_of(weights, vertex), std::array{1.0});
}

bool row_less(const Weights& weights, int a, int b)
{
    if (!std::ranges::equal(bones_of(weights, a), bones_of(weights, b)))
        return std::ranges::lexicographical_compare(bones_of(weights, a), bones_of(weights, b));
    return std::ranges::lexicographical_compare(weights_of(weights, a), weights_of(weights, b));
}

// Appends rows of weights and the turned bones that they use.
template <class Scalar>
class RowWriter {
public:
    RowWriter(const Weights& weights, PackedWeights<Scalar>& packed) : weights_(weights), packed_(packed) {}

    void append(WeightRows<Scalar>& rows, int vertex)
    {
        const auto bones = bones_of(weights_, vertex);
        const auto weights = weights_of(weights_, vertex);
        const auto heaviest = std::ranges::max_element(weights) - weights.begin();
        for (std::size_t entry = 0; entry < bones.size(); ++entry) {
            rows.bone.push_back(bones[entry]);
            rows.turned_bone.push_back(turned_bone({bones[entry], bones[heaviest]}));
            rows.weight.push_back(static_cast<Scalar>(weights[entry]));
        }
        rows.first.push_back(static_cast<int>(rows.bone.size()));
    }

private:
    int turned_bone(const TurnedBone& bone)
    {
        const auto [place, is_new] =
            index_.try_emplace({bone.bone, bone.pivot}, static_cast<int>(packed_.turned_bones.size()));
        if (is_new) packed_.turned_bones.push_back(bone);
        return place->second;
    }

    const Weights& weights_;
    PackedWeights<Scalar>& packed_;
    std::map<std::pair<int, int>, int> index_;
};

// Vertices of several bones, equal rows side by side.
std::vector<int> vertices_by_row(const Weights& weights)
{
    std::vector<int> vertices(weights.vertices());
    std::iota(vertices.begin(), vertices.end(), 0);
    std::erase_if(vertices, [&](int vertex) { return is_rigid(weights, vertex); });
    std::ranges::stable_sort(vertices, [&](int a, int b) { return row_less(weights, a, b); });
    return vertices;
}

template <class Scalar>
void share_rows(const Weights& weights, RowWriter<Scalar>& writer, PackedWeights<Scalar>& packed)
{
    const std::vector<int> vertices = vertices_by_row(weights);
    for (auto begin = vertices.begin(); begin != vertices.end();) {
        const auto end =
            std::find_if(begin, vertices.end(), [&](int vertex) { return row_less(weights, *begin, vertex); });
        if (end - begin > 1) {
            for (auto vertex = begin; vertex != end; ++vertex)
                packed.matrix[*vertex] = packed.bones + packed.shared.rows();
            writer.append(packed.shared, *begin);
        }
        begin = end;
    }
}

// A loop of its own pays from some 30 vertices on: it saves 0.2 ns each, and the branch into it, mispredicted, costs
// some 5 ns.
constexpr int shortest_run = 32;

template <class Scalar>
void cut_into_stretches(PackedWeights<Scalar>& packed)
{
    using enum VertexStretch::Kind;
    const std::vector<int>& matrix = packed.matrix;
    int rows = 0;  // number of own rows that precede these vertices
    for (auto run = matrix.begin(); run != matrix.end();) {
        const auto end = std::find_if(run, matrix.end(), [&](int other) { return other != *run; });
        const auto kind = *run < 0 ? own_rows : end - run < shortest_run ? matrix_each : one_matrix;
        const int first = static_cast<int>(run - matrix.begin()), last = static_cast<int>(end - matrix.begin());
        if (kind == matrix_each && !packed.stretches.empty() && packed.stretches.back().kind == matrix_each)
            packed.stretches.back().last = last;
        else
            packed.stretches.push_back({kind, first, last, rows});
        if (kind == own_rows) rows += last - first;
        run = end;
    }
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

void linear_blend_skinning(const Positions& rest, const Weights& weights, const Pose& pose, Positions& posed)
{
    posed.resize(rest.rows(), 3);
    for (int i = 0; i < rest.rows(); ++i) {
        const Vec3 vertex = rest.row(i);
        Vec3 sum = Vec3::Zero();
        for (int entry = weights.first[i]; entry < weights.first[i + 1]; ++entry)
            sum += weights.weight[entry] * (pose[weights.bone[entry]] * vertex);  // Eq. 1
        posed.row(i) = sum;
    }
}

void dual_quaternion_skinning(const Positions& rest, const Weights& weights, const Pose& pose, Positions& posed)
{
    std::vector<DualQuaternion> bones;
    for (const Eigen::Isometry3d& transform : pose) bones.push_back(dual_quaternion_of(transform));
    posed.resize(rest.rows(), 3);
    for (int i = 0; i < rest.rows(); ++i) posed.row(i) = transform_point(blend(bones, weights, i), rest.row(i));
}

template <class Scalar>
PackedWeights<Scalar> pack_weights(const Weights& all_weights)
{
    const Weights weights = without_zeros(all_weights);
    PackedWeights<Scalar> packed;
    packed.bones = weights.bone.empty() ? 0 : 1 + *std::ranges::max_element(weights.bone);
    packed.matrix.assign(weights.vertices(), -1);
    for (int vertex = 0; vertex < weights.vertices(); ++vertex)
        if (is_rigid(weights, vertex)) packed.matrix[vertex] = weights.bone[weights.first[vertex]];
    RowWriter<Scalar> writer(weights, packed);
    share_rows(weights, writer, packed);
    for (int vertex = 0; vertex < weights.vertices(); ++vertex)
        if (packed.matrix[vertex] < 0) writer.append(packed.own, vertex);
    cut_into_stretches(packed);
    return packed;
}

template PackedWeights<float> pack_weights(const Weights&);
template PackedWeights<double> pack_weights(const Weights&);

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

template void to_world(const std::vector<float>&, const Vec3&, Positions&);
template void to_world(const std::vector<double>&, const Vec3&, Positions&);

template <class Scalar>
BlendSkinning<Scalar>::BlendSkinning(const Positions& rest, const Weights& weights)
    : packed_(pack_weights<Scalar>(weights)),
      middle_(std::is_same_v<Scalar, double> ? Vec3(Vec3::Zero()) : middle_of_box(rest)),
      rest_(rest.size() + 1)
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
    move_points(packed_, std::as_const(matrices_).data(), raw(packed_.own, packed_.own.turned_bone), bones,
                rest_.data(), posed);
}

// double writes world coordinates directly; float blends about the middle of the body, and the result is moved there in
// double.
template <class Scalar>
template <class Blend>
void BlendSkinning<Scalar>::blend_in_world(const Pose& pose, Positions& posed, const Blend& blend)
{
    posed.resize(vertices(), 3);
    if constexpr (std::is_same_v<Scalar, double>) {
        blend(Vec3(Vec3::Zero()), posed.data());
    } else {
        const Vec3 origin = posed_origin(pose, middle_);
        posed_.resize(rest_.size() - 1);
        blend(origin, posed_.data());
        to_world(posed_, origin, posed);
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

template <class Scalar>
void BlendSkinning<Scalar>::rotations(const Pose& pose, std::vector<Eigen::Matrix3d>& rotations)
{
    place_bones(pose, Vec3::Zero());
    place_turned_bones();
    const PackedDualQuaternion<Scalar>* bones = dual_quaternions_.data();
    blend_matrices(raw(packed_.shared, packed_.shared.turned_bone), bones, matrices_.data() + packed_.bones);
    own_matrices_.resize(packed_.own.rows());
    blend_matrices(raw(packed_.own, packed_.own.turned_bone), bones, own_matrices_.data());
    rotations.resize(packed_.matrix.size());
    const PaddedMatrix<Scalar>* own = own_matrices_.data();
    for (std::size_t i = 0; i < rotations.size(); ++i) {
        const PaddedMatrix<Scalar>& matrix = packed_.matrix[i] < 0 ? *own++ : matrices_[packed_.matrix[i]];
        rotations[i] = Eigen::Map<const Eigen::Matrix<Scalar, 4, 4>>(matrix.numbers)
                           .template topLeftCorner<3, 3>()
                           .template cast<double>();
    }
}

template class BlendSkinning<float>;
template class BlendSkinning<double>;

}  // namespace pbs
