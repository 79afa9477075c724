// The effect of rounding on the gradient of elastic flesh, and on a minimum that is found with such a gradient.
//   EXPECT_LT((in_float - in_double).norm(), test_support::displaced_by_rounding<float>(energy, centres, in_double));
#pragma once

#include "pbs/flesh/flesh_energy.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <ranges>

namespace test_support {

constexpr int roundings_per_tet =
    30;  // of an entry of its forces: edges, cofactors, the dot products of each, and their sum

// The largest number of tets at a vertex.
inline int largest_valence(const pbs::FleshEnergy& energy)
{
    std::map<int, int> tets;
    for (const pbs::FleshTet& tet : energy.tets())
        for (const int vertex : tet.vertex) ++tets[vertex];
    return std::ranges::max(tets | std::views::values);
}

// One rounding of the largest part of an entry of the gradient, kappa d n [m^2].
template <typename Scalar>
double rounding_of_part(const pbs::FleshEnergy& energy)
{
    double part = 0.0;
    for (const pbs::FleshTet& tet : energy.tets())
        part = std::max(part, tet.kappa * tet.d * std::pow(6.0 * tet.d, 2.0 / 3.0));
    return std::numeric_limits<Scalar>::epsilon() / 2.0 * part;
}

// The error of an entry of the gradient whose roundings all have one sign [m^2]. Twice: two programs are compared.
template <typename Scalar>
double rounding_of_gradient(const pbs::FleshEnergy& energy)
{
    return 2.0 * largest_valence(energy) * roundings_per_tet * rounding_of_part<Scalar>(energy);
}

// The eigenvalues of the Hessian, by central differences of the gradient in double [m].
inline Eigen::VectorXd stiffnesses(const pbs::FleshEnergy& energy, const pbs::Positions& centres,
                                   const pbs::Positions& x)
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

// The distance from `minimum` of a point whose gradient is nothing but rounding [m]: |H^-1 g|, with independent
// roundings of at most u = epsilon / 2 in the entries of g, so that n of them add up to sqrt(n) u (N. Higham, T. Mary,
// SIAM Journal on Scientific Computing 41(5), 2019). Four standard deviations. accumulated: further roundings of each
// tet, of sums that are kept from iteration to iteration.
template <typename Scalar>
double displaced_by_rounding(const pbs::FleshEnergy& energy, const pbs::Positions& centres,
                             const pbs::Positions& minimum, int accumulated = 0)
{
    const double roundings = double(largest_valence(energy)) * (roundings_per_tet + accumulated);
    return 4.0 * std::sqrt(roundings) * rounding_of_part<Scalar>(energy) *
           stiffnesses(energy, centres, minimum).cwiseInverse().norm();
}

}  // namespace test_support
