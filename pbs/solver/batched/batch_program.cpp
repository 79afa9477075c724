#include "pbs/solver/batched/batch_program.hpp"

#include "pbs/packed/constraint_sequence.hpp"
#include "pbs/solver/batched/pbs_kernels.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <algorithm>
#include <new>

namespace pbs {
namespace {

constexpr int constraints_a_cluster = 8192;

}  // namespace

template <typename Scalar>
BatchProgram<Scalar>::BatchProgram(const std::vector<PackedConstraint>& constraints,
                                   const ConstraintValues<Scalar>& values, const VertexOrder& order, int dummy_begin)
    : runs_(order.slabs()), constraints_(constraints.size())
{
    BatchScheduler scheduler(static_cast<int>(order.new_of_old.size()));
    const std::vector<SlabClusters> clusters = clusters_of_slabs(constraints, order, constraints_a_cluster);
    for (int slab = 0; slab < order.slabs(); ++slab)
        for (const std::vector<int>& cluster : clusters[slab]) {
            std::vector<PackedConstraint> of_cluster;
            for (const int c : cluster) of_cluster.push_back(constraints[c]);
            with_kind(of_cluster.front().kind, [&](auto kind) {
                append<kind()>(of_cluster, scheduler.schedule(of_cluster), values, order, slab,
                               dummy_begin + slab * dummies_a_slab);
            });
        }
    lines_.shrink_to_fit();
}

template <typename Scalar>
template <ConstraintKind kind>
void BatchProgram<Scalar>::append(const std::vector<PackedConstraint>& constraints,
                                  const std::vector<std::vector<int>>& batches, const ConstraintValues<Scalar>& values,
                                  const VertexOrder& order, int slab, int dummy)
{
    if (batches.empty()) return;
    constexpr std::size_t lines_a_batch = sizeof(Batch<Scalar, kind>) / sizeof(CacheLine);
    runs_[slab].push_back({kind, static_cast<int>(batches.size()), lines_.size()});
    lines_.resize(lines_.size() + batches.size() * lines_a_batch);
    lanes_ += batches.size() * batch_size;
    auto* to = lines_.data() + runs_[slab].back().first_line;
    for (const std::vector<int>& members : batches) {
        auto& batch = *new (to) Batch<Scalar, kind>();
        for (int lane = 0; lane < batch_size; ++lane) {
            const PackedConstraint* constraint =
                lane < static_cast<int>(members.size()) ? &constraints[members[lane]] : nullptr;
            for (int v = 0; v < corners(kind); ++v)
                batch.offset[v][lane] =
                    4u * (constraint ? order.new_of_old[constraint->vertex[v]] : dummy + 4 * lane + v);
            if (!constraint) continue;
            batch.rest[lane] = values.rest[constraint->constraint];
            batch.stiffness[lane] = values.stiffness[constraint->constraint];
        }
        to += lines_a_batch;
    }
}

template <typename Scalar>
std::vector<BatchRun> BatchProgram<Scalar>::runs_awake(int slab, const std::vector<char>& awake) const
{
    std::vector<BatchRun> result;
    for (const BatchRun& run : runs_[slab])
        with_kind(run.kind, [&](auto of_kind) {
            const auto* all = static_cast<const Batch<Scalar, of_kind()>*>(batches(run));
            for (int b = 0, next = -1; b < run.count; ++b) {
                const bool is_awake =
                    std::any_of(all[b].offset[0], all[b].offset[0] + sizeof(all[b].offset) / sizeof(std::uint32_t),
                                [&](std::uint32_t offset) { return awake[offset / 4]; });
                if (!is_awake) continue;
                if (b != next) result.push_back({run.kind, 0, run.first_line + b * sizeof(all[b]) / sizeof(CacheLine)});
                ++result.back().count;
                next = b + 1;
            }
        });
    return result;
}

template <typename Scalar>
void BatchProgram<Scalar>::mark_unsatisfied(const Scalar* vertices, double tolerance, std::vector<char>& marked) const
{
    std::vector<Scalar> errors;
    for (const std::vector<BatchRun>& slab : runs_)
        for (const BatchRun& run : slab)
            with_kind(run.kind, [&](auto of_kind) {
                const auto* all = static_cast<const Batch<Scalar, of_kind()>*>(batches(run));
                errors.resize(static_cast<std::size_t>(run.count) * batch_size);
                largest_errors(run.kind, all, run.count, vertices, errors.data());
                for (std::size_t lane = 0; lane < errors.size(); ++lane) {
                    if (errors[lane] <= Scalar(tolerance)) continue;
                    for (const auto& offsets : all[lane / batch_size].offset)
                        marked[offsets[lane % batch_size] / 4] = true;
                }
            });
}

template <typename Scalar>
double BatchProgram<Scalar>::fill() const
{
    return lanes_ == 0 ? 1.0 : double(constraints_) / double(lanes_);
}

template class BatchProgram<float>;
template class BatchProgram<double>;

template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintClassData<Scalar, 2>& stretch,
                                                    const ConstraintClassData<Scalar, 4>& volume, int vertices,
                                                    const Tets& tets)
{
    BatchedConstraints<Scalar> batched{order_vertices(tets, vertices, vertices_a_slab(vertices)),
                                       (vertices + batch_size - 1) / batch_size * batch_size,
                                       {},
                                       {}};
    batched.stretch = {packed_edges(stretch.vertex), stretch, batched.order, batched.dummy_begin};
    batched.volume = {packed_tets(volume.vertex), volume, batched.order, batched.dummy_begin};
    return batched;
}

template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintSet<Scalar>& constraints, const Tets& tets)
{
    ConstraintClassData<Scalar, 2> stretch;
    for (const StretchConstraint<Scalar>& edge : constraints.stretch) {
        const Scalar w = constraints.inverse_mass[edge.vertex[0]] + constraints.inverse_mass[edge.vertex[1]];
        stretch.add(edge.vertex, edge.rest_length, w > Scalar(0) ? edge.stiffness / w : Scalar(0));
    }
    ConstraintClassData<Scalar, 4> volume;
    for (const VolumeConstraint<Scalar>& tet : constraints.volume)
        volume.add(tet.vertex, Scalar(6) * tet.rest_volume, tet.stiffness);
    return make_batched_constraints(stretch, volume, static_cast<int>(constraints.inverse_mass.size()), tets);
}

template BatchedConstraints<float> make_batched_constraints(const ConstraintClassData<float, 2>&,
                                                            const ConstraintClassData<float, 4>&, int, const Tets&);
template BatchedConstraints<double> make_batched_constraints(const ConstraintClassData<double, 2>&,
                                                             const ConstraintClassData<double, 4>&, int, const Tets&);
template BatchedConstraints<float> make_batched_constraints(const ConstraintSet<float>&, const Tets&);
template BatchedConstraints<double> make_batched_constraints(const ConstraintSet<double>&, const Tets&);

}  // namespace pbs
