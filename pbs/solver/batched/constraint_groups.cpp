#include "pbs/packed/groups.hpp"

namespace pbs {

int vertices_of(GroupKind kind)
{
    return with_kind(kind, [](auto of_kind) { return GroupShape<of_kind()>::vertices; });
}

int constraints_of(GroupKind kind)
{
    return with_kind(kind, [](auto of_kind) { return GroupShape<of_kind()>::constraints; });
}

std::vector<ConstraintGroup> single_edges(const std::vector<std::array<int, 2>>& edges)
{
    std::vector<ConstraintGroup> groups;
    groups.reserve(edges.size());
    for (const auto& [i, j] : edges) groups.push_back({GroupKind::edge, {i, j}, {static_cast<int>(groups.size())}});
    return groups;
}

std::vector<ConstraintGroup> single_tets(const std::vector<std::array<int, 4>>& tets)
{
    std::vector<ConstraintGroup> groups;
    groups.reserve(tets.size());
    for (const auto& [i, j, k, l] : tets) groups.push_back({GroupKind::tet, {i, j, k, l}, {static_cast<int>(groups.size())}});
    return groups;
}

}  // namespace pbs
