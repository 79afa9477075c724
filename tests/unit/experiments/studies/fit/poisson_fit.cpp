// Reference: an interpolant is exact at its nodes, and for polynomials of its degree in its variable.
#include "experiments/studies/fit/poisson_fit.hpp"

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
        EXPECT_LT((family.at(poisson) - polynomial(poisson)).cwiseAbs().maxCoeff(), 1e-12) << poisson;
}

// Only the lowest ratios are left where the others did not converge.
TEST(PoissonFamily, OfTheFirstNodesIsExactForPolynomials)
{
    std::vector<double> nodes = poisson_nodes(7);
    nodes.resize(4);
    std::vector<pbs::Positions> positions;
    for (const double poisson : nodes) positions.push_back(polynomial(poisson));
    EXPECT_LT((PoissonFamily(nodes, positions).at(between(nodes, 2)) - polynomial(between(nodes, 2))).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
