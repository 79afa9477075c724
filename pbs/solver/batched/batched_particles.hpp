// Particles in the order of memory of the batches (../../packed/vertex_order.hpp), with the dummies of each slab behind them, and their bind
// constraints, each of which moves its own vertex alone.
#pragma once

#include "pbs/constraints/bind.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/solver/batched/batch_program.hpp"

#include <vector>

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
class BatchedParticles {
public:
    struct alignas(64) Block {  // sixteen vertices of x, y, z [m], w
        Scalar xyzw[4 * batch_size];
    };

    // inverse_mass: #V, in the mesh's numbering; zero: held. bind: at most one per vertex, in the mesh's numbering.
    BatchedParticles(const BatchedConstraints<Scalar>& batched, const std::vector<Scalar>& inverse_mass,
                     const std::vector<BindConstraint<Scalar>>& bind);

    // p: positions, q: posed bind points [m], #V x 3; inside, positions are relative to origin [m].
    void load(const Positions& p, const Positions& q, const Vec3& origin);
    void store(const Vec3& origin, Positions& p) const;
    void project_bind_constraints(const Parallel& parallel);

    Scalar* xyzw() { return blocks_.front().xyzw; }
    const Scalar* xyzw() const { return blocks_.front().xyzw; }
    int vertices() const { return static_cast<int>(old_of_new_.size()); }  // #V of the mesh, dummies not counted
    const std::vector<Block>& blocks() const { return blocks_; }           // of the vertices, then of the dummies
    const std::vector<BindBatch<Scalar>>& bind() const { return bind_; }   // of all vertices; empty: no bind constraints

private:
    void fill_bind(const std::vector<int>& new_of_old, const std::vector<Scalar>& inverse_mass,
                   const std::vector<BindConstraint<Scalar>>& bind);

    std::vector<int> old_of_new_;
    std::vector<BindBatch<Scalar>> bind_;
    std::vector<Block> blocks_;
};

}  // namespace pbs
