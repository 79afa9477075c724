#include "analysis/measured_verdict.hpp"

#include "analysis/measurement.hpp"
#include "analysis/verdict_texts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace analysis {
namespace {

std::vector<Measurement> of_quantities(const Claim& claim, const std::vector<std::string>& quantities, const Records& records)
{
    std::vector<Measurement> found;
    for (const std::string& quantity : quantities)
        for (const Measurement& measured : records.measurements)
            if (measured.claim == claim.id && measured.quantity == quantity) found.push_back(measured);
    return found;
}

struct Count {
    int within = 0, all = 0;
};

// What a character's figures say: by quantity how many there are and how many hold.
using Subject = std::map<std::string, Count>;

std::map<std::string, Subject> by_subject(const Verdict& verdict)
{
    std::map<std::string, Subject> subjects;
    for (const Measurement& measured : verdict.measurements) {
        Count& count = subjects[measured.of.substr(0, measured.of.find(','))][measured.quantity];
        ++count.all;
        count.within += extent_of(verdict.claim, measured) == Extent::whole;
    }
    return subjects;
}

Count sum_of(const Subject& subject)
{
    Count sum;
    for (const auto& [quantity, count] : subject) sum = {sum.within + count.within, sum.all + count.all};
    return sum;
}

// A claim of several quantities asks for all of them.
Extent extent_of(const Subject& subject)
{
    const auto some = [](const auto& entry) { return entry.second.within > 0; };
    if (sum_of(subject).within == sum_of(subject).all) return Extent::whole;
    return std::all_of(subject.begin(), subject.end(), some) ? Extent::part : Extent::none;
}

VerdictKind kind_of(const std::map<std::string, Subject>& subjects)
{
    const auto holds = [](Extent least) { return [least](const auto& entry) { return extent_of(entry.second) >= least; }; };
    if (std::all_of(subjects.begin(), subjects.end(), holds(Extent::whole))) return VerdictKind::reproduced;
    return std::any_of(subjects.begin(), subjects.end(), holds(Extent::part)) ? VerdictKind::reproduced_only_for
                                                                              : VerdictKind::not_reproduced;
}

// How far outside, in the bound's own size; what is not a number is farthest.
double distance_outside(const Claim& claim, const Measurement& measured)
{
    const QuantityBound bound = bound_of(claim, measured.quantity);
    if (std::isnan(measured.value)) return std::numeric_limits<double>::infinity();
    const double below = (bound.low - measured.value) / std::max(std::abs(bound.low), 1e-300);
    const double above = (measured.value - bound.high) / std::max(std::abs(bound.high), 1e-300);
    return std::max({0.0, below, above});
}

std::string farthest_text(const Verdict& verdict)
{
    const auto farther = [&](const Measurement& a, const Measurement& b) {
        return distance_outside(verdict.claim, a) < distance_outside(verdict.claim, b);
    };
    const Measurement& farthest = *std::max_element(verdict.measurements.begin(), verdict.measurements.end(), farther);
    return fmt::format("farthest: {} of {} is {}", farthest.quantity, farthest.of, figure_text(farthest));
}

// What stands beside, as ranges: a claim that holds may hold for less than it seems.
std::string beside_text(const Verdict& verdict)
{
    std::string text;
    for (const std::string& quantity : verdict.claim.beside) {
        std::vector<Measurement> all;
        for (const Measurement& measured : verdict.measured_beside)
            if (measured.quantity == quantity) all.push_back(measured);
        if (all.empty()) continue;
        const auto [least, most] = std::minmax_element(all.begin(), all.end(), [](auto& a, auto& b) { return a.value < b.value; });
        text += fmt::format("{}{} {} to {}", text.empty() ? "; beside it: " : ", ", quantity, figure_text(*least), figure_text(*most));
    }
    return text;
}

std::string text_of(const Verdict& verdict, const std::map<std::string, Subject>& subjects)
{
    std::vector<std::string> holding, failing;
    for (const auto& [name, subject] : subjects) {
        const Count count = sum_of(subject);
        if (extent_of(subject) == Extent::none)
            failing.push_back(name);
        else
            holding.push_back(count.within == count.all ? name : fmt::format("{} ({} of {} figures)", name, count.within, count.all));
    }
    if (verdict.kind == VerdictKind::reproduced)
        return fmt::format("{}: {}{}", label(verdict.kind), fmt::join(holding, ", "), beside_text(verdict));
    std::string text = label(verdict.kind);
    if (!holding.empty()) text += fmt::format(" {}", fmt::join(holding, ", "));
    if (!failing.empty()) text += fmt::format("{}{}", holding.empty() ? ": " : "; not for ", fmt::join(failing, ", "));
    return text + "; " + farthest_text(verdict);
}

}  // namespace

Verdict judge_measurements(const Claim& claim, const Records& records)
{
    Verdict verdict = verdict_of(claim, VerdictKind::not_computable, "");
    verdict.measurements = of_quantities(claim, claim.metrics, records);
    verdict.measured_beside = of_quantities(claim, claim.beside, records);
    if (!records.missing_runs.empty())
        return verdict_of(claim, VerdictKind::not_computable, fmt::format("no record of {}", fmt::join(records.missing_runs, ", ")));
    if (verdict.measurements.empty() && !records.left_out.empty())
        return verdict_of(claim, VerdictKind::cannot_be_tested_here, left_out_text(records.left_out));
    if (verdict.measurements.empty()) return verdict_of(claim, VerdictKind::not_computable, "nothing was measured");
    std::set<std::string> runs;
    std::size_t holding = 0;
    for (const Measurement& measured : verdict.measurements) {
        holding += extent_of(claim, measured) == Extent::whole;
        if (!measured.run.empty()) runs.insert(measured.run);
    }
    verdict.runs.assign(runs.begin(), runs.end());
    verdict.measured = fmt::format("{} of {} figures within", holding, verdict.measurements.size());
    const auto subjects = by_subject(verdict);
    verdict.kind = kind_of(subjects);
    verdict.text = verdict.summary = text_of(verdict, subjects);
    if (!records.left_out.empty()) verdict.text += "; left out: " + left_out_text(records.left_out);
    return verdict;
}

}  // namespace analysis
