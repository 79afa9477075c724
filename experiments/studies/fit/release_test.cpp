#include "experiments/studies/fit/release_test.hpp"

#include "experiments/process/terminal.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace experiments {
namespace {

std::vector<bool> opposite(std::vector<bool> flags)
{
    flags.flip();
    return flags;
}

pbs::PbsOptions swinging(pbs::PbsOptions options)
{
    options.precision = pbs::Precision::f64;
    options.gravity_m_s2.setZero();
    options.k_bind = 0.0;
    options.jiggle = pbs::Jiggle{options.k_stretch};
    return options;
}

double mean_along(const pbs::Positions& displacement, const ReleasedBody& body)
{
    double sum = 0.0;
    for (const int v : body.tip) sum += displacement.row(v).dot(body.direction);
    return sum / static_cast<double>(body.tip.size());
}

// Where the signal passes through zero, in samples, by linear interpolation.
std::vector<double> zero_crossings(const std::vector<double>& signal)
{
    std::vector<double> crossings;
    for (std::size_t i = 1; i < signal.size(); ++i)
        if (signal[i - 1] * signal[i] < 0.0 || (signal[i] == 0.0 && signal[i - 1] != 0.0))
            crossings.push_back(static_cast<double>(i - 1) + signal[i - 1] / (signal[i - 1] - signal[i]));
    return crossings;
}

// Largest |signal| between one crossing and the next.
std::vector<double> extremes(const std::vector<double>& signal, const std::vector<double>& crossings)
{
    std::vector<double> peaks;
    for (std::size_t i = 1; i < crossings.size(); ++i) {
        double peak = 0.0;
        for (auto s = static_cast<std::size_t>(std::ceil(crossings[i - 1])); s <= static_cast<std::size_t>(crossings[i]); ++s)
            peak = std::max(peak, std::abs(signal[s]));
        peaks.push_back(peak);
    }
    return peaks;
}

}  // namespace

ReleaseTest measure_swing(const std::vector<double>& signal, double dt_s)
{
    ReleaseTest test;
    test.steps = static_cast<int>(signal.size()) - 1;
    if (!std::all_of(signal.begin(), signal.end(), [](double value) { return std::isfinite(value); })) {
        test.outcome = SwingOutcome::not_finite;
        return test;
    }
    const std::vector<double> crossings = zero_crossings(signal);
    if (crossings.size() < 3) {
        test.outcome = SwingOutcome::no_crossing;
        return test;
    }
    test.half_periods = static_cast<int>(crossings.size()) - 1;
    test.frequency_hz = test.half_periods / (2.0 * (crossings.back() - crossings.front()) * dt_s);
    const std::vector<double> peaks = extremes(signal, crossings);
    const double decrement = std::log(peaks.front() / peaks.back()) / static_cast<double>(peaks.size() - 1);  // per half period
    test.damping_ratio = decrement / std::hypot(std::numbers::pi, decrement);
    test.undamped_hz = test.frequency_hz / std::sqrt(1.0 - test.damping_ratio * test.damping_ratio);
    return test;
}

ReleaseTest release(const ReleasedBody& body, double dt_s, int half_periods, int most_steps)
{
    pbs::PbsSolver solver(body.mesh, Eigen::VectorXd::Zero(body.mesh.rest.rows()), opposite(body.held), swinging(body.options), body.held);
    const pbs::Positions start = body.mesh.rest + body.displacement;
    std::vector<double> signal = {mean_along(body.displacement, body)};
    int crossings = 0;
    for (int step = 0; step < most_steps && crossings <= half_periods; ++step) {
        stop_if_interrupted();
        // Line (3): the first step puts the particles where they are let go, at rest.
        solver.advance(step == 0 ? start : body.mesh.rest, body.mesh.rest, dt_s);
        signal.push_back(mean_along(solver.positions() - body.mesh.rest, body));
        if (!std::isfinite(signal.back())) break;
        crossings += signal.back() * signal[signal.size() - 2] < 0.0;
    }
    return measure_swing(signal, dt_s);
}

}  // namespace experiments
