// The rule by which a claim is judged: judge() of verdict.hpp and its steps, in the order in which they are taken. The
// measurements of a claim are grouped into cases, each case is compared with its threshold, cases in which the control
// does not fail are excluded, and the kind of the verdict follows from the share of the cases that hold. The files
// claims.json and claims.md are written by claims_report.cpp.

#include "analysis/verdicts/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace analysis {
namespace {

bool is_selected(const Selection& selection, const CaseKey& key, const Measurement& measured)
{
    return std::ranges::count(selection.quantities, measured.quantity) > 0 && matches(measured.of, key);
}

using Values = std::vector<const Measurement*>;

Values selected(const Selection& selection, const CaseKey& key, const std::vector<Measurement>& measured)
{
    Values values;
    for (const Measurement& measurement : measured)
        if (is_selected(selection, key, measurement)) values.push_back(&measurement);
    return values;
}

// The case that a measurement belongs to. Only the claim's case_fields are set.
JudgedCase case_of(const Claim& claim, const Measurement& measured)
{
    JudgedCase tested;
    for (const std::string& name : claim.case_fields) {
        const CaseKeyField* field = case_key_field(name);
        if (!field)
            tested.quantity = measured.quantity;
        else if (field->text)
            tested.of.*field->text = measured.of.*field->text;
        else
            tested.of.*field->number = measured.of.*field->number;
    }
    return tested;
}

double mean_of(Mean mean_kind, const std::vector<double>& values)
{
    if (mean_kind == Mean::arithmetic) return mean(values);
    if (std::ranges::count(values, 0.0) > 0)
        return std::ranges::all_of(values, [](double value) { return value >= 0.0; }) ? 0.0 : not_known;
    std::vector<double> logarithms;
    // NaN for a value below 0, as for one that is not known
    for (const double value : values) logarithms.push_back(std::log(value));
    return std::exp(mean(logarithms));
}

Threshold threshold_of(const Selection& selection, const std::string& quantity, const CaseKey& key)
{
    const auto applies = [&](const Threshold& threshold) {
        return (threshold.quantity.empty() || threshold.quantity == quantity) && matches(key, threshold.of);
    };
    const auto threshold = std::ranges::find_if(selection.thresholds, applies);
    return threshold == selection.thresholds.end() ? Threshold{} : *threshold;
}

// True for a censored value of which some of the values that it stands for are within the threshold and others are not.
bool is_undecided(const JudgedCase& tested)
{
    if (tested.limit == Limit::none) return false;
    const bool above = tested.limit == Limit::at_least || tested.limit == Limit::more_than;
    if (!tested.threshold.contains(tested.value))
        return above ? tested.value < tested.threshold.low : tested.value > tested.threshold.high;
    return std::isfinite(above ? tested.threshold.high : tested.threshold.low);
}

double mean_of(Mean mean_kind, const Values& values)
{
    std::vector<double> numbers;
    for (const Measurement* measurement : values) numbers.push_back(measurement->value);
    return mean_of(mean_kind, numbers);
}

Values with_quantity(const Values& values, const std::string& quantity)
{
    Values matching;
    std::ranges::copy_if(values, std::back_inserter(matching),
                         [&](const Measurement* measurement) { return measurement->quantity == quantity; });
    return matching;
}

// One quantity of a case, compared with its threshold. over: the values by whose mean the number is divided, where the
// selection names some.
JudgedCase compared(const Claim& claim, const Selection& selection, JudgedCase tested, const Values& values,
                    const Values& over)
{
    tested.value = mean_of(claim.mean, values);
    tested.low = tested.high = values.front()->value;
    // A mean over values that are censored from below and others that are censored from above is not known.
    bool has_least = false;
    bool has_most = false;
    for (const Measurement* measurement : values) {
        tested.low = std::min({tested.low, measurement->value, measurement->low});
        tested.high = std::max({tested.high, measurement->value, measurement->high});
        if (measurement->limit == Limit::none) continue;
        tested.limit = measurement->limit;
        (measurement->limit == Limit::at_most ? has_most : has_least) = true;
    }
    tested.n = static_cast<int>(values.size());
    tested.unit = values.front()->unit;
    tested.threshold = threshold_of(selection, values.front()->quantity, tested.of);
    if (selection.over != CaseKey{}) {
        const double base = over.empty() ? not_known : mean_of(claim.mean, over);
        if (!(std::isfinite(base) && base != 0.0)) {
            tested.excluded = Excluded::nothing_to_compare_with;
            return tested;
        }
        tested.value /= base;
        tested.low /= base;
        tested.high /= base;
    }
    tested.holds = tested.threshold.contains(tested.value);
    if (is_undecided(tested) || (has_least && has_most)) tested.excluded = Excluded::censored;
    return tested;
}

// Drops the runs beside the study's own. They count only in cases for which no other run has values.
void drop_runs_beside(Values& values)
{
    if (std::ranges::any_of(values, [](const Measurement* measurement) { return !measurement->beside; }))
        std::erase_if(values, [](const Measurement* measurement) { return measurement->beside; });
}

// A case without one of the quantities does not hold, since nothing shows that it does.
JudgedCase whole_case(const Claim& claim, const Selection& selection, const JudgedCase& tested, const Values& values,
                      const Values& over)
{
    if (!tested.quantity.empty()) return compared(claim, selection, tested, values, over);
    std::vector<JudgedCase> parts;
    for (const std::string& quantity : selection.quantities) {
        const Values own = with_quantity(values, quantity);
        JudgedCase part{.of = tested.of, .value = not_known, .low = not_known, .high = not_known};
        if (!own.empty()) part = compared(claim, selection, tested, own, with_quantity(over, quantity));
        part.quantity = quantity;
        parts.push_back(part);
    }
    JudgedCase judged_case = parts.front();
    judged_case.quantity = "";
    judged_case.holds = std::ranges::all_of(parts, &JudgedCase::holds);
    for (const JudgedCase& part : parts)
        if (judged_case.counts()) judged_case.excluded = part.excluded;
    if (parts.size() > 1) judged_case.parts = std::move(parts);
    return judged_case;
}

// Counts the cases, and decides whether a control behaves as its role demands.
void count(Judged& judged)
{
    judged.held = judged.n = 0;
    for (const JudgedCase& tested : judged.cases) {
        judged.n += tested.counts();
        judged.held += tested.counts() && tested.holds;
    }
    const bool fails = judged.n > 0 && judged.share() <= failing_share;
    const bool holds = judged.n > 0 && judged.share() >= holding_share;
    judged.behaves = judged.selection.role == Role::negative_control   ? fails
                     : judged.selection.role == Role::positive_control ? holds
                                                                       : true;
}

// Excludes the cases in which the negative control does not fail, since they show nothing.
void exclude_unseen(const Judged& control, Judged& own)
{
    for (JudgedCase& tested : own.cases) {
        const auto same = std::ranges::find_if(
            control.cases, [&](const JudgedCase& judged_case) { return judged_case.is_same(tested); });
        if (same == control.cases.end() || !same->counts())
            tested.excluded = Excluded::no_control;
        else if (same->holds)
            tested.excluded = Excluded::nothing_to_see;
    }
    count(own);
}

// The share of cases that hold without the effect that is claimed: the largest one of the negative controls. It is
// estimated by the rule of succession, (k + 1) / (n + 2), since a control that fails in each of a few cases does not
// show a share of exactly 0. The control by which cases are excluded fails in all that count.
double share_of_controls(const Verdict& verdict)
{
    if (verdict.claim.no_effect > 0.0) return verdict.claim.no_effect;
    double largest = 0.0;
    for (const Judged& other : verdict.others) {
        if (other.selection.role != Role::negative_control) continue;
        const bool selects = !verdict.claim.selected_by.empty() && other.selection.name == verdict.claim.selected_by;
        largest = std::max(largest, selects ? 1.0 / (verdict.own.n + 2.0) : (other.held + 1.0) / (other.n + 2.0));
    }
    return largest;
}

// The interval of the share of cases that hold: the wider one of the binomial interval and the bootstrap over bodies.
Interval interval_of(const Judged& own)
{
    std::vector<std::string> bodies;
    std::vector<bool> holds;
    for (const JudgedCase& tested : own.cases) {
        if (!tested.counts()) continue;
        bodies.push_back(tested.of.body);
        holds.push_back(tested.holds);
    }
    const Interval binomial = share_interval(own.held, own.n);
    const Interval bootstrap = bootstrap_share_of_groups(bodies, holds);
    return bootstrap.high - bootstrap.low > binomial.high - binomial.low ? bootstrap : binomial;
}

struct CaseCount {
    int held = 0;   // cases that hold
    int cases = 0;  // cases that count
};

// The cases that have each value of a field, such as each body. field: null for the field `quantity`.
std::map<std::string, CaseCount> counts_by_value(const Judged& own, const CaseKeyField* field)
{
    std::map<std::string, CaseCount> counts;
    for (const JudgedCase& tested : own.cases) {
        if (!tested.counts() || (field && !field->is_set(tested.of))) continue;
        CaseCount& count = counts[field ? value_text(*field, tested.of) : tested.quantity];
        count.held += tested.holds;
        ++count.cases;
    }
    return counts;
}

// The field by whose values the shares of the cases that hold differ most. A value with fewer than two cases is not
// compared. The result is empty if no field has two values with different shares.
std::optional<Difference> largest_difference(const Claim& claim, const Judged& own)
{
    std::optional<Difference> largest;
    for (const std::string& name : claim.case_fields) {
        Difference difference{.field = name, .least = 2.0, .most = -1.0};
        for (const auto& [value, count] : counts_by_value(own, case_key_field(name))) {
            if (count.cases < 2) continue;
            const double share = double(count.held) / count.cases;
            if (share < difference.least) {
                difference.least = share;
                difference.least_at = value;
            }
            if (share > difference.most) {
                difference.most = share;
                difference.most_at = value;
            }
        }
        if (difference.least_at != difference.most_at &&
            (!largest || difference.most - difference.least > largest->most - largest->least))
            largest = difference;
    }
    return largest;
}

// The claim judged in every other order and precision of projection that its values are recorded in. There are none
// unless the claim names an order or a precision of its own.
std::vector<Judged> readings_of(const Claim& claim, const std::vector<Measurement>& measured)
{
    std::vector<Judged> readings;
    if (claim.own.of.order.empty() && claim.own.of.precision.empty()) return readings;
    Selection any = claim.own;
    any.of.order = any.of.precision = "";
    std::set<std::pair<std::string, std::string>> recorded;  // order, precision
    for (const Measurement& measurement : measured)
        if (is_selected(any, any.of, measurement)) recorded.insert({measurement.of.order, measurement.of.precision});
    for (const auto& [order, precision] : recorded) {
        any.of.order = order;
        any.of.precision = precision;
        any.name = order.empty() ? precision : order + " " + precision;
        any.role = Role::comparison;
        if (any.of != claim.own.of) readings.push_back(judged(claim, any, measured));
    }
    return readings;
}

Inconclusive why_inconclusive(const Verdict& verdict)
{
    for (const Judged& other : verdict.others)
        if (!other.behaves)
            return other.n == 0 ? Inconclusive::control_without_record : Inconclusive::control_misbehaves;
    if (verdict.own.n < least_cases) return Inconclusive::too_few_cases;
    const bool by_chance = verdict.own.share() >= holding_share && !(verdict.by_chance < largest_chance);
    return by_chance ? Inconclusive::chance : Inconclusive::no;
}

VerdictKind kind_of(const Verdict& verdict)
{
    if (verdict.inconclusive != Inconclusive::no) return VerdictKind::inconclusive;
    if (verdict.own.share() <= failing_share) return VerdictKind::fails;
    if (!(verdict.by_chance < largest_chance)) return VerdictKind::not_shown;
    return verdict.own.share() >= holding_share ? VerdictKind::holds : VerdictKind::mixed;
}

// The kind of a verdict by cases, with the cases that count and what chance reaches.
void decide(Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    const auto control = std::ranges::find(verdict.others, claim.selected_by, [](const Judged& judged_selection) {
        return judged_selection.selection.name;
    });
    if (!claim.selected_by.empty()) {
        exclude_unseen(*control, verdict.own);
        // The control selects the cases, so that its share shows nothing. It has to fail in enough of them.
        control->behaves = control->n - control->held >= least_cases;
        for (Judged& reading : verdict.readings) exclude_unseen(*control, reading);
        for (Judged& other : verdict.others)
            if (other.selection.role == Role::comparison) exclude_unseen(*control, other);
    }
    verdict.q = share_of_controls(verdict);
    if (verdict.own.n > 0) verdict.by_chance = binomial_tail(verdict.own.held, verdict.own.n, verdict.q);
    verdict.inconclusive = why_inconclusive(verdict);
    verdict.kind = kind_of(verdict);
}

void judge_cases(Verdict& verdict)
{
    decide(verdict);
    if (verdict.own.n > 0) verdict.interval = interval_of(verdict.own);
    if (verdict.kind == VerdictKind::mixed) verdict.differs = largest_difference(verdict.claim, verdict.own);
}

// Judges one number by its range.
void judge_single(Verdict& verdict)
{
    if (verdict.own.cases.size() != 1) {
        verdict.kind = VerdictKind::inconclusive;
        verdict.inconclusive = Inconclusive::too_few_cases;
        return;
    }
    const JudgedCase& only = verdict.own.cases.front();
    const bool inside = only.threshold.contains(only.low) && only.threshold.contains(only.high);
    const bool outside = only.high < only.threshold.low || only.low > only.threshold.high || std::isnan(only.value);
    verdict.kind = inside ? VerdictKind::holds : outside ? VerdictKind::fails : VerdictKind::mixed;
}

void judge_print(const std::vector<PrintedValue>& values, Verdict& verdict)
{
    std::ranges::copy_if(values, std::back_inserter(verdict.printed),
                         [&](const PrintedValue& value) { return value.claim == verdict.claim.id; });
    if (verdict.printed.empty()) return;
    const bool consistent = std::ranges::all_of(verdict.printed, &PrintedValue::is_consistent);
    verdict.kind = consistent ? VerdictKind::holds : VerdictKind::inconsistent_in_print;
}

// Judges the measured values by the claim's rule. otherwise: a verdict whose controls take the place of controls that
// have no cases; null if there is none.
void judge_values(const std::vector<Measurement>& measured, const Verdict* otherwise, Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    verdict.own = judged(claim, claim.own, measured);
    for (std::size_t i = 0; i < claim.others.size(); ++i) {
        Judged other = judged(claim, claim.others[i], measured);
        const bool is_control = other.selection.role != Role::comparison && claim.others[i].name != claim.selected_by;
        verdict.others.push_back(other.cases.empty() && is_control && otherwise ? otherwise->others[i]
                                                                                : std::move(other));
    }
    verdict.readings = readings_of(claim, measured);
    std::set<std::string> runs;
    for (const Measurement* measurement : selected(claim.own, claim.own.of, measured))
        if (!measurement->run.empty()) runs.insert(measurement->run);
    verdict.runs.assign(runs.begin(), runs.end());
    if (claim.rule == ClaimRule::single)
        judge_single(verdict);
    else if (claim.rule == ClaimRule::cases)
        judge_cases(verdict);
}

struct SplitMeasurements {
    std::vector<Measurement> measured;  // by which the claim is judged
    std::vector<Measurement> held_out;  // of the cases that Claim::held_out names
};

SplitMeasurements split_measurements(const Claim& claim, const Records& records)
{
    std::vector<Measurement> measurements = records.measurements;
    for (const CaseRecord& record : records.cases)
        std::ranges::move(frame_measurements(record), std::back_inserter(measurements));
    const auto is_held_out = [&](const Measurement& measurement) {
        return std::ranges::any_of(claim.held_out, [&](const CaseKey& key) { return matches(measurement.of, key); });
    };
    SplitMeasurements split;
    std::ranges::partition_copy(measurements, std::back_inserter(split.held_out), std::back_inserter(split.measured),
                                is_held_out);
    return split;
}

void judge_measured(const Records& records, Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    verdict.left_out = records.left_out;
    verdict.missing = missing_from(records);
    if (!verdict.missing.empty()) return;
    const SplitMeasurements split = split_measurements(claim, records);
    judge_values(split.measured, nullptr, verdict);
    if (selected(claim.own, claim.own.of, split.held_out).empty()) return;
    Verdict held_out{.claim = claim};
    judge_values(split.held_out, &verdict, held_out);
    verdict.held_out.push_back(std::move(held_out));
}

}  // namespace

Judged judged(const Claim& claim, const Selection& selection, const std::vector<Measurement>& measured)
{
    const Values own = selected(selection, selection.of, measured);
    const Values over = selected(selection, selection.over, measured);
    std::vector<JudgedCase> cases;
    std::vector<Values> values;       // of each case
    std::vector<Values> over_values;  // of each case: those by which its values are divided
    const auto place_of = [&](const JudgedCase& tested) {
        const auto same = std::ranges::find_if(cases, [&](const JudgedCase& other) { return other.is_same(tested); });
        return static_cast<std::size_t>(same - cases.begin());
    };
    for (const Measurement* measurement : own) {
        JudgedCase tested = case_of(claim, *measurement);
        const std::size_t place = place_of(tested);
        if (place == cases.size()) {
            cases.push_back(std::move(tested));
            values.emplace_back();
        }
        values[place].push_back(measurement);
    }
    over_values.resize(cases.size());
    for (const Measurement* measurement : over)
        if (const std::size_t place = place_of(case_of(claim, *measurement)); place < cases.size())
            over_values[place].push_back(measurement);
    for (auto* lists : {&values, &over_values})
        for (Values& values_of_case : *lists) drop_runs_beside(values_of_case);
    Judged result{.selection = selection};
    for (std::size_t i = 0; i < cases.size(); ++i)
        result.cases.push_back(whole_case(claim, selection, cases[i], values[i], over_values[i]));
    count(result);
    return result;
}

// Planned scenes without a record and without a reason for it, then planned runs without a record.
std::vector<std::string> missing_from(const Records& records)
{
    std::vector<std::string> missing;
    for (const std::string& scene : records.planned_scenes) {
        const bool recorded = std::ranges::count(records.cases, scene, &CaseRecord::scene) > 0;
        const bool left_out = std::ranges::count(records.left_out, scene, &LeftOut::scene) > 0;
        if (!recorded && !left_out) missing.push_back(scene);
    }
    missing.insert(missing.end(), records.missing_runs.begin(), records.missing_runs.end());
    return missing;
}

std::vector<Measurement> own_measurements(const Claim& claim, const Records& records)
{
    std::vector<Measurement> measured = split_measurements(claim, records).measured;
    const auto reads = [](const Selection& selection, const Measurement& measurement) {
        return is_selected(selection, selection.of, measurement) ||
               (selection.over != CaseKey{} && is_selected(selection, selection.over, measurement));
    };
    std::erase_if(measured, [&](const Measurement& measurement) {
        return !reads(claim.own, measurement) && std::ranges::none_of(claim.others, [&](const Selection& selection) {
            return reads(selection, measurement);
        });
    });
    return measured;
}

VerdictKind kind_on(const Claim& claim, const std::vector<Measurement>& measured,
                    const std::vector<Measurement>& otherwise)
{
    Verdict verdict{.claim = claim};
    verdict.own = judged(claim, claim.own, measured);
    for (const Selection& other : claim.others) {
        Judged judged_selection{.selection = other};
        if (other.role != Role::comparison) judged_selection = judged(claim, other, measured);
        if (other.role != Role::comparison && judged_selection.cases.empty() && other.name != claim.selected_by)
            judged_selection = judged(claim, other, otherwise);
        verdict.others.push_back(std::move(judged_selection));
    }
    decide(verdict);
    return verdict.kind;
}

Verdict judge(const Claim& claim, const Records& records)
{
    Verdict verdict{.claim = claim};
    if (claim.rule == ClaimRule::printed)
        judge_print(records.printed, verdict);
    else if (!claim.own.quantities.empty())
        judge_measured(records, verdict);
    if (claim.rule == ClaimRule::definition && verdict.missing.empty()) verdict.kind = VerdictKind::definition;
    if (claim.rule == ClaimRule::untestable && verdict.missing.empty()) verdict.kind = VerdictKind::untestable;
    return verdict;
}

const char* name_of(VerdictKind kind)
{
    static constexpr std::array names = {"holds",         "fails",      "mixed",      "not_shown",
                                         "inconclusive",  "untestable", "definition", "inconsistent_in_print",
                                         "not_computable"};
    return names[static_cast<std::size_t>(kind)];
}

const char* name_of(Inconclusive why)
{
    static constexpr std::array names = {"none", "too_few_cases", "control_without_record", "control_misbehaves",
                                         "chance"};
    return names[static_cast<std::size_t>(why)];
}

const char* name_of(Excluded why)
{
    static constexpr std::array names = {"no", "nothing_to_see", "no_control", "nothing_to_compare_with", "censored"};
    return names[static_cast<std::size_t>(why)];
}

}  // namespace analysis
