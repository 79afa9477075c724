#include "pbs/solver/xpbd_solver.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/solver/particles.hpp"

#include <algorithm>

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

}  // namespace pbs
