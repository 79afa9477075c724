#include "analysis/statistics/fits.hpp"

#include "pbs/geometry/input_error.hpp"

#include <Eigen/QR>
#include <fmt/format.h>
#include <gsl/gsl_blas.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace analysis {
namespace {

void require_points_for_a_line(const std::vector<double>& x, const std::vector<double>& y)
{
    if (x.size() != y.size() || x.size() < 2)
        throw pbs::InputError("", 0, "points of a line fit", fmt::format("{} x, {} y", x.size(), y.size()),
                              "expected as many, at least 2");
    const auto [least, most] = std::minmax_element(x.begin(), x.end());
    if (!(*least < *most))
        throw pbs::InputError("", 0, "x of a line fit", fmt::format("{}", *least), "expected values that differ");
}

// By Student's t, for a value fitted with so many parameters to n points; NaN bounds unless there are more points.
Interval student_interval(double estimate, double variance, double level, int n, int parameters)
{
    double half_width = std::numeric_limits<double>::quiet_NaN();
    if (n > parameters) half_width = gsl_cdf_tdist_Pinv((1.0 + level) / 2.0, n - parameters) * std::sqrt(variance);
    return {estimate, estimate - half_width, estimate + half_width, level, n, 0};
}

std::vector<double> logarithms(std::vector<double> values, const char* name)
{
    for (double& value : values) {
        if (!(value > 0.0)) throw pbs::InputError("", 0, name, fmt::format("{}", value), "expected > 0");
        value = std::log(value);
    }
    return values;
}

constexpr double died_away = 0.02, least_explained = 0.5, overdamped_from = 0.95;
constexpr int least_samples = 8, parameters = 5;  // d, w, a, b, c
using Parameters = std::array<double, parameters>;

struct Samples {
    std::vector<double> y;
    double dt_s;
    double time_s(std::size_t i) const { return static_cast<double>(i) * dt_s; }
};

// The samples up to the last excursion from the end value that exceeds the threshold.
Samples living_part(const std::vector<double>& series, double dt_s)
{
    const std::size_t tail = std::max<std::size_t>(series.size() / 10, 1);
    const double end = mean({series.end() - static_cast<std::ptrdiff_t>(tail), series.end()});
    double largest = 0.0;
    for (const double y : series) largest = std::max(largest, std::abs(y - end));
    std::size_t last = series.size();
    while (last > 0 && std::abs(series[last - 1] - end) <= died_away * largest) --last;
    return {{series.begin(), series.begin() + static_cast<std::ptrdiff_t>(last)}, dt_s};
}

double model(const double* p, double t)
{
    return p[4] + std::exp(-p[0] * t) * (p[2] * std::cos(p[1] * t) + p[3] * std::sin(p[1] * t));
}

int residuals(const gsl_vector* x, void* data, gsl_vector* f)
{
    const Samples& samples = *static_cast<const Samples*>(data);
    for (std::size_t i = 0; i < samples.y.size(); ++i)
        gsl_vector_set(f, i, model(x->data, samples.time_s(i)) - samples.y[i]);
    return GSL_SUCCESS;
}

// a, b and c are linear parameters: their best values for a given decay and frequency.
std::pair<double, Parameters> linear_part(const Samples& samples, double decay, double omega)
{
    Eigen::MatrixX3d basis(samples.y.size(), 3);
    for (std::size_t i = 0; i < samples.y.size(); ++i) {
        const double t = samples.time_s(i), envelope = std::exp(-decay * t);
        basis.row(static_cast<Eigen::Index>(i)) << envelope * std::cos(omega * t), envelope * std::sin(omega * t), 1.0;
    }
    const Eigen::Map<const Eigen::VectorXd> y(samples.y.data(), static_cast<Eigen::Index>(samples.y.size()));
    const Eigen::Vector3d best = basis.colPivHouseholderQr().solve(y);
    return {(basis * best - y).squaredNorm(), {decay, omega, best(0), best(1), best(2)}};
}

Parameters best_start(const Samples& samples)
{
    const double length_s = samples.time_s(samples.y.size());
    const double slowest = std::numbers::pi / length_s, fastest = 0.9 * std::numbers::pi / samples.dt_s;
    std::pair<double, Parameters> best{std::numeric_limits<double>::infinity(), {}};
    for (double omega = slowest; omega < fastest; omega *= 1.05)
        for (const double decay : {0.003, 0.01, 0.03, 0.1, 0.2, 0.4, 0.8, 1.6, 4.0}) {
            const auto start = linear_part(samples, decay * omega, omega);
            if (start.first < best.first) best = start;
        }
    return best.second;
}

struct Fit {
    Parameters value;
    Eigen::Matrix<double, parameters, parameters, Eigen::RowMajor> covariance;
    double residual = 0.0;  // sum of squares
};

Fit refine(Samples& samples, const Parameters& start)
{
    gsl_multifit_nlinear_fdf system{};
    system.f = residuals;
    system.n = samples.y.size();
    system.p = parameters;
    system.params = &samples;
    const gsl_multifit_nlinear_parameters options = gsl_multifit_nlinear_default_parameters();
    const std::unique_ptr<gsl_multifit_nlinear_workspace, decltype(&gsl_multifit_nlinear_free)> work(
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &options, system.n, system.p),
        gsl_multifit_nlinear_free);
    const gsl_vector_const_view first = gsl_vector_const_view_array(start.data(), parameters);
    gsl_error_handler_t* const handler = gsl_set_error_handler_off();
    gsl_multifit_nlinear_init(&first.vector, &system, work.get());
    int why = 0;
    gsl_multifit_nlinear_driver(200, 1e-10, 1e-10, 0.0, nullptr, nullptr, &why, work.get());

    Fit fit;
    std::copy_n(gsl_multifit_nlinear_position(work.get())->data, parameters, fit.value.begin());
    gsl_matrix_view covariance = gsl_matrix_view_array(fit.covariance.data(), parameters, parameters);
    gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(work.get()), 0.0, &covariance.matrix);
    gsl_set_error_handler(handler);
    const gsl_vector* left = gsl_multifit_nlinear_residual(work.get());
    gsl_blas_ddot(left, left, &fit.residual);
    fit.covariance *= fit.residual / static_cast<double>(system.n - parameters);
    return fit;
}

void add_values(DampedOscillation& swing, const Fit& fit, double level)
{
    const double d = fit.value[0], w = std::abs(fit.value[1]), undamped = std::hypot(d, w);
    swing.frequency_hz =
        student_interval(w / (2.0 * std::numbers::pi), fit.covariance(1, 1) / std::pow(2.0 * std::numbers::pi, 2),
                         level, swing.samples, parameters);
    const double by_d = w * w / std::pow(undamped, 3), by_w = -d * w / std::pow(undamped, 3);
    const double variance = by_d * by_d * fit.covariance(0, 0) + by_w * by_w * fit.covariance(1, 1) +
                            2.0 * by_d * by_w * fit.covariance(0, 1);
    swing.damping_ratio = student_interval(d / undamped, std::max(variance, 0.0), level, swing.samples, parameters);
}

}  // namespace

Interval fit_line(const std::vector<double>& x, const std::vector<double>& y, double level)
{
    require_points_for_a_line(x, y);
    double intercept, slope, var_intercept, covariance, var_slope, squares;
    gsl_fit_linear(x.data(), 1, y.data(), 1, x.size(), &intercept, &slope, &var_intercept, &covariance, &var_slope,
                   &squares);
    return student_interval(slope, var_slope, level, static_cast<int>(x.size()), 2);
}

Interval observed_order(const std::vector<double>& h, const std::vector<double>& error, double level)
{
    return fit_line(logarithms(h, "h"), logarithms(error, "error"), level);
}

PowerLawEnd power_law_end(const std::vector<double>& sizes, const std::vector<double>& costs, double limit)
{
    const auto refuse = [](const std::string& field, double value, const char* rule) {
        throw pbs::InputError("", 0, field, fmt::format("{}", value), rule);
    };
    if (costs.size() != sizes.size()) refuse("costs", double(costs.size()), "expected as many as sizes");
    std::vector<std::pair<double, double>> points;  // size, cost
    for (std::size_t i = 0; i < sizes.size(); ++i) points.emplace_back(sizes[i], costs[i]);
    if (points.size() < 2)
        throw pbs::InputError("", 0, "sizes", fmt::format("{}", points.size()), "expected two or more");
    std::sort(points.begin(), points.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!(points[i].first > 0.0)) refuse("sizes", points[i].first, "expected sizes above 0");
        if (!(points[i].second > 0.0)) refuse("costs", points[i].second, "expected costs above 0");
        if (i > 0 && points[i].first == points[i - 1].first)
            refuse("sizes", points[i].first, "expected different sizes");
    }
    std::size_t next = 1;  // the line passes through points[next - 1] and points[next]
    while (next + 1 < points.size() && points[next].second < limit) ++next;
    const auto [below, below_cost] = points[next - 1];
    const auto [above, above_cost] = points[next];
    if (above_cost == below_cost) refuse("costs", below_cost, "expected different costs at the sizes around the limit");
    const double slope = std::log(above_cost / below_cost) / std::log(above / below);
    PowerLawEnd end;
    end.size = below * std::pow(limit / below_cost, 1.0 / slope);
    end.beyond = end.size < points.front().first || end.size > points.back().first;
    end.exponent = observed_order(sizes, costs).estimate;
    return end;
}

DampedOscillation fit_damped_oscillation(const std::vector<double>& series, double dt_s, double level)
{
    DampedOscillation swing;
    if (series.empty() || !std::all_of(series.begin(), series.end(), [](double y) { return std::isfinite(y); }))
        return swing;
    Samples samples = living_part(series, dt_s);
    swing.samples = static_cast<int>(samples.y.size());
    if (samples.y.empty()) return swing;
    if (swing.samples < least_samples) {
        swing.outcome = OscillationOutcome::too_short;
        return swing;
    }
    const double centre = mean(samples.y);
    double spread = 0.0;
    for (const double y : samples.y) spread += (y - centre) * (y - centre);
    const Fit fit = refine(samples, best_start(samples));
    swing.explained = 1.0 - fit.residual / spread;
    add_values(swing, fit, level);
    const bool turns = std::abs(fit.value[1]) * samples.time_s(samples.y.size()) > std::numbers::pi;
    swing.outcome = !(swing.explained >= least_explained)                      ? OscillationOutcome::unclear
                    : !turns || swing.damping_ratio.estimate > overdamped_from ? OscillationOutcome::overdamped
                                                                               : OscillationOutcome::found;
    return swing;
}

}  // namespace analysis
