#include "pbs/solver/batched/batched_projection.hpp"

#include "pbs/solver/batched/batch_kernels.hpp"
#include "pbs/solver/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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

int blocks_of(int vertices)
{
    return (vertices + batch_size - 1) / batch_size;
}

}  // namespace

template <typename Scalar>
BatchedProjection<Scalar>::BatchedProjection(const ConstraintSet<Scalar>& constraints, const Tets& tets, const PbsOptions& options)
    : order_(order_vertices(tets, static_cast<int>(constraints.inverse_mass.size()))),
      threads_(options.threads),
      edges_(constraints.stretch.size()),
      tets_(constraints.volume.size())
{
    const int vertices = static_cast<int>(constraints.inverse_mass.size()), dummies = batch_size * blocks_of(vertices);
    const auto edges = vertices_of_class(constraints.stretch);
    const auto volumes = vertices_of_class(constraints.volume);
    const bool grouped = options.order == Order::grouped;
    stretch_ = {grouped ? grouped_edges(edges, tets) : single_edges(edges), stretch_values(constraints), order_, dummies};
    volume_ = {grouped ? grouped_tets(volumes) : single_tets(volumes), volume_values(constraints), order_, dummies};
    vertices_.resize(blocks_of(dummies + order_.slabs() * BatchProgram<Scalar>::dummies_a_slab), Block{});
    for (int i = 0; i < vertices; ++i) this->vertices()[4 * i + 3] = constraints.inverse_mass[order_.old_of_new[i]];
    fill_bind(constraints);
}

template <typename Scalar>
void BatchedProjection<Scalar>::fill_bind(const ConstraintSet<Scalar>& constraints)
{
    if (constraints.bind.empty()) return;
    bind_.resize(blocks_of(static_cast<int>(constraints.inverse_mass.size())), BindBatch<Scalar>{});
    for (const BindConstraint<Scalar>& bind : constraints.bind) {
        const int i = order_.new_of_old[bind.vertex];
        BindBatch<Scalar>& batch = bind_[i / batch_size];
        batch.rest_distance[i % batch_size] = bind.rest_distance;
        batch.stiffness[i % batch_size] = constraints.inverse_mass[bind.vertex] > Scalar(0) ? bind.stiffness : Scalar(0);
    }
}

template <typename Scalar>
void BatchedProjection<Scalar>::load(const Positions& p, const Positions& q, const Vec3& origin)
{
    for (std::size_t i = 0; i < order_.old_of_new.size(); ++i) {
        const int old = order_.old_of_new[i];
        for (int axis = 0; axis < 3; ++axis) vertices()[4 * i + axis] = Scalar(p(old, axis) - origin(axis));
        if (bind_.empty()) continue;
        BindBatch<Scalar>& batch = bind_[i / batch_size];
        batch.x[i % batch_size] = Scalar(q(old, 0) - origin(0));
        batch.y[i % batch_size] = Scalar(q(old, 1) - origin(1));
        batch.z[i % batch_size] = Scalar(q(old, 2) - origin(2));
    }
}

template <typename Scalar>
void BatchedProjection<Scalar>::store(const Vec3& origin, Positions& p) const
{
    for (std::size_t i = 0; i < order_.old_of_new.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) p(order_.old_of_new[i], axis) = double(vertices()[4 * i + axis]) + origin(axis);
}

template <typename Scalar>
void BatchedProjection<Scalar>::project_bind_constraints()
{
    constexpr int blocks_a_task = 64;
    const int blocks = static_cast<int>(bind_.size()), tasks = (blocks + blocks_a_task - 1) / blocks_a_task;
    parallel_for(tasks, threads_, [&](int task) {
        const int first = task * blocks_a_task;
        project_bind_batches(bind_.data() + first, std::min(blocks_a_task, blocks - first), vertices_[first].xyzw);
    });
}

template <typename Scalar>
void BatchedProjection<Scalar>::project_stretch_constraints()
{
    project(stretch_);
}

template <typename Scalar>
void BatchedProjection<Scalar>::project_volume_constraints()
{
    project(volume_);
}

template <typename Scalar>
void BatchedProjection<Scalar>::project(const BatchProgram<Scalar>& program)
{
    for (const int parity : {0, 1})
        parallel_for((order_.slabs() + 1 - parity) / 2, threads_, [&](int pair) {
            for (const BatchRun& run : program.runs(2 * pair + parity))
                project_batches(run.kind, program.batches(run), run.count, vertices());
        });
}

template <typename Scalar>
Residuals BatchedProjection<Scalar>::residuals() const
{
    const auto sum = [&](const BatchProgram<Scalar>& program) {
        std::vector<double> of_slab(order_.slabs(), 0.0);
        parallel_for(order_.slabs(), threads_, [&](int slab) {
            for (const BatchRun& run : program.runs(slab))
                of_slab[slab] += sum_squared_errors(run.kind, program.batches(run), run.count, vertices());
        });
        return std::accumulate(of_slab.begin(), of_slab.end(), 0.0);
    };
    const auto rms = [](double sum, std::size_t count) { return count == 0 ? 0.0 : std::sqrt(sum / double(count)); };
    const double bind = sum_squared_bind_errors(bind_.data(), static_cast<int>(bind_.size()), vertices());
    return {rms(sum(stretch_), edges_), rms(sum(volume_), tets_), rms(bind, bind_.empty() ? 0 : order_.old_of_new.size())};
}

template <typename Scalar>
std::size_t BatchedProjection<Scalar>::bytes_an_iteration() const
{
    const std::size_t positions = 4 * sizeof(Scalar) * order_.old_of_new.size();
    return stretch_.bytes() + volume_.bytes() + bind_.size() * sizeof(BindBatch<Scalar>) + 2 * 3 * positions;
}

template class BatchedProjection<float>;
template class BatchedProjection<double>;

}  // namespace pbs
