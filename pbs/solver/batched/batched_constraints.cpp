#include "pbs/solver/batched/batched_constraints.hpp"

#include "pbs/solver/pbs_solver.hpp"

#include <algorithm>

namespace pbs {
namespace {

template <typename Constraints>
auto vertices_of_class(const Constraints& constraints)
{
    std::vector<decltype(constraints.front().vertex)> vertices;
    vertices.reserve(constraints.size());
    for (const auto& constraint : constraints) vertices.push_back(constraint.vertex);
    return vertices;
}

template <typename Scalar>
ConstraintValues<Scalar> stretch_values(const ConstraintSet<Scalar>& constraints)
{
    ConstraintValues<Scalar> values;
    for (const StretchConstraint<Scalar>& edge : constraints.stretch) {
        const Scalar w = constraints.inverse_mass[edge.vertex[0]] + constraints.inverse_mass[edge.vertex[1]];
        values.rest.push_back(edge.rest_length);
        values.stiffness.push_back(w > Scalar(0) ? edge.stiffness / w : Scalar(0));
    }
    return values;
}

template <typename Scalar>
ConstraintValues<Scalar> volume_values(const ConstraintSet<Scalar>& constraints)
{
    ConstraintValues<Scalar> values;
    for (const VolumeConstraint<Scalar>& tet : constraints.volume) {
        values.rest.push_back(Scalar(6) * tet.rest_volume);
        values.stiffness.push_back(tet.stiffness);
    }
    return values;
}

constexpr int least_vertices_a_slab = 3072;

}  // namespace

int vertices_a_slab(int vertices)
{
    const int slabs = vertices / (4 * least_vertices_a_slab) * 4;
    return slabs == 0 ? std::max(vertices, 1) : vertices / slabs;
}

bool shared_among_threads(int vertices)
{
    return vertices >= 4 * least_vertices_a_slab;
}

template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintSet<Scalar>& constraints, const Tets& tets, Order order)
{
    const int vertices = static_cast<int>(constraints.inverse_mass.size());
    BatchedConstraints<Scalar> batched{
        order_vertices(tets, vertices, vertices_a_slab(vertices)), (vertices + batch_size - 1) / batch_size * batch_size, {}, {}};
    const auto edges = vertices_of_class(constraints.stretch);
    const auto volumes = vertices_of_class(constraints.volume);
    const bool grouped = order == Order::grouped;
    batched.stretch = {grouped ? grouped_edges(edges, tets) : single_edges(edges), stretch_values(constraints), batched.order,
                       batched.dummy_begin};
    batched.volume = {grouped ? grouped_tets(volumes) : single_tets(volumes), volume_values(constraints), batched.order,
                      batched.dummy_begin};
    return batched;
}

template BatchedConstraints<float> make_batched_constraints(const ConstraintSet<float>&, const Tets&, Order);
template BatchedConstraints<double> make_batched_constraints(const ConstraintSet<double>&, const Tets&, Order);

}  // namespace pbs
