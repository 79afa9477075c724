#include "pbs/solver/batched/batch_program.hpp"

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
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintClassData<Scalar, 2>& stretch,
                                                    const ConstraintClassData<Scalar, 4>& volume, int vertices, const Tets& tets,
                                                    Order order)
{
    BatchedConstraints<Scalar> batched{
        order_vertices(tets, vertices, vertices_a_slab(vertices)), (vertices + batch_size - 1) / batch_size * batch_size, {}, {}};
    const bool grouped = order == Order::grouped;
    batched.stretch = {grouped ? grouped_edges(stretch.vertex, tets) : single_edges(stretch.vertex), stretch.values, batched.order,
                       batched.dummy_begin};
    batched.volume = {grouped ? grouped_tets(volume.vertex) : single_tets(volume.vertex), volume.values, batched.order,
                      batched.dummy_begin};
    return batched;
}

template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintSet<Scalar>& constraints, const Tets& tets, Order order)
{
    const ConstraintClassData<Scalar, 2> stretch{vertices_of_class(constraints.stretch), stretch_values(constraints)};
    const ConstraintClassData<Scalar, 4> volume{vertices_of_class(constraints.volume), volume_values(constraints)};
    return make_batched_constraints(stretch, volume, static_cast<int>(constraints.inverse_mass.size()), tets, order);
}

template BatchedConstraints<float> make_batched_constraints(const ConstraintClassData<float, 2>&, const ConstraintClassData<float, 4>&, int,
                                                            const Tets&, Order);
template BatchedConstraints<double> make_batched_constraints(const ConstraintClassData<double, 2>&, const ConstraintClassData<double, 4>&,
                                                             int, const Tets&, Order);
template BatchedConstraints<float> make_batched_constraints(const ConstraintSet<float>&, const Tets&, Order);
template BatchedConstraints<double> make_batched_constraints(const ConstraintSet<double>&, const Tets&, Order);

}  // namespace pbs
