#include "pbs/solver/project_plain.hpp"

namespace pbs {

template <typename Scalar>
void project_bind_constraints(const ConstraintSet<Scalar>& constraints, const std::vector<Vector3<Scalar>>& q,
                              std::vector<Vector3<Scalar>>& p)
{
    const std::vector<Scalar>& w = constraints.inverse_mass;
    for (const BindConstraint<Scalar>& bind : constraints.bind)
        project(bind, w[bind.vertex], q[bind.vertex], p[bind.vertex]);
}

template <typename Scalar>
void project_stretch_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p)
{
    const std::vector<Scalar>& w = constraints.inverse_mass;
    for (const StretchConstraint<Scalar>& edge : constraints.stretch) {
        const auto [i, j] = edge.vertex;
        project(edge, w[i], w[j], p[i], p[j]);
    }
}

template <typename Scalar>
void project_volume_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p)
{
    const std::vector<Scalar>& w = constraints.inverse_mass;
    for (const VolumeConstraint<Scalar>& tet : constraints.volume) {
        const auto [i, j, k, l] = tet.vertex;
        project(tet, w[i], w[j], w[k], w[l], p[i], p[j], p[k], p[l]);
    }
}

template <typename Scalar>
void project_region_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p)
{
    project_regions(constraints.regions, constraints.inverse_mass, [&](int i) -> Vector3<Scalar>& { return p[i]; });
}

template <Printed form, typename Scalar>
void project_volume_constraints_printed(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p)
{
    for (const VolumeConstraint<Scalar>& tet : constraints.volume) {
        const auto [i, j, k, l] = tet.vertex;
        project_printed<form>(tet, p[i], p[j], p[k], p[l]);
    }
}

template void project_bind_constraints(const ConstraintSet<float>&, const std::vector<Vector3<float>>&,
                                       std::vector<Vector3<float>>&);
template void project_stretch_constraints(const ConstraintSet<float>&, std::vector<Vector3<float>>&);
template void project_volume_constraints(const ConstraintSet<float>&, std::vector<Vector3<float>>&);
template void project_region_constraints(const ConstraintSet<float>&, std::vector<Vector3<float>>&);
template void project_volume_constraints_printed<Printed::labels_relative>(const ConstraintSet<float>&,
                                                                           std::vector<Vector3<float>>&);
template void project_volume_constraints_printed<Printed::labels_absolute>(const ConstraintSet<float>&,
                                                                           std::vector<Vector3<float>>&);
template void project_volume_constraints_printed<Printed::sign>(const ConstraintSet<float>&,
                                                                std::vector<Vector3<float>>&);
template void project_volume_constraints_printed<Printed::as_printed>(const ConstraintSet<float>&,
                                                                      std::vector<Vector3<float>>&);
template void project_bind_constraints(const ConstraintSet<double>&, const std::vector<Vector3<double>>&,
                                       std::vector<Vector3<double>>&);
template void project_stretch_constraints(const ConstraintSet<double>&, std::vector<Vector3<double>>&);
template void project_volume_constraints(const ConstraintSet<double>&, std::vector<Vector3<double>>&);
template void project_region_constraints(const ConstraintSet<double>&, std::vector<Vector3<double>>&);
template void project_volume_constraints_printed<Printed::labels_relative>(const ConstraintSet<double>&,
                                                                           std::vector<Vector3<double>>&);
template void project_volume_constraints_printed<Printed::labels_absolute>(const ConstraintSet<double>&,
                                                                           std::vector<Vector3<double>>&);
template void project_volume_constraints_printed<Printed::sign>(const ConstraintSet<double>&,
                                                                std::vector<Vector3<double>>&);
template void project_volume_constraints_printed<Printed::as_printed>(const ConstraintSet<double>&,
                                                                      std::vector<Vector3<double>>&);

}  // namespace pbs
