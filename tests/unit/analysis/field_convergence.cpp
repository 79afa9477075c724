// Reference: fields made by hand as x_0 + e h^p, whose order, limit and distances are known.
#include "analysis/field_convergence.hpp"

#include "analysis/minimise.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using analysis::fit_fields;

pbs::Positions random_field(unsigned seed)
{
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    return pbs::Positions::NullaryExpr(40, 3, [&](Eigen::Index, Eigen::Index) { return normal(generator); });
}

const pbs::Positions exact_limit = random_field(1), error_field = random_field(2);

std::vector<pbs::Positions> series(const std::vector<double>& sizes, double order)
{
    std::vector<pbs::Positions> fields;
    for (const double size : sizes) fields.push_back(exact_limit + std::pow(size, order) * error_field);
    return fields;
}

double rms(const pbs::Positions& one, const pbs::Positions& other)
{
    return (one - other).norm() / std::sqrt(static_cast<double>(one.rows()));
}

// The search for the order ends in an interval of this share of twice the formal order.
double order_error(double formal_order)
{
    return analysis::MinimiseOptions().tolerance * 2.0 * formal_order;
}

// A fit to x_0 + e h^p with an order in error by so much has these errors, relative to |e| h_0^p: the error of its limit, the largest of
// its residuals, their norm, and that over the norm of the differences from the mean.
struct FitError {
    double limit = 0.0, residual = 0.0, residuals = 0.0, unexplained = 0.0;
};

FitError fit_error(const std::vector<double>& sizes, double order, double order_error)
{
    const auto scaled = Eigen::Map<const Eigen::ArrayXd>(sizes.data(), std::ssize(sizes)) / sizes[0];
    const Eigen::VectorXd exact = scaled.pow(order);
    FitError worst;
    for (const double off : {-order_error, order_error}) {
        Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(exact.size(), 2);
        columns.col(1) = scaled.pow(order + off);
        const Eigen::VectorXd fitted = columns.householderQr().solve(exact), residual = exact - columns * fitted;
        worst.limit = std::max(worst.limit, std::abs(fitted(0)));
        worst.residual = std::max(worst.residual, residual.cwiseAbs().maxCoeff());
        worst.residuals = std::max(worst.residuals, residual.norm());
        worst.unexplained = std::max(worst.unexplained, residual.norm() / (exact.array() - exact.mean()).matrix().norm());
    }
    return worst;
}

// The rounding error of the root mean square of a difference of fields. Their coordinates go through two roundings each, on both sides, and
// the sum has 120 squares.
double rms_error(double value)
{
    const double largest = exact_limit.cwiseAbs().maxCoeff() + 2.0 * error_field.cwiseAbs().maxCoeff();
    return std::sqrt(3.0) * test_support::rounding_error(2 * 2, largest) + test_support::rounding_error(2 * 120, value);
}

TEST(FieldConvergence, FindsTheOrderAndTheLimitOfAPowerOfTheMeshSize)
{
    for (const double order : {0.5, 1.0, 1.7, 3.0})
        for (const auto& sizes : {std::vector{0.1, 0.2, 0.4}, std::vector{0.1, 0.15, 0.2, 0.35}}) {
            const auto fields = series(sizes, order);
            const auto fit = fit_fields(fields, sizes, 3.0);
            const auto error = fit_error(sizes, order, order_error(3.0));
            EXPECT_NEAR(fit.observed_order, order, order_error(3.0));
            EXPECT_LT(rms(fit.limit, exact_limit), error.limit * rms(fields[0], exact_limit) + rms_error(0.0)) << order;
            EXPECT_LT(fit.unexplained, error.unexplained);
            EXPECT_EQ(fit.reliable, order >= 1.5);
            EXPECT_EQ(fit.safety_factor, order >= 1.5 ? 1.25 : 3.0);
        }
}

TEST(FieldConvergence, UsesNoHigherOrderThanTheFormalOne)
{
    const std::vector<double> sizes{0.1, 0.2, 0.4};
    const auto fit = fit_fields(series(sizes, 3.0), sizes, 2.0);
    EXPECT_NEAR(fit.observed_order, 3.0, order_error(2.0));
    EXPECT_EQ(fit.order, 2.0);
}

// Points of weight 0, here without any order and not finite, do not count.
TEST(FieldConvergence, LeavesOutPointsWithoutWeight)
{
    const std::vector<double> sizes{0.1, 0.2, 0.4};
    auto fields = series(sizes, 2.0);
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(40);
    for (int v = 30; v < 40; ++v) {
        weights(v) = 0.0;
        fields[1].row(v).setConstant(v == 35 ? std::nan("") : 17.0 * v);
    }
    EXPECT_NEAR(fit_fields(fields, sizes, 3.0, weights).observed_order, 2.0, order_error(3.0));
    EXPECT_THROW(fit_fields(fields, sizes, 3.0), pbs::InputError);
}

// The differences grow under refinement: there is no limit to approach, and the bound is three times the largest difference.
TEST(FieldConvergence, ObservesNoOrderWhereRefinementMovesAway)
{
    const std::vector<double> sizes{0.1, 0.2, 0.4};
    const std::vector<pbs::Positions> fields{exact_limit + 3.0 * error_field, exact_limit + error_field, exact_limit};
    const auto fit = fit_fields(fields, sizes, 2.0);
    EXPECT_TRUE(std::isnan(fit.observed_order));
    EXPECT_FALSE(fit.reliable);
    const double bound = 3.0 * rms(fields[0], fields[2]);  // a sum of 120 squares, on both sides
    EXPECT_NEAR(analysis::bound_of(fit, fields, 0, rms), bound, test_support::rounding_error(2 * 120, bound));
}

// A bound by hand: the exact series leaves no residual, so that 1.25 times the distance remains.
TEST(FieldConvergence, BoundsTheDistanceWithTheSafetyFactor)
{
    const std::vector<double> sizes{0.1, 0.2, 0.4};
    const auto fields = series(sizes, 2.0);
    const auto fit = fit_fields(fields, sizes, 2.0);
    const auto error = fit_error(sizes, 2.0, order_error(2.0));
    const double of_bound = 1.25 * error.limit + error.residual + error.residuals;
    for (const std::size_t which : {0u, 1u, 2u}) {
        const double bound = 1.25 * rms(fields[which], exact_limit);
        EXPECT_NEAR(analysis::bound_of(fit, fields, which, rms), bound, of_bound * rms(fields[0], exact_limit) + 4.0 * rms_error(bound));
    }
}

// Overshooting by half and returning: (x, x + e, x + 0.4 e) has no limit on one side, and (x, x + 0.3 e, x - e) neither.
TEST(FieldConvergence, ObservesNoOrderWhereFieldsOscillate)
{
    const std::vector<double> sizes{0.1, 0.2, 0.4};
    for (const auto& [middle, coarse] : {std::pair{1.0, 0.4}, {0.3, -1.0}}) {
        const std::vector<pbs::Positions> fields{exact_limit, exact_limit + middle * error_field, exact_limit + coarse * error_field};
        const auto fit = fit_fields(fields, sizes, 2.0);
        EXPECT_TRUE(std::isnan(fit.observed_order));
        const double range = std::max(middle, coarse) - std::min(0.0, coarse);
        const double largest = range * rms(error_field, pbs::Positions::Zero(40, 3));
        EXPECT_NEAR(analysis::bound_of(fit, fields, 0, rms), 3.0 * largest, 3.0 * rms_error(largest));
    }
}

// By hand, in units of |e|: the distance 2 from the limit, the own residual 0.2, the deviation sqrt(0.1^2 + 0.2^2 + 0.2^2) = 0.3 of three
// fields. That is 1.25 * 2 + 0.5 = 3; where the fit explains less than half, 3 * 2.5 = 7.5.
TEST(FieldConvergence, BoundsWhatTheFitDoesNotExplain)
{
    const std::vector<pbs::Positions> fields{exact_limit + error_field, exact_limit + 2.0 * error_field, exact_limit};
    analysis::FieldConvergence fit{2.0, 2.0, true, 1.25, exact_limit, {0.1 * error_field, -0.2 * error_field, 0.2 * error_field}, 0.2};
    const double unit = rms(error_field, pbs::Positions::Zero(40, 3));
    const double rounding = 3.0 * rms_error(3.0 * unit);  // of the distance, the residual and the deviation
    EXPECT_NEAR(analysis::bound_of(fit, fields, 1, rms), 3.0 * unit, rounding);
    fit.unexplained = 0.7;
    EXPECT_NEAR(analysis::bound_of(fit, fields, 1, rms), 7.5 * unit, 3.0 * rounding);
}

TEST(FieldConvergence, ABoundOfWhatCannotBeMeasuredIsNotANumber)
{
    const std::vector<double> sizes{0.1, 0.2, 0.4};
    const auto nothing = [](const pbs::Positions&, const pbs::Positions&) { return std::nan(""); };
    const auto fields = series(sizes, 2.0);
    EXPECT_TRUE(std::isnan(analysis::bound_of(fit_fields(fields, sizes, 2.0), fields, 0, nothing)));
    const std::vector<pbs::Positions> growing{fields[2], fields[1], fields[0]};
    EXPECT_TRUE(std::isnan(analysis::bound_of(fit_fields(growing, sizes, 2.0), growing, 0, nothing)));
}

TEST(FieldConvergence, EqualFieldsHaveNoErrorAndNoOrder)
{
    const std::vector<pbs::Positions> fields(3, exact_limit);
    const auto fit = fit_fields(fields, {1.0, 2.0, 4.0}, 2.0);
    EXPECT_TRUE(std::isnan(fit.observed_order));
    EXPECT_EQ(analysis::bound_of(fit, fields, 0, rms), 0.0);
}

TEST(FieldConvergence, RefusesWhatCannotBeFitted)
{
    const auto fields = series({0.1, 0.2, 0.4}, 1.0);
    EXPECT_THROW(fit_fields({fields[0], fields[1]}, {0.1, 0.2}, 1.0), pbs::InputError);
    EXPECT_THROW(fit_fields(fields, {0.1, 0.2}, 1.0), pbs::InputError);
    EXPECT_THROW(fit_fields(fields, {0.1, 0.129, 0.4}, 1.0), pbs::InputError);
    EXPECT_THROW(fit_fields(fields, {0.4, 0.2, 0.1}, 1.0), pbs::InputError);
    EXPECT_THROW(fit_fields(fields, {0.0, 0.2, 0.4}, 1.0), pbs::InputError);
    EXPECT_THROW(fit_fields(fields, {0.1, 0.2, 0.4}, 0.0), pbs::InputError);
    EXPECT_THROW(fit_fields(fields, {0.1, 0.2, 0.4}, 1.0, Eigen::VectorXd::Ones(7)), pbs::InputError);
    EXPECT_THROW(fit_fields({fields[0], fields[1], fields[2].topRows(5)}, {0.1, 0.2, 0.4}, 1.0), pbs::InputError);
}

}  // namespace
