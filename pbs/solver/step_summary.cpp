#include "pbs/solver/step_summary.hpp"

#include "pbs/solver/project_plain.hpp"

#include <cmath>
#include <utility>

namespace pbs {

const char* to_string(Outcome outcome)
{
    constexpr const char* names[] = {"finished", "not_finite", "not_converged"};  // in the order of Outcome
    return names[static_cast<int>(outcome)];
}

namespace {

// Root mean square of error(constraint) over a class; zero over none.
template <typename Constraints, typename Error>
double rms(const Constraints& constraints, Error error)
{
    double sum = 0.0;
    for (const auto& constraint : constraints) {
        const double e = error(constraint);
        sum += e * e;
    }
    return constraints.empty() ? 0.0 : std::sqrt(sum / constraints.size());
}

int severity(Outcome outcome)
{
    return outcome == Outcome::finished ? 0 : outcome == Outcome::not_converged ? 1 : 2;
}

}  // namespace

template <typename Scalar>
Residuals residuals_of(const ConstraintSet<Scalar>& constraints, const std::vector<Vector3<Scalar>>& p,
                       const std::vector<Vector3<Scalar>>& q)
{
    Residuals residuals;
    residuals.stretch_rms = rms(constraints.stretch, [&](const StretchConstraint<Scalar>& c) {
        return value(c, p[c.vertex[0]], p[c.vertex[1]]) / double(c.rest_length);
    });
    residuals.volume_rms = joint_rms(
        rms(constraints.volume,
            [&](const VolumeConstraint<Scalar>& c) {
                return value(c, p[c.vertex[0]], p[c.vertex[1]], p[c.vertex[2]], p[c.vertex[3]]) / double(c.rest_volume);
            }),
        constraints.volume.size(),
        rms_of_regions(constraints.regions, [&](int i) -> const Vector3<Scalar>& { return p[i]; }),
        constraints.regions.size());
    residuals.bind_rms_m = rms(
        constraints.bind, [&](const BindConstraint<Scalar>& c) { return double(value(c, p[c.vertex], q[c.vertex])); });
    return residuals;
}

double largest(const Residuals& residuals)
{
    double result = residuals.stretch_rms;
    for (const double residual : {residuals.volume_rms, residuals.bind_rms_m})
        if (residual > result || std::isnan(residual)) result = residual;
    return result;
}

template Residuals residuals_of(const ConstraintSet<float>&, const std::vector<Vector3<float>>&,
                                const std::vector<Vector3<float>>&);
template Residuals residuals_of(const ConstraintSet<double>&, const std::vector<Vector3<double>>&,
                                const std::vector<Vector3<double>>&);

void FrameStep::add(StepSummary summary, std::size_t step)
{
    const Outcome before = summary_.outcome;
    summary_ = std::move(summary);
    if (before == Outcome::finished || severity(summary_.outcome) > severity(before))
        worst_step_ = step;
    else
        summary_.outcome = before;
}

}  // namespace pbs
