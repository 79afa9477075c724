// Forces that do not change with the displacement, such as gravity and tractions: -f . u.
#pragma once

#include "reference_fem/potentials/potential.hpp"

namespace reference_fem {

// Its Hessian is 0.
class DeadLoad : public Potential {
public:
    explicit DeadLoad(Eigen::VectorXd force) : force_(std::move(force)) {}  // [N], #dofs

    void set(const Eigen::VectorXd& force) { force_ = force; }  // [N], #dofs; in place of the one before
    const Eigen::VectorXd& force() const { return force_; }     // [N], #dofs

    double value(const Eigen::VectorXd& displacement) const override { return -force_.dot(displacement); }
    void add_gradient(const Eigen::VectorXd&, Eigen::VectorXd& gradient) const override { gradient -= force_; }
    void add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix&) const override {}
    bool is_quadratic() const override { return true; }

private:
    Eigen::VectorXd force_;
};

}  // namespace reference_fem
