// Reference: the finite elements themselves. The fit must find the modulus of a body that is an elastic bar, and leave
// a misfit for one that is not. The sag is compared with Timoshenko's beam.
#include "experiments/studies/fit/fit.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;
using pbs::Positions;

const pbs::TetMesh sagging_bar = test_support::structured_bar({-1, -0.1, -0.1}, {1, 0.1, 0.1}, {20, 2, 2});

const Cantilever cantilever = make_cantilever(sagging_bar);

FemOptions options_of(double young_pa)
{
    FemOptions options;
    options.young_pa = young_pa;
    options.poisson = 0.45;
    return options;
}

TEST(Cantilever, HoldsTheFirstTenthAndHasATip)
{
    for (Eigen::Index v = 0; v < sagging_bar.rest.rows(); ++v)
        EXPECT_EQ(cantilever.body.held[v], sagging_bar.rest(v, 0) < -0.8 + 1e-9) << sagging_bar.rest.row(v);
    for (const int v : cantilever.tip) EXPECT_GE(sagging_bar.rest(v, 0), 0.8);
    std::size_t free = 0;
    for (const auto& fifth : cantilever.fifths) free += fifth.size();
    EXPECT_EQ(free, 18u * 9u);
}

// A cantilever of 1.8 m under its own weight: w L^4 / (8 E I) and w L^2 / (2 k G A), k = 10 (1 + nu) / (12 + 11 nu)
// (Cowper 1966). The held end keeps the cross-section flat, which stiffens by at most 3 nu^2 h / L of the bending (6.8
// %); P2 on this mesh is within 1 % of its limit.
TEST(ElasticSag, IsThatOfTimoshenkosBeam)
{
    const ElasticSag sag = elastic_sag(cantilever, options_of(1e5));
    const double nu = 0.45, length = 1.8, side = 0.2, inertia = std::pow(side, 4) / 12.0, weight = 1000.0 * side * side;
    const double k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu), shear_pa = 1e5 / (2.0 * (1.0 + nu));
    double tip = 0.0, count = 0.0;
    for (Eigen::Index v = 0; v < sagging_bar.rest.rows(); ++v)
        if (sagging_bar.rest(v, 0) > 1.0 - 1e-9) tip -= sag.displacement(v, 2), ++count;
    const double expected = weight * std::pow(length, 4) / (8.0 * 1e5 * inertia) +
                            weight * length * length / (2.0 * k * shear_pa * side * side);
    EXPECT_LT(tip / count, 1.01 * expected);
    EXPECT_GT(tip / count, 0.92 * expected);
}

// Two linear solutions differ by rounding, eps times some 1e6 of condition, and so do the modulus and the five without
// a fifth. The half width of the interval is t (n - 1) / sqrt n s, with n = 5, t = 2.776 and a standard deviation s of
// at most sqrt(5 / 4) times this rounding. The squared misfit is 1 - 2 + 1, of sums of products over the 36 free
// vertices of a fifth.
TEST(YoungFit, FindsTheModulusOfAnElasticBar)
{
    const ElasticSag reference = elastic_sag(cantilever, options_of(1.0)),
                     body = elastic_sag(cantilever, options_of(3.7e4));
    const YoungFit fit = fit_young(cantilever, reference, 9.81 * body.displacement, 9.81);
    EXPECT_EQ(fit.outcome, "converged");
    EXPECT_TRUE(fit.identifiable);
    const double rounding = 1e-9;  // relative
    EXPECT_NEAR(fit.young_pa.estimate, 3.7e4, rounding * 3.7e4);
    EXPECT_LT(fit.misfit_pct, 100.0 * (rounding + std::sqrt(test_support::rounding_error(3 * 36 + 10, 4.0))));
    EXPECT_LT(fit.young_pa.high - fit.young_pa.low, 2.0 * 2.776 * 2.0 * rounding * 3.7e4);
}

// This shape bends in another way: no modulus removes the misfit, and the fifths of the bar disagree.
TEST(YoungFit, AnotherShapeLeavesAMisfitAndWhatIsNotFiniteHasNone)
{
    const ElasticSag reference = elastic_sag(cantilever, options_of(1.0));
    Positions shape = Positions::Zero(sagging_bar.rest.rows(), 3);
    shape.col(2) = -(sagging_bar.rest.col(0).array() + 1.0).pow(6) * 1e-3;
    const YoungFit fit = fit_young(cantilever, reference, shape, 1.0);
    EXPECT_GT(fit.misfit_pct, 20.0);
    EXPECT_GT(fit.young_pa.high - fit.young_pa.low, 0.2 * fit.young_pa.estimate);

    Positions broken = reference.displacement;
    broken(sagging_bar.rest.rows() - 1, 2) = std::nan("");
    EXPECT_TRUE(std::isnan(fit_young(cantilever, reference, broken, 1.0).young_pa.estimate));
    EXPECT_EQ(fit_young(cantilever, reference, -reference.displacement, 1.0).outcome, "not_finite");
}

}  // namespace
