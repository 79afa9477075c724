#include "experiments/studies/convergence/convergence_case.hpp"

#include "analysis/statistics/fits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

const Columns<PathCase> case_columns = MEMBER_COLUMNS(PathCase, body, pose, vertices, tets, own_mesh, order, precision, k_stretch, start);

PathCase case_of(PathCase path_case, std::size_t start)
{
    path_case.start = name_of(all_starts[start]);
    return path_case;
}

// Six digits are enough for drawing. All digits would double the size of the record.
Look rounded(Look look)
{
    for (const auto member : {&Look::stretch_rms, &Look::volume_rms, &Look::bind_rms_m, &Look::combined, &Look::volume_change_pct,
                              &Look::volume_abs_change_pct, &Look::error_joint_pct, &Look::whole_joint_pct})
        look.*member = std::stod(fmt::format("{:.6g}", look.*member));
    return look;
}

// The looks that are recorded: the first one past each fifth of a decade, and the last.
std::vector<Look> thinned(const IterationPath& path)
{
    std::vector<Look> kept;
    double next = 0.0;
    for (const Look& look : path.looks) {
        if (look.iteration < next && &look != &path.looks.back()) continue;
        kept.push_back(rounded(look));
        next = std::max(look.iteration + 1.0, std::floor(look.iteration * std::pow(10.0, 0.2)));
    }
    return kept;
}

RateRow rate_row(const ConvergencePaths& paths, std::size_t start, double floor)
{
    const IterationPath& path = paths.paths[start];
    RateRow row;
    row.of = case_of(paths.of, start);
    row.outcome = path.finite ? "finished" : "not_finite";
    row.paper = look_at(path, paper_iterations);
    row.nearest = nearest_to_reference(path);
    row.last = path.looks.back();
    row.iterations = row.last.iteration;
    row.floor = floor;
    row.rate = rate_of(path, floor);
    row.residual = reached_residual(path, floor);
    row.volume = reached_volume(path);
    row.reference = paths.reference;
    row.quality = paths.quality;
    return row;
}

const Columns<Look> residual_look_columns =
    MEMBER_COLUMNS(Look, iteration, stretch_rms, volume_rms, bind_rms_m, combined, volume_change_pct, volume_abs_change_pct, inverted_tets);

const Columns<Look> error_look_columns = MEMBER_COLUMNS(Look, iteration, error_joint_pct, whole_joint_pct);

const Columns<ReferenceQuality> quality_columns =
    MEMBER_COLUMNS(ReferenceQuality, masked_share_pct) + Columns<ReferenceQuality>{{"reference_bound_pct", &ReferenceQuality::bound_pct}};

// A value of one setting, and what it bounds where a tolerance was not reached.
struct PathValue {
    double value = 0.0;
    analysis::Limit limit = analysis::Limit::none;
};
using ValueOf = std::function<std::optional<PathValue>(const ConvergencePaths&)>;
using Group = std::vector<const ConvergencePaths*>;  // meshes of about one size, the scene's own first

std::vector<Group> groups_of(const ConvergenceResult& result)
{
    std::vector<Group> groups;
    for (const ConvergencePaths& paths : result.all) {
        const auto same = [&](const Group& group) {
            const PathCase &first = group.front()->of, &other = paths.of;
            return std::tie(first.pose, first.k_stretch, first.order, first.precision) ==
                       std::tie(other.pose, other.k_stretch, other.order, other.precision) &&
                   (!result.ladder || first.vertices == other.vertices);
        };
        if (const auto found = std::find_if(groups.begin(), groups.end(), same); found != groups.end())
            found->push_back(&paths);
        else
            groups.push_back({&paths});
    }
    return groups;
}

analysis::CaseKey key_of(const ConvergencePaths& paths)
{
    analysis::CaseKey key = paths.key;
    key.body = paths.of.body;
    key.deformer = "pbs";
    key.order = paths.of.order;
    key.precision = paths.of.precision;
    key.vertices = paths.of.vertices;
    key.k_stretch = paths.of.k_stretch;
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
    Reached (*reached)(const ConvergencePaths& paths, const IterationPath& path);
};
const Tolerance tolerances[] = {
    {"residual", [](const ConvergencePaths& paths, const IterationPath& path) { return reached_residual(path, floor_of(paths.paths)); }},
    {"volume", [](const ConvergencePaths&, const IterationPath& path) { return reached_volume(path); }}};

PathValue iterations_of(const Reached& reached)
{
    return {double(reached.iterations), reached.within ? analysis::Limit::none : analysis::Limit::more_than};
}

ValueOf iterations_to(const Tolerance& tolerance)
{
    return [&tolerance](const ConvergencePaths& paths) { return iterations_of(tolerance.reached(paths, paths.paths[0])); };
}

// One of a case's paths.
using PathOf = std::function<const IterationPath&(const ConvergencePaths&)>;

// An initial guess that fulfils the tolerance counts as one iteration.
ValueOf over_lbs(const Tolerance& tolerance, const PathOf& path_of)
{
    return [&tolerance, path_of](const ConvergencePaths& paths) -> std::optional<PathValue> {
        const Reached other = tolerance.reached(paths, path_of(paths)), lbs = tolerance.reached(paths, paths.paths[0]);
        if (!other.within && !lbs.within) return {};
        return PathValue{std::max(other.iterations, 1) / double(std::max(lbs.iterations, 1)), !other.within ? analysis::Limit::at_least
                                                                                              : !lbs.within ? analysis::Limit::at_most
                                                                                                            : analysis::Limit::none};
    };
}

// The later code of the paper's first author, by the residual's own floor.
void add_author(std::vector<analysis::Measurement>& to, const Group& group)
{
    add(to, {"C12", "iterations_to_tolerance", "residual"}, group,
        [](const ConvergencePaths& paths) { return iterations_of(reached_residual(*paths.author, paths.author->looks.back().combined)); });
    to.back().of.deformer = "pbs_author";
    to.back().of.order = "first_fit";
}

void add_starts(std::vector<analysis::Measurement>& to, const Group& group)
{
    const std::string in_a_twist = group.front()->twist ? "_in_a_twist" : "";
    const auto add_guess = [&](const char* guess, const PathOf& path_of) {
        for (const Tolerance& tolerance : tolerances)
            add(to, {"C03", "iterations_over_lbs_guess" + in_a_twist, tolerance.name, guess}, group, over_lbs(tolerance, path_of));
        add(to, {"C03", "error_after_24_iterations_over_lbs_guess", "", guess}, group, [path_of](const ConvergencePaths& paths) {
            return PathValue{look_at(path_of(paths), paper_iterations).error_joint_pct /
                             look_at(paths.paths[0], paper_iterations).error_joint_pct};
        });
    };
    for (std::size_t start = 1; start < group.front()->paths.size(); ++start)
        add_guess(name_of(all_starts[start]),
                  [start](const ConvergencePaths& paths) -> const IterationPath& { return paths.paths[start]; });
    if (group.front()->controls.empty()) return;
    add_guess("lbs", [](const ConvergencePaths& paths) -> const IterationPath& { return paths.controls[0]; });
    add_guess("random", [](const ConvergencePaths& paths) -> const IterationPath& { return paths.controls[1]; });
}

constexpr double exponent_level = 0.99;  // sizes in any other order than their own lie beyond it in less than 1 % of all cases

// iterations ~ vertices^exponent, over the sizes that reach the tolerance, by order.
void add_exponents(std::vector<analysis::Measurement>& to, const ConvergenceResult& result)
{
    for (const ConvergencePaths& first : result.all) {
        const auto ladder_of = [](const PathCase& path_case) {
            return std::tie(path_case.pose, path_case.k_stretch, path_case.order, path_case.precision);
        };
        const auto same = [&](const ConvergencePaths& other) { return ladder_of(other.of) == ladder_of(first.of); };
        if (&*std::find_if(result.all.begin(), result.all.end(), same) != &first) continue;
        for (const Tolerance& tolerance : tolerances) {
            std::vector<double> vertices, iterations;
            for (const ConvergencePaths& paths : result.all)
                if (const Reached lbs = tolerance.reached(paths, paths.paths[0]); same(paths) && lbs.within && lbs.iterations > 0) {
                    vertices.push_back(paths.of.vertices);
                    iterations.push_back(lbs.iterations);
                }
            if (vertices.size() < 3) continue;
            const analysis::Interval exponent = analysis::observed_order(vertices, iterations, exponent_level).slope;
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

const Columns<LookRow> residual_columns = within(&LookRow::of, case_columns) + within(&LookRow::look, residual_look_columns);
const Columns<LookRow> towards_columns = within(&LookRow::of, case_columns) + within(&LookRow::look, error_look_columns);

using Rates = Columns<RateRow>;
using Looks = Columns<Look>;
const Columns<RateRow> rate_columns =
    within(&RateRow::of, case_columns) + MEMBER_COLUMNS(RateRow, iterations, outcome, floor) +
    within(&RateRow::paper, Looks{{"residual_24", &Look::combined}}) + within(&RateRow::last, Looks{{"last_residual", &Look::combined}}) +
    Rates{{"rate_per_iteration", &RateRow::rate}} +
    within(&RateRow::residual, Columns<Reached>{{"iterations_to_residual", &Reached::iterations}, {"residual_reached", &Reached::within}}) +
    within(&RateRow::volume, Columns<Reached>{{"iterations_to_volume", &Reached::iterations}, {"volume_reached", &Reached::within}}) +
    within(&RateRow::paper, Looks{{"volume_abs_change_24_pct", &Look::volume_abs_change_pct}}) +
    within(&RateRow::last, Looks{{"last_volume_abs_change_pct", &Look::volume_abs_change_pct}}) +
    Rates{{"reference", &RateRow::reference}} + within(&RateRow::paper, Looks{{"error_24_pct", &Look::error_joint_pct}}) +
    within(&RateRow::nearest, Looks{{"least_error_iteration", &Look::iteration}}) +
    within(&RateRow::last, Looks{{"last_error_pct", &Look::error_joint_pct}}) + within(&RateRow::quality, quality_columns);

std::vector<LookRow> look_rows(const ConvergenceResult& result)
{
    std::vector<LookRow> rows;
    for (const ConvergencePaths& paths : result.all) {
        if (!paths.of.own_mesh && !result.ladder) continue;  // of other tessellations only the rates are recorded
        for (std::size_t start = 0; start < paths.paths.size(); ++start)
            for (const Look& look : thinned(paths.paths[start])) rows.push_back({case_of(paths.of, start), look});
    }
    return rows;
}

std::vector<RateRow> rate_rows(const ConvergenceResult& result)
{
    std::vector<RateRow> rows;
    for (const ConvergencePaths& paths : result.all) {
        const double floor = floor_of(paths.paths);
        for (std::size_t start = 0; start < paths.paths.size(); ++start) rows.push_back(rate_row(paths, start, floor));
    }
    return rows;
}

std::vector<LookRow> towards_rows(std::vector<LookRow> looks)
{
    std::erase_if(looks, [](const LookRow& row) { return std::isnan(row.look.error_joint_pct); });
    return looks;
}

std::vector<analysis::Measurement> convergence_values(const ConvergenceResult& result)
{
    std::vector<analysis::Measurement> measurements;
    const std::vector<Group> groups = groups_of(result);
    for (const Group& group : groups) {
        for (const Tolerance& tolerance : tolerances)
            add(measurements,
                {"C12", group.front()->character ? "iterations_to_tolerance" : "iterations_to_tolerance_of_limbs", tolerance.name}, group,
                iterations_to(tolerance));
        if (group.front()->author) add_author(measurements, group);
        if (!result.ladder) add_starts(measurements, group);
    }
    if (result.exponents) add_exponents(measurements, result);
    return measurements;
}

}  // namespace experiments
