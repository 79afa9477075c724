// A frame of a character that its bones hold, as a problem that CalculiX can solve too.
#pragma once

#include "experiments/deformers/fem/bone_attachment.hpp"
#include "reference_fem/verification/calculix/calculix_rows.hpp"

namespace experiments {

// pose_at(1) is the frame; pose_at(0), where a large rotation starts from, is the rest pose. Poses are relative to the root.
struct HeldFrame {
    reference_fem::ElasticMaterial material;
    FemAttachment attachment = FemAttachment::nodes;  // or smooth, embedded
    reference_fem::BodyModel model = reference_fem::BodyModel::linear;
    int element_order = 1;
    std::function<pbs::Pose(double fraction)> pose_at;
};
reference_fem::HeldBody held_body(const pbs::Character& character, const HeldFrame& frame);

}  // namespace experiments
