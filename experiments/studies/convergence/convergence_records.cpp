#include "experiments/studies/convergence/convergence_records.hpp"

#include "experiments/deformers/deformer_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

const Columns<PathCase> case_columns = {{"body", &PathCase::body, "", "name of the body"},
                                        {"pose", &PathCase::pose, "", "name of the pose"},
                                        {"vertices", &PathCase::vertices, "", "vertices of the mesh"},
                                        {"tets", &PathCase::tets, "", "tets of the mesh"},
                                        {"own_mesh", &PathCase::own_mesh, "", "the mesh is the scene's own"},
                                        {"order", &PathCase::order, "", "order of projection"},
                                        {"precision", &PathCase::precision, "", "f32 or f64"},
                                        {"k_stretch", &PathCase::k_stretch, "", "stiffness of the stretch constraints"},
                                        {"start", &PathCase::start, "", "initial guess: lbs, previous_frame, rest_pose or rigid_bind"}};

PathCase case_of(const ConvergencePaths& of, std::size_t start)
{
    return {of.body,
            of.pose,
            of.vertices,
            of.tets,
            of.own_mesh,
            name_of(of.setting.order),
            name_of(of.setting.precision),
            of.k_stretch,
            name_of(all_starts[start])};
}

// Enough digits for drawing. All digits would double the size of the record.
double six_digits(double value)
{
    return std::stod(fmt::format("{:.6g}", value));
}

Look rounded(Look look)
{
    for (const auto member : {&Look::stretch_rms, &Look::volume_rms, &Look::bind_rms_m, &Look::combined, &Look::volume_change_pct,
                              &Look::volume_abs_change_pct, &Look::error_joint_pct, &Look::whole_joint_pct})
        look.*member = six_digits(look.*member);
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

RateRow rate_row(const ConvergencePaths& of, std::size_t start, double floor)
{
    const IterationPath& path = of.paths[start];
    RateRow row;
    row.of = case_of(of, start);
    row.outcome = path.finite ? "finished" : "not_finite";
    row.first = path.looks.front();
    row.paper = look_at(path, 24);
    row.nearest = nearest_to_reference(path);
    row.last = path.looks.back();
    row.iterations = row.last.iteration;
    row.floor = floor;
    row.last_half_change_pct = 100.0 * (row.last.combined / look_at(path, row.last.iteration / 2).combined - 1.0);
    row.rate = rate_of(path, floor);
    row.residual = reached_residual(path, floor);
    row.volume = reached_volume(path);
    row.iteration_cpu_ms = path.iteration_ms;
    if (row.residual.within) row.cpu_ms_to_residual = row.residual.iterations * path.iteration_ms;
    if (row.volume.within) row.cpu_ms_to_volume = row.volume.iterations * path.iteration_ms;
    row.reference = of.reference;
    row.quality = of.quality;
    row.limit_from_lbs_pct = of.limit_from_lbs_pct[start];
    return row;
}

const Columns<Look> residual_look_columns = {
    {"iteration", &Look::iteration, "", "number of the iteration; 0: the initial guess"},
    {"stretch_rms", &Look::stretch_rms, "", "root mean square of l / l0 - 1 over the edges"},
    {"volume_rms", &Look::volume_rms, "", "root mean square of V / V0 - 1 over the tets"},
    {"bind_rms_m", &Look::bind_rms_m, "m", "root mean square of |x_i - q_i| - d_i over the vertices"},
    {"combined", &Look::combined, "", "root mean square of the three, the last one over the mean distance to the bone"},
    {"volume_change_pct", &Look::volume_change_pct, "%", "signed change of the whole volume"},
    {"volume_abs_change_pct", &Look::volume_abs_change_pct, "%", "sum of the absolute changes of each tet"},
    {"inverted_tets", &Look::inverted_tets, "", "number of inverted tets"}};

const Columns<Look> error_look_columns = {
    {"iteration", &Look::iteration, "", "number of the iteration; 0: the initial guess"},
    {"error_joint_pct", &Look::error_joint_pct, "%", "distance to the reference over the blended vertices outside its mask"},
    {"whole_joint_pct", &Look::whole_joint_pct, "%", "distance to the reference over all blended vertices"}};

const Columns<Look> start_residual = {{"start_residual", &Look::combined, "", "combined residual of the initial guess"}};
const Columns<Look> paper_residual = {{"residual_24", &Look::combined, "", "combined residual after 24 iterations"}};
const Columns<Look> last_residual = {{"last_residual", &Look::combined, "", "combined residual after the last iteration"}};

const Columns<analysis::Interval> rate_interval = {
    {"rate_per_iteration", &analysis::Interval::estimate, "", "factor per iteration of residual - floor"},
    {"rate_low", &analysis::Interval::low, "", "lower end of its interval"},
    {"rate_high", &analysis::Interval::high, "", "upper end of its interval"}};
const Columns<Rate> fitted_rate = Columns<Rate>{{"stalls_at_iteration", &Rate::stalls_at, "", "where it stalls; empty: nowhere"}} +
                                  within(&Rate::rate, rate_interval) +
                                  Columns<Rate>{{"rate_log_rms_off", &Rate::log_rms_off, "", "root mean square logarithm over the fit"}};

const Columns<Reached> to_residual = {{"iterations_to_residual", &Reached::iterations, "", "iterations to the residual's tolerance"},
                                      {"residual_reached", &Reached::within, "", "they reached it"}};
const Columns<Reached> to_volume = {{"iterations_to_volume", &Reached::iterations, "", "iterations to the paper's 0.5 % of volume"},
                                    {"volume_reached", &Reached::within, "", "they reached it"}};

const Columns<Look> paper_volume = {
    {"volume_change_24_pct", &Look::volume_change_pct, "%", "volume change after 24 iterations"},
    {"volume_abs_change_24_pct", &Look::volume_abs_change_pct, "%", "sum of the tets' absolute changes after 24 iterations"}};
const Columns<Look> last_volume = {
    {"last_volume_change_pct", &Look::volume_change_pct, "%", "volume change at the end"},
    {"last_volume_abs_change_pct", &Look::volume_abs_change_pct, "%", "sum of the tets' absolute changes at the end"},
    {"last_inverted_tets", &Look::inverted_tets, "", "inverted tets at the end"}};

const Columns<Look> start_error = {
    {"start_error_pct", &Look::error_joint_pct, "%", "error of the initial guess at the joints outside the mask"}};
const Columns<Look> paper_error = {{"error_24_pct", &Look::error_joint_pct, "%", "error after 24 iterations"}};
const Columns<Look> paper_whole_error = {
    {"whole_error_24_pct", &Look::whole_joint_pct, "%", "error after 24 iterations with the joints that the mask leaves out"}};
const Columns<Look> least_error = {{"least_error_pct", &Look::error_joint_pct, "%", "least error on the way"},
                                   {"least_error_iteration", &Look::iteration, "", "iteration of the least error"}};
const Columns<Look> last_error = {{"last_error_pct", &Look::error_joint_pct, "%", "error at the end"}};

const Columns<ReferenceQuality> quality_columns = {
    {"masked_share_pct", &ReferenceQuality::masked_share_pct, "%", "share of the volume that is left out because the reference overlaps"},
    {"observed_order", &ReferenceQuality::observed_order, "", "of convergence of the reference's linear elements"},
    {"order_is_reliable", &ReferenceQuality::order_is_reliable, "", "the order is credible, and the safety factor 1.25 instead of 3"},
    {"reference_bound_pct", &ReferenceQuality::bound_pct, "%", "bound of the reference's own error at the joints outside the mask"}};

}  // namespace

const Columns<LookRow> residual_columns = within(&LookRow::of, case_columns) + within(&LookRow::look, residual_look_columns);
const Columns<LookRow> towards_columns = within(&LookRow::of, case_columns) + within(&LookRow::look, error_look_columns);

using Rates = Columns<RateRow>;
const Columns<RateRow> rate_columns =
    within(&RateRow::of, case_columns) +
    Rates{{"iterations", &RateRow::iterations, "", "iterations that were done"},
          {"outcome", &RateRow::outcome, "", "finished or not_finite"},
          {"floor", &RateRow::floor, "", "lowest combined residual that any initial guess leads to"}} +
    within(&RateRow::first, start_residual) + within(&RateRow::paper, paper_residual) + within(&RateRow::last, last_residual) +
    Rates{{"last_half_change_pct", &RateRow::last_half_change_pct, "%", "change of the residual over the second half of the iterations"}} +
    within(&RateRow::rate, fitted_rate) + within(&RateRow::residual, to_residual) + within(&RateRow::volume, to_volume) +
    Rates{{"iteration_cpu_ms", &RateRow::iteration_cpu_ms, "ms", "mean processor time per iteration"},
          {"cpu_ms_to_residual", &RateRow::cpu_ms_to_residual, "ms", "processor time to the residual's tolerance; empty: not reached"},
          {"cpu_ms_to_volume", &RateRow::cpu_ms_to_volume, "ms", "processor time to the volume's tolerance; empty: not reached"}} +
    within(&RateRow::paper, paper_volume) + within(&RateRow::last, last_volume) +
    Rates{{"reference", &RateRow::reference, "", "name of the reference, or why there is none"}} + within(&RateRow::first, start_error) +
    within(&RateRow::paper, paper_error) + within(&RateRow::nearest, least_error) + within(&RateRow::last, last_error) +
    within(&RateRow::paper, paper_whole_error) + within(&RateRow::quality, quality_columns) +
    Rates{{"limit_from_lbs_pct", &RateRow::limit_from_lbs_pct, "%", "distance of the last shape from the one that LBS leads to"}};

std::vector<LookRow> look_rows(const ConvergenceResult& result)
{
    std::vector<LookRow> rows;
    for (const ConvergencePaths& paths : result.all) {
        if (!paths.own_mesh && !result.ladder) continue;  // of other tessellations only the rates are recorded
        for (std::size_t start = 0; start < paths.paths.size(); ++start)
            for (const Look& look : thinned(paths.paths[start])) rows.push_back({case_of(paths, start), look});
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

}  // namespace experiments
