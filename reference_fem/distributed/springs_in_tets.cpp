#include "reference_fem/distributed/distributed_space.hpp"

#include "pbs/geometry/tet_mesh.hpp"

#include <algorithm>

namespace reference_fem {

SpringsInTets::SpringsInTets(const pbs::TetMesh& mesh, const Attachment& attachment, const pbs::Positions& targets)
{
    if (attachment.spring_points.rows() == 0) return;
    const pbs::PointLocation where(mesh);
    for (Eigen::Index s = 0; s < attachment.spring_points.rows(); ++s) {
        const pbs::Vec3 point = attachment.spring_points.row(s);
        const pbs::Location location = where.locate(point);
        if (location.tet < 0) continue;
        springs_.push_back({location.tet, attachment.spring_stiffness(s), location.barycentric, targets.row(s).transpose() - point});
    }
    std::ranges::stable_sort(springs_, {}, &SpringInTet::tet);
}

std::span<const SpringInTet> SpringsInTets::in(Eigen::Index tet) const
{
    const auto range = std::ranges::equal_range(springs_, static_cast<int>(tet), {}, &SpringInTet::tet);
    return {range.begin(), range.end()};
}

}  // namespace reference_fem
