// A frame of a character that its bones hold by attachment *nodes*, as a problem that CalculiX can solve too, with the reference's answer.
#pragma once

#include "experiments/deformers/fem/bone_attachment.hpp"
#include "reference_fem/verification/calculix/nodal_problem.hpp"

#include <functional>

namespace experiments {

// Whole tets inside the bones' capsules are held. pose_at(1) is the frame; pose_at(0), where a large rotation starts from, is the rest
// pose. Poses are relative to the root.
enum class FrameModel {
    linear,
    st_venant_kirchhoff,
    st_venant_kirchhoff_at_four_points,  // P2 integrated by C3D10's rule; the reference's own rule has six points
};
struct HeldFrame {
    reference_fem::ElasticMaterial material;
    double core_radius = 0.6;
    FrameModel model = FrameModel::linear;
    std::function<pbs::Pose(double fraction)> pose_at;
};
reference_fem::AnsweredProblem answered_frame(const pbs::Character& character, int element_order, const HeldFrame& frame);

}  // namespace experiments
