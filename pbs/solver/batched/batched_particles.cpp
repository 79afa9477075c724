#include "pbs/solver/batched/batched_projection.hpp"

#include "pbs/solver/batched/pbs_kernels.hpp"

#include <algorithm>

namespace pbs {
namespace {

int blocks_of(int vertices)
{
    return (vertices + batch_size - 1) / batch_size;
}

}  // namespace

template <typename Scalar>
BatchedParticles<Scalar>::BatchedParticles(const BatchedConstraints<Scalar>& batched, const std::vector<Scalar>& inverse_mass,
                                           const std::vector<BindConstraint<Scalar>>& bind)
    : old_of_new_(batched.order.old_of_new),
      blocks_(blocks_of(batched.dummy_begin + batched.order.slabs() * BatchProgram<Scalar>::dummies_a_slab), Block{})
{
    for (int i = 0; i < vertices(); ++i) xyzw()[4 * i + 3] = inverse_mass[old_of_new_[i]];
    fill_bind(batched.order.new_of_old, inverse_mass, bind);
}

template <typename Scalar>
void BatchedParticles<Scalar>::fill_bind(const std::vector<int>& new_of_old, const std::vector<Scalar>& inverse_mass,
                                         const std::vector<BindConstraint<Scalar>>& bind)
{
    if (bind.empty()) return;
    bind_.resize(blocks_of(vertices()), BindBatch<Scalar>{});
    for (const BindConstraint<Scalar>& constraint : bind) {
        const int i = new_of_old[constraint.vertex];
        BindBatch<Scalar>& batch = bind_[i / batch_size];
        batch.rest_distance[i % batch_size] = constraint.rest_distance;
        batch.stiffness[i % batch_size] = inverse_mass[constraint.vertex] > Scalar(0) ? constraint.stiffness : Scalar(0);
    }
}

template <typename Scalar>
void BatchedParticles<Scalar>::load(const Positions& p, const Positions& q, const Vec3& origin)
{
    for (std::size_t i = 0; i < old_of_new_.size(); ++i) {
        const int old = old_of_new_[i];
        for (int axis = 0; axis < 3; ++axis) xyzw()[4 * i + axis] = Scalar(p(old, axis) - origin(axis));
        if (bind_.empty()) continue;
        BindBatch<Scalar>& batch = bind_[i / batch_size];
        batch.x[i % batch_size] = Scalar(q(old, 0) - origin(0));
        batch.y[i % batch_size] = Scalar(q(old, 1) - origin(1));
        batch.z[i % batch_size] = Scalar(q(old, 2) - origin(2));
    }
}

template <typename Scalar>
void BatchedParticles<Scalar>::store(const Vec3& origin, Positions& p) const
{
    for (std::size_t i = 0; i < old_of_new_.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) p(old_of_new_[i], axis) = double(xyzw()[4 * i + axis]) + origin(axis);
}

template <typename Scalar>
void BatchedParticles<Scalar>::project_bind_constraints(const Parallel& parallel)
{
    constexpr int blocks_a_task = 64;
    const int blocks = static_cast<int>(bind_.size()), tasks = (blocks + blocks_a_task - 1) / blocks_a_task;
    parallel.for_each(tasks, [&](int task) {
        const int first = task * blocks_a_task;
        project_bind_batches(bind_.data() + first, std::min(blocks_a_task, blocks - first), blocks_[first].xyzw);
    });
}

template class BatchedParticles<float>;
template class BatchedParticles<double>;

}  // namespace pbs
