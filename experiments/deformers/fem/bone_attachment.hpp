// From capsules to what the finite element solver is given: springs at sample points, or prescribed tets, each with the bone that moves
// it. "Attachment of the reference to the skeleton" in two forms, see FemAttachment.
#pragma once

#include "experiments/deformers/fem/bone_capsules.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "reference_fem/linear_elasticity.hpp"

namespace experiments {

struct BoneAttachment {
    std::vector<BoneCapsule> capsules;     // #bones
    reference_fem::Attachment attachment;  // springs or prescribed tets
    std::vector<int> spring_bone;          // #springs
    std::vector<int> vertex_bone;          // #V, -1: not prescribed
    std::vector<int> tet_bone;             // of each prescribed tet
};

// Springs of density q E / r^2 over each capsule's volume.
BoneAttachment embedded_attachment(const pbs::Character& character, const FemOptions& options);

// Whole tets inside the capsules. No vertex is shared by two bones: the tet of the later bone is left out. A bone that keeps no tet
// (fewer than four vertices that are not in one plane) is a pbs::InputError.
BoneAttachment nodes_attachment(const pbs::Character& character, const FemOptions& options);

// Where a pose (relative to the root) takes what is attached [m]: #springs x 3; #V x 3, rest positions where nothing is prescribed.
pbs::Positions spring_targets(const BoneAttachment& bones, const pbs::Pose& pose);
pbs::Positions vertex_targets(const BoneAttachment& bones, const pbs::Positions& rest, const pbs::Pose& pose);

}  // namespace experiments
