// The attachment of the reference to the skeleton in its five forms (see FemAttachment): springs at sample points,
// prescribed tets, or bound vertices, each with the bone that moves it.
#pragma once

#include "experiments/characters/bone_capsules.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "reference_fem/elastic_body.hpp"

namespace experiments {

struct BoneAttachment {
    std::vector<pbs::BoneCapsule> capsules;  // #bones
    reference_fem::Attachment attachment;    // springs, prescribed tets or bound vertices
    std::vector<int> spring_bone;            // #springs
    std::vector<double> spring_density;      // #springs, 0 to 1: over the density on the axis
    std::vector<int> vertex_bone;            // #V, -1: not prescribed
    std::vector<int> tet_bone;               // of each prescribed tet
    pbs::BoneBinding binding;                // of bound vertices; otherwise empty
    int loose_parts = 0;                     // as of pbs::CapsuleSprings
    double loose_share = 0.0;
};

// By options.attachment:
//   smooth    springs over each capsule's volume, of density q E / r^2 times smooth_density
//             (experiments/characters/bone_capsules.hpp)
//   embedded  springs of density q E / r^2 over each capsule's volume
//   held      as smooth, and stiff springs throughout the tets that one bone alone moves
//   nodes     whole tets inside the capsules. No vertex is shared by two bones: the tet of the later bone is left out.
//             A bone that keeps no tet (fewer than four vertices that are not in one plane) is a pbs::InputError. A
//             refined character has the children of the tets of the unrefined one
//   bind      every vertex at its rest distance d from its rest projection on its bone: k_i = q E V_i / R^2, V_i the
//             vertex's lumped rest volume and R the limb radius of its bone. The sum over the vertices is then the
//             vertex rule for the integral over the flesh of q E / (2 R^2) (|x - q(X)| - d(X))^2 dV, which does not
//             depend on the mesh. The weight is R, not d, because 1 / d^2 is not integrable at the bone
BoneAttachment bone_attachment(const pbs::Character& character, const FemOptions& options);

// Springs of a smaller density, over that on the axis, do not grip: the flesh yields to them.
constexpr double gripping_density = 0.5;

// The bone that grips each vertex as prescribed, or by the stiffest springs in the tets around it, #V; -1: none.
// spring_tet: the tet that holds each spring, -1: outside.
std::vector<int> gripping_bones(const BoneAttachment& bones, const pbs::Tets& tets, const std::vector<int>& spring_tet);

// Positions [m] of what is attached, in a pose. Vertices that are not prescribed are at rest.
reference_fem::Targets targets(const BoneAttachment& bones, const pbs::Positions& rest, const pbs::Pose& pose);

}  // namespace experiments
