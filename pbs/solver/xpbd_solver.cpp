#include "pbs/solver/xpbd_solver.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/batched/pbs_kernels.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/particles.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace pbs {

XpbdSolver::XpbdSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                       const XpbdOptions& options, const std::vector<bool>& held)
    : options_(options),
      integrated_(mesh.rest.rows(), false),
      constraints_(make_xpbd_constraints(mesh, bind_distance, options, held)),
      x_(mesh.rest),
      before_(mesh.rest),
      v_(Positions::Zero(mesh.rest.rows(), 3))
{
    for (const auto& [field, number] : {std::pair("substeps", options.substeps), {"threads", options.threads}})
        if (number < 1) throw InputError("xpbd", 0, field, std::to_string(number), "expected 1 or more");
    projection_ = make_xpbd_projection(constraints_, mesh.tets, options);
    for (std::size_t i = 0; i < integrated_.size(); ++i)
        integrated_[i] = options.jiggle && !jiggle_zone.empty() && jiggle_zone[i];
    integrates_ = std::find(integrated_.begin(), integrated_.end(), true) != integrated_.end();
}

StepSummary XpbdSolver::advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s)
{
    if (!(dt_s > 0.0)) throw InputError("xpbd", 0, "dt", std::to_string(dt_s) + " s", "expected a positive time step");
    const Stopwatch stopwatch;
    for (std::size_t i = 0; i < integrated_.size(); ++i)
        if (!integrated_[i] || !started_) x_.row(i) = lbs_positions.row(i);
    started_ = true;
    const double substep_s = dt_s / options_.substeps;
    const Vec3 origin = options_.precision == Precision::f32 ? local_origin<float>(x_) : local_origin<double>(x_);
    for (int substep = 0; substep < options_.substeps; ++substep) {
        predict(substep_s);
        if (substep == 0 || integrates_) projection_->load(x_, bind_points, origin);
        projection_->begin_substep(substep_s);
        for (int iteration = 0; iteration < options_.iterations; ++iteration) {
            if (!options_.keep_multipliers) projection_->forget_multipliers();
            projection_->project_bind_constraints();
            projection_->project_stretch_constraints();
            projection_->project_volume_constraints();
        }
        if (substep + 1 == options_.substeps || integrates_) projection_->store(origin, x_);
        update_velocities(substep_s);
    }
    return summary(stopwatch.seconds());
}

StepSummary XpbdSolver::summary(double seconds) const
{
    StepSummary summary;
    summary.iterations = options_.iterations * options_.substeps;
    const auto volumes = static_cast<std::int64_t>(constraints_.volume.size());
    const auto others = static_cast<std::int64_t>(constraints_.bind.size() + constraints_.stretch.size());
    summary.work = {.tet_visits = summary.iterations * volumes, .projections = summary.iterations * (others + volumes)};
    if (!x_.allFinite()) summary.outcome = Outcome::not_finite;
    summary.seconds = seconds;
    return summary;
}

void XpbdSolver::predict(double dt_s)
{
    if (!integrates_) return;
    before_ = x_;
    for (std::size_t i = 0; i < integrated_.size(); ++i) {
        if (!integrated_[i]) continue;
        v_.row(i) += options_.gravity_m_s2.transpose() * dt_s;
        x_.row(i) += v_.row(i) * dt_s;
    }
}

void XpbdSolver::update_velocities(double dt_s)
{
    for (std::size_t i = 0; i < integrated_.size(); ++i)
        if (integrated_[i]) v_.row(i) = (x_.row(i) - before_.row(i)) / dt_s;
}

namespace {

// A sixth of the rest volume of the tets around each edge [m^3]. The sum is the volume of the body.
std::map<std::pair<int, int>, double> edge_volumes(const Tets& tets, const Eigen::VectorXd& tet_volumes)
{
    std::map<std::pair<int, int>, double> volumes;
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int a = 0; a < 4; ++a)
            for (int b = a + 1; b < 4; ++b) volumes[std::minmax({tets(t, a), tets(t, b)})] += tet_volumes(t) / 6.0;
    return volumes;
}

// Order `plain`: one constraint after the other in the order given. The packed orders are tested against it.
template <typename Scalar>
class PlainXpbdProjection : public XpbdProjection {
public:
    explicit PlainXpbdProjection(const XpbdConstraints& constraints)
        : w_(constraints.inverse_mass.begin(), constraints.inverse_mass.end()),
          bind_(with_multipliers(constraints.bind)),
          stretch_(with_multipliers(constraints.stretch)),
          volume_(with_multipliers(constraints.volume)),
          x_(w_.size()),
          q_(w_.size())
    {
    }

    void load(const Positions& p, const Positions& q, const Vec3& origin) override
    {
        for (std::size_t i = 0; i < x_.size(); ++i) {
            x_[i] = (p.row(i).transpose() - origin).template cast<Scalar>();
            q_[i] = (q.row(i).transpose() - origin).template cast<Scalar>();
        }
    }

    void forget_multipliers() override
    {
        for (auto& multiplied : bind_) multiplied.multiplier = Scalar(0);
        for (auto& multiplied : stretch_) multiplied.multiplier = Scalar(0);
        for (auto& multiplied : volume_) multiplied.multiplier = Scalar(0);
    }

    void project_bind_constraints() override
    {
        for (auto& bind : bind_) {
            const int i = bind.constraint.vertex;
            project(bind, value(bind.constraint, x_[i], q_[i]), std::array{gradient(bind.constraint, x_[i], q_[i])},
                    std::array{i});
        }
    }

    void project_stretch_constraints() override
    {
        for (auto& edge : stretch_) {
            const auto [i, j] = edge.constraint.vertex;
            project(edge, value(edge.constraint, x_[i], x_[j]), gradient(edge.constraint, x_[i], x_[j]),
                    edge.constraint.vertex);
        }
    }

    void project_volume_constraints() override
    {
        for (auto& tet : volume_) {
            const auto [i, j, k, l] = tet.constraint.vertex;
            const Scalar C = value(tet.constraint, x_[i], x_[j], x_[k], x_[l]);
            project(tet, C, gradient(tet.constraint, x_[i], x_[j], x_[k], x_[l]), tet.constraint.vertex);
        }
    }

    void store(const Vec3& origin, Positions& p) const override
    {
        for (std::size_t i = 0; i < x_.size(); ++i) p.row(i) = x_[i].template cast<double>() + origin;
    }

private:
    using Point = Vector3<Scalar>;
    template <typename Constraint>
    struct Multiplied {
        Constraint constraint;
        Scalar compliance;  // alpha
        Scalar multiplier;  // lambda of this substep
    };

    template <template <typename> typename Constraint>
    static std::vector<Multiplied<Constraint<Scalar>>> with_multipliers(
        const std::vector<Compliant<Constraint<double>>>& constraints)
    {
        std::vector<Multiplied<Constraint<Scalar>>> multiplied;
        for (const auto& [constraint, compliance] : constraints) {
            const auto& [vertex, rest, stiffness] = constraint;
            multiplied.push_back({{vertex, Scalar(rest), Scalar(1)}, Scalar(compliance), Scalar(0)});
        }
        return multiplied;
    }

    // Eq. 18 of Macklin 2016 for the value C and its gradients by these vertices; zero if nothing can move.
    template <typename Constraint, std::size_t n>
    void project(Multiplied<Constraint>& multiplied, Scalar C, const std::array<Point, n>& gradient,
                 const std::array<int, n>& vertex)
    {
        Scalar w_gradient2 = Scalar(0);
        for (std::size_t i = 0; i < n; ++i) w_gradient2 += w_[vertex[i]] * gradient[i].squaredNorm();
        const Scalar compliance_per_dt2 = multiplied.compliance / Scalar(dt2_s2_),
                     denominator = w_gradient2 + compliance_per_dt2;
        const Scalar step =
            w_gradient2 > Scalar(0) ? (-C - compliance_per_dt2 * multiplied.multiplier) / denominator : Scalar(0);
        multiplied.multiplier += step;
        for (std::size_t i = 0; i < n; ++i) x_[vertex[i]] += w_[vertex[i]] * step * gradient[i];
    }

    std::vector<Scalar> w_;  // inverse masses [1/kg], #V
    std::vector<Multiplied<BindConstraint<Scalar>>> bind_;
    std::vector<Multiplied<StretchConstraint<Scalar>>> stretch_;
    std::vector<Multiplied<VolumeConstraint<Scalar>>> volume_;
    std::vector<Point> x_, q_;  // relative to the origin [m], #V
};

// The order `ordered`: the batches, the slabs and the sequence of BatchedProjection, with a compliance
// and a multiplier for each constraint. Any machine and any number of threads project alike, and threads give the same
// bits.
template <typename Scalar>
class BatchedXpbdProjection : public XpbdProjection {
public:
    BatchedXpbdProjection(const XpbdConstraints& constraints, const Tets& tets, int threads)
        : batched_(make_batched_constraints<Scalar>(constraints, tets)),
          parallel_(batched_.order.slabs() >= slabs_worth_threads ? threads : 1),
          particles_(batched_, {constraints.inverse_mass.begin(), constraints.inverse_mass.end()},
                     rigid_binds(constraints)),
          stretch_(multipliers_of(batched_.stretch)),
          volume_(multipliers_of(batched_.volume))
    {
    }

    void load(const Positions& p, const Positions& q, const Vec3& origin) override { particles_.load(p, q, origin); }
    void forget_multipliers() override
    {
        for (Multipliers* multipliers : {&stretch_, &volume_})
            std::fill(multipliers->lambdas.begin(), multipliers->lambdas.end(), Lambdas{});
    }
    // Compliance zero: their multipliers change nothing and are not kept.
    void project_bind_constraints() override { particles_.project_bind_constraints(parallel_); }
    void project_stretch_constraints() override { project(batched_.stretch, stretch_); }
    void project_volume_constraints() override { project(batched_.volume, volume_); }
    void store(const Vec3& origin, Positions& p) const override { particles_.store(origin, p); }

private:
    struct alignas(64) Lambdas {  // of a batch
        Scalar of_lane[batch_size];
    };
    struct Multipliers {
        std::vector<Lambdas> lambdas;                        // by runs, then batches
        std::vector<std::vector<std::size_t>> first_of_run;  // of each slab
    };

    static std::vector<BindConstraint<Scalar>> rigid_binds(const XpbdConstraints& constraints)
    {
        std::vector<BindConstraint<Scalar>> binds;
        for (const auto& [bind, compliance] : constraints.bind)
            binds.push_back({bind.vertex, Scalar(bind.rest_distance), Scalar(1)});
        return binds;
    }

    static Multipliers multipliers_of(const BatchProgram<Scalar>& program)
    {
        Multipliers multipliers;
        std::size_t next = 0;
        for (int slab = 0; slab < program.slabs(); ++slab) {
            std::vector<std::size_t>& first = multipliers.first_of_run.emplace_back();
            for (const BatchRun& run : program.runs(slab)) {
                first.push_back(next);
                next += static_cast<std::size_t>(run.count);
            }
        }
        multipliers.lambdas.resize(next, Lambdas{});
        return multipliers;
    }

    void project(const BatchProgram<Scalar>& program, Multipliers& multipliers)
    {
        parallel_.for_each_slab(program.slabs(), [&](int slab) {
            const std::vector<BatchRun>& runs = program.runs(slab);
            for (std::size_t r = 0; r < runs.size(); ++r)
                project_compliant_batches(runs[r].kind, program.batches(runs[r]), runs[r].count, Scalar(dt2_s2_),
                                          multipliers.lambdas[multipliers.first_of_run[slab][r]].of_lane,
                                          particles_.xyzw());
        });
    }

    BatchedConstraints<Scalar> batched_;
    Parallel parallel_;
    BatchedParticles<Scalar> particles_;
    Multipliers stretch_, volume_;
};

template <typename Scalar>
std::unique_ptr<XpbdProjection> in_precision(const XpbdConstraints& constraints, const Tets& tets,
                                             const XpbdOptions& options)
{
    if (options.order == Order::spread)
        return std::make_unique<PlainXpbdProjection<Scalar>>(in_spread_order(constraints));
    if (options.order == Order::plain) return std::make_unique<PlainXpbdProjection<Scalar>>(constraints);
    return std::make_unique<BatchedXpbdProjection<Scalar>>(constraints, tets, options.threads);
}

}  // namespace

XpbdConstraints make_xpbd_constraints(const TetMesh& mesh, const Eigen::VectorXd& bind_distance,
                                      const XpbdOptions& options, const std::vector<bool>& held)
{
    if (!(options.poisson >= 0.25 && options.poisson < 0.5))
        throw InputError("xpbd", 0, "poisson", std::to_string(options.poisson), "expected 1/4 <= poisson < 1/2");
    const double mu = options.young_pa / (2.0 * (1.0 + options.poisson));
    const double missing_bulk = options.young_pa / (3.0 * (1.0 - 2.0 * options.poisson)) - 5.0 / 3.0 * mu;
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets), lumped = lumped_volumes(mesh.rest, mesh.tets);

    XpbdConstraints constraints;
    for (Eigen::Index i = 0; i < lumped.size(); ++i) {
        const bool is_held = !held.empty() && held[i];
        constraints.inverse_mass.push_back(is_held || !(lumped(i) > 0.0) ? 0.0
                                                                         : 1.0 / (options.density_kg_m3 * lumped(i)));
    }
    for (Eigen::Index i = 0; i < bind_distance.size(); ++i)
        constraints.bind.push_back({{static_cast<int>(i), bind_distance(i), 1.0}});
    for (const auto& [edge, volume] : edge_volumes(mesh.tets, volumes)) {
        const double length = (mesh.rest.row(edge.first) - mesh.rest.row(edge.second)).norm();
        constraints.stretch.push_back(
            {{{edge.first, edge.second}, length, 1.0}, length * length / (15.0 * mu * volume)});
    }
    for (Eigen::Index t = 0; t < mesh.tets.rows() && missing_bulk > 0.0; ++t)
        constraints.volume.push_back(
            {{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, volumes(t), 1.0},
             volumes(t) / missing_bulk});
    return constraints;
}

template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const XpbdConstraints& constraints, const Tets& tets)
{
    ConstraintClassData<Scalar, 2> stretch;
    for (const auto& [edge, compliance] : constraints.stretch)
        stretch.add(edge.vertex, Scalar(edge.rest_length), Scalar(1.0 / compliance));
    ConstraintClassData<Scalar, 4> volume;
    for (const auto& [tet, compliance] : constraints.volume)
        volume.add(tet.vertex, Scalar(6.0 * tet.rest_volume), Scalar(1.0 / (36.0 * compliance)));
    return make_batched_constraints(stretch, volume, static_cast<int>(constraints.inverse_mass.size()), tets);
}

template BatchedConstraints<float> make_batched_constraints(const XpbdConstraints&, const Tets&);
template BatchedConstraints<double> make_batched_constraints(const XpbdConstraints&, const Tets&);

std::unique_ptr<XpbdProjection> make_xpbd_projection(const XpbdConstraints& constraints, const Tets& tets,
                                                     const XpbdOptions& options)
{
    return options.precision == Precision::f32 ? in_precision<float>(constraints, tets, options)
                                               : in_precision<double>(constraints, tets, options);
}

}  // namespace pbs
