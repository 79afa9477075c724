// Reference: an interpolant is exact at its nodes, and for polynomials of its degree in its variable. Tolerance: the barycentric formula of
// degree n has the error of 3 n + 4 roundings of each term of its numerator and of its denominator, whose magnitudes add up to at most the
// Lebesgue function times the largest value (N. J. Higham, IMA J. Numer. Anal. 24, 2004, Theorem 4.1).
#include "experiments/studies/fit/poisson_fit.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

pbs::Positions polynomial(double poisson)
{
    const double s = std::log10(1.0 - 2.0 * poisson);
    pbs::Positions positions(2, 3);
    positions << 1.0, s, s * s, s * s * s, 0.5 * s - 2.0, s * s - s;
    return positions;
}

// The Lebesgue function of nodes at `poisson`: the sum of the magnitudes of the Lagrange polynomials.
double lebesgue(const std::vector<double>& nodes, double poisson)
{
    const auto s = [](double ratio) { return std::log10(1.0 - 2.0 * ratio); };
    double sum = 0.0;
    for (const double node : nodes) {
        double polynomial = 1.0;
        for (const double other : nodes)
            if (other != node) polynomial *= (s(poisson) - s(other)) / (s(node) - s(other));
        sum += std::abs(polynomial);
    }
    return sum;
}

// The values at the nodes and at `poisson` go through two roundings of the same logarithms.
double interpolation_error(const std::vector<double>& nodes, double poisson)
{
    const double roundings = 2.0 * (3.0 * static_cast<double>(nodes.size() - 1) + 4.0) + 2.0 * 2.0;
    return lebesgue(nodes, poisson) * test_support::rounding_error(roundings, polynomial(nodes.back()).cwiseAbs().maxCoeff());
}

TEST(PoissonNodes, SpanTheWholeRange)
{
    const std::vector<double> nodes = poisson_nodes(7);
    ASSERT_EQ(nodes.size(), 7u);
    EXPECT_EQ(nodes.front(), 0.0);
    EXPECT_EQ(nodes.back(), highest_poisson);
    for (std::size_t i = 1; i < nodes.size(); ++i) EXPECT_LT(nodes[i - 1], nodes[i]);
    EXPECT_GT(between(nodes, 2), nodes[2]);
    EXPECT_LT(between(nodes, 2), nodes[3]);
}

TEST(PoissonFamily, IsExactAtNodesAndForPolynomials)
{
    const std::vector<double> nodes = poisson_nodes(5);
    std::vector<pbs::Positions> positions;
    for (const double poisson : nodes) positions.push_back(polynomial(poisson));
    const PoissonFamily family(nodes, positions);
    for (const double poisson : nodes) EXPECT_EQ(family.at(poisson), polynomial(poisson));
    for (const double poisson : {0.01, 0.2, 0.3, 0.45, 0.49, 0.4998})
        EXPECT_LT((family.at(poisson) - polynomial(poisson)).cwiseAbs().maxCoeff(), interpolation_error(nodes, poisson)) << poisson;
}

// Only the lowest ratios are left where the others did not converge.
TEST(PoissonFamily, OfTheFirstNodesIsExactForPolynomials)
{
    std::vector<double> nodes = poisson_nodes(7);
    nodes.resize(4);
    std::vector<pbs::Positions> positions;
    for (const double poisson : nodes) positions.push_back(polynomial(poisson));
    const double poisson = between(nodes, 2);
    EXPECT_LT((PoissonFamily(nodes, positions).at(poisson) - polynomial(poisson)).cwiseAbs().maxCoeff(),
              interpolation_error(nodes, poisson));
}

}  // namespace
