#include "reference_fem/dynamics/time_scheme.hpp"

#include "reference_fem/input_checks.hpp"

namespace reference_fem {

TimeScheme newmark()
{
    return {};
}

TimeScheme generalized_alpha(double spectral_radius)
{
    require(spectral_radius >= 0.0 && spectral_radius <= 1.0, "spectral_radius", spectral_radius, "expected 0 <= spectral_radius <= 1");
    TimeScheme scheme;
    // The optimal algorithm of Chung and Hulbert; then what second order (gamma) and the highest modes (beta) ask for.
    scheme.alpha_m = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
    scheme.alpha_f = spectral_radius / (spectral_radius + 1.0);
    scheme.gamma = 0.5 - scheme.alpha_m + scheme.alpha_f;
    scheme.beta = 0.25 * (1.0 - scheme.alpha_m + scheme.alpha_f) * (1.0 - scheme.alpha_m + scheme.alpha_f);
    return scheme;
}

double end_share(const TimeScheme& scheme)
{
    return 1.0 - scheme.alpha_f;
}

double inertia_coefficient(const TimeScheme& scheme, double step_s)
{
    return (1.0 - scheme.alpha_m) / (end_share(scheme) * scheme.beta * step_s * step_s);
}

double damping_coefficient(const TimeScheme& scheme, double step_s)
{
    return scheme.gamma / (scheme.beta * step_s);
}

Eigen::VectorXd inertia_centre(const TimeScheme& scheme, const Motion& motion, double step_s)
{
    const double of_acceleration = (0.5 - scheme.beta / (1.0 - scheme.alpha_m)) * step_s * step_s;
    return motion.displacement + end_share(scheme) * (step_s * motion.velocity + of_acceleration * motion.acceleration);
}

Eigen::VectorXd damping_centre(const TimeScheme& scheme, const Motion& motion, double step_s)
{
    const double ratio = scheme.beta / scheme.gamma;
    return motion.displacement + (end_share(scheme) - ratio) * step_s * motion.velocity +
           end_share(scheme) * (0.5 - ratio) * step_s * step_s * motion.acceleration;
}

Eigen::VectorXd moved_acceleration(const TimeScheme& scheme, const Eigen::VectorXd& acceleration, const Eigen::VectorXd& rate,
                                   double longer_s)
{
    return acceleration + (scheme.alpha_m - scheme.alpha_f) * longer_s * rate;
}

Motion accept(const TimeScheme& scheme, const Motion& motion, const Eigen::VectorXd& w, double step_s)
{
    const Eigen::VectorXd increment = (w - motion.displacement) / end_share(scheme);
    Motion next;
    next.displacement = motion.displacement + increment;
    // Eq. (b)
    next.acceleration = (increment - step_s * motion.velocity - (0.5 - scheme.beta) * step_s * step_s * motion.acceleration) /
                        (scheme.beta * step_s * step_s);
    // Eq. (c)
    next.velocity = motion.velocity + step_s * ((1.0 - scheme.gamma) * motion.acceleration + scheme.gamma * next.acceleration);
    return next;
}

}  // namespace reference_fem
