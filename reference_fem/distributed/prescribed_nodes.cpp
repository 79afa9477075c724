#include "reference_fem/distributed/prescribed_nodes.hpp"

#include <algorithm>

namespace reference_fem {

PrescribedNodes::PrescribedNodes(const pbs::TetMesh& mesh, const Attachment& attachment, const pbs::Positions& vertex_targets)
    : mesh_(mesh), vertex_targets_(vertex_targets)
{
    for (const int tet : attachment.prescribed_tets)
        for (const int first : mesh.tets.row(tet))
            for (const int second : mesh.tets.row(tet))
                if (first <= second) nodes_.insert({first, second});
}

std::optional<pbs::Vec3> PrescribedNodes::displacement(const std::pair<int, int>& ends) const
{
    if (!nodes_.contains(ends)) return std::nullopt;
    const auto of_vertex = [&](int v) -> pbs::Vec3 { return vertex_targets_.row(v) - mesh_.rest.row(v); };
    return (of_vertex(ends.first) + of_vertex(ends.second)) / 2.0;
}

}  // namespace reference_fem
