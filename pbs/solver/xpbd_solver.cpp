#include "pbs/solver/xpbd_solver.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace pbs {
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

// The change of lambda by Eq. 18 of Macklin 2016; zero if nothing can move.
double multiplier_step(double C, double compliance_per_dt2, double lambda, double w_gradient2)
{
    const double denominator = w_gradient2 + compliance_per_dt2;
    return w_gradient2 > 0.0 ? (-C - compliance_per_dt2 * lambda) / denominator : 0.0;
}

}  // namespace

XpbdSolver::XpbdSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                       const XpbdOptions& options, const std::vector<bool>& held)
    : options_(options),
      integrated_(mesh.rest.rows(), false),
      x_(mesh.rest.rows()),
      before_(mesh.rest.rows()),
      v_(mesh.rest.rows(), Point::Zero()),
      positions_(mesh.rest)
{
    if (!(options.poisson >= 0.25 && options.poisson < 0.5))
        throw InputError("xpbd", 0, "poisson", std::to_string(options.poisson), "expected 1/4 <= poisson < 1/2");
    if (options.substeps < 1) throw InputError("xpbd", 0, "substeps", std::to_string(options.substeps), "expected 1 or more");
    const double mu = options.young_pa / (2.0 * (1.0 + options.poisson));
    const double missing_bulk = options.young_pa / (3.0 * (1.0 - 2.0 * options.poisson)) - 5.0 / 3.0 * mu;
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets), lumped = lumped_volumes(mesh.rest, mesh.tets);
    const std::map<std::pair<int, int>, double> around = edge_volumes(mesh.tets, volumes);

    for (Eigen::Index i = 0; i < lumped.size(); ++i) {
        const bool is_held = !held.empty() && held[i];
        w_.push_back(is_held || !(lumped(i) > 0.0) ? 0.0 : 1.0 / (options.density_kg_m3 * lumped(i)));
        integrated_[i] = options.jiggle && !jiggle_zone.empty() && jiggle_zone[i];
    }
    for (Eigen::Index i = 0; i < bind_distance.size(); ++i) bind_.push_back({{static_cast<int>(i), bind_distance(i), 1.0}});
    for (const auto& [edge, volume] : around) {
        const double length = (mesh.rest.row(edge.first) - mesh.rest.row(edge.second)).norm();
        stretch_.push_back({{{edge.first, edge.second}, length, 1.0}, length * length / (15.0 * mu * volume)});
    }
    for (Eigen::Index t = 0; t < mesh.tets.rows() && missing_bulk > 0.0; ++t)
        volume_.push_back(
            {{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, volumes(t), 1.0}, volumes(t) / missing_bulk});
}

StepSummary XpbdSolver::advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s)
{
    if (!(dt_s > 0.0)) throw InputError("xpbd", 0, "dt", std::to_string(dt_s) + " s", "expected a positive time step");
    const Stopwatch stopwatch;
    for (std::size_t i = 0; i < x_.size(); ++i)
        if (!integrated_[i] || !started_) x_[i] = lbs_positions.row(i);
    started_ = true;
    const double substep_s = dt_s / options_.substeps;
    for (int substep = 0; substep < options_.substeps; ++substep) {
        predict(substep_s);
        for (int iteration = 0; iteration < options_.iterations; ++iteration) {
            if (iteration == 0 || !options_.keep_multipliers) forget_multipliers();
            project(bind_points, substep_s);
        }
        update_velocities(substep_s);
    }
    for (std::size_t i = 0; i < x_.size(); ++i) positions_.row(i) = x_[i];

    StepSummary summary;
    summary.iterations = options_.iterations * options_.substeps;
    const auto constraints = static_cast<std::int64_t>(bind_.size() + stretch_.size() + volume_.size());
    summary.work = {.tet_visits = summary.iterations * static_cast<std::int64_t>(volume_.size()),
                    .projections = summary.iterations * constraints};
    if (!positions_.allFinite()) summary.outcome = Outcome::not_finite;
    summary.seconds = stopwatch.seconds();
    return summary;
}

void XpbdSolver::predict(double dt_s)
{
    before_ = x_;
    for (std::size_t i = 0; i < x_.size(); ++i) {
        if (!integrated_[i]) continue;
        v_[i] += options_.gravity_m_s2 * dt_s;
        x_[i] += v_[i] * dt_s;
    }
}

void XpbdSolver::forget_multipliers()
{
    for (auto& compliant : bind_) compliant.multiplier = 0.0;
    for (auto& compliant : stretch_) compliant.multiplier = 0.0;
    for (auto& compliant : volume_) compliant.multiplier = 0.0;
}

void XpbdSolver::project(const Positions& bind_points, double dt_s)
{
    const double dt2 = dt_s * dt_s;
    for (auto& [constraint, compliance, lambda] : bind_) {
        const int i = constraint.vertex;
        const Point q = bind_points.row(i);
        const Point g = gradient(constraint, x_[i], q);
        const double step = multiplier_step(value(constraint, x_[i], q), compliance / dt2, lambda, w_[i] * g.squaredNorm());
        lambda += step;
        x_[i] += w_[i] * step * g;
    }
    for (auto& [constraint, compliance, lambda] : stretch_) {
        const auto [i, j] = constraint.vertex;
        const auto [g1, g2] = gradient(constraint, x_[i], x_[j]);
        const double step =
            multiplier_step(value(constraint, x_[i], x_[j]), compliance / dt2, lambda, w_[i] * g1.squaredNorm() + w_[j] * g2.squaredNorm());
        lambda += step;
        x_[i] += w_[i] * step * g1;
        x_[j] += w_[j] * step * g2;
    }
    for (auto& [constraint, compliance, lambda] : volume_) {
        const auto& v = constraint.vertex;
        const auto g = gradient(constraint, x_[v[0]], x_[v[1]], x_[v[2]], x_[v[3]]);
        double w_gradient2 = 0.0;
        for (int c = 0; c < 4; ++c) w_gradient2 += w_[v[c]] * g[c].squaredNorm();
        const double C = value(constraint, x_[v[0]], x_[v[1]], x_[v[2]], x_[v[3]]);
        const double step = multiplier_step(C, compliance / dt2, lambda, w_gradient2);
        lambda += step;
        for (int c = 0; c < 4; ++c) x_[v[c]] += w_[v[c]] * step * g[c];
    }
}

void XpbdSolver::update_velocities(double dt_s)
{
    for (std::size_t i = 0; i < x_.size(); ++i)
        if (integrated_[i]) v_[i] = (x_[i] - before_[i]) / dt_s;
}

}  // namespace pbs
