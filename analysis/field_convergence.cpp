#include "analysis/field_convergence.hpp"

#include "analysis/minimise.hpp"
#include "pbs/geometry/input_error.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

constexpr double least_ratio = 1.3;  // Celik et al. 2008
constexpr double lowest_order = 0.05;
constexpr double reliable_factor = 1.25, other_factor = 3.0;
constexpr double above_formal = 0.1;  // Eca and Hoekstra 2014
constexpr double mostly_explained = 0.5;
constexpr double no_order = std::numeric_limits<double>::quiet_NaN();

void check_fields(const std::vector<pbs::Positions>& fields, const std::vector<double>& sizes, double formal_order,
                  const Eigen::VectorXd& weights)
{
    const auto refuse = [](const char* field, double value, const char* rule) {
        throw pbs::InputError("", 0, field, fmt::format("{}", value), rule);
    };
    if (fields.size() < 3) refuse("fields", static_cast<double>(fields.size()), "expected three or more");
    if (sizes.size() != fields.size()) refuse("mesh sizes", static_cast<double>(sizes.size()), "expected as many as fields");
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        if (!(sizes[i] > 0.0) || !std::isfinite(sizes[i])) refuse("mesh size", sizes[i], "expected > 0");
        if (i > 0 && sizes[i] < least_ratio * sizes[i - 1] * (1.0 - 1e-12))
            refuse("ratio of mesh sizes", sizes[i] / sizes[i - 1], "expected at least 1.3");
        if (fields[i].rows() != fields[0].rows()) refuse("points", static_cast<double>(fields[i].rows()), "expected as many in each field");
    }
    if (!(formal_order > 0.0)) refuse("order of convergence", formal_order, "expected > 0");
    if (weights.size() > 0 && (weights.size() != fields[0].rows() || !(weights.array() >= 0.0).all()))
        refuse("weights", static_cast<double>(weights.size()), "expected one per point, none below 0");
}

// Sums over the points of the products of two fields' differences from the finest one, #fields x #fields.
Eigen::MatrixXd gram_matrix(const std::vector<pbs::Positions>& fields, const Eigen::VectorXd& weights)
{
    const auto count = static_cast<Eigen::Index>(fields.size());
    Eigen::MatrixXd gram(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index j = 0; j <= i; ++j) {
            double sum = 0.0;
            for (Eigen::Index v = 0; v < weights.size(); ++v)
                if (weights(v) > 0.0) sum += weights(v) * (fields[i].row(v) - fields[0].row(v)).dot(fields[j].row(v) - fields[0].row(v));
            gram(i, j) = gram(j, i) = sum;
        }
    return gram;
}

// Columns 1 and h^p, #fields x 2.
Eigen::MatrixXd regressors(const std::vector<double>& sizes, double order)
{
    Eigen::MatrixXd columns(sizes.size(), 2);
    for (std::size_t i = 0; i < sizes.size(); ++i) columns.row(i) << 1.0, std::pow(sizes[i] / sizes[0], order);
    return columns;
}

// The projection, #fields x #fields, that leaves the residuals of the least squares fit of the columns.
Eigen::MatrixXd left_by(const Eigen::MatrixXd& columns)
{
    const Eigen::MatrixXd q = columns.householderQr().householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
    return Eigen::MatrixXd::Identity(columns.rows(), columns.rows()) - q * q.transpose();
}

double squared_residual(const Eigen::MatrixXd& projection, const Eigen::MatrixXd& gram)
{
    return std::max(0.0, (projection * gram).trace());
}

// Successive differences of opposite directions. gram: of the differences from the finest field.
bool oscillates(const Eigen::MatrixXd& gram)
{
    const auto product = [&](Eigen::Index i) {  // of x_{i+1} - x_i and x_{i+2} - x_{i+1}
        return gram(i + 1, i + 2) - gram(i + 1, i + 1) - gram(i, i + 2) + gram(i, i + 1);
    };
    for (Eigen::Index i = 0; i + 2 < gram.rows(); ++i)
        if (product(i) <= 0.0) return true;
    return false;
}

}  // namespace

FieldConvergence fit_fields(const std::vector<pbs::Positions>& fields, const std::vector<double>& sizes, double formal_order,
                            const Eigen::VectorXd& weights)
{
    check_fields(fields, sizes, formal_order, weights);
    const Eigen::VectorXd counted = weights.size() > 0 ? weights : Eigen::VectorXd::Ones(fields[0].rows());
    const Eigen::MatrixXd gram = gram_matrix(fields, counted);
    if (!gram.allFinite()) throw pbs::InputError("", 0, "fields", "", "expected finite values");
    const double spread = squared_residual(left_by(Eigen::MatrixXd::Ones(gram.rows(), 1)), gram);
    const Minimum best =
        minimise([&](double order) { return squared_residual(left_by(regressors(sizes, order)), gram); }, lowest_order, 2.0 * formal_order);

    FieldConvergence fit;
    const bool approaches = best.outcome == MinimumOutcome::converged || best.outcome == MinimumOutcome::at_upper_bound;
    const bool observed = approaches && !oscillates(gram);
    fit.observed_order = observed ? best.x : no_order;
    fit.order = observed ? std::min(best.x, formal_order) : formal_order;
    const Eigen::MatrixXd columns = regressors(sizes, fit.order);
    const Eigen::MatrixXd solution = (columns.transpose() * columns).ldlt().solve(columns.transpose());  // 2 x #fields
    fit.limit = pbs::Positions::Zero(fields[0].rows(), 3);
    for (std::size_t i = 0; i < fields.size(); ++i) fit.limit += solution(0, i) * fields[i];
    const Eigen::MatrixXd projection = left_by(columns);
    for (std::size_t i = 0; i < fields.size(); ++i) {
        fit.residuals.emplace_back(pbs::Positions::Zero(fields[0].rows(), 3));
        for (std::size_t j = 0; j < fields.size(); ++j) fit.residuals.back() += projection(i, j) * fields[j];
    }
    fit.unexplained = spread > 0.0 ? std::sqrt(squared_residual(projection, gram) / spread) : 0.0;
    fit.reliable = observed && fit.observed_order >= formal_order / 2.0 && fit.observed_order <= formal_order + above_formal &&
                   fit.unexplained < mostly_explained;
    fit.safety_factor = fit.reliable ? reliable_factor : other_factor;
    if (!observed) fit.limit.setConstant(no_order);
    return fit;
}

double bound_of(const FieldConvergence& fit, const std::vector<pbs::Positions>& fields, std::size_t which, const FieldDistance& distance)
{
    if (std::isnan(fit.observed_order)) {
        double largest = 0.0;
        for (std::size_t i = 0; i < fields.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (const double d = distance(fields[i], fields[j]); std::isnan(d) || d > largest) largest = d;  // a NaN is kept
        return other_factor * largest;
    }
    const auto residual = [&](std::size_t i) { return distance(fields[i], fields[i] - fit.residuals[i]); };
    double squared = 0.0;
    for (std::size_t i = 0; i < fields.size(); ++i) squared += residual(i) * residual(i);
    constexpr int fitted = 2;  // values per point: the limit and the amplitude
    const double deviation = std::sqrt(squared / static_cast<double>(fields.size() - fitted));
    const double error = distance(fields[which], fit.limit), unexplained = residual(which) + deviation;
    if (fit.unexplained >= mostly_explained) return other_factor * (error + unexplained);
    return fit.safety_factor * error + unexplained;
}

}  // namespace analysis
