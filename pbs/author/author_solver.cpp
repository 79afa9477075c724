#include "pbs/author/author_solver.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace pbs {
namespace {

void check_within(const char* field, double value, double highest)
{
    if (!(value >= 0.0 && value <= highest))
        throw InputError("pbs_author", 0, field, std::to_string(value),
                         "expected 0 <= k <= " + std::to_string(static_cast<int>(highest)));
}

AuthorOptions checked(const AuthorOptions& options, const TetMesh& mesh, const BoneBinding& binding)
{
    if (static_cast<Eigen::Index>(binding.bone.size()) != mesh.rest.rows())
        throw InputError("pbs_author", 0, "binding", std::to_string(binding.bone.size()) + " vertices",
                         "expected those of the mesh");
    check_within("k_compression", options.k_compression, 1.0);
    check_within("k_stretch", options.k_stretch, 1.0);
    check_within("k_volume_inverted", options.k_volume_inverted, 6.0);
    check_within("k_volume", options.k_volume, 6.0);
    if (options.iterations < 0)
        throw InputError("pbs_author", 0, "iterations", std::to_string(options.iterations), "expected 0 or more");
    if (!(options.time_step_s > 0.0))
        throw InputError("pbs_author", 0, "time_step_s", std::to_string(options.time_step_s),
                         "expected a positive time step");
    if (!(options.length_unit_m > 0.0))
        throw InputError("pbs_author", 0, "length_unit_m", std::to_string(options.length_unit_m),
                         "expected a positive length");
    return options;
}

AuthorStiffness stiffness_of(const AuthorOptions& options)
{
    const double unit2_m2 = options.length_unit_m * options.length_unit_m;
    return {options.k_compression, options.k_stretch, options.k_volume_inverted, options.k_volume,
            smallest_gradient2 * unit2_m2 * unit2_m2};
}

bool is_same_pose(const Pose& pose, const Pose& other)
{
    return std::equal(pose.begin(), pose.end(), other.begin(), other.end(),
                      [](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) { return a.matrix() == b.matrix(); });
}

// First-fit colouring.
struct FirstFit {
    std::size_t vertices;
    std::vector<AuthorGroup> groups = {};
    std::vector<std::vector<bool>> has_vertex = {};  // #groups x #V

    // The group that these vertices join, which is a new one if they need another.
    template <std::size_t size>
    AuthorGroup& of(const std::array<int, size>& constrained)
    {
        const auto is_free = [&](const std::vector<bool>& has) {
            return std::none_of(constrained.begin(), constrained.end(), [&](int vertex) { return has[vertex]; });
        };
        const std::size_t group = std::find_if(has_vertex.begin(), has_vertex.end(), is_free) - has_vertex.begin();
        if (group == groups.size()) {
            groups.emplace_back();
            has_vertex.emplace_back(vertices, false);
        }
        for (const int vertex : constrained) has_vertex[group][vertex] = true;
        return groups[group];
    }
};

}  // namespace

AuthorSolver::AuthorSolver(const TetMesh& mesh, const Skeleton& skeleton, const BoneBinding& binding,
                           const AuthorOptions& options)
    : options_(checked(options, mesh, binding)),
      stiffness_(stiffness_of(options)),
      skeleton_(skeleton),
      skinning_(mesh.rest, author_weights(binding, skeleton)),
      groups_(author_groups(mesh, binding)),
      positions_(mesh.rest),
      x_(mesh.rest.rows()),
      v_(mesh.rest.rows(), Vector3<double>::Zero())
{
}

StepSummary AuthorSolver::advance(const Pose& pose)
{
    const Stopwatch stopwatch;
    StepSummary summary;
    if (!last_pose_ || !is_same_pose(*last_pose_, pose)) {
        predict(pose);
        const std::vector<BoneSegment> bones = posed_bones(pose);
        for (; summary.iterations < options_.iterations; ++summary.iterations) project(bones);
        update();
        last_pose_ = pose;
        summary.work = work_of(summary.iterations);
    }
    if (!positions_.allFinite()) summary.outcome = Outcome::not_finite;
    summary.seconds = stopwatch.seconds();
    return summary;
}

// x <- LBS, v <- v + h g, x <- x + h v, for every particle. v holds the bones' own motion of the last frame, which LBS
// contains already.
void AuthorSolver::predict(const Pose& pose)
{
    skinning_.linear(pose, lbs_);
    const double h = options_.time_step_s;
    for (std::size_t i = 0; i < x_.size(); ++i) {
        v_[i] += h * options_.gravity_m_s2;
        x_[i] = lbs_.row(i).transpose() + h * v_[i];
    }
}

// One iteration.
void AuthorSolver::project(const std::vector<BoneSegment>& bones)
{
    for (const AuthorGroup& group : groups_) {
        for (const AuthorVolume& constraint : group.volume) pbs::project(constraint, stiffness_, x_);
        for (const AuthorBind& constraint : group.bind) pbs::project(constraint, bones, stiffness_, x_);
        for (const AuthorStretch& constraint : group.stretch) pbs::project(constraint, stiffness_, x_);
    }
}

// v <- (x - x of the last frame) / h.
void AuthorSolver::update()
{
    for (std::size_t i = 0; i < x_.size(); ++i) {
        v_[i] = (x_[i] - positions_.row(i).transpose()) / options_.time_step_s;
        positions_.row(i) = x_[i];
    }
}

// A blend, and each constraint once per iteration. A tet that the threshold leaves out is visited too.
WorkCounters AuthorSolver::work_of(int iterations) const
{
    std::int64_t volumes = 0, others = 0;
    for (const AuthorGroup& group : groups_) {
        volumes += static_cast<std::int64_t>(group.volume.size());
        others += static_cast<std::int64_t>(group.bind.size() + group.stretch.size());
    }
    return {.vertex_visits = positions_.rows(),
            .tet_visits = iterations * volumes,
            .projections = iterations * (volumes + others)};
}

std::vector<BoneSegment> AuthorSolver::posed_bones(const Pose& pose) const
{
    std::vector<BoneSegment> bones;
    for (std::size_t j = 0; j < skeleton_.bones.size(); ++j)
        bones.push_back({pose[j] * skeleton_.bones[j].head, pose[j] * skeleton_.bones[j].tail});
    return bones;
}

Weights author_weights(const BoneBinding& binding, const Skeleton& skeleton)
{
    const int bones = static_cast<int>(skeleton.bones.size());
    BonesAtEnd at_head(bones), at_tail(bones);
    for (int j = 0; j < bones; ++j) {
        const int parent = skeleton.bones[j].parent;
        at_head[j].push_back(j);
        at_tail[j].insert(at_tail[j].begin(), j);
        if (parent < 0) continue;
        at_head[j].push_back(parent);
        at_tail[parent].push_back(j);
    }
    return weights_by_end(binding, at_head, at_tail);
}

Edges edges_by_appearance(const Tets& tets)
{
    std::set<std::pair<int, int>> seen;
    std::vector<std::pair<int, int>> found;
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int a = 0; a < 4; ++a)
            for (int b = a + 1; b < 4; ++b) {
                const std::pair<int, int> edge = std::minmax({tets(t, a), tets(t, b)});
                if (seen.insert(edge).second) found.push_back(edge);
            }
    Edges edges(static_cast<Eigen::Index>(found.size()), 2);
    for (Eigen::Index e = 0; e < edges.rows(); ++e) edges.row(e) << found[e].first, found[e].second;
    return edges;
}

std::vector<AuthorGroup> author_groups(const TetMesh& mesh, const BoneBinding& binding)
{
    FirstFit fit{static_cast<std::size_t>(mesh.rest.rows())};
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const std::array<int, 4> vertex = {mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)};
        fit.of(vertex).volume.push_back({vertex, std::abs(volumes(t))});
    }
    for (int i = 0; i < static_cast<int>(binding.bone.size()); ++i)
        fit.of<1>({i}).bind.push_back({i, binding.bone[i], binding.distance(i)});
    const Edges edges = edges_by_appearance(mesh.tets);
    for (Eigen::Index e = 0; e < edges.rows(); ++e) {
        const std::array<int, 2> vertex = {edges(e, 0), edges(e, 1)};
        const double rest_length = (mesh.rest.row(vertex[0]) - mesh.rest.row(vertex[1])).norm();
        fit.of(vertex).stretch.push_back({vertex, rest_length});
    }
    return fit.groups;
}

}  // namespace pbs
