#include "analysis/statistics/minimise.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>

#include <cmath>
#include <map>
#include <memory>

namespace analysis {
namespace {

// The function, with a record of all its evaluations.
class Recorder {
public:
    explicit Recorder(const Misfit& function) : function_(function) {}

    double operator()(double parameter)
    {
        evaluations_.push_back({parameter, function_(parameter)});
        return evaluations_.back().value;
    }
    const std::vector<Evaluation>& evaluations() const { return evaluations_; }

    // The best evaluation that is a number; NaN if there is none.
    Evaluation best() const
    {
        Evaluation best{not_known, not_known};
        for (const Evaluation& each : evaluations_)
            if (std::isfinite(each.value) && !(each.value >= best.value)) best = each;
        return best;
    }

private:
    const Misfit& function_;
    std::vector<Evaluation> evaluations_;
};

void require_interval(double low, double high, const MinimiseOptions& options)
{
    if (!(std::isfinite(low) && std::isfinite(high) && low < high))
        throw pbs::InputError("", 0, "interval of a minimum", fmt::format("[{}, {}]", low, high), "expected finite low < high");
    if (options.samples < 3)
        throw pbs::InputError("", 0, "samples of a minimum", fmt::format("{}", options.samples), "expected at least 3");
}

bool is_flat(const std::vector<Evaluation>& samples)
{
    const auto [least, most] =
        std::minmax_element(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
    return most->value - least->value <= 1e-12 * std::max(std::abs(most->value), std::abs(least->value));
}

double call_recorder(double parameter, void* recorder)
{
    return (*static_cast<Recorder*>(recorder))(parameter);
}

// Brent's method between left and right, both above the middle.
MinimumOutcome refine(Recorder& recorder, const Evaluation& left, const Evaluation& middle, const Evaluation& right,
                      const MinimiseOptions& options, double tolerance, int& iterations)
{
    const std::unique_ptr<gsl_min_fminimizer, decltype(&gsl_min_fminimizer_free)> brent(gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent),
                                                                                        gsl_min_fminimizer_free);
    gsl_function function{call_recorder, &recorder};
    if (gsl_min_fminimizer_set_with_values(brent.get(), &function, middle.parameter, middle.value, left.parameter, left.value,
                                           right.parameter, right.value) != GSL_SUCCESS)
        return MinimumOutcome::not_finite;
    while (iterations < options.iterations) {
        ++iterations;
        if (gsl_min_fminimizer_iterate(brent.get()) != GSL_SUCCESS) return MinimumOutcome::not_finite;
        if (gsl_min_fminimizer_x_upper(brent.get()) - gsl_min_fminimizer_x_lower(brent.get()) < tolerance) return MinimumOutcome::converged;
    }
    return MinimumOutcome::iterations_exhausted;
}

// GSL's default handler ends the process; here a numerical breakdown is an outcome.
class WithoutGslHandler {
public:
    WithoutGslHandler() : handler_(gsl_set_error_handler_off()) {}
    ~WithoutGslHandler() { gsl_set_error_handler(handler_); }
    WithoutGslHandler(const WithoutGslHandler&) = delete;
    WithoutGslHandler& operator=(const WithoutGslHandler&) = delete;

private:
    gsl_error_handler_t* handler_;
};

// Approaches an end of the interval whose value is below that of its neighbour, by halving, until a point has a value below that of the
// end.
std::optional<Evaluation> deeper_than_end(Recorder& recorder, const Evaluation& end, const Evaluation& neighbour, double tolerance)
{
    for (double step = (neighbour.parameter - end.parameter) / 2.0; std::abs(step) > tolerance; step /= 2.0) {
        const double value = recorder(end.parameter + step);
        if (value < end.value) return Evaluation{end.parameter + step, value};
    }
    return std::nullopt;
}

MinimumOutcome search(Recorder& recorder, double low, double high, const MinimiseOptions& options, int& iterations)
{
    const int last = options.samples - 1;
    const double tolerance = options.tolerance * (high - low);
    for (int i = 0; i <= last; ++i) recorder(i == last ? high : low + (high - low) * i / last);
    const std::vector<Evaluation> samples = recorder.evaluations();
    const double deepest = recorder.best().value;
    if (std::isnan(deepest)) return MinimumOutcome::not_finite;
    const auto finite = [](const Evaluation& each) { return std::isfinite(each.value); };
    if (std::all_of(samples.begin(), samples.end(), finite) && is_flat(samples)) return MinimumOutcome::flat;

    // The left neighbour of the first of several equal minima is larger. Equal values on its right are skipped, since Brent's method needs
    // a middle below both ends.
    const auto is_deepest = [&](const Evaluation& each) { return each.value == deepest; };
    const auto first = static_cast<int>(std::find_if(samples.begin(), samples.end(), is_deepest) - samples.begin());
    const auto next = static_cast<int>(std::find_if_not(samples.begin() + first, samples.end(), is_deepest) - samples.begin());
    if (first == 0 || next > last) {
        const Evaluation &end = first == 0 ? samples[0] : samples[last], &neighbour = first == 0 ? samples[next] : samples[first - 1];
        const auto inside = finite(neighbour) ? deeper_than_end(recorder, end, neighbour, tolerance) : std::nullopt;
        if (!inside) return first == 0 ? MinimumOutcome::at_lower_bound : MinimumOutcome::at_upper_bound;
        return refine(recorder, first == 0 ? end : neighbour, *inside, first == 0 ? neighbour : end, options, tolerance, iterations);
    }
    if (!finite(samples[first - 1]) || !finite(samples[next])) return MinimumOutcome::not_finite;
    return refine(recorder, samples[first - 1], samples[first], samples[next], options, tolerance, iterations);
}

// A misfit that is evaluated only once at each parameter, however many of the fits need it.
Misfit remembered(const Misfit& misfit)
{
    return [misfit, known = std::make_shared<std::map<double, double>>()](double parameter) {
        const auto found = known->find(parameter);
        return found != known->end() ? found->second : known->emplace(parameter, misfit(parameter)).first->second;
    };
}

double rise_around(Recorder& recorder, const Evaluation& best, double low, double high, double perturbation)
{
    double rise = std::numeric_limits<double>::infinity();
    for (const double sign : {-1.0, 1.0}) {
        const double parameter = best.parameter * (1.0 + sign * perturbation);
        if (parameter < low || parameter > high || parameter == best.parameter) continue;
        const double value = recorder(parameter);
        if (std::isfinite(value)) rise = std::min(rise, (value - best.value) / std::abs(best.value));
    }
    return rise;
}

bool is_candidate(const WorkPrecision& point)
{
    return std::isfinite(point.cost) && std::isfinite(point.error);
}

}  // namespace

const char* name_of(MinimumOutcome outcome)
{
    constexpr const char* names[] = {"converged", "at_lower_bound", "at_upper_bound", "flat", "not_finite", "iterations_exhausted"};
    return names[static_cast<int>(outcome)];
}

Minimum minimise(const Misfit& function, double low, double high, const MinimiseOptions& options)
{
    require_interval(low, high, options);
    const WithoutGslHandler handler_off;
    Recorder recorder(function);
    Minimum minimum;
    minimum.outcome = search(recorder, low, high, options, minimum.iterations);
    const Evaluation best = recorder.best();
    minimum.x = best.parameter;
    minimum.value = best.value;
    minimum.rise = std::isnan(best.value) ? not_known : rise_around(recorder, best, low, high, options.perturbation);
    minimum.flat_valley = !(minimum.rise >= options.least_rise);
    minimum.evaluations = recorder.evaluations();
    std::sort(minimum.evaluations.begin(), minimum.evaluations.end(),
              [](const Evaluation& a, const Evaluation& b) { return a.parameter < b.parameter; });
    return minimum;
}

FittedParameter fit_over_cases(const std::vector<Misfit>& misfits, double low, double high, const MinimiseOptions& options, double level)
{
    if (misfits.empty()) throw pbs::InputError("", 0, "cases of a fit", "none", "expected at least one");
    const std::size_t n = misfits.size();
    std::vector<Misfit> known;
    std::transform(misfits.begin(), misfits.end(), std::back_inserter(known), remembered);
    const auto rms_without = [&](std::size_t left_out) {
        return [&known, n, left_out](double parameter) {
            double squares = 0.0;
            for (std::size_t i = 0; i < n; ++i)
                if (i != left_out) squares += std::pow(known[i](parameter), 2);
            return std::sqrt(squares / static_cast<double>(left_out < n ? n - 1 : n));
        };
    };
    FittedParameter fit;
    fit.all = minimise(rms_without(n), low, high, options);
    for (const Misfit& misfit : known) fit.cases.push_back(minimise(misfit, low, high, options));
    fit.interval = {fit.all.x, not_known, not_known, level, static_cast<int>(n), 0};
    if (n < 2) return fit;
    for (std::size_t i = 0; i < n; ++i) fit.without.push_back(minimise(rms_without(i), low, high, options).x);
    const double share = static_cast<double>(n - 1) / static_cast<double>(n);
    const double error = std::sqrt(share * (n - 1)) * standard_deviation(fit.without);
    const double half_width = gsl_cdf_tdist_Pinv((1.0 + level) / 2.0, static_cast<double>(n - 1)) * error;
    fit.interval.low = std::max(low, fit.all.x - half_width);
    fit.interval.high = std::min(high, fit.all.x + half_width);
    return fit;
}

bool dominates(const WorkPrecision& a, const WorkPrecision& b)
{
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

std::vector<std::size_t> pareto_front(const std::vector<WorkPrecision>& points)
{
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto beats = [&](const WorkPrecision& other) { return is_candidate(other) && dominates(other, points[i]); };
        if (is_candidate(points[i]) && std::none_of(points.begin(), points.end(), beats)) front.push_back(i);
    }
    std::stable_sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) { return points[a].cost < points[b].cost; });
    return front;
}

std::optional<std::size_t> best_within(const std::vector<WorkPrecision>& points, double budget)
{
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_candidate(points[i]) && points[i].cost <= budget &&
            (!best || dominates(points[i], points[*best]) || points[i].error < points[*best].error))
            best = i;
    return best;
}

}  // namespace analysis
