// Velocity and acceleration of degrees of freedom whose displacement is given, from the displacements alone, to second order for steps of
// any length: the slope of the parabola through the last three and the curvature of the cubic through the last four, at the end of the
// step. The scheme's own Eqs. (b), (c) would answer a jump of the given velocity by V with a velocity that alternates by 2 V and, for
// Newmark, with accelerations that grow by 4 V / h a step: the weak instability of average acceleration under constraints (A. Cardona, M.
// Geradin, Computers and Structures 33(3), 1989). Here a jump is forgotten after three steps, and its impulse M V is passed on whole.
#pragma once

#include "reference_fem/dynamics/time_scheme.hpp"

#include <vector>

namespace reference_fem {

// Remembers what the past steps did; next() only looks, accept() goes on.
class PrescribedMotion {
public:
    explicit PrescribedMotion(const std::vector<bool>& prescribed);  // #dofs

    void start() { steps_ = 0; }  // of the past only the velocity is known

    // The motion at the end of a step that takes the prescribed degrees of freedom to `values` [m], #dofs; others are left as in `motion`.
    // The first step uses the mean acceleration, which is also that at its beginning.
    Motion next(const Motion& motion, const Eigen::VectorXd& values, double step_s) const;
    void copy(const Motion& from, Motion& to) const;  // the prescribed part
    // Moves on to the next motion after the end of a step was reached.
    void accept(const Motion& motion, const Motion& next, double step_s);

    const std::vector<int>& dofs() const { return dofs_; }  // the prescribed ones, increasing

private:
    struct Differences {
        Eigen::VectorXd slope, curvature;  // first and second divided differences, #prescribed dofs
    };
    Differences differences(const Motion& motion, const Eigen::VectorXd& values, double step_s) const;

    std::vector<int> dofs_;
    int steps_ = 0;
    Differences before_;                                     // over the steps before
    double step_before_s_ = 0.0, step_before_that_s_ = 0.0;  // 0: a velocity instead of a displacement
};

}  // namespace reference_fem
