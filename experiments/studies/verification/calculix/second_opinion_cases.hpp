// The problems that CalculiX is asked about, and the judge's answers to them: a cantilever under its weight and an end load, and a frame
// of a character that its bones hold by attachment *nodes*.
#pragma once

#include "experiments/deformers/fem/bone_attachment.hpp"
#include "experiments/studies/verification/calculix/nodal_problem.hpp"

#include <functional>

namespace experiments {

// Nodes at the lowest x held; gravity [m/s^2] and an end load [N], shared equally by the nodes at the highest x.
struct LoadedCantilever {
    reference_fem::ElasticMaterial material;
    double density_kg_m3 = 1000.0;
    pbs::Vec3 gravity_m_s2 = pbs::Vec3::Zero(), end_load_n = pbs::Vec3::Zero();
};
NodalProblem cantilever_problem(const reference_fem::SimplexSpace& space, const LoadedCantilever& cantilever);
AnsweredProblem answered_cantilever(const pbs::TetMesh& mesh, int element_order, const LoadedCantilever& cantilever);

// The character held by whole tets inside its bones' capsules, by the linear model or that of St Venant and Kirchhoff. pose_at(1) is the
// frame; pose_at(0), where a large rotation starts from, is the rest pose. Poses are relative to the root.
enum class FrameModel {
    linear,
    st_venant_kirchhoff,
    st_venant_kirchhoff_at_four_points,  // P2 integrated by C3D10's rule; the judge's own has six points
};
struct HeldFrame {
    reference_fem::ElasticMaterial material;
    double core_radius = 0.6;
    FrameModel model = FrameModel::linear;
    std::function<pbs::Pose(double fraction)> pose_at;
};
AnsweredProblem answered_frame(const pbs::Character& character, int element_order, const HeldFrame& frame);

}  // namespace experiments
