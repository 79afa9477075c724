#include "pbs/solver/algorithm_1.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/step_summary.hpp"

#include <algorithm>
#include <utility>

namespace pbs {
namespace {

SleepTolerance sleep_tolerance(const TetMesh& mesh, const PbsOptions& options)
{
    if (!options.sleep) return {};
    const Edges edges = edges_of(mesh.tets);
    double sum_m = 0.0;
    for (const auto edge : edges.rowwise()) sum_m += (mesh.rest.row(edge(0)) - mesh.rest.row(edge(1))).norm();
    return {options.sleep_tolerance, options.sleep_tolerance * sum_m / double(std::max<Eigen::Index>(edges.rows(), 1))};
}

}  // namespace

template <typename Scalar>
Algorithm1<Scalar>::Algorithm1(const TetMesh& mesh, const Eigen::VectorXd& bind_distance,
                               const std::vector<bool>& jiggle_zone, const PbsOptions& options,
                               const std::vector<bool>& held)
    : options_(options),
      projection_(
          projection_of(make_constraint_set<Scalar>(mesh, bind_distance, jiggle_zone, options, held), mesh.tets)),
      sleep_tolerance_(sleep_tolerance(mesh, options)),
      particles_(mesh.rest, jiggle_zone, options)
{
    if (!options.contact) return;
    const PositionRows<Scalar> rows = projection_->rows();
    rows_ = rows.data;
    contact_.emplace(mesh, rows.place, rows.stride);
}

template <typename Scalar>
std::unique_ptr<Projection<Scalar>> Algorithm1<Scalar>::projection_of(ConstraintSet<Scalar> constraints,
                                                                      const Tets& tets)
{
    bind_ = static_cast<std::int64_t>(constraints.bind.size());
    stretch_ = static_cast<std::int64_t>(constraints.stretch.size());
    volume_ = static_cast<std::int64_t>(constraints.volume.size());
    if (options_.contact) inverse_mass_ = constraints.inverse_mass;
    return make_projection(std::move(constraints), tets, options_);
}

template <typename Scalar>
StepSummary Algorithm1<Scalar>::advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s)
{
    particles_.check_input(lbs_positions, bind_points, dt_s);
    const Stopwatch stopwatch;
    const Positions& bound_to = options_.bind_to == BindTo::blended_position ? lbs_positions : bind_points;
    StepSummary summary;
    contacts_ = 0;

    particles_.predict(lbs_positions, dt_s);  // (2)-(9)
    const Vec3 origin = local_origin();
    bool converged;
    do {
        converged = false;
        projection_->load(particles_.predicted(), bound_to, origin);
        if (options_.sleep && summary.wakings == 0) projection_->sleep(sleep_tolerance_);
        // (10)
        for (summary.iterations = 0; summary.iterations < options_.iterations && !converged; ++summary.iterations) {
            if (contact_) seek_contacts(summary.iterations);
            projection_->project_bind_constraints();     // (11)
            projection_->project_stretch_constraints();  // (12)
            projection_->project_volume_constraints();   // (13)
            if (contact_) contact_->project(inverse_mass_, rows_);
            converged = examine_residuals(summary);
        }  // (14)
        summary.work += work_of(summary.iterations);
    } while (options_.sleep && woken(summary));
    summary.work.projections += contacts_;
    projection_->store(origin, particles_.predicted());
    particles_.update(dt_s);  // (15)-(18)

    summary.sleeping_share = projection_->sleeping_share();
    if (options_.stop_residual > 0.0 && !converged) summary.outcome = Outcome::not_converged;
    if (!positions().allFinite()) summary.outcome = Outcome::not_finite;
    summary.seconds = stopwatch.seconds();
    return summary;
}

// The printed form of absolute positions depends on the world's origin, so it is left there.
template <typename Scalar>
Vec3 Algorithm1<Scalar>::local_origin() const
{
    const bool of_absolute_positions =
        options_.volume_form == VolumeForm::labels_absolute || options_.volume_form == VolumeForm::as_printed;
    return of_absolute_positions ? Vec3(Vec3::Zero()) : pbs::local_origin<Scalar>(particles_.predicted());
}

// The work of these iterations. Sleeping constraints are counted by their share, which is that of both classes.
template <typename Scalar>
WorkCounters Algorithm1<Scalar>::work_of(int iterations) const
{
    const double awake = 1.0 - projection_->sleeping_share();
    const auto awake_of = [&](std::int64_t constraints) { return std::llround(awake * double(constraints)); };
    return {.tet_visits = iterations * awake_of(volume_),
            .projections = iterations * (bind_ + awake_of(stretch_) + awake_of(volume_))};
}

// Skin in flesh of another part is sought after a quarter and after three quarters of the iterations. Before, the tets
// that LBS turns inside out would report flesh where there is none.
template <typename Scalar>
void Algorithm1<Scalar>::seek_contacts(int iteration)
{
    if (iteration == 0) contact_->forget();
    if (iteration == options_.iterations / 4 || iteration == 3 * options_.iterations / 4) contact_->find(rows_);
    contacts_ += static_cast<std::int64_t>(contact_->constraints().size());
}

// Whether a sleeping constraint is needed after all; the step is redone with it.
template <typename Scalar>
bool Algorithm1<Scalar>::woken(StepSummary& summary)
{
    if (projection_->wake(sleep_tolerance_) == 0) return false;
    ++summary.wakings;
    summary.history.clear();
    return true;
}

// Records residuals if requested; true when the largest is below stop_residual.
template <typename Scalar>
bool Algorithm1<Scalar>::examine_residuals(StepSummary& summary) const
{
    if (!options_.record_iterations && options_.stop_residual <= 0.0) return false;
    const Residuals residuals = projection_->residuals();
    if (options_.record_iterations) summary.history.push_back(residuals);
    return largest(residuals) < options_.stop_residual;
}

template class Algorithm1<float>;
template class Algorithm1<double>;

}  // namespace pbs
