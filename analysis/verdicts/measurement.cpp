#include "analysis/verdicts/measurement.hpp"

#include "analysis/records/tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

namespace analysis {
namespace {

// How far the value lies outside the bound; negative inside. NaN counts as farthest outside.
double excess(const Claim& claim, double value)
{
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(claim.low - value, value - claim.high);
}

std::vector<bool> frames_within(const Claim& claim, const std::vector<double>& values)
{
    std::vector<bool> holds;
    for (double value : values) holds.push_back(excess(claim, value) <= 0.0);
    return holds;
}

std::vector<FailingFrame> deepest_failures(const Claim& claim, const CaseRecord& record, const std::vector<double>& values)
{
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return excess(claim, values[a]) > excess(claim, values[b]); });
    std::vector<FailingFrame> failures;
    for (std::size_t i : order)
        if (failures.size() < 3 && excess(claim, values[i]) > 0.0)
            failures.push_back({record.frame[i], record.time_s[i], record.is_sweep() ? record.angle_deg[i] : not_known, values[i],
                                record.inverted_tets[i]});
    return failures;
}

// Consecutive frames that hold, as ranges of sampled angles.
std::vector<AngleRange> holding_angles(const std::vector<double>& angle_deg, const std::vector<bool>& holds)
{
    std::vector<AngleRange> ranges;
    for (std::size_t i = 0; i < holds.size(); ++i) {
        if (!holds[i]) continue;
        if (i == 0 || !holds[i - 1]) ranges.push_back({angle_deg[i], angle_deg[i]});
        ranges.back().to_deg = angle_deg[i];
    }
    return ranges;
}

// share_within: from the start of the sweep to the last angle before the first failure.
void judge_sweep_from_its_start(const Claim& claim, const std::vector<double>& angle_deg, const std::vector<bool>& holds,
                                CaseJudgement& result)
{
    if (!holds.front()) return;
    result.angles = {holding_angles(angle_deg, holds).front()};
    const double held = std::abs(result.angles[0].to_deg - result.angles[0].from_deg),
                 whole = std::abs(angle_deg.back() - angle_deg.front());
    if (!(held > 0.0)) return;  // a claim that holds in the rest pose alone holds nowhere
    result.extent = held >= claim.share * whole ? Extent::whole : held >= claim.part * whole ? Extent::part : Extent::none;
}

// mean_within: wherever the sweep passes through the band; a mean over its angles has no meaning.
void judge_sweep_in_band(const std::vector<double>& angle_deg, const std::vector<bool>& holds, CaseJudgement& result)
{
    result.angles = holding_angles(angle_deg, holds);
    result.extent = result.angles.empty() ? Extent::none : Extent::part;
}

void judge_sweep(const Claim& claim, const std::vector<double>& angle_deg, const std::vector<double>& values,
                 const std::vector<bool>& holds, CaseJudgement& result)
{
    result.last_angle_deg = angle_deg.back();
    result.mean = {mean(values), not_known, not_known, claim.level, result.frames, 0};
    result.share = {mean(std::vector<double>(holds.begin(), holds.end())), not_known, not_known, claim.level, result.frames, 0};
    if (claim.rule == ClaimRule::share_within)
        judge_sweep_from_its_start(claim, angle_deg, holds, result);
    else
        judge_sweep_in_band(angle_deg, holds, result);
}

void judge_clip(const Claim& claim, const std::vector<double>& values, const std::vector<bool>& holds, CaseJudgement& result)
{
    const BootstrapOptions options{.level = claim.level, .autocorrelation_time = integrated_autocorrelation_time(values)};
    result.mean = bootstrap_mean(values, options);
    result.share = bootstrap_share(holds, options);
    if (claim.rule == ClaimRule::share_within) {
        result.extent = result.share.low >= claim.share ? Extent::whole : Extent::none;
    } else {
        const bool mean_in_band = excess(claim, result.mean.low) <= 0.0 && excess(claim, result.mean.high) <= 0.0;
        result.extent = mean_in_band ? Extent::whole : result.share.estimate > 0.0 ? Extent::part : Extent::none;
    }
}

void find_extremes(const std::vector<double>& values, CaseJudgement& result)
{
    const bool broken = std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
    result.least = broken ? not_known : *std::min_element(values.begin(), values.end());
    result.most = broken ? not_known : *std::max_element(values.begin(), values.end());
}

CaseKey key_of(const CaseRecord& record)
{
    CaseKey key = record.place;
    if (key.body.empty()) key.body = record.scene;
    key.deformer = record.deformer;
    key.variant = record.variant == "default" ? "" : record.variant;
    key.order = record.order;
    key.precision = record.precision;
    if (record.iterations > 0) key.iterations = record.iterations;
    return key;
}

const Columns<Measurement>& measurement_columns()
{
    static const Columns<Measurement> columns =
        Columns<Measurement>{{"claim", &Measurement::claim, "", "id of the claim"},
                             {"quantity", &Measurement::quantity, "", "what is measured"}} +
        within(&Measurement::of, case_key_columns()) +
        Columns<Measurement>{{"value", &Measurement::value, "", "in `unit`"},
                             {"low", &Measurement::low, "", "lower end of its interval"},
                             {"high", &Measurement::high, "", "upper end of its interval"},
                             {"unit", &Measurement::unit, "", "unit of value, low and high"}} +
        optional(Columns<Measurement>{
            column_with_empty(Limit::none, "limit", &Measurement::limit, "", "how the value limits the quantity"),
            column_with_empty(0, "n", &Measurement::n, "", "settings, cells or comparisons from which the value is computed"),
            column_with_empty(0, "not_reached", &Measurement::not_reached, "", "how many of these reach the tolerance from no guess")});
    return columns;
}

bool within(const QuantityBound& bound, double value)
{
    return bound.low <= value && value <= bound.high;
}

bool is_of_a_metric(const Claim& claim, const Measurement& measured)
{
    return measured.claim == claim.id && std::count(claim.metrics.begin(), claim.metrics.end(), measured.quantity) > 0;
}

}  // namespace

CaseJudgement judge_case(const Claim& claim, const CaseRecord& record, const std::string& metric)
{
    const std::vector<double> values = metric_series(record, metric);
    const std::vector<bool> holds = frames_within(claim, values);
    CaseJudgement result;
    result.rule = claim.rule;
    result.scene = record.scene;
    result.deformer = record.deformer;
    result.variant = record.variant;
    result.metric = metric;
    result.of = key_of(record);
    result.run = record.run;
    result.iterations = record.iterations;
    result.frames = static_cast<int>(values.size());
    result.sweep = record.is_sweep();
    if (values.empty()) return result;
    find_extremes(values, result);
    if (claim.rule == ClaimRule::share_within) result.deepest = deepest_failures(claim, record, values);
    for (std::size_t i = 0; i < holds.size(); ++i) result.holding_with_inverted_tets += holds[i] && record.inverted_tets[i] > 0.0;
    if (!result.sweep)
        judge_clip(claim, values, holds, result);
    else
        judge_sweep(claim, record.angle_deg, values, holds, result);
    return result;
}

std::vector<Measurement> measurements(const std::string& csv)
{
    return rows_of(measurement_columns(), read_csv(csv));
}

CsvTable measurement_table(const std::vector<Measurement>& measurements)
{
    return table_of(used_columns(measurement_columns(), measurements), measurements);
}

bool is_judged(const Claim& claim, const Measurement& measured)
{
    return is_of_a_metric(claim, measured) && matches(measured.of, claim.of);
}

bool is_control(const Claim& claim, const Measurement& measured)
{
    return is_of_a_metric(claim, measured) && !matches(measured.of, claim.of);
}

QuantityBound bound_of(const Claim& claim, const std::string& quantity)
{
    const auto found =
        std::find_if(claim.bounds.begin(), claim.bounds.end(), [&](const auto& bound) { return bound.quantity == quantity; });
    return found == claim.bounds.end() ? QuantityBound{quantity, claim.low, claim.high} : *found;
}

Extent extent_of(const Claim& claim, const Measurement& measured)
{
    const QuantityBound bound = bound_of(claim, measured.quantity);
    if (!within(bound, measured.value)) return Extent::none;
    return within(bound, measured.low) && within(bound, measured.high) ? Extent::whole : Extent::part;
}

std::string bound_text(const QuantityBound& bound)
{
    if (bound.low == bound.high) return fmt::format("{:.4g}", bound.low);
    if (bound.high >= open_end) return fmt::format("{:.4g} or more", bound.low);
    if (std::isinf(bound.low)) return fmt::format("{:.4g} or less", bound.high);
    return fmt::format("{:.4g} to {:.4g}", bound.low, bound.high);
}

}  // namespace analysis
