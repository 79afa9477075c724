#include "experiments/studies/convergence/convergence_case.hpp"

#include "analysis/statistics/fits.hpp"
#include "analysis/verdicts/measurement.hpp"

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

const Columns<PathCase> case_columns =
    MEMBER_COLUMNS(PathCase, body, pose, vertices, tets, own_mesh, order, precision, k_stretch, start);

// Six digits are enough for drawing. All digits would double the size of the record.
Look rounded(Look look)
{
    for (const auto member :
         {&Look::stretch_rms, &Look::volume_rms, &Look::bind_rms_m, &Look::combined, &Look::volume_change_pct,
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

RateRow rate_row(const ConvergencePaths& paths, const IterationPath& path, double floor, PathKind kind,
                 const std::string& start)
{
    RateRow row{.kind = kind, .key = paths.key, .character = paths.character, .twist = paths.twist, .of = paths.of};
    row.of.start = start;
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
    MEMBER_COLUMNS(Look, iteration, stretch_rms, volume_rms, bind_rms_m, combined, volume_change_pct,
                   volume_abs_change_pct, inverted_tets);

const Columns<Look> error_look_columns = MEMBER_COLUMNS(Look, iteration, error_joint_pct, whole_joint_pct);

const Columns<ReferenceQuality> quality_columns =
    MEMBER_COLUMNS(ReferenceQuality, masked_share_pct) +
    Columns<ReferenceQuality>{{"reference_bound_pct", &ReferenceQuality::bound_pct}};

// A value of one setting, and what it bounds where a tolerance was not reached.
struct PathValue {
    double value = 0.0;
    analysis::Limit limit = analysis::Limit::none;
};
using ValueOf = std::function<std::optional<PathValue>(const RateRow& row, const RateRow& lbs)>;
using MeshRows = std::vector<const RateRow*>;  // of one mesh and setting, LBS first
using Group = std::vector<MeshRows>;           // meshes of about one size, the scene's own first

std::vector<Group> groups_of(const std::vector<RateRow>& rows, bool ladder)
{
    const auto setting = [&](const PathCase& of) {
        return std::tuple(of.pose, of.k_stretch, of.order, of.precision, ladder ? of.vertices : 0);
    };
    std::vector<Group> groups;
    std::size_t group = 0;
    for (const RateRow& row : rows) {
        if (row.kind == PathKind::guess && row.of.start == name_of(SolverStart::lbs)) {  // the first path of a mesh
            const auto is_same = [&](const Group& other) {
                return setting(other.front().front()->of) == setting(row.of);
            };
            group = static_cast<std::size_t>(std::ranges::find_if(groups, is_same) - groups.begin());
            if (group == groups.size()) groups.emplace_back();
            groups[group].emplace_back();
        }
        groups[group].back().push_back(&row);
    }
    return groups;
}

// place: of the path among those of its mesh. key: the part in which the values of a group differ.
void add(std::vector<analysis::Measurement>& to, const std::string& claim, const std::string& quantity,
         const analysis::CaseKey& key, const Group& group, std::size_t place, const ValueOf& value_of)
{
    const auto value_on = [&](const MeshRows& rows) { return value_of(*rows.at(place), *rows.front()); };
    const std::optional<PathValue> own = value_on(group.front());
    if (!own || !std::isfinite(own->value)) return;
    analysis::Measurement measured{claim, quantity, key, own->value, own->value, own->value, "1"};
    measured.limit = own->limit;
    int without = 0;
    for (const MeshRows& other : group) {
        const std::optional<PathValue> value = value_on(other);
        without += !value;
        if (!value || !std::isfinite(value->value)) continue;
        measured.low = std::min(measured.low, value->value);
        measured.high = std::max(measured.high, value->value);
    }
    if (without > 0) {
        measured.not_reached = without;
        measured.n = static_cast<int>(group.size());
        measured.low = 0.0;
        measured.high = std::numeric_limits<double>::infinity();
    }
    to.push_back(measured);
}

const std::pair<const char*, Reached RateRow::*> tolerances[] = {{"residual", &RateRow::residual},
                                                                 {"volume", &RateRow::volume}};

ValueOf iterations_to(Reached RateRow::*tolerance)
{
    return [tolerance](const RateRow& row, const RateRow&) {
        const Reached& reached = row.*tolerance;
        return PathValue{double(reached.iterations),
                         reached.within ? analysis::Limit::none : analysis::Limit::more_than};
    };
}

// An initial guess that fulfils the tolerance counts as one iteration.
ValueOf over_lbs(Reached RateRow::*tolerance)
{
    return [tolerance](const RateRow& row, const RateRow& lbs_row) -> std::optional<PathValue> {
        const Reached &other = row.*tolerance, &lbs = lbs_row.*tolerance;
        if (!other.within && !lbs.within) return {};
        return PathValue{std::max(other.iterations, 1) / double(std::max(lbs.iterations, 1)),
                         !other.within ? analysis::Limit::at_least
                         : !lbs.within ? analysis::Limit::at_most
                                       : analysis::Limit::none};
    };
}

std::optional<PathValue> error_over_lbs(const RateRow& row, const RateRow& lbs)
{
    return PathValue{row.paper.error_joint_pct / lbs.paper.error_joint_pct};
}

constexpr double exponent_level =
    0.99;  // sizes in any other order than their own lie beyond it in less than 1 % of all cases

}  // namespace

const Columns<LookRow> residual_columns =
    within(&LookRow::of, case_columns) + within(&LookRow::look, residual_look_columns);
const Columns<LookRow> towards_columns =
    within(&LookRow::of, case_columns) + within(&LookRow::look, error_look_columns);

using Rates = Columns<RateRow>;
using Looks = Columns<Look>;
const Columns<RateRow> rate_columns =
    within(&RateRow::of, case_columns) + MEMBER_COLUMNS(RateRow, iterations, outcome, floor) +
    within(&RateRow::paper, Looks{{"residual_24", &Look::combined}}) +
    within(&RateRow::last, Looks{{"last_residual", &Look::combined}}) + Rates{{"rate_per_iteration", &RateRow::rate}} +
    within(&RateRow::residual,
           Columns<Reached>{{"iterations_to_residual", &Reached::iterations}, {"residual_reached", &Reached::within}}) +
    within(&RateRow::volume,
           Columns<Reached>{{"iterations_to_volume", &Reached::iterations}, {"volume_reached", &Reached::within}}) +
    within(&RateRow::paper, Looks{{"volume_abs_change_24_pct", &Look::volume_abs_change_pct}}) +
    within(&RateRow::last, Looks{{"last_volume_abs_change_pct", &Look::volume_abs_change_pct}}) +
    Rates{{"reference", &RateRow::reference}} +
    within(&RateRow::paper, Looks{{"error_24_pct", &Look::error_joint_pct}}) +
    within(&RateRow::nearest, Looks{{"least_error_iteration", &Look::iteration}}) +
    within(&RateRow::last, Looks{{"last_error_pct", &Look::error_joint_pct}}) +
    within(&RateRow::quality, quality_columns);

std::vector<LookRow> look_rows(const ConvergenceResult& result)
{
    std::vector<LookRow> rows;
    for (const ConvergencePaths& paths : result.all) {
        if (!paths.of.own_mesh && !result.ladder) continue;  // of other tessellations only the rates are recorded
        for (std::size_t start = 0; start < paths.paths.size(); ++start) {
            PathCase of = paths.of;
            of.start = name_of(all_starts[start]);
            for (const Look& look : thinned(paths.paths[start])) rows.push_back({of, look});
        }
    }
    return rows;
}

std::vector<RateRow> rate_rows(const ConvergenceResult& result)
{
    std::vector<RateRow> rows;
    for (const ConvergencePaths& paths : result.all) {
        const double floor = floor_of(paths.paths);
        for (std::size_t start = 0; start < paths.paths.size(); ++start)
            rows.push_back(rate_row(paths, paths.paths[start], floor, PathKind::guess, name_of(all_starts[start])));
        for (std::size_t control = 0; control < paths.controls.size(); ++control)
            rows.push_back(
                rate_row(paths, paths.controls[control], floor, PathKind::control, control == 0 ? "lbs" : "random"));
        if (paths.author)
            rows.push_back(
                // its own floor
                rate_row(paths, *paths.author, paths.author->looks.back().combined, PathKind::author, "author"));
    }
    return rows;
}

std::vector<LookRow> towards_rows(std::vector<LookRow> looks)
{
    std::erase_if(looks, [](const LookRow& row) { return std::isnan(row.look.error_joint_pct); });
    return looks;
}

std::vector<analysis::Measurement> convergence_values(const std::vector<RateRow>& rows, bool ladder)
{
    std::vector<analysis::Measurement> measurements;
    for (const Group& group : groups_of(rows, ladder)) {
        const RateRow& lbs = *group.front().front();
        const std::string in_a_twist = lbs.twist ? "_in_a_twist" : "", of_limbs = lbs.character ? "" : "_of_limbs";
        for (std::size_t place = 0; place < (ladder ? 1 : group.front().size()); ++place) {
            const RateRow& row = *group.front()[place];
            analysis::CaseKey key = row.key;
            key.body = row.of.body;
            key.deformer = row.kind == PathKind::author ? "pbs_author" : "pbs";
            key.order = row.kind == PathKind::author ? "first_fit" : row.of.order;
            key.precision = row.of.precision;
            key.vertices = row.of.vertices;
            key.k_stretch = row.of.k_stretch;
            const bool is_lbs = place == 0, is_guess = !is_lbs && row.kind != PathKind::author;
            if (is_guess) key.initial_guess = row.of.start;
            if (is_guess)
                add(measurements, "C03", "error_after_24_iterations_over_lbs_guess", key, group, place, error_over_lbs);
            for (const auto& [name, tolerance] : tolerances) {
                key.tolerance = name;
                if (is_guess)
                    add(measurements, "C03", "iterations_over_lbs_guess" + in_a_twist, key, group, place,
                        over_lbs(tolerance));
                else if (is_lbs || tolerance == &RateRow::residual)
                    add(measurements, "C12", "iterations_to_tolerance" + of_limbs, key, group, place,
                        iterations_to(tolerance));
            }
        }
    }
    return measurements;
}

std::vector<analysis::Measurement> convergence_conclusions(const std::vector<analysis::Measurement>& measured)
{
    std::vector<analysis::Measurement> exponents;
    for (const char* quantity : {"iterations_to_tolerance", "iterations_to_tolerance_of_limbs"})
        for (const auto& [ladder, series] : series_over(measured, quantity, &analysis::CaseKey::vertices)) {
            std::vector<double> vertices, iterations;
            for (const auto& [size, value] : series)
                if (value.limit == analysis::Limit::none && value.value > 0.0) {
                    vertices.push_back(size);
                    iterations.push_back(value.value);
                }
            if (vertices.size() < 3) continue;
            const analysis::Interval exponent = analysis::observed_order(vertices, iterations, exponent_level);
            analysis::CaseKey of = ladder;
            of.vertices = vertices.front();
            of.vertices_to = vertices.back();
            exponents.push_back({"C12", "exponent_of_iterations_over_vertices", of, exponent.estimate, exponent.low,
                                 exponent.high, "1"});
        }
    return exponents;
}

}  // namespace experiments
