#include "reference_fem/dynamics/time_stepper.hpp"

#include "reference_fem/options.hpp"

namespace reference_fem {

ConsistentMass::ConsistentMass(const SimplexSpace& space, double density_kg_m3)
    : of_nodes_(mass_matrix(space, density_kg_m3))
{
}

Eigen::VectorXd ConsistentMass::times(const Eigen::VectorXd& values) const
{
    const Eigen::Map<const pbs::Positions> at_nodes(values.data(), of_nodes_.rows(), 3);
    Eigen::VectorXd product(values.size());
    // The matrix is symmetric: its columns are read as rows, which gathers instead of scattering.
    Eigen::Map<pbs::Positions>(product.data(), of_nodes_.rows(), 3).noalias() = of_nodes_.transpose() * at_nodes;
    return product;
}

void ConsistentMass::add_to(NodalMatrix& matrix, double factor) const
{
    matrix.add_isotropic(of_nodes_, factor);
}

SparseMatrix ConsistentMass::matrix() const
{
    SparseMatrix matrix(3 * of_nodes_.rows(), 3 * of_nodes_.cols());
    matrix.reserve(3 * of_nodes_.nonZeros());
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
        matrix.startVec(column);
        for (SparseMatrix::InnerIterator entry(of_nodes_, column / 3); entry; ++entry)
            matrix.insertBack(3 * entry.row() + column % 3, column) = entry.value();
    }
    matrix.finalize();
    return matrix;
}

TimeScheme newmark()
{
    return {};
}

TimeScheme generalized_alpha(double spectral_radius)
{
    require(spectral_radius >= 0.0 && spectral_radius <= 1.0, "spectral_radius", spectral_radius,
            "expected 0 <= spectral_radius <= 1");
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

Eigen::VectorXd moved_acceleration(const TimeScheme& scheme, const Eigen::VectorXd& acceleration,
                                   const Eigen::VectorXd& rate, double longer_s)
{
    return acceleration + (scheme.alpha_m - scheme.alpha_f) * longer_s * rate;
}

Motion accept(const TimeScheme& scheme, const Motion& motion, const Eigen::VectorXd& w, double step_s)
{
    const Eigen::VectorXd increment = (w - motion.displacement) / end_share(scheme);
    Motion next;
    next.displacement = motion.displacement + increment;
    // Eq. (b)
    next.acceleration =
        (increment - step_s * motion.velocity - (0.5 - scheme.beta) * step_s * step_s * motion.acceleration) /
        (scheme.beta * step_s * step_s);
    // Eq. (c)
    next.velocity =
        motion.velocity + step_s * ((1.0 - scheme.gamma) * motion.acceleration + scheme.gamma * next.acceleration);
    return next;
}

PrescribedMotion::PrescribedMotion(const std::vector<bool>& prescribed)
{
    for (std::size_t i = 0; i < prescribed.size(); ++i)
        if (prescribed[i]) dofs_.push_back(static_cast<int>(i));
}

PrescribedMotion::Differences PrescribedMotion::differences(const Motion& motion, const Eigen::VectorXd& values,
                                                            double step_s) const
{
    Differences now;
    now.slope = (values(dofs_) - motion.displacement(dofs_)) / step_s;
    if (steps_ == 0)
        now.curvature = (now.slope - motion.velocity(dofs_)) / step_s;
    else
        now.curvature = (now.slope - before_.slope) / (step_s + step_before_s_);
    return now;
}

// Newton's form through u_(n+1), u_n, u_(n-1), u_(n-2):
//   p(t) = u_(n+1) + s (t - t_(n+1)) + c (t - t_(n+1)) (t - t_n) + e (t - t_(n+1)) (t - t_n) (t - t_(n-1)).
Motion PrescribedMotion::next(const Motion& motion, const Eigen::VectorXd& values, double step_s) const
{
    const Differences now = differences(motion, values, step_s);
    Motion next = motion;
    next.displacement(dofs_) = values(dofs_);
    next.velocity(dofs_) = now.slope + step_s * now.curvature;
    next.acceleration(dofs_) = 2.0 * now.curvature;
    if (steps_ == 0) return next;
    const Eigen::VectorXd third = (now.curvature - before_.curvature) / (step_s + step_before_s_ + step_before_that_s_);
    next.acceleration(dofs_) += 2.0 * (2.0 * step_s + step_before_s_) * third;
    return next;
}

void PrescribedMotion::copy(const Motion& from, Motion& to) const
{
    to.displacement(dofs_) = from.displacement(dofs_);
    to.velocity(dofs_) = from.velocity(dofs_);
    to.acceleration(dofs_) = from.acceleration(dofs_);
}

void PrescribedMotion::accept(const Motion& motion, const Motion& next, double step_s)
{
    before_ = differences(motion, next.displacement, step_s);
    step_before_that_s_ = steps_ == 0 ? 0.0 : step_before_s_;
    step_before_s_ = step_s;
    ++steps_;
}

namespace {

const TimeStepperOptions& checked(const TimeStepperOptions& options)
{
    require(options.density_kg_m3 > 0.0 && std::isfinite(options.density_kg_m3), "density_kg_m3", options.density_kg_m3,
            "expected a finite density > 0 where there is inertia");
    for (const double damping : {options.rayleigh_mass_1_s, options.rayleigh_stiffness_s})
        require(damping >= 0.0 && std::isfinite(damping), "rayleigh", damping, "expected finite factors >= 0");
    return options;
}

// `share` of the way from one to the other; where they are equal, that to the bit.
Eigen::VectorXd between(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double share)
{
    return from + share * (to - from);
}

}  // namespace

TimeStepper::TimeStepper(const SimplexSpace& space, const std::vector<bool>& prescribed, const Potential& flesh,
                         const TimeStepperOptions& options, NewtonMinimiser& newton)
    : fixed_(prescribed),
      options_(checked(options)),
      newton_(newton),
      mass_(space, options.density_kg_m3),
      inertia_(mass_),
      mass_damping_(mass_),
      state_{{}, PrescribedMotion(prescribed), 0.0, {}}
{
    if (options.rayleigh_stiffness_s > 0.0)
        stiffness_damping_ = std::make_unique<StiffnessPotential>(rest_stiffness(space, flesh));
    start(Eigen::VectorXd::Zero(space.dofs()));
}

void TimeStepper::start(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity)
{
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(displacement.size());
    state_.motion = {displacement, velocity.size() > 0 ? velocity : zero, zero};
    state_.prescribed.start();
    state_.last_step_s = 0.0;
}

double TimeStepper::kinetic_energy_j() const
{
    return state_.motion.velocity.dot(mass_.times(state_.motion.velocity)) / 2.0;
}

LoadPathSummary TimeStepper::advance(const Terms& terms, const MovingData& data, double step_s, Eigen::VectorXd& guess,
                                     const NewtonOptions& newton, const LoadPathOptions& path)
{
    require(step_s > 0.0 && std::isfinite(step_s), "time_step_s", step_s, "expected a finite step > 0");
    const State before = state_;
    double reached = 0.0;
    const LoadPathSummary summary = follow_load_path(
        [&](double fraction) {
            const NewtonSummary part =
                attempt(terms, data, reached, fraction, (fraction - reached) * step_s, guess, newton);
            if (part.converged()) reached = fraction;
            return part;
        },
        guess, path);
    if (summary.converged()) return summary;
    state_ = before;
    guess = state_.motion.displacement;
    return summary;
}

NewtonSummary TimeStepper::attempt(const Terms& terms, const MovingData& data, double from, double to, double step_s,
                                   Eigen::VectorXd& guess, const NewtonOptions& options)
{
    Motion now = state_.motion;
    const Motion end = state_.prescribed.next(now, data.prescribed ? data.prescribed(to) : now.displacement, step_s);
    const auto move_terms = [&](double share) {
        if (data.move_terms) data.move_terms(from, to, share);
    };
    if (state_.last_step_s == 0.0) {
        move_terms(0.0);
        now.acceleration = start_acceleration(terms, end.acceleration);
    } else {
        now.acceleration = later_acceleration(step_s);
    }
    const double share = end_share(options_.scheme);
    move_terms(share);
    set_centres(now, end, step_s);
    if (step_s != factored_step_s_) newton_.forget_factor();
    factored_step_s_ = step_s;

    Eigen::VectorXd w = between(now.displacement, guess, share);
    const NewtonSummary summary =
        newton_.minimise(with_inertia(terms), between(now.displacement, end.displacement, share), w, options);
    last_iterate_ = w;
    if (!summary.converged()) return summary;
    accept_step(now, end, w, step_s);
    guess = state_.motion.displacement;
    return summary;
}

// M a = -(grad Pi(u) + C v) at the free degrees of freedom, given a at the others.
Eigen::VectorXd TimeStepper::start_acceleration(const Terms& terms, const Eigen::VectorXd& of_prescribed)
{
    const Motion& motion = state_.motion;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(motion.displacement.size());
    Eigen::VectorXd force = zero;
    for (const Potential* term : terms) term->add_gradient(motion.displacement, force);
    set_damping(1.0, zero);
    mass_damping_.add_gradient(motion.velocity, force);
    if (stiffness_damping_) stiffness_damping_->add_gradient(motion.velocity, force);
    const SparseMatrix mass = mass_.matrix();
    return EliminatedSystem(mass, fixed_, LinearSolver::cholmod).solve(-force, of_prescribed).displacement;
}

// A prescribed displacement has the acceleration at t_n itself.
Eigen::VectorXd TimeStepper::later_acceleration(double step_s) const
{
    if (step_s == state_.last_step_s) return state_.motion.acceleration;
    Eigen::VectorXd acceleration = moved_acceleration(options_.scheme, state_.motion.acceleration,
                                                      state_.acceleration_rate, step_s - state_.last_step_s);
    const auto& prescribed = state_.prescribed.dofs();
    acceleration(prescribed) = state_.motion.acceleration(prescribed);
    return acceleration;
}

void TimeStepper::set_damping(double coefficient, const Eigen::VectorXd& centre)
{
    mass_damping_.set(coefficient * options_.rayleigh_mass_1_s, centre);
    if (stiffness_damping_) stiffness_damping_->set(coefficient * options_.rayleigh_stiffness_s, centre);
}

// Where the displacement is prescribed so are the rates at t_(n+1-alpha_f): the centres are put where Eqs. (d), (e)
// give those.
void TimeStepper::set_centres(const Motion& now, const Motion& end, double step_s)
{
    const TimeScheme& scheme = options_.scheme;
    const double c_m = inertia_coefficient(scheme, step_s), c_c = damping_coefficient(scheme, step_s),
                 share = end_share(scheme);
    Eigen::VectorXd of_inertia = inertia_centre(scheme, now, step_s), of_damping = damping_centre(scheme, now, step_s);
    for (const int i : state_.prescribed.dofs()) {
        const auto at_w = [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
            return from(i) + share * (to(i) - from(i));
        };
        const double w = at_w(now.displacement, end.displacement);
        of_inertia(i) = w - at_w(now.acceleration, end.acceleration) / c_m;
        of_damping(i) = w - at_w(now.velocity, end.velocity) / c_c;
    }
    inertia_.set(c_m, of_inertia);
    set_damping(c_c, of_damping);
}

Terms TimeStepper::with_inertia(const Terms& terms) const
{
    Terms with_inertia = terms;
    with_inertia.push_back(&inertia_);
    if (options_.rayleigh_mass_1_s > 0.0) with_inertia.push_back(&mass_damping_);
    if (stiffness_damping_) with_inertia.push_back(stiffness_damping_.get());
    return with_inertia;
}

void TimeStepper::accept_step(const Motion& now, const Motion& end, const Eigen::VectorXd& w, double step_s)
{
    Motion next = accept(options_.scheme, now, w, step_s);
    state_.prescribed.copy(end, next);
    state_.prescribed.accept(now, next, step_s);
    state_.acceleration_rate = (next.acceleration - now.acceleration) / step_s;
    state_.last_step_s = step_s;
    state_.motion = next;
}

}  // namespace reference_fem
