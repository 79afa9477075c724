#include "analysis/verdicts/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace analysis {
namespace {

bool is_selected(const Selection& selection, const CaseKey& of, const Measurement& measured)
{
    return std::ranges::count(selection.quantities, measured.quantity) > 0 && matches(measured.of, of);
}

std::vector<Measurement> selected(const Selection& selection, const CaseKey& of, const std::vector<Measurement>& measured)
{
    std::vector<Measurement> found;
    std::ranges::copy_if(measured, std::back_inserter(found), [&](const Measurement& one) { return is_selected(selection, of, one); });
    return found;
}

Unit unit_of(const Claim& claim, const Measurement& measured)
{
    Unit unit;
    for (const std::string& name : claim.unit) {
        const CaseKeyField* field = case_key_field(name);
        if (!field)
            unit.quantity = measured.quantity;
        else if (field->text)
            unit.of.*field->text = measured.of.*field->text;
        else
            unit.of.*field->number = measured.of.*field->number;
    }
    return unit;
}

double mean_of(Mean mean_kind, const std::vector<double>& values)
{
    if (mean_kind == Mean::arithmetic) return mean(values);
    if (std::ranges::count(values, 0.0) > 0) return std::ranges::all_of(values, [](double one) { return one >= 0.0; }) ? 0.0 : not_known;
    std::vector<double> logarithms;
    for (const double value : values) logarithms.push_back(std::log(value));  // NaN for a value below 0, as for one that is not known
    return std::exp(mean(logarithms));
}

Bound bound_of(const Selection& selection, const std::string& quantity, const CaseKey& of)
{
    const auto applies = [&](const Bound& bound) {
        return (bound.quantity.empty() || bound.quantity == quantity) && matches(of, bound.of);
    };
    const auto found = std::ranges::find_if(selection.bounds, applies);
    return found == selection.bounds.end() ? Bound{} : *found;
}

// A censored value decides only where every value that it stands for does.
bool is_undecided(const Unit& unit)
{
    if (unit.limit == Limit::none) return false;
    const bool above = unit.limit == Limit::at_least || unit.limit == Limit::more_than;
    if (!unit.bound.contains(unit.value)) return above ? unit.value < unit.bound.low : unit.value > unit.bound.high;
    return std::isfinite(above ? unit.bound.high : unit.bound.low);
}

using Values = std::vector<const Measurement*>;

double mean_of(Mean mean_kind, const Values& values)
{
    std::vector<double> numbers;
    for (const Measurement* one : values) numbers.push_back(one->value);
    return mean_of(mean_kind, numbers);
}

Values of_quantity(const Values& values, const std::string& quantity)
{
    Values found;
    std::ranges::copy_if(values, std::back_inserter(found), [&](const Measurement* one) { return one->quantity == quantity; });
    return found;
}

// One quantity of a unit, compared with its bound.
Unit compared(const Claim& claim, const Selection& selection, Unit unit, const Values& values, const Values& over)
{
    unit.value = mean_of(claim.mean, values);
    unit.low = unit.high = values.front()->value;
    bool has_least = false, has_most = false;  // of a mean with a number of each kind nothing is known
    for (const Measurement* one : values) {
        unit.low = std::min({unit.low, one->value, one->low});
        unit.high = std::max({unit.high, one->value, one->high});
        if (one->limit == Limit::none) continue;
        unit.limit = one->limit;
        (one->limit == Limit::at_most ? has_most : has_least) = true;
    }
    unit.n = static_cast<int>(values.size());
    unit.unit = values.front()->unit;
    unit.bound = bound_of(selection, values.front()->quantity, unit.of);
    if (selection.over != CaseKey{}) {
        const double base = over.empty() ? not_known : mean_of(claim.mean, over);
        if (!(std::isfinite(base) && base != 0.0)) {
            unit.left_out = LeftOutUnit::nothing_to_compare_with;
            return unit;
        }
        unit.value /= base;
        unit.low /= base;
        unit.high /= base;
    }
    unit.holds = unit.bound.contains(unit.value);
    if (is_undecided(unit) || (has_least && has_most)) unit.left_out = LeftOutUnit::censored;
    return unit;
}

// Runs beside the study's own count only in units of which no other run has values.
void drop_those_beside(Values& values)
{
    if (std::ranges::any_of(values, [](const Measurement* one) { return !one->beside; }))
        std::erase_if(values, [](const Measurement* one) { return one->beside; });
}

// A unit without one of the quantities does not hold, since nothing shows that it does.
Unit judged_unit(const Claim& claim, const Selection& selection, const Unit& unit, const Values& values, const Values& over)
{
    if (!unit.quantity.empty()) return compared(claim, selection, unit, values, over);
    std::vector<Unit> parts;
    for (const std::string& quantity : selection.quantities) {
        const Values own = of_quantity(values, quantity);
        Unit part{.of = unit.of, .value = not_known, .low = not_known, .high = not_known};
        if (!own.empty()) part = compared(claim, selection, unit, own, of_quantity(over, quantity));
        part.quantity = quantity;
        parts.push_back(part);
    }
    Unit all = parts.front();
    all.quantity = "";
    all.holds = std::ranges::all_of(parts, &Unit::holds);
    for (const Unit& part : parts)
        if (all.counts()) all.left_out = part.left_out;
    if (parts.size() > 1) all.parts = std::move(parts);
    return all;
}

void count(Judged& judged)
{
    judged.held = judged.n = 0;
    for (const Unit& unit : judged.units) {
        judged.n += unit.counts();
        judged.held += unit.counts() && unit.holds;
    }
    const bool fails = judged.n > 0 && judged.share() <= failing_share, holds = judged.n > 0 && judged.share() >= holding_share;
    judged.behaves = judged.selection.role == Role::must_fail ? fails : judged.selection.role == Role::must_hold ? holds : true;
}

// A unit in which the method that must fail does not fail shows nothing.
void leave_out_unseen(const Judged& control, Judged& own)
{
    for (Unit& unit : own.units) {
        const auto same = std::ranges::find_if(control.units, [&](const Unit& one) { return one.is_same(unit); });
        if (same == control.units.end() || !same->counts())
            unit.left_out = LeftOutUnit::no_control;
        else if (same->holds)
            unit.left_out = LeftOutUnit::nothing_to_see;
    }
    count(own);
}

// The rule of succession, (k + 1) / (n + 2): a control that fails in each of a few units does not show a share of exactly 0. The control
// by which units are left out fails in all that count.
double share_of_controls(const Verdict& verdict)
{
    if (verdict.claim.no_effect > 0.0) return verdict.claim.no_effect;
    double largest = 0.0;
    for (const Judged& other : verdict.others) {
        if (other.selection.role != Role::must_fail) continue;
        const bool decides = !verdict.claim.unseen_by.empty() && other.selection.name == verdict.claim.unseen_by;
        largest = std::max(largest, decides ? 1.0 / (verdict.own.n + 2.0) : (other.held + 1.0) / (other.n + 2.0));
    }
    return largest;
}

Interval interval_of(const Judged& own)
{
    std::vector<std::string> bodies;
    std::vector<bool> holds;
    for (const Unit& unit : own.units) {
        if (!unit.counts()) continue;
        bodies.push_back(unit.of.body);
        holds.push_back(unit.holds);
    }
    const Interval binomial = share_interval(own.held, own.n), bootstrap = bootstrap_share_of_groups(bodies, holds);
    return bootstrap.high - bootstrap.low > binomial.high - binomial.low ? bootstrap : binomial;
}

// Shares by the values of each field that a unit has; a value with fewer than two units says nothing.
std::optional<Difference> largest_difference(const Claim& claim, const Judged& own)
{
    std::optional<Difference> largest;
    for (const std::string& name : claim.unit) {
        const CaseKeyField* field = case_key_field(name);
        std::map<std::string, std::array<int, 2>> counts;  // held, all
        for (const Unit& unit : own.units) {
            if (!unit.counts() || (field && !field->is_set(unit.of))) continue;
            auto& [held, all] = counts[field ? value_text(*field, unit.of) : unit.quantity];
            held += unit.holds;
            ++all;
        }
        Difference found{.field = name, .least = 2.0, .most = -1.0};
        for (const auto& [value, of] : counts) {
            if (of[1] < 2) continue;
            const double share = double(of[0]) / of[1];
            if (share < found.least) found.least = share, found.least_at = value;
            if (share > found.most) found.most = share, found.most_at = value;
        }
        if (found.least_at != found.most_at && (!largest || found.most - found.least > largest->most - largest->least)) largest = found;
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
    for (const Measurement& one : measured)
        if (is_selected(any, any.of, one)) found.insert({one.of.order, one.of.precision});
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
        if (!other.behaves) return other.n == 0 ? Inconclusive::control_without_record : Inconclusive::control_misbehaves;
    if (verdict.own.n < least_units) return Inconclusive::too_few_units;
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

void judge_units(Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    const auto unseen = std::ranges::find(verdict.others, claim.unseen_by, [](const Judged& one) { return one.selection.name; });
    if (!claim.unseen_by.empty()) {
        leave_out_unseen(*unseen, verdict.own);
        unseen->behaves = unseen->n - unseen->held >= least_units;  // it selects the units, so that its share says nothing
        for (Judged& reading : verdict.readings) leave_out_unseen(*unseen, reading);
        for (Judged& other : verdict.others)
            if (other.selection.role == Role::comparison) leave_out_unseen(*unseen, other);
    }
    verdict.q = share_of_controls(verdict);
    if (verdict.own.n > 0) {
        verdict.by_chance = binomial_tail(verdict.own.held, verdict.own.n, verdict.q);
        verdict.interval = interval_of(verdict.own);
    }
    verdict.inconclusive = why_inconclusive(verdict);
    verdict.kind = kind_of(verdict);
    if (verdict.kind == VerdictKind::mixed) verdict.differs = largest_difference(claim, verdict.own);
}

// One number, judged by its range.
void judge_single(Verdict& verdict)
{
    if (verdict.own.units.size() != 1) {
        verdict.kind = VerdictKind::inconclusive;
        verdict.inconclusive = Inconclusive::too_few_units;
        return;
    }
    const Unit& only = verdict.own.units.front();
    const bool inside = only.bound.contains(only.low) && only.bound.contains(only.high);
    const bool outside = only.high < only.bound.low || only.low > only.bound.high || std::isnan(only.value);
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

// otherwise: the verdict whose control takes the place of one without units; null: none does.
void judge_values(const std::vector<Measurement>& measured, const Verdict* otherwise, Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    verdict.own = judged(claim, claim.own, measured);
    for (std::size_t i = 0; i < claim.others.size(); ++i) {
        Judged other = judged(claim, claim.others[i], measured);
        const bool is_control = other.selection.role != Role::comparison && claim.others[i].name != claim.unseen_by;
        verdict.others.push_back(other.units.empty() && is_control && otherwise ? otherwise->others[i] : std::move(other));
    }
    verdict.readings = readings_of(claim, measured);
    std::set<std::string> runs;
    for (const Measurement& one : selected(claim.own, claim.own.of, measured))
        if (!one.run.empty()) runs.insert(one.run);
    verdict.runs.assign(runs.begin(), runs.end());
    if (claim.rule == ClaimRule::single)
        judge_single(verdict);
    else if (claim.rule == ClaimRule::units)
        judge_units(verdict);
}

void judge_measured(const Records& records, Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    verdict.left_out = records.left_out;
    verdict.missing = missing_from(records);
    if (!verdict.missing.empty()) return;
    std::vector<Measurement> all = records.measurements, measured, apart;
    for (const CaseRecord& record : records.cases) std::ranges::move(frame_measurements(record), std::back_inserter(all));
    std::ranges::partition_copy(all, std::back_inserter(apart), std::back_inserter(measured), [&](const Measurement& one) {
        return std::ranges::any_of(claim.confirmatory, [&](const CaseKey& key) { return matches(one.of, key); });
    });
    judge_values(measured, nullptr, verdict);
    if (selected(claim.own, claim.own.of, apart).empty()) return;
    Verdict confirmatory{.claim = claim};
    judge_values(apart, &verdict, confirmatory);
    verdict.confirmatory.push_back(std::move(confirmatory));
}

}  // namespace

Judged judged(const Claim& claim, const Selection& selection, const std::vector<Measurement>& measured)
{
    const std::vector<Measurement> own = selected(selection, selection.of, measured), over = selected(selection, selection.over, measured);
    std::vector<Unit> units;
    std::vector<Values> values, base;
    const auto place_of = [&](const Measurement& one) {
        const Unit unit = unit_of(claim, one);
        return std::ranges::find_if(units, [&](const Unit& other) { return other.is_same(unit); }) - units.begin();
    };
    for (const Measurement& one : own) {
        const auto place = static_cast<std::size_t>(place_of(one));
        if (place == units.size()) {
            units.push_back(unit_of(claim, one));
            values.emplace_back();
        }
        values[place].push_back(&one);
    }
    base.resize(units.size());
    for (const Measurement& one : over)
        if (const auto place = static_cast<std::size_t>(place_of(one)); place < units.size()) base[place].push_back(&one);
    for (auto* lists : {&values, &base})
        for (Values& of_unit : *lists) drop_those_beside(of_unit);
    Judged result{.selection = selection};
    for (std::size_t i = 0; i < units.size(); ++i) result.units.push_back(judged_unit(claim, selection, units[i], values[i], base[i]));
    count(result);
    return result;
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
    static constexpr std::array names = {
        "holds", "fails", "mixed", "not_shown", "inconclusive", "untestable", "definition", "inconsistent_in_print", "not_computable"};
    return names[static_cast<std::size_t>(kind)];
}

const char* name_of(Inconclusive why)
{
    static constexpr std::array names = {"none", "too_few_units", "control_without_record", "control_misbehaves", "chance"};
    return names[static_cast<std::size_t>(why)];
}

const char* name_of(LeftOutUnit why)
{
    static constexpr std::array names = {"no", "nothing_to_see", "no_control", "nothing_to_compare_with", "censored"};
    return names[static_cast<std::size_t>(why)];
}

}  // namespace analysis
