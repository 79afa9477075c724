#include "pbs/author/author_solver.hpp"

#include "pbs/geometry/tet_volume.hpp"

#include <set>
#include <utility>

namespace pbs {
namespace {

// First-fit colouring: which vertices the groups have so far.
class FirstFit {
public:
    explicit FirstFit(std::size_t vertices) : vertices_(vertices) {}

    // The group that these vertices join; the number of groups so far if they need another one.
    template <std::size_t size>
    std::size_t place(const std::array<int, size>& constrained)
    {
        std::size_t group = 0;
        while (group < has_vertex_.size() && has_any(has_vertex_[group], constrained)) ++group;
        if (group == has_vertex_.size()) has_vertex_.emplace_back(vertices_, false);
        for (const int vertex : constrained) has_vertex_[group][vertex] = true;
        return group;
    }

private:
    template <std::size_t size>
    static bool has_any(const std::vector<bool>& has_vertex, const std::array<int, size>& constrained)
    {
        return std::any_of(constrained.begin(), constrained.end(), [&](int vertex) { return has_vertex[vertex]; });
    }

    std::size_t vertices_;
    std::vector<std::vector<bool>> has_vertex_;  // #groups x #V
};

AuthorGroup& group_at(std::vector<AuthorGroup>& groups, std::size_t index)
{
    if (index == groups.size()) groups.emplace_back();
    return groups[index];
}

}  // namespace

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
    FirstFit fit(mesh.rest.rows());
    std::vector<AuthorGroup> groups;
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const std::array<int, 4> vertex = {mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)};
        group_at(groups, fit.place(vertex)).volume.push_back({vertex, std::abs(volumes(t))});
    }
    for (int i = 0; i < static_cast<int>(binding.bone.size()); ++i)
        group_at(groups, fit.place<1>({i})).bind.push_back({i, binding.bone[i], binding.distance(i)});
    const Edges edges = edges_by_appearance(mesh.tets);
    for (Eigen::Index e = 0; e < edges.rows(); ++e) {
        const std::array<int, 2> vertex = {edges(e, 0), edges(e, 1)};
        const double rest_length = (mesh.rest.row(vertex[0]) - mesh.rest.row(vertex[1])).norm();
        group_at(groups, fit.place(vertex)).stretch.push_back({vertex, rest_length});
    }
    return groups;
}

}  // namespace pbs
