// The effect of rounding on the gradient of elastic flesh, and on a minimum that is found with such a gradient.
//   EXPECT_LT((in_float - in_double).norm(), test_support::displaced_by_rounding<float>(energy, centres, in_double));
#pragma once

#include "pbs/flesh/flesh_energy.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace test_support {

// The error of an entry of the gradient whose roundings all have one sign: some 25 tets with some 30 roundings each of terms as large as
// the largest of its parts, kappa d n.
template <typename Scalar>
double rounding_of_gradient(const pbs::FleshEnergy& energy, int tets = 25, int roundings = 30)
{
    double part = 0.0;
    for (const pbs::FleshTet& tet : energy.tets()) part = std::max(part, tet.kappa * tet.d * std::pow(6.0 * tet.d, 2.0 / 3.0));
    return tets * roundings * std::numeric_limits<Scalar>::epsilon() * part;
}

// The eigenvalues of the Hessian, by central differences of the gradient in double [m].
inline Eigen::VectorXd stiffnesses(const pbs::FleshEnergy& energy, const pbs::Positions& centres, const pbs::Positions& x)
{
    constexpr double step = 1e-5;
    Eigen::MatrixXd hessian(x.size(), x.size());
    for (Eigen::Index entry = 0; entry < x.size(); ++entry) {
        pbs::Positions forward = x, backward = x, of_forward, of_backward;
        forward.data()[entry] += step;
        backward.data()[entry] -= step;
        energy.value_and_gradient(forward, centres, of_forward);
        energy.value_and_gradient(backward, centres, of_backward);
        const pbs::Positions difference = of_forward - of_backward;
        hessian.col(entry) = Eigen::Map<const Eigen::VectorXd>(difference.data(), x.size()) / (2.0 * step);
    }
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian, Eigen::EigenvaluesOnly).eigenvalues();
}

// The distance from `minimum` of a point whose gradient is nothing but rounding [m]: |H^-1 g|, with independent roundings of at most u =
// epsilon / 2 in the entries of g, so that n of them add up to sqrt(n) u (N. Higham, T. Mary, SIAM Journal on Scientific Computing 41(5),
// 2019). Four standard deviations. accumulated: further roundings of each tet, of sums that are kept from iteration to iteration.
template <typename Scalar>
double displaced_by_rounding(const pbs::FleshEnergy& energy, const pbs::Positions& centres, const pbs::Positions& minimum,
                             int accumulated = 0)
{
    const double one_rounding = rounding_of_gradient<Scalar>(energy, 1, 1) / 2.0;
    return 4.0 * one_rounding * std::sqrt(25.0 * (30.0 + accumulated)) * stiffnesses(energy, centres, minimum).cwiseInverse().norm();
}

}  // namespace test_support
