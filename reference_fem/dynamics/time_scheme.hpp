// Implicit one-step schemes for M u'' + C u' + grad Pi(u) = 0 as incremental potentials: generalised-alpha (J. Chung, G. Hulbert, J. Appl.
// Mech. 60(2), 1993) and Newmark's average acceleration (N. Newmark, J. Eng. Mech. Div. ASCE 85, 1959), its case alpha_m = alpha_f = 0.
// With x_(n+1-alpha) = (1 - alpha) x_(n+1) + alpha x_n and the step h:
//   M a_(n+1-alpha_m) + C v_(n+1-alpha_f) + grad Pi(u_(n+1-alpha_f)) = 0                  balance, data at t_(n+1-alpha_f)      (a)
//   u_(n+1) = u_n + h v_n + h^2 ((1/2 - beta) a_n + beta a_(n+1))                                                             (b)
//   v_(n+1) = v_n + h ((1 - gamma) a_n + gamma a_(n+1))                                                                       (c)
// The unknown is w = u_(n+1-alpha_f). Eliminating a_(n+1) by (b) and v_(n+1) by (c) leaves both rates affine in w:
//   a_(n+1-alpha_m) = c_m (w - w~),  c_m = (1 - alpha_m) / ((1 - alpha_f) beta h^2)                                           (d)
//   v_(n+1-alpha_f) = c_c (w - w^),  c_c = gamma / (beta h)                                                                   (e)
//   w~ = u_n + (1 - alpha_f) (h v_n + (1/2 - beta / (1 - alpha_m)) h^2 a_n)                                                   (f)
//   w^ = u_n + (1 - alpha_f - beta / gamma) h v_n + (1 - alpha_f) (1/2 - beta / gamma) h^2 a_n                                (g)
// so that (a) says that w is a stationary point of  c_m / 2 |w - w~|_M^2 + c_c / 2 |w - w^|_C^2 + Pi(w).
// grad Pi is taken at the mean displacement, not averaged over both ends: where a body turns by theta in a step, w lies on the chord and
// generalised-alpha sees a strain of alpha_f (1 - alpha_f) theta^2 / 2, of second order in h. Newmark (w = u_(n+1)) sees none.
// a_n of generalised-alpha is the acceleration at t_n + (alpha_m - alpha_f) h (S. Erlicher, L. Bonaventura, O. Bursi, Comput. Mech. 28,
// 2002): where the next step has another length it is moved to that one's place, so that the order stays.
#pragma once

#include <Eigen/Core>

namespace reference_fem {

// The parameters of Eqs. (a) to (c), without unit.
struct TimeScheme {
    double alpha_m = 0.0, alpha_f = 0.0, beta = 0.25, gamma = 0.5;  // the defaults are Newmark's average acceleration
};

TimeScheme newmark();  // second order, unconditionally stable, without dissipation in linear problems

// Second order, unconditionally stable, the least dissipation at low frequencies for a given spectral radius at infinite frequency, 0 to 1,
// else pbs::InputError: 1 keeps the energy, 0 annihilates the highest modes, in three steps.
TimeScheme generalized_alpha(double spectral_radius);

// The state at t_n, #dofs each.
struct Motion {
    Eigen::VectorXd displacement, velocity, acceleration;  // [m], [m/s], [m/s^2]
};

double inertia_coefficient(const TimeScheme& scheme, double step_s);                            // c_m [1/s^2], Eq. (d)
double damping_coefficient(const TimeScheme& scheme, double step_s);                            // c_c [1/s], Eq. (e)
Eigen::VectorXd inertia_centre(const TimeScheme& scheme, const Motion& motion, double step_s);  // w~ [m], Eq. (f)
Eigen::VectorXd damping_centre(const TimeScheme& scheme, const Motion& motion, double step_s);  // w^ [m], Eq. (g)
// Acceleration [m/s^2] of a step of h + `longer_s`, from the one that a step of h ended with and its rate of change over it [m/s^3].
Eigen::VectorXd moved_acceleration(const TimeScheme& scheme, const Eigen::VectorXd& acceleration, const Eigen::VectorXd& rate,
                                   double longer_s);
double end_share(const TimeScheme& scheme);                                                              // 1 - alpha_f
Motion accept(const TimeScheme& scheme, const Motion& motion, const Eigen::VectorXd& w, double step_s);  // n + 1, Eqs. (b), (c)

}  // namespace reference_fem
