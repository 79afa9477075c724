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
    Values found;
    for (const Measurement& measurement : measured)
        if (is_selected(selection, key, measurement)) found.push_back(&measurement);
    return found;
}

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
    const auto found = std::ranges::find_if(selection.thresholds, applies);
    return found == selection.thresholds.end() ? Threshold{} : *found;
}

// A censored value decides only where every value that it stands for does.
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

Values of_quantity(const Values& values, const std::string& quantity)
{
    Values found;
    std::ranges::copy_if(values, std::back_inserter(found),
                         [&](const Measurement* measurement) { return measurement->quantity == quantity; });
    return found;
}

// One quantity of a case, compared with its threshold.
JudgedCase compared(const Claim& claim, const Selection& selection, JudgedCase tested, const Values& values,
                    const Values& over)
{
    tested.value = mean_of(claim.mean, values);
    tested.low = tested.high = values.front()->value;
    bool has_least = false, has_most = false;  // of a mean with a number of each kind nothing is known
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

// Runs beside the study's own count only in cases of which no other run has values.
void drop_those_beside(Values& values)
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
        const Values own = of_quantity(values, quantity);
        JudgedCase part{.of = tested.of, .value = not_known, .low = not_known, .high = not_known};
        if (!own.empty()) part = compared(claim, selection, tested, own, of_quantity(over, quantity));
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

void count(Judged& judged)
{
    judged.held = judged.n = 0;
    for (const JudgedCase& tested : judged.cases) {
        judged.n += tested.counts();
        judged.held += tested.counts() && tested.holds;
    }
    const bool fails = judged.n > 0 && judged.share() <= failing_share,
               holds = judged.n > 0 && judged.share() >= holding_share;
    judged.behaves = judged.selection.role == Role::negative_control   ? fails
                     : judged.selection.role == Role::positive_control ? holds
                                                                       : true;
}

// A case in which the negative control does not fail shows nothing.
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

// The rule of succession, (k + 1) / (n + 2): a control that fails in each of a few cases does not show a share of
// exactly 0. The control by which cases are excluded fails in all that count.
double share_of_controls(const Verdict& verdict)
{
    if (verdict.claim.no_effect > 0.0) return verdict.claim.no_effect;
    double largest = 0.0;
    for (const Judged& other : verdict.others) {
        if (other.selection.role != Role::negative_control) continue;
        const bool decides = !verdict.claim.selected_by.empty() && other.selection.name == verdict.claim.selected_by;
        largest = std::max(largest, decides ? 1.0 / (verdict.own.n + 2.0) : (other.held + 1.0) / (other.n + 2.0));
    }
    return largest;
}

Interval interval_of(const Judged& own)
{
    std::vector<std::string> bodies;
    std::vector<bool> holds;
    for (const JudgedCase& tested : own.cases) {
        if (!tested.counts()) continue;
        bodies.push_back(tested.of.body);
        holds.push_back(tested.holds);
    }
    const Interval binomial = share_interval(own.held, own.n), bootstrap = bootstrap_share_of_groups(bodies, holds);
    return bootstrap.high - bootstrap.low > binomial.high - binomial.low ? bootstrap : binomial;
}

// Shares by the values of each field that a case has; a value with fewer than two cases says nothing.
std::optional<Difference> largest_difference(const Claim& claim, const Judged& own)
{
    std::optional<Difference> largest;
    for (const std::string& name : claim.case_fields) {
        const CaseKeyField* field = case_key_field(name);
        std::map<std::string, std::array<int, 2>> counts;  // held, all
        for (const JudgedCase& tested : own.cases) {
            if (!tested.counts() || (field && !field->is_set(tested.of))) continue;
            auto& [held, all] = counts[field ? value_text(*field, tested.of) : tested.quantity];
            held += tested.holds;
            ++all;
        }
        Difference found{.field = name, .least = 2.0, .most = -1.0};
        for (const auto& [value, of] : counts) {
            if (of[1] < 2) continue;
            const double share = double(of[0]) / of[1];
            if (share < found.least) found.least = share, found.least_at = value;
            if (share > found.most) found.most = share, found.most_at = value;
        }
        if (found.least_at != found.most_at && (!largest || found.most - found.least > largest->most - largest->least))
            largest = found;
    }
    return largest;
}

// The claim in each order and precision in which its values are recorded, where its own are named.
std::vector<Judged> readings_of(const Claim& claim, const std::vector<Measurement>& measured)
{
    std::vector<Judged> readings;
    if (claim.own.of.order.empty() && claim.own.of.precision.empty()) return readings;
    Selection any = claim.own;
    any.of.order = any.of.precision = "";
    std::set<std::pair<std::string, std::string>> found;
    for (const Measurement& measurement : measured)
        if (is_selected(any, any.of, measurement)) found.insert({measurement.of.order, measurement.of.precision});
    for (const auto& [order, precision] : found) {
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
    const auto unseen = std::ranges::find(verdict.others, claim.selected_by, [](const Judged& judged_selection) {
        return judged_selection.selection.name;
    });
    if (!claim.selected_by.empty()) {
        exclude_unseen(*unseen, verdict.own);
        unseen->behaves =
            unseen->n - unseen->held >= least_cases;  // it selects the cases, so that its share says nothing
        for (Judged& reading : verdict.readings) exclude_unseen(*unseen, reading);
        for (Judged& other : verdict.others)
            if (other.selection.role == Role::comparison) exclude_unseen(*unseen, other);
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

// One number, judged by its range.
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

// otherwise: the verdict whose control takes the place of one without cases; null: none does.
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

// The claim's values, and the held-out ones.
std::pair<std::vector<Measurement>, std::vector<Measurement>> measurements_of(const Claim& claim,
                                                                              const Records& records)
{
    std::vector<Measurement> measurements = records.measurements, measured, apart;
    for (const CaseRecord& record : records.cases)
        std::ranges::move(frame_measurements(record), std::back_inserter(measurements));
    std::ranges::partition_copy(
        measurements, std::back_inserter(apart), std::back_inserter(measured), [&](const Measurement& measurement) {
            return std::ranges::any_of(claim.held_out,
                                       [&](const CaseKey& key) { return matches(measurement.of, key); });
        });
    return {measured, apart};
}

void judge_measured(const Records& records, Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    verdict.left_out = records.left_out;
    verdict.missing = missing_from(records);
    if (!verdict.missing.empty()) return;
    const auto [measured, apart] = measurements_of(claim, records);
    judge_values(measured, nullptr, verdict);
    if (selected(claim.own, claim.own.of, apart).empty()) return;
    Verdict held_out{.claim = claim};
    judge_values(apart, &verdict, held_out);
    verdict.held_out.push_back(std::move(held_out));
}

}  // namespace

Judged judged(const Claim& claim, const Selection& selection, const std::vector<Measurement>& measured)
{
    const Values own = selected(selection, selection.of, measured),
                 over = selected(selection, selection.over, measured);
    std::vector<JudgedCase> cases;
    std::vector<Values> values, base;
    const auto place_of = [&](const JudgedCase& tested) {
        const auto found = std::ranges::find_if(cases, [&](const JudgedCase& other) { return other.is_same(tested); });
        return static_cast<std::size_t>(found - cases.begin());
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
    base.resize(cases.size());
    for (const Measurement* measurement : over)
        if (const std::size_t place = place_of(case_of(claim, *measurement)); place < cases.size())
            base[place].push_back(measurement);
    for (auto* lists : {&values, &base})
        for (Values& of_case : *lists) drop_those_beside(of_case);
    Judged result{.selection = selection};
    for (std::size_t i = 0; i < cases.size(); ++i)
        result.cases.push_back(whole_case(claim, selection, cases[i], values[i], base[i]));
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
    std::vector<Measurement> measured = measurements_of(claim, records).first;
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
