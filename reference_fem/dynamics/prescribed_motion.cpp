#include "reference_fem/dynamics/prescribed_motion.hpp"

namespace reference_fem {

PrescribedMotion::PrescribedMotion(const std::vector<bool>& prescribed)
{
    for (std::size_t i = 0; i < prescribed.size(); ++i)
        if (prescribed[i]) dofs_.push_back(static_cast<int>(i));
}

PrescribedMotion::Differences PrescribedMotion::differences(const Motion& motion, const Eigen::VectorXd& values, double step_s) const
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

}  // namespace reference_fem
