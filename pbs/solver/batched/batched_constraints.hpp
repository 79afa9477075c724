// A constraint set in the orders `ordered` and `grouped`: where vertices lie, and stretch and volume constraints as batches.
#pragma once

#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/constraint_set.hpp"

namespace pbs {

template <typename Scalar>
struct BatchedConstraints {
    VertexOrder order;
    int dummy_begin = 0;  // dummy vertices follow the mesh's, from a whole batch on; see BatchProgram
    BatchProgram<Scalar> stretch, volume;

    int vertices() const { return static_cast<int>(order.old_of_new.size()); }
};

template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintSet<Scalar>& constraints, const Tets& tets, Order order);

}  // namespace pbs
