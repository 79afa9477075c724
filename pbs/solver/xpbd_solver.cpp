#include "pbs/solver/xpbd_solver.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/batched/batched_xpbd_projection.hpp"
#include "pbs/solver/particles.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace pbs {
namespace {

void check_numbers(const XpbdOptions& options)
{
    if (options.substeps < 1) throw InputError("xpbd", 0, "substeps", std::to_string(options.substeps), "expected 1 or more");
    if (options.threads < 1) throw InputError("xpbd", 0, "threads", std::to_string(options.threads), "expected 1 or more");
}

}  // namespace

XpbdSolver::XpbdSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                       const XpbdOptions& options, const std::vector<bool>& held)
    : options_(options),
      integrated_(mesh.rest.rows(), false),
      constraints_(make_xpbd_constraints(mesh, bind_distance, options, held)),
      x_(mesh.rest),
      before_(mesh.rest),
      v_(Positions::Zero(mesh.rest.rows(), 3))
{
    check_numbers(options);
    projection_ = make_xpbd_projection(constraints_, mesh.tets, options);
    for (std::size_t i = 0; i < integrated_.size(); ++i) integrated_[i] = options.jiggle && !jiggle_zone.empty() && jiggle_zone[i];
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

}  // namespace

XpbdConstraints make_xpbd_constraints(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const XpbdOptions& options,
                                      const std::vector<bool>& held)
{
    if (!(options.poisson >= 0.25 && options.poisson < 0.5))
        throw InputError("xpbd", 0, "poisson", std::to_string(options.poisson), "expected 1/4 <= poisson < 1/2");
    const double mu = options.young_pa / (2.0 * (1.0 + options.poisson));
    const double missing_bulk = options.young_pa / (3.0 * (1.0 - 2.0 * options.poisson)) - 5.0 / 3.0 * mu;
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets), lumped = lumped_volumes(mesh.rest, mesh.tets);

    XpbdConstraints constraints;
    for (Eigen::Index i = 0; i < lumped.size(); ++i) {
        const bool is_held = !held.empty() && held[i];
        constraints.inverse_mass.push_back(is_held || !(lumped(i) > 0.0) ? 0.0 : 1.0 / (options.density_kg_m3 * lumped(i)));
    }
    for (Eigen::Index i = 0; i < bind_distance.size(); ++i) constraints.bind.push_back({{static_cast<int>(i), bind_distance(i), 1.0}});
    for (const auto& [edge, volume] : edge_volumes(mesh.tets, volumes)) {
        const double length = (mesh.rest.row(edge.first) - mesh.rest.row(edge.second)).norm();
        constraints.stretch.push_back({{{edge.first, edge.second}, length, 1.0}, length * length / (15.0 * mu * volume)});
    }
    for (Eigen::Index t = 0; t < mesh.tets.rows() && missing_bulk > 0.0; ++t)
        constraints.volume.push_back(
            {{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, volumes(t), 1.0}, volumes(t) / missing_bulk});
    return constraints;
}

namespace {

// The change of lambda by Eq. 18 of Macklin 2016; zero if nothing can move.
template <typename Scalar>
Scalar multiplier_step(Scalar C, Scalar compliance_per_dt2, Scalar lambda, Scalar w_gradient2)
{
    const Scalar denominator = w_gradient2 + compliance_per_dt2;
    return w_gradient2 > Scalar(0) ? (-C - compliance_per_dt2 * lambda) / denominator : Scalar(0);
}

}  // namespace

template <typename Scalar>
PlainXpbdProjection<Scalar>::PlainXpbdProjection(const XpbdConstraints& constraints)
    : w_(constraints.inverse_mass.begin(), constraints.inverse_mass.end()), x_(w_.size()), q_(w_.size())
{
    for (const auto& [bind, compliance] : constraints.bind)
        bind_.push_back({{bind.vertex, Scalar(bind.rest_distance), Scalar(1)}, Scalar(compliance), Scalar(0)});
    for (const auto& [edge, compliance] : constraints.stretch)
        stretch_.push_back({{edge.vertex, Scalar(edge.rest_length), Scalar(1)}, Scalar(compliance), Scalar(0)});
    for (const auto& [tet, compliance] : constraints.volume)
        volume_.push_back({{tet.vertex, Scalar(tet.rest_volume), Scalar(1)}, Scalar(compliance), Scalar(0)});
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::load(const Positions& p, const Positions& q, const Vec3& origin)
{
    for (std::size_t i = 0; i < x_.size(); ++i) {
        x_[i] = (p.row(i).transpose() - origin).template cast<Scalar>();
        q_[i] = (q.row(i).transpose() - origin).template cast<Scalar>();
    }
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::begin_substep(double dt_s)
{
    dt2_ = Scalar(dt_s * dt_s);
    forget_multipliers();
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::forget_multipliers()
{
    for (auto& multiplied : bind_) multiplied.multiplier = Scalar(0);
    for (auto& multiplied : stretch_) multiplied.multiplier = Scalar(0);
    for (auto& multiplied : volume_) multiplied.multiplier = Scalar(0);
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::project_bind_constraints()
{
    for (auto& [constraint, compliance, lambda] : bind_) {
        const int i = constraint.vertex;
        const Point g = gradient(constraint, x_[i], q_[i]);
        const Scalar step = multiplier_step(value(constraint, x_[i], q_[i]), compliance / dt2_, lambda, w_[i] * g.squaredNorm());
        lambda += step;
        x_[i] += w_[i] * step * g;
    }
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::project_stretch_constraints()
{
    for (auto& [constraint, compliance, lambda] : stretch_) {
        const auto [i, j] = constraint.vertex;
        const auto [g1, g2] = gradient(constraint, x_[i], x_[j]);
        const Scalar w_gradient2 = w_[i] * g1.squaredNorm() + w_[j] * g2.squaredNorm();
        const Scalar step = multiplier_step(value(constraint, x_[i], x_[j]), compliance / dt2_, lambda, w_gradient2);
        lambda += step;
        x_[i] += w_[i] * step * g1;
        x_[j] += w_[j] * step * g2;
    }
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::project_volume_constraints()
{
    for (auto& [constraint, compliance, lambda] : volume_) {
        const auto& v = constraint.vertex;
        const auto g = gradient(constraint, x_[v[0]], x_[v[1]], x_[v[2]], x_[v[3]]);
        Scalar w_gradient2 = Scalar(0);
        for (int c = 0; c < 4; ++c) w_gradient2 += w_[v[c]] * g[c].squaredNorm();
        const Scalar C = value(constraint, x_[v[0]], x_[v[1]], x_[v[2]], x_[v[3]]);
        const Scalar step = multiplier_step(C, compliance / dt2_, lambda, w_gradient2);
        lambda += step;
        for (int c = 0; c < 4; ++c) x_[v[c]] += w_[v[c]] * step * g[c];
    }
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::store(const Vec3& origin, Positions& p) const
{
    for (std::size_t i = 0; i < x_.size(); ++i) p.row(i) = x_[i].template cast<double>() + origin;
}

template class PlainXpbdProjection<float>;
template class PlainXpbdProjection<double>;

namespace {

template <typename Scalar>
std::unique_ptr<XpbdProjection> in_precision(const XpbdConstraints& constraints, const Tets& tets, const XpbdOptions& options)
{
    if (options.order == Order::plain) return std::make_unique<PlainXpbdProjection<Scalar>>(constraints);
    return std::make_unique<BatchedXpbdProjection<Scalar>>(constraints, tets, options.order, options.threads);
}

}  // namespace

std::unique_ptr<XpbdProjection> make_xpbd_projection(const XpbdConstraints& constraints, const Tets& tets, const XpbdOptions& options)
{
    return options.precision == Precision::f32 ? in_precision<float>(constraints, tets, options)
                                               : in_precision<double>(constraints, tets, options);
}

}  // namespace pbs
