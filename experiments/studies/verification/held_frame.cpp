#include "experiments/studies/verification/held_frame.hpp"

namespace experiments {

reference_fem::HeldBody held_body(const pbs::Character& character, const HeldFrame& frame)
{
    constexpr double whole_tets_fit = 0.6;  // radius of a capsule over that of the limb
    FemOptions options{.young_pa = frame.material.young_pa, .attachment = frame.attachment};
    if (frame.attachment == FemAttachment::nodes) options.core_radius = whole_tets_fit;
    const BoneAttachment bones = bone_attachment(character, options);
    const auto targets_at = [bones, rest = character.mesh.rest, pose_at = frame.pose_at](double fraction) {
        return targets(bones, rest, pose_at(fraction));
    };
    return {frame.material, frame.model, frame.element_order, bones.attachment, targets_at};
}

}  // namespace experiments
