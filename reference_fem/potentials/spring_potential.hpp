// The springs of an attachment as a potential: sum_s k_s / 2 |x(p_s) - target_s|^2.
#pragma once

#include "reference_fem/attached_points.hpp"
#include "reference_fem/potentials/potential.hpp"

namespace reference_fem {

// Call move_to() before anything else.
class SpringPotential : public Potential {
public:
    explicit SpringPotential(const AttachedPoints& springs) : springs_(springs) {}  // which outlive the potential

    void move_to(const pbs::Positions& targets) { targets_ = targets; }  // [m], #S x 3

    double value(const Eigen::VectorXd& displacement) const override { return springs_.energy(targets_, displacement); }
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override
    {
        springs_.add_pull(targets_, displacement, gradient);
    }
    void add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix& hessian) const override { springs_.add_to(hessian); }
    bool is_quadratic() const override { return true; }

private:
    const AttachedPoints& springs_;
    pbs::Positions targets_;
};

}  // namespace reference_fem
