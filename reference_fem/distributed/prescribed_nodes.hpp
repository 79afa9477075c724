// The nodes of prescribed tets, named by the two vertices they lie halfway between, and where they go.
#pragma once

#include "reference_fem/attachment.hpp"

#include <optional>
#include <set>
#include <utility>

namespace reference_fem {

// The set of those nodes, over prescribed_tets of an attachment.
class PrescribedNodes {
public:
    // The mesh and the targets [m], #V x 3, outlive it.
    PrescribedNodes(const pbs::TetMesh& mesh, const Attachment& attachment, const pbs::Positions& vertex_targets);

    // [m], the mean of its ends' for a mid-edge node; nothing where no prescribed tet has the node. ends: lower first, a vertex twice for
    // itself.
    std::optional<pbs::Vec3> displacement(const std::pair<int, int>& ends) const;

private:
    const pbs::TetMesh& mesh_;
    const pbs::Positions& vertex_targets_;
    std::set<std::pair<int, int>> nodes_;
};

}  // namespace reference_fem
