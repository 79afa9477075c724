// The skeleton's springs by the tet that holds them, so that whoever owns the tet can add them.
#pragma once

#include "reference_fem/attachment.hpp"

#include <span>

namespace reference_fem {

// Pulls on its rest point by stiffness times (stretch - displacement there).
struct SpringInTet {
    int tet = 0;             // index into the mesh's tets
    double stiffness = 0.0;  // [N/m]
    pbs::Vec3 barycentric;   // on corners 2, 3, 4
    pbs::Vec3 stretch;       // target minus rest point [m]
};

// Sorted once; mesh, attachment and targets may go.
class SpringsInTets {
public:
    // targets [m], #S x 3. A point outside every tet is left out.
    SpringsInTets(const pbs::TetMesh& mesh, const Attachment& attachment, const pbs::Positions& targets);

    std::span<const SpringInTet> in(Eigen::Index tet) const;  // in the attachment's order; a view, valid while this lives

private:
    std::vector<SpringInTet> springs_;  // by tet, increasing
};

}  // namespace reference_fem
