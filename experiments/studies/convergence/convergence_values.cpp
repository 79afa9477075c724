#include "experiments/studies/convergence/convergence_values.hpp"

#include "analysis/statistics/fits.hpp"
#include "experiments/deformers/deformer_options.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace experiments {
namespace {

// A value of one setting, and what it bounds where a tolerance was not reached.
struct PathValue {
    double value = 0.0;
    analysis::Limit limit = analysis::Limit::none;
};
using ValueOf = std::function<std::optional<PathValue>(const ConvergencePaths&)>;
using Group = std::vector<const ConvergencePaths*>;  // the default setting first

std::vector<Group> groups_of(const ConvergenceResult& result)
{
    std::vector<Group> groups;
    for (const ConvergencePaths& paths : result.all) {
        const auto same = [&](const Group& group) {
            const ConvergencePaths& first = *group.front();
            return first.pose == paths.pose && first.k_stretch == paths.k_stretch && (!result.ladder || first.vertices == paths.vertices);
        };
        if (const auto found = std::find_if(groups.begin(), groups.end(), same); found != groups.end())
            found->push_back(&paths);
        else
            groups.push_back({&paths});
    }
    return groups;
}

analysis::CaseKey key_of(const ConvergencePaths& of)
{
    analysis::CaseKey key = of.key;
    key.body = of.body;
    key.deformer = "pbs";
    key.order = experiments::name_of(of.setting.order);
    key.precision = experiments::name_of(of.setting.precision);
    key.vertices = of.vertices;
    key.k_stretch = of.k_stretch;
    return key;
}

// The part of a value's key in which the values of a group differ.
struct What {
    std::string claim, quantity;
    std::string tolerance = {}, initial_guess = {};
};

void add(std::vector<analysis::Measurement>& to, const What& what, const Group& group, const ValueOf& value_of)
{
    const std::optional<PathValue> own = value_of(*group.front());
    if (!own || !std::isfinite(own->value)) return;
    analysis::Measurement measured{what.claim, what.quantity, key_of(*group.front()), own->value, own->value, own->value, "1"};
    measured.of.tolerance = what.tolerance;
    measured.of.initial_guess = what.initial_guess;
    measured.limit = own->limit;
    int without = 0;
    for (const ConvergencePaths* other : group) {
        const std::optional<PathValue> measurement = value_of(*other);
        without += !measurement;
        if (!measurement || !std::isfinite(measurement->value)) continue;
        measured.low = std::min(measured.low, measurement->value);
        measured.high = std::max(measured.high, measurement->value);
    }
    if (without > 0) {
        measured.not_reached = without;
        measured.n = static_cast<int>(group.size());
        measured.low = 0.0;
        measured.high = std::numeric_limits<double>::infinity();
    }
    to.push_back(measured);
}

struct Tolerance {
    const char* name;  // in a key
    Reached (*reached)(const ConvergencePaths&, std::size_t start);
};
const Tolerance tolerances[] = {
    {"residual", [](const ConvergencePaths& of, std::size_t start) { return reached_residual(of.paths[start], floor_of(of.paths)); }},
    {"volume", [](const ConvergencePaths& of, std::size_t start) { return reached_volume(of.paths[start]); }}};

ValueOf iterations_to(const Tolerance& tolerance)
{
    return [&tolerance](const ConvergencePaths& of) {
        const Reached lbs = tolerance.reached(of, 0);
        return PathValue{double(lbs.iterations), lbs.within ? analysis::Limit::none : analysis::Limit::more_than};
    };
}

// An initial guess that fulfils the tolerance counts as one iteration.
ValueOf over_lbs(const Tolerance& tolerance, std::size_t start)
{
    return [&tolerance, start](const ConvergencePaths& of) -> std::optional<PathValue> {
        const Reached other = tolerance.reached(of, start), lbs = tolerance.reached(of, 0);
        if (!other.within && !lbs.within) return {};
        return PathValue{std::max(other.iterations, 1) / double(std::max(lbs.iterations, 1)), !other.within ? analysis::Limit::at_least
                                                                                              : !lbs.within ? analysis::Limit::at_most
                                                                                                            : analysis::Limit::none};
    };
}

void add_further(std::vector<analysis::Measurement>& to, const Group& group)
{
    const auto measurement = [&](const char* quantity, double (*of_lbs)(const IterationPath&)) {
        add(to, {"C12", quantity}, group, [of_lbs](const ConvergencePaths& of) { return PathValue{of_lbs(of.paths[0])}; });
    };
    measurement("residual_after_24_over_1000_iterations",
                [](const IterationPath& path) { return look_at(path, 24).combined / look_at(path, 1000).combined; });
    measurement("error_after_24_iterations_over_least",
                [](const IterationPath& path) { return look_at(path, 24).error_joint_pct / nearest_to_reference(path).error_joint_pct; });
    measurement("error_after_1000_iterations_over_least",
                [](const IterationPath& path) { return look_at(path, 1000).error_joint_pct / nearest_to_reference(path).error_joint_pct; });
}

void add_starts(std::vector<analysis::Measurement>& to, const Group& group)
{
    const std::string in_a_twist = group.front()->twist ? "_in_a_twist" : "";
    for (std::size_t start = 1; start < group.front()->paths.size(); ++start) {
        const char* guess = name_of(all_starts[start]);
        for (const Tolerance& tolerance : tolerances)
            add(to, {"C03", "iterations_over_lbs_guess" + in_a_twist, tolerance.name, guess}, group, over_lbs(tolerance, start));
        add(to, {"C03", "error_after_24_iterations_over_lbs_guess", "", guess}, group, [start](const ConvergencePaths& of) {
            return PathValue{look_at(of.paths[start], 24).error_joint_pct / look_at(of.paths[0], 24).error_joint_pct};
        });
    }
}

// The share of the comparisons with LBS, over all poses, orders and meshes, that have no value.
void add_neither(std::vector<analysis::Measurement>& to, const ConvergenceResult& result)
{
    for (const Tolerance& tolerance : tolerances) {
        int neither = 0, all = 0;
        for (const ConvergencePaths& paths : result.all)
            for (std::size_t start = 1; start < paths.paths.size(); ++start, ++all) neither += !over_lbs(tolerance, start)(paths);
        if (all == 0) continue;
        const double share = neither / double(all);
        const analysis::CaseKey key = {.body = result.all.front().body, .tolerance = tolerance.name};
        to.push_back({"C03", "share_of_ratios_not_reached", key, share, share, share, "1"});
        to.back().n = all;
    }
}

bool on_one_ladder(const ConvergencePaths& a, const ConvergencePaths& b)
{
    return a.pose == b.pose && a.k_stretch == b.k_stretch && a.setting.order == b.setting.order &&
           a.setting.precision == b.setting.precision;
}

// iterations ~ vertices^exponent, over the sizes that reach the tolerance, by order.
void add_exponents(std::vector<analysis::Measurement>& to, const ConvergenceResult& result)
{
    for (const ConvergencePaths& first : result.all) {
        const auto same = [&](const ConvergencePaths& other) { return on_one_ladder(first, other); };
        if (&*std::find_if(result.all.begin(), result.all.end(), same) != &first) continue;
        for (const Tolerance& tolerance : tolerances) {
            std::vector<double> vertices, iterations;
            for (const ConvergencePaths& paths : result.all)
                if (const Reached lbs = tolerance.reached(paths, 0); same(paths) && lbs.within && lbs.iterations > 0) {
                    vertices.push_back(paths.vertices);
                    iterations.push_back(lbs.iterations);
                }
            if (vertices.size() < 3) continue;
            const analysis::Interval exponent = analysis::observed_order(vertices, iterations).slope;
            const auto [fewest, most] = std::minmax_element(vertices.begin(), vertices.end());
            analysis::CaseKey key = key_of(first);
            key.tolerance = tolerance.name;
            key.vertices = *fewest;
            key.vertices_to = *most;
            to.push_back({"C12", "exponent_of_iterations_over_vertices", key, exponent.estimate, exponent.low, exponent.high, "1"});
        }
    }
}

}  // namespace

std::vector<analysis::Measurement> convergence_values(const ConvergenceResult& result)
{
    std::vector<analysis::Measurement> measurements;
    const std::vector<Group> groups = groups_of(result);
    for (const Group& group : groups) {
        for (const Tolerance& tolerance : tolerances)
            add(measurements,
                {"C12", group.front()->character ? "iterations_to_tolerance" : "iterations_to_tolerance_of_limbs", tolerance.name}, group,
                iterations_to(tolerance));
        add_further(measurements, group);
        add_starts(measurements, group);
    }
    add_neither(measurements, result);
    if (result.ladder) add_exponents(measurements, result);
    return measurements;
}

}  // namespace experiments
