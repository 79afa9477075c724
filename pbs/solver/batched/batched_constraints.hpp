// A constraint set in the orders `ordered` and `grouped`: where vertices lie, and stretch and volume constraints as batches.
#pragma once

#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/constraint_set.hpp"

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
struct BatchedConstraints {
    VertexOrder order;    // where the mesh's vertices lie
    int dummy_begin = 0;  // dummy vertices follow the mesh's, from a whole batch on; see BatchProgram
    // Programs of the edges and the tets; empty where the class is left out.
    BatchProgram<Scalar> stretch, volume;

    int vertices() const { return static_cast<int>(order.old_of_new.size()); }  // #V of the mesh, dummies not counted
};

// The size of the slabs of a mesh: about four of them and a half at either end, or eight ..., which two threads share evenly; or one. Fewer
// slabs are nearer to `plain`.
int vertices_a_slab(int vertices);
// Fewer slabs than these are done before a second thread has come to help.
inline constexpr int slabs_worth_threads = 3;

// The vertices of the constraints of a class and, as Batch has them, their values.
template <typename Scalar, std::size_t vertices>
struct ConstraintClassData {
    std::vector<std::array<int, vertices>> vertex;
    ConstraintValues<Scalar> values;
};

// vertices: #V of the mesh. tets: those whose edges may be grouped, constrained or not. order: ordered or grouped.
template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintClassData<Scalar, 2>& stretch,
                                                    const ConstraintClassData<Scalar, 4>& volume, int vertices, const Tets& tets,
                                                    Order order);
// Batches the stretch and volume constraints of Algorithm 1.
template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintSet<Scalar>& constraints, const Tets& tets, Order order);

}  // namespace pbs
