#include "pbs/solver/algorithm_1.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/solver/residuals.hpp"

#include <type_traits>

namespace pbs {
namespace {

std::vector<int> jiggling_vertices(const std::vector<bool>& jiggle_zone, const PbsOptions& options)
{
    std::vector<int> vertices;
    for (std::size_t i = 0; options.jiggle && i < jiggle_zone.size(); ++i)
        if (jiggle_zone[i]) vertices.push_back(static_cast<int>(i));
    return vertices;
}

void check_rows(const char* field, const Positions& points, std::size_t vertices)
{
    if (static_cast<std::size_t>(points.rows()) != vertices)
        throw InputError("pbs", 0, field, std::to_string(points.rows()) + " points", "expected one a vertex, " + std::to_string(vertices));
}

}  // namespace

template <typename Scalar>
Algorithm1<Scalar>::Algorithm1(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                               const PbsOptions& options, const std::vector<bool>& held)
    : options_(options),
      projection_(make_projection(make_constraint_set<Scalar>(mesh, bind_distance, jiggle_zone, options, held), mesh.tets, options)),
      jiggling_(jiggling_vertices(jiggle_zone, options)),
      x_(mesh.rest)
{
}

template <typename Scalar>
StepSummary Algorithm1<Scalar>::advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s)
{
    check_input(lbs_positions, bind_points, dt_s);
    const Stopwatch stopwatch;
    StepSummary summary;

    if (v_.rows() == 0) {
        v_ = Positions::Zero(jiggling_.size(), 3);  // (2)
        x_ = lbs_positions;                         // (3)
    }
    p_ = lbs_positions;
    // (6)
    for (std::size_t j = 0; j < jiggling_.size(); ++j) {
        const int i = jiggling_[j];
        v_.row(j) += options_.gravity_m_s2.transpose() * dt_s;  // (7)
        p_.row(i) = x_.row(i) + v_.row(j) * dt_s;               // (8)
    }                                                           // (9)

    const Vec3 origin = local_origin();
    projection_->load(p_, bind_points, origin);
    bool converged = false;
    // (10)
    while (summary.iterations < options_.iterations && !converged) {
        projection_->project_bind_constraints();     // (11)
        projection_->project_stretch_constraints();  // (12)
        projection_->project_volume_constraints();   // (13)
        ++summary.iterations;
        converged = examine_residuals(summary);
    }  // (14)
    projection_->store(origin, p_);

    for (std::size_t j = 0; j < jiggling_.size(); ++j)                     // (15)
        v_.row(j) = (p_.row(jiggling_[j]) - x_.row(jiggling_[j])) / dt_s;  // (16)
    x_ = p_;                                                               // (17)-(18)

    if (options_.stop_residual > 0.0 && !converged) summary.outcome = Outcome::not_converged;
    if (!x_.allFinite()) summary.outcome = Outcome::not_finite;
    summary.seconds = stopwatch.seconds();
    return summary;
}

template <typename Scalar>
void Algorithm1<Scalar>::check_input(const Positions& lbs_positions, const Positions& bind_points, double dt_s) const
{
    check_rows("lbs_positions", lbs_positions, static_cast<std::size_t>(x_.rows()));
    check_rows("bind_points", bind_points, static_cast<std::size_t>(x_.rows()));
    if (!jiggling_.empty() && !(dt_s > 0.0)) throw InputError("pbs", 0, "dt", std::to_string(dt_s) + " s", "expected a positive time step");
}

// The printed form of absolute positions depends on the world's origin, so it is left there.
template <typename Scalar>
Vec3 Algorithm1<Scalar>::local_origin() const
{
    const bool of_absolute_positions =
        options_.volume_form == VolumeForm::labels_absolute || options_.volume_form == VolumeForm::as_printed;
    const bool local = std::is_same_v<Scalar, float> && !of_absolute_positions && p_.rows() > 0;
    return local ? Vec3(p_.colwise().mean()) : Vec3(Vec3::Zero());
}

// Records residuals where asked; true when the largest is below stop_residual.
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
