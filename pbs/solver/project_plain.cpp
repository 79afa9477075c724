#include "pbs/solver/project_plain.hpp"

#include "pbs/constraints/volume_printed.hpp"

namespace pbs {

namespace {

// Calls project(constraint, particle_1 .. particle_4) for each tet.
template <typename Scalar, typename Project>
void for_each_tet(const std::vector<VolumeConstraint<Scalar>>& constraints, std::vector<Particle<Scalar>>& particles, Project project_one)
{
    for (const VolumeConstraint<Scalar>& tet : constraints)
        project_one(tet, particles[tet.vertex[0]], particles[tet.vertex[1]], particles[tet.vertex[2]], particles[tet.vertex[3]]);
}

}  // namespace

template <typename Scalar>
void project_bind_constraints(const ConstraintSet<Scalar>& constraints, const std::vector<Vector3<Scalar>>& bind_points,
                              std::vector<Particle<Scalar>>& particles)
{
    for (const BindConstraint<Scalar>& bind : constraints.bind) project(bind, bind_points[bind.vertex], particles[bind.vertex]);
}

template <typename Scalar>
void project_stretch_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Particle<Scalar>>& particles)
{
    for (const StretchConstraint<Scalar>& edge : constraints.stretch) project(edge, particles[edge.vertex[0]], particles[edge.vertex[1]]);
}

template <typename Scalar>
void project_volume_constraints(const ConstraintSet<Scalar>& constraints, VolumeForm form, std::vector<Particle<Scalar>>& particles)
{
    switch (form) {
        case VolumeForm::derived:
            return for_each_tet(constraints.volume, particles, [](const auto& tet, auto&... corner) { project(tet, corner...); });
        case VolumeForm::labels_relative:
            return for_each_tet(constraints.volume, particles,
                                [](const auto& tet, auto&... corner) { project_printed<Printed::labels_relative>(tet, corner...); });
        case VolumeForm::labels_absolute:
            return for_each_tet(constraints.volume, particles,
                                [](const auto& tet, auto&... corner) { project_printed<Printed::labels_absolute>(tet, corner...); });
        case VolumeForm::sign:
            return for_each_tet(constraints.volume, particles,
                                [](const auto& tet, auto&... corner) { project_printed<Printed::sign>(tet, corner...); });
    }
}

template void project_bind_constraints(const ConstraintSet<float>&, const std::vector<Vector3<float>>&, std::vector<Particle<float>>&);
template void project_bind_constraints(const ConstraintSet<double>&, const std::vector<Vector3<double>>&, std::vector<Particle<double>>&);
template void project_stretch_constraints(const ConstraintSet<float>&, std::vector<Particle<float>>&);
template void project_stretch_constraints(const ConstraintSet<double>&, std::vector<Particle<double>>&);
template void project_volume_constraints(const ConstraintSet<float>&, VolumeForm, std::vector<Particle<float>>&);
template void project_volume_constraints(const ConstraintSet<double>&, VolumeForm, std::vector<Particle<double>>&);

}  // namespace pbs
