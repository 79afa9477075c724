#include "pbs/skinning/weights.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>

namespace pbs {
namespace {

struct Projection {
    double parameter;  // along the bone, not clamped
    Vec3 point;        // on the bone's segment [m]
    double distance;   // [m]
};

// A bone without length is the point at its head, which is its near end too: parameter 0.
Projection project_on_bone(const Vec3& vertex, const Bone& bone)
{
    const Vec3 axis = bone.tail - bone.head;
    const double length_squared = axis.squaredNorm();
    const double parameter = length_squared > 0.0 ? (vertex - bone.head).dot(axis) / length_squared : 0.0;
    const Vec3 point = parameter >= 1.0 ? bone.tail : Vec3(bone.head + std::max(parameter, 0.0) * axis);
    return {parameter, point, (vertex - point).norm()};
}

void append_vertex(Weights& weights, const std::vector<int>& bones)
{
    for (const int bone : bones) weights.add(bone, 1.0 / bones.size());
    weights.end_vertex();
}

constexpr double negligible = 1e-6;
constexpr double regular =
    1e-9;  // keeps the system of a part that nothing grips from being singular; its weights become 0

using Laplacian = Eigen::SparseMatrix<double>;

// The rows of known vertices are those of the identity; their couplings go to the right-hand side.
Laplacian held_laplacian(const TetMesh& mesh, const std::vector<bool>& known, const Eigen::MatrixXd& weights,
                         Eigen::MatrixXd& right_hand_sides)
{
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t v = 0; v < known.size(); ++v) {
        if (!known[v]) continue;
        entries.emplace_back(v, v, 1.0);
        right_hand_sides.row(static_cast<Eigen::Index>(v)) = weights.row(static_cast<Eigen::Index>(v));
    }
    for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
        double volume_m3 = 0.0;
        const Eigen::Matrix<double, 3, 4> gradients = barycentric_gradients(mesh, tet, &volume_m3);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) {
                const int row = mesh.tets(tet, a), column = mesh.tets(tet, b);
                if (known[row]) continue;
                const double entry = volume_m3 * gradients.col(a).dot(gradients.col(b));
                if (known[column])
                    right_hand_sides.row(row) -= entry * weights.row(column);
                else
                    entries.emplace_back(row, column, row == column ? (1.0 + regular) * entry : entry);
            }
    }
    Laplacian laplacian(mesh.rest.rows(), mesh.rest.rows());
    laplacian.setFromTriplets(entries.begin(), entries.end());
    return laplacian;
}

}  // namespace

BoneBinding bind_to_nearest_bone(const Positions& rest, const Skeleton& skeleton,
                                 const std::function<bool(int, int)>& may_bind)
{
    if (skeleton.bones.empty()) throw InputError("skeleton", 0, "bones", "0", "expected at least one bone");
    BoneBinding binding{std::vector<int>(rest.rows()), Eigen::VectorXd(rest.rows()), Positions(rest.rows(), 3),
                        Eigen::VectorXd(rest.rows())};
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
        const Vec3 vertex = rest.row(i);
        int nearest = 0;
        bool may_be_bound = false;
        Projection best{};
        for (int j = 0; j < static_cast<int>(skeleton.bones.size()); ++j) {
            const Projection candidate = project_on_bone(vertex, skeleton.bones[j]);
            const bool may = !may_bind || may_bind(static_cast<int>(i), j);
            if (j > 0 && (may < may_be_bound || (may == may_be_bound && !(candidate.distance < best.distance))))
                continue;
            nearest = j;
            may_be_bound = may;
            best = candidate;
        }
        binding.bone[i] = nearest;
        binding.parameter(i) = best.parameter;
        binding.rest_point.row(i) = best.point;
        binding.distance(i) = best.distance;
    }
    return binding;
}

Positions posed_bind_points(const BoneBinding& binding, const Pose& pose)
{
    Positions points(binding.rest_point.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        points.row(i) = pose[binding.bone[i]] * Vec3(binding.rest_point.row(i));
    return points;
}

Positions reprojected_bind_points(const BoneBinding& binding, const Skeleton& skeleton, const Pose& pose,
                                  const Positions& positions)
{
    Positions points(positions.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const int j = binding.bone[i];
        const Bone posed{"", -1, pose[j] * skeleton.bones[j].head, pose[j] * skeleton.bones[j].tail};
        points.row(i) = project_on_bone(positions.row(i), posed).point;
    }
    return points;
}

Weights paper_weights(const BoneBinding& binding, const Skeleton& skeleton)
{
    BonesAtEnd at_head, at_tail;
    for (int j = 0; j < static_cast<int>(skeleton.bones.size()); ++j) {
        at_head.push_back(bones_meeting(skeleton, j, BoneEnd::head));
        at_tail.push_back(bones_meeting(skeleton, j, BoneEnd::tail));
    }
    return weights_by_end(binding, at_head, at_tail);
}

Weights weights_by_end(const BoneBinding& binding, const BonesAtEnd& at_head, const BonesAtEnd& at_tail)
{
    Weights weights{{0}, {}, {}};
    for (std::size_t i = 0; i < binding.bone.size(); ++i) {
        const int bone = binding.bone[i];
        const double t = binding.parameter(i);
        // Eq. 2: w_j = 1 for 1/6 <= t <= 5/6, otherwise 1 / n over the bones that meet at the nearest end, the head
        // where t < 1/2.
        if (t < 1.0 / 6.0)
            append_vertex(weights, at_head[bone]);
        else if (t <= 5.0 / 6.0)
            append_vertex(weights, {bone});
        else
            append_vertex(weights, at_tail[bone]);
    }
    return weights;
}

Weights either_end_weights(const BoneBinding& binding, const Skeleton& skeleton)
{
    Weights weights{{0}, {}, {}};
    for (std::size_t i = 0; i < binding.bone.size(); ++i) {
        std::vector<int> bones = {binding.bone[i]};
        const double t = binding.parameter(i);
        if (t < 1.0 / 6.0 || t > 5.0 / 6.0)
            for (const BoneEnd end : {BoneEnd::head, BoneEnd::tail})
                for (const int other : bones_meeting(skeleton, binding.bone[i], end))
                    if (std::find(bones.begin(), bones.end(), other) == bones.end()) bones.push_back(other);
        append_vertex(weights, bones);
    }
    return weights;
}

Weights rigid_weights(const BoneBinding& binding)
{
    Weights weights{{0}, {}, {}};
    for (const int bone : binding.bone) append_vertex(weights, {bone});
    return weights;
}

Weights sparse_weights(const Eigen::MatrixXd& dense, double negligible, const Weights& otherwise)
{
    Weights result{{0}, {}, {}};
    for (Eigen::Index v = 0; v < dense.rows(); ++v) {
        const double sum = (dense.row(v).array() > negligible).select(dense.row(v), 0.0).sum();
        for (int j = 0; j < dense.cols(); ++j)
            if (dense(v, j) > negligible) result.add(j, dense(v, j) / sum);
        for (int k = otherwise.first[v]; sum == 0.0 && k < otherwise.first[v + 1]; ++k)
            result.add(otherwise.bone[k], otherwise.weight[k]);
        result.end_vertex();
    }
    return result;
}

Weights harmonic_extension(const TetMesh& mesh, const std::vector<bool>& known, const Eigen::MatrixXd& weights)
{
    Eigen::MatrixXd right_hand_sides = Eigen::MatrixXd::Zero(weights.rows(), weights.cols());
    const Laplacian laplacian = held_laplacian(mesh, known, weights, right_hand_sides);
    const Eigen::SimplicialLDLT<Laplacian> factor(laplacian);
    const BoneBinding of_first{std::vector<int>(known.size(), 0), {}, {}, {}};
    return sparse_weights(factor.solve(right_hand_sides), negligible, rigid_weights(of_first));
}

Weights harmonic_weights(const TetMesh& mesh, const std::vector<int>& gripping_bone, int bones)
{
    std::vector<bool> gripped;
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(mesh.rest.rows(), bones);
    for (std::size_t v = 0; v < gripping_bone.size(); ++v) {
        gripped.push_back(gripping_bone[v] >= 0);
        if (gripped.back()) weights(static_cast<Eigen::Index>(v), gripping_bone[v]) = 1.0;
    }
    return harmonic_extension(mesh, gripped, weights);
}

Weights diffused_weights(const TetMesh& mesh, const Weights& weights, int steps)
{
    const Adjacency neighbours = adjacency_of(mesh.tets, weights.vertices());
    const int bones = weights.bone.empty() ? 0 : 1 + *std::ranges::max_element(weights.bone);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(weights.vertices(), bones);
    for (int v = 0; v < weights.vertices(); ++v)
        for (int k = weights.first[v]; k < weights.first[v + 1]; ++k) rows(v, weights.bone[k]) += weights.weight[k];
    for (int step = 0; step < steps; ++step) {
        const Eigen::MatrixXd last = rows;
        for (int v = 0; v < weights.vertices(); ++v) {
            const int first = neighbours.first[v], end = neighbours.first[v + 1];
            if (first == end) continue;
            rows.row(v) *= 0.5;
            for (int k = first; k < end; ++k) rows.row(v) += 0.5 * last.row(neighbours.neighbour[k]) / (end - first);
        }
    }
    return sparse_weights(rows, negligible, weights);
}

}  // namespace pbs
