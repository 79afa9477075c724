#include "pbs/solver/batched/batched_projection.hpp"

#include "pbs/packed/parallel.hpp"
#include "pbs/solver/batched/pbs_kernels.hpp"
#include "pbs/solver/project_plain.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace pbs {

template <typename Scalar>
BatchedParticles<Scalar>::BatchedParticles(const BatchedConstraints<Scalar>& batched,
                                           const std::vector<Scalar>& inverse_mass,
                                           const std::vector<BindConstraint<Scalar>>& bind)
    : new_of_old_(batched.order.new_of_old),
      rows_(batched.dummy_begin + batched.order.slabs() * BatchProgram<Scalar>::dummies_a_slab),
      bind_(bind.empty() ? 0 : (vertices() + batch_size - 1) / batch_size, BindBatch<Scalar>{})
{
    for (int i = 0; i < vertices(); ++i) rows_[new_of_old_[i]][3] = inverse_mass[i];
    for (const BindConstraint<Scalar>& constraint : bind) {
        const int i = new_of_old_[constraint.vertex];
        BindBatch<Scalar>& batch = bind_[i / batch_size];
        batch.rest_distance[i % batch_size] = constraint.rest_distance;
        batch.stiffness[i % batch_size] =
            inverse_mass[constraint.vertex] > Scalar(0) ? constraint.stiffness : Scalar(0);
    }
}

template <typename Scalar>
void BatchedParticles<Scalar>::load(const Positions& p, const Positions& q, const Vec3& origin)
{
    load_rows(p, new_of_old_, origin, rows_);
    for (std::size_t old = 0; !bind_.empty() && old < new_of_old_.size(); ++old) {
        const int i = new_of_old_[old], lane = i % batch_size;
        BindBatch<Scalar>& batch = bind_[i / batch_size];
        batch.x[lane] = Scalar(q(old, 0) - origin(0));
        batch.y[lane] = Scalar(q(old, 1) - origin(1));
        batch.z[lane] = Scalar(q(old, 2) - origin(2));
    }
}

template <typename Scalar>
void BatchedParticles<Scalar>::store(const Vec3& origin, Positions& p) const
{
    store_rows(rows_, new_of_old_, origin, p);
}

template <typename Scalar>
void BatchedParticles<Scalar>::project_bind_constraints(const Parallel& parallel)
{
    constexpr int blocks_a_task = 64;
    const int blocks = static_cast<int>(bind_.size()), tasks = (blocks + blocks_a_task - 1) / blocks_a_task;
    parallel.for_each(tasks, [&](int task) {
        const int first = task * blocks_a_task;
        project_bind_batches(bind_.data() + first, std::min(blocks_a_task, blocks - first), rows_[first * batch_size]);
    });
}

template class BatchedParticles<float>;
template class BatchedParticles<double>;

namespace {

template <typename Scalar>
double length(Scalar x, Scalar y, Scalar z)
{
    return std::sqrt(double(x * x + y * y + z * z));
}

double position_bytes(const ProjectionLayout& layout)
{
    return (layout.poses == 1 ? 4.0 : 3.0) * layout.scalar_bytes;
}

// The constraints' own data, shared by all poses.
double data_bytes(const ProjectionLayout& layout, const BodySize& size)
{
    const auto bytes = [&](double indices, double scalars) { return 4.0 * indices + scalars * layout.scalar_bytes; };
    if (layout.poses == 1) return size.edges * bytes(2, 2) + size.tets * bytes(4, 2) + size.vertices * bytes(0, 2);
    return size.edges * bytes(3, 4) + size.tets * bytes(5, 5) + size.vertices * bytes(0, 2);
}

}  // namespace

template <typename Scalar>
BatchedProjection<Scalar>::BatchedProjection(const ConstraintSet<Scalar>& constraints, const Tets& tets,
                                             const PbsOptions& options)
    : batched_(make_batched_constraints(constraints, tets)),
      parallel_(batched_.order.slabs() >= slabs_worth_threads ? options.threads : 1),
      edges_(constraints.stretch.size()),
      tets_(constraints.volume.size()),
      regions_(constraints.regions),
      particles_(batched_, constraints.inverse_mass, constraints.bind)
{
    for (RegionVolumeConstraint<Scalar>& region : regions_)
        for (int& vertex : region.vertex) vertex = batched_.order.new_of_old[vertex];
    for (const int old : batched_.order.old_of_new) inverse_mass_.push_back(constraints.inverse_mass[old]);
    for (int slab = 0; slab < batched_.order.slabs(); ++slab) {
        stretch_runs_.push_back(batched_.stretch.runs(slab));
        volume_runs_.push_back(batched_.volume.runs(slab));
    }
    if (!options.sleep) return;
    neighbours_ = adjacency_of(Tets(tets.unaryExpr([&](int old) { return batched_.order.new_of_old[old]; })),
                               batched_.vertices());
}

template <typename Scalar>
void BatchedProjection<Scalar>::project_stretch_constraints()
{
    project(batched_.stretch, stretch_runs_);
}

template <typename Scalar>
void BatchedProjection<Scalar>::project_volume_constraints()
{
    project(batched_.volume, volume_runs_);
    project_regions(regions_, inverse_mass_, [this](int i) { return Eigen::Map<Vector3<Scalar>>(vertices() + 4 * i); });
}

template <typename Scalar>
void BatchedProjection<Scalar>::project(const BatchProgram<Scalar>& program,
                                        const std::vector<std::vector<BatchRun>>& runs)
{
    parallel_.for_each_slab(batched_.order.slabs(), [&](int slab) {
        for (const BatchRun& run : runs[slab]) project_batches(run.kind, program.batches(run), run.count, vertices());
    });
}

template <typename Scalar>
Residuals BatchedProjection<Scalar>::residuals() const
{
    const auto sum = [&](const BatchProgram<Scalar>& program) {
        std::vector<double> of_slab(batched_.order.slabs(), 0.0);
        parallel_.for_each(batched_.order.slabs(), [&](int slab) {
            for (const BatchRun& run : program.runs(slab))
                of_slab[slab] += sum_squared_errors(run.kind, program.batches(run), run.count, vertices());
        });
        return std::accumulate(of_slab.begin(), of_slab.end(), 0.0);
    };
    const auto rms = [](double sum, std::size_t count) { return count == 0 ? 0.0 : std::sqrt(sum / double(count)); };
    const double bind =
        sum_squared_bind_errors(particles_.bind().data(), static_cast<int>(particles_.bind().size()), vertices());
    const double of_regions =
        rms_of_regions(regions_, [this](int i) { return Eigen::Map<const Vector3<Scalar>>(vertices() + 4 * i); });
    return {rms(sum(batched_.stretch), edges_),
            joint_rms(rms(sum(batched_.volume), tets_), tets_, of_regions, regions_.size()),
            rms(bind, particles_.bind().empty() ? 0 : batched_.order.old_of_new.size())};
}

template <typename Scalar>
std::vector<char> BatchedProjection<Scalar>::unsatisfied(const SleepTolerance& tolerance) const
{
    std::vector<char> vertices(particles_.rows().size(), false);
    batched_.stretch.mark_unsatisfied(this->vertices(), tolerance.ratio, vertices);
    batched_.volume.mark_unsatisfied(this->vertices(), tolerance.ratio, vertices);
    for (std::size_t i = 0; !particles_.bind().empty() && i < batched_.order.old_of_new.size(); ++i) {
        const BindBatch<Scalar>& batch = particles_.bind()[i / batch_size];
        const int lane = i % batch_size;
        const Scalar* p = this->vertices() + 4 * i;
        const double distance = length(p[0] - batch.x[lane], p[1] - batch.y[lane], p[2] - batch.z[lane]);
        if (!(std::abs(distance - batch.rest_distance[lane]) <= tolerance.length_m)) vertices[i] = true;
    }
    return vertices;
}

template <typename Scalar>
void BatchedProjection<Scalar>::sleep(const SleepTolerance& tolerance)
{
    if (neighbours_.first.empty()) return;
    std::vector<char> needed = unsatisfied(tolerance);
    for (std::size_t i = 0; i < moved_.size(); ++i) needed[i] = needed[i] || moved_[i];
    loaded_ = particles_.rows();
    awake_.assign(needed.size(), false);
    keep_awake(needed);
}

template <typename Scalar>
int BatchedProjection<Scalar>::wake(const SleepTolerance& tolerance)
{
    if (awake_.empty()) return 0;
    if (sleeping_share() > 0.0) {
        std::vector<char> woken = unsatisfied(tolerance);
        for (std::size_t i = 0; i < woken.size(); ++i) woken[i] = woken[i] && !awake_[i];
        if (const auto count = std::count(woken.begin(), woken.end(), true); count > 0) {
            keep_awake(woken);
            return static_cast<int>(count);
        }
    }
    moved_.assign(awake_.size(), false);
    for (std::size_t i = 0; i < batched_.order.old_of_new.size(); ++i) {
        const Scalar *now = this->vertices() + 4 * i, *before = loaded_[static_cast<int>(i)];
        moved_[i] = !(length(now[0] - before[0], now[1] - before[1], now[2] - before[2]) <= tolerance.length_m);
    }
    return 0;
}

template <typename Scalar>
void BatchedProjection<Scalar>::keep_awake(const std::vector<char>& vertices)
{
    constexpr int rings = 3;
    std::vector<int> ring;
    for (int i = 0; i < static_cast<int>(batched_.order.old_of_new.size()); ++i)
        if (vertices[i] && !std::exchange(awake_[i], true)) ring.push_back(i);
    for (int r = 0; r < rings; ++r) {
        std::vector<int> next;
        for (const int i : ring)
            for (int k = neighbours_.first[i]; k < neighbours_.first[i + 1]; ++k)
                if (!std::exchange(awake_[neighbours_.neighbour[k]], true)) next.push_back(neighbours_.neighbour[k]);
        ring = std::move(next);
    }
    for (int slab = 0; slab < batched_.order.slabs(); ++slab) {
        stretch_runs_[slab] = batched_.stretch.runs_awake(slab, awake_);
        volume_runs_[slab] = batched_.volume.runs_awake(slab, awake_);
    }
}

template <typename Scalar>
double BatchedProjection<Scalar>::sleeping_share() const
{
    const auto count = [](const std::vector<std::vector<BatchRun>>& runs) {
        int batches = 0;
        for (const auto& slab : runs)
            for (const BatchRun& run : slab) batches += run.count;
        return batches;
    };
    const int batches = batched_.stretch.batches() + batched_.volume.batches();
    return batches == 0 ? 0.0 : 1.0 - double(count(stretch_runs_) + count(volume_runs_)) / batches;
}

template class BatchedProjection<float>;
template class BatchedProjection<double>;

double bytes_per_iteration(const ProjectionLayout& layout, const BodySize& size)
{
    constexpr double classes = 3.0;
    return data_bytes(layout, size) +
           layout.poses * size.vertices * (3.0 * layout.scalar_bytes + classes * 2.0 * position_bytes(layout));
}

double working_set_bytes(const ProjectionLayout& layout, const BodySize& size)
{
    return data_bytes(layout, size) +
           layout.poses * size.vertices * (position_bytes(layout) + 3.0 * layout.scalar_bytes);
}

}  // namespace pbs
