#include "pbs/flesh/flesh_contact.hpp"

#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>

#include <map>

namespace pbs {
namespace {

Eigen::VectorXd column_stiffness(const TetMesh& mesh, const FleshEnergy& energy)
{
    const Eigen::VectorXd section = lumped_areas(mesh.rest, boundary_of(mesh.tets));
    Eigen::VectorXd modulus_volume = Eigen::VectorXd::Zero(mesh.rest.rows()), stiffness = modulus_volume;
    const Eigen::VectorXd volume = lumped_volumes(mesh.rest, mesh.tets), volumes = tet_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const double modulus = 6.0 * energy.tets()[t].kappa * energy.tets()[t].d;  // lambda alpha = lambda + mu
        for (const int v : mesh.tets.row(t)) modulus_volume(v) += modulus * volumes(t) / 4.0;
    }
    for (Eigen::Index v = 0; v < stiffness.size(); ++v)
        if (section(v) > 0.0) stiffness(v) = modulus_volume(v) * section(v) * section(v) / (volume(v) * volume(v));
    return stiffness;
}

}  // namespace

template <typename Scalar>
FleshContact<Scalar>::FleshContact(const TetMesh& mesh, const FleshEnergy& energy, const std::vector<int>& place)
    : contact_(mesh, place, 4), place_(place), stiffness_(column_stiffness(mesh, energy))
{
}

template <typename Scalar>
bool FleshContact<Scalar>::find(const Rows<Scalar>& x)
{
    contact_.find(x.data());
    return !contact_.constraints().empty();
}

template <typename Scalar>
double FleshContact<Scalar>::add_value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient) const
{
    double energy = 0.0;
    for (const DepthConstraint<Scalar>& pair : contact_.constraints()) {
        const double C = double(value(pair, contact_.points(pair, x.data()))), k = stiffness_(pair.vertex[0]);
        if (C >= 0.0) continue;
        energy += k / 2.0 * C * C;
        const auto of_C = pbs::gradient(pair);
        for (int i = 0; i < 5; ++i)
            for (int axis = 0; axis < 3; ++axis)
                gradient[place_[pair.vertex[i]]][axis] += Scalar(k * C) * of_C[i](axis);
    }
    return energy;
}

template <typename Scalar>
std::vector<ContactPull> FleshContact<Scalar>::pulls(const Rows<Scalar>& x) const
{
    std::map<int, ContactPull> of_vertex;
    for (const DepthConstraint<Scalar>& pair : contact_.constraints()) {
        const double C = double(value(pair, contact_.points(pair, x.data()))), k = stiffness_(pair.vertex[0]);
        const auto of_C = pbs::gradient(pair);
        for (int i = 0; i < 5; ++i) {
            ContactPull& pull = of_vertex.try_emplace(pair.vertex[i], ContactPull{pair.vertex[i]}).first->second;
            pull.stiffness += 2.0 * k * std::abs(double(pair.weight[i])) * double(pair.m.squaredNorm());
            if (C < 0.0) pull.gradient += k * C * of_C[i].template cast<double>();
        }
    }
    std::vector<ContactPull> pulls;
    for (const auto& [vertex, pull] : of_vertex) pulls.push_back(pull);
    return pulls;
}

template class FleshContact<float>;
template class FleshContact<double>;

}  // namespace pbs
