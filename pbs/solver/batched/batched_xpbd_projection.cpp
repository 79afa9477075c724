#include "pbs/solver/batched/batched_xpbd_projection.hpp"

#include "pbs/solver/batched/pbs_kernels.hpp"

#include <algorithm>

namespace pbs {
namespace {

template <typename Scalar>
std::vector<BindConstraint<Scalar>> rigid_binds(const XpbdConstraints& constraints)
{
    std::vector<BindConstraint<Scalar>> binds;
    for (const auto& [bind, compliance] : constraints.bind) binds.push_back({bind.vertex, Scalar(bind.rest_distance), Scalar(1)});
    return binds;
}

}  // namespace

template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const XpbdConstraints& constraints, const Tets& tets, Order order)
{
    ConstraintClassData<Scalar, 2> stretch;
    for (const auto& [edge, compliance] : constraints.stretch) {
        stretch.vertex.push_back(edge.vertex);
        stretch.values.rest.push_back(Scalar(edge.rest_length));
        stretch.values.stiffness.push_back(Scalar(1.0 / compliance));
    }
    ConstraintClassData<Scalar, 4> volume;
    for (const auto& [tet, compliance] : constraints.volume) {
        volume.vertex.push_back(tet.vertex);
        volume.values.rest.push_back(Scalar(6.0 * tet.rest_volume));
        volume.values.stiffness.push_back(Scalar(1.0 / (36.0 * compliance)));
    }
    return make_batched_constraints(stretch, volume, static_cast<int>(constraints.inverse_mass.size()), tets, order);
}

template <typename Scalar>
BatchedXpbdProjection<Scalar>::BatchedXpbdProjection(const XpbdConstraints& constraints, const Tets& tets, Order order, int threads)
    : batched_(make_batched_constraints<Scalar>(constraints, tets, order)),
      parallel_(batched_.order.slabs() >= slabs_worth_threads ? threads : 1),
      particles_(batched_, {constraints.inverse_mass.begin(), constraints.inverse_mass.end()}, rigid_binds<Scalar>(constraints)),
      stretch_(multipliers_of(batched_.stretch)),
      volume_(multipliers_of(batched_.volume))
{
}

template <typename Scalar>
auto BatchedXpbdProjection<Scalar>::multipliers_of(const BatchProgram<Scalar>& program) -> Multipliers
{
    Multipliers multipliers;
    std::size_t next = 0;
    for (int slab = 0; slab < program.slabs(); ++slab) {
        std::vector<std::size_t>& first = multipliers.first_of_run.emplace_back();
        for (const BatchRun& run : program.runs(slab)) {
            first.push_back(next);
            next += static_cast<std::size_t>(run.count) * constraints_of(run.kind);
        }
    }
    multipliers.lambdas.resize(next, Lambdas{});
    return multipliers;
}

template <typename Scalar>
void BatchedXpbdProjection<Scalar>::load(const Positions& p, const Positions& q, const Vec3& origin)
{
    particles_.load(p, q, origin);
}

template <typename Scalar>
void BatchedXpbdProjection<Scalar>::begin_substep(double dt_s)
{
    dt2_ = Scalar(dt_s * dt_s);
    forget_multipliers();
}

template <typename Scalar>
void BatchedXpbdProjection<Scalar>::forget_multipliers()
{
    for (Multipliers* multipliers : {&stretch_, &volume_}) std::fill(multipliers->lambdas.begin(), multipliers->lambdas.end(), Lambdas{});
}

template <typename Scalar>
void BatchedXpbdProjection<Scalar>::project_bind_constraints()
{
    particles_.project_bind_constraints(parallel_);
}

template <typename Scalar>
void BatchedXpbdProjection<Scalar>::project_stretch_constraints()
{
    project(batched_.stretch, stretch_);
}

template <typename Scalar>
void BatchedXpbdProjection<Scalar>::project_volume_constraints()
{
    project(batched_.volume, volume_);
}

template <typename Scalar>
void BatchedXpbdProjection<Scalar>::project(const BatchProgram<Scalar>& program, Multipliers& multipliers)
{
    for (const int parity : {0, 1})
        parallel_.for_each((program.slabs() + 1 - parity) / 2, [&](int pair) {
            const int slab = 2 * pair + parity;
            const std::vector<BatchRun>& runs = program.runs(slab);
            for (std::size_t r = 0; r < runs.size(); ++r)
                project_compliant_batches(runs[r].kind, program.batches(runs[r]), runs[r].count, dt2_,
                                          multipliers.lambdas[multipliers.first_of_run[slab][r]].of_lane, particles_.xyzw());
        });
}

template <typename Scalar>
void BatchedXpbdProjection<Scalar>::store(const Vec3& origin, Positions& p) const
{
    particles_.store(origin, p);
}

template BatchedConstraints<float> make_batched_constraints(const XpbdConstraints&, const Tets&, Order);
template BatchedConstraints<double> make_batched_constraints(const XpbdConstraints&, const Tets&, Order);
template class BatchedXpbdProjection<float>;
template class BatchedXpbdProjection<double>;

}  // namespace pbs
