#include "experiments/studies/ambiguity/claim_changes.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/character/body_cache.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace experiments {

std::vector<Reading> readings_of(const StudyCase& of, const std::string& which)
{
    const nlohmann::json document = cases_document("ambiguity");
    std::vector<Reading> readings;
    const auto add = [&](const std::string& place, const std::string& name, const std::string& baseline, const Overrides& overrides) {
        const Scene scene = of.scene(overrides);
        nlohmann::json settings = to_json(spec_of(scene, "pbs")).at("options");
        settings["weights"] = scene.resolved.at("skinning").at("weights");
        settings["time_step_s"] = scene.motion.time_step_s;
        readings.push_back({place, name, baseline, overrides, settings});
    };
    for (const nlohmann::json& place : document.at("place")) {
        if (which != "all" && (which == "of_motion") != place.value("motion", false)) continue;
        const std::string baseline = place.value("baseline", own_reading);
        const auto& baselines = document.at("baseline");
        const auto named = std::ranges::find_if(baselines, [&](const nlohmann::json& one) { return one.at("name") == baseline; });
        const Overrides common = named->at("overrides");
        if (std::ranges::find(readings, baseline, &Reading::name) == readings.end()) add("", baseline, baseline, common);
        for (const Overrides reading : place.at("readings")) {
            Overrides overrides = common;
            overrides.insert(overrides.end(), reading.begin() + 1, reading.end());
            add(place.at("name"), reading.front(), baseline, overrides);
        }
    }
    return readings;
}

std::string untouched_because(const std::string& claim, const Reading& reading, const Reading& baseline)
{
    const std::vector<std::string> differing = differing_paths(reading.settings, baseline.settings);
    if (differing.empty()) return "the scene is so by itself";
    const nlohmann::json document = cases_document("ambiguity");
    for (const nlohmann::json& rule : document.at("untouched")) {
        const auto has = [&](const char* key, const std::string& name) {
            return std::ranges::count(rule.value(key, std::vector<std::string>{}), name) > 0;
        };
        if (!has("claims", claim)) continue;
        if (has("unless", reading.name)) return "";
        const bool by_jiggle = rule.value("jiggling", false) && reading.jiggles();
        const bool has_no_effect =
            rule.contains("settings") && std::ranges::all_of(differing, [&](const std::string& name) { return has("settings", name); });
        const bool lacks_the_cause =
            rule.contains("only") && std::ranges::none_of(differing, [&](const std::string& name) { return has("only", name); });
        if (by_jiggle || has_no_effect || lacks_the_cause) return rule.at("reason");
    }
    return "";
}

const analysis::Columns<ClaimChange>& claim_change_columns()
{
    using Changes = analysis::Columns<ClaimChange>;
    static const Changes columns = [] {
        analysis::Columns<analysis::CaseKey> of_case = analysis::case_key_columns();
        auto& body = *std::ranges::find(of_case, "body", &analysis::Column<analysis::CaseKey>::name);
        body = {"case_body", &analysis::CaseKey::body, "", "body of the value's case, or its scene"};
        body.group = body.name;
        return Changes{{"body", &ClaimChange::body, "", "name of the body"},
                       {"place", &ClaimChange::place, "", "place of the paper that can be read in two ways"},
                       {"reading_a", &ClaimChange::reading_a, "", "the baseline"},
                       {"reading_b", &ClaimChange::reading_b, "", "the other reading"},
                       {"claim", &ClaimChange::claim, "", "id of the claim"},
                       {"quantity", &ClaimChange::quantity, "", "quantity that the claim is judged by"}} +
               within(&ClaimChange::of, of_case) +
               Changes{{"unit", &ClaimChange::unit, "", "unit of a, b and change"},
                       {"bound", &ClaimChange::bound, "", "the claim's bound, in words"},
                       {"a", &ClaimChange::a, "", "value by reading A"},
                       {"b", &ClaimChange::b, "", "value by reading B"},
                       {"change", &ClaimChange::change, "", "b less a"},
                       {"b_over_a", &ClaimChange::b_over_a, "", "b over a"},
                       {"holds_a", &ClaimChange::holds_a, "", "extent to which a lies within the bound: whole, part, none"},
                       {"holds_b", &ClaimChange::holds_b, "", "extent to which b lies within the bound"},
                       {"verdict_flips", &ClaimChange::verdict_flips, "", "yes, no, not_touched or no_value"},
                       {"reason", &ClaimChange::reason, "", "why there is no value, or why it is only a limit, in words"}};
    }();
    return columns;
}

namespace {

const JudgedValue* find(const JudgedReading& of, const JudgedValue& wanted)
{
    const auto found = std::ranges::find_if(of.values, [&](const JudgedValue& one) {
        return one.claim == wanted.claim && one.quantity == wanted.quantity && one.of == wanted.of;
    });
    return found == of.values.end() ? nullptr : &*found;
}

std::string why(const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    if (b_broke_down) return "B breaks down";
    if (!a || !b) return std::string(a ? "B" : "A") + " has no such value";
    const auto limit = [](const char* which, const JudgedValue& of) {
        return of.limit == analysis::Limit::none ? "" : std::string(which) + ": " + analysis::recorded_name(of.limit);
    };
    const std::string of_a = limit("A", *a), of_b = limit("B", *b);
    return of_a + (of_a.empty() || of_b.empty() ? "" : "; ") + of_b;
}

std::string flips(const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    if (a && !b && b_broke_down) return a->extent == analysis::Extent::none ? "no" : "yes";
    if (!a || !b) return "no_value";
    return a->extent == b->extent ? "no" : "yes";
}

ClaimChange named(ClaimChange row, const JudgedValue& one)
{
    row.quantity = one.quantity, row.of = one.of, row.unit = one.unit, row.bound = one.bound;
    return row;
}

// row: named by one of them. Either may be null.
ClaimChange compared(ClaimChange row, const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    if (a) row.a = a->value, row.holds_a = analysis::name_of(a->extent);
    if (b) row.b = b->value, row.holds_b = analysis::name_of(b->extent);
    if (a && b) row.change = b->value - a->value;
    if (a && b && a->value != 0.0) row.b_over_a = b->value / a->value;
    row.verdict_flips = flips(a, b, b_broke_down);
    row.reason = why(a, b, b_broke_down);
    return row;
}

ClaimChange without_value(ClaimChange row, const std::string& verdict_flips, const std::string& reason, const std::string& quantity = "")
{
    row.quantity = quantity, row.verdict_flips = verdict_flips, row.reason = reason;
    return row;
}

ClaimChange row_of(const std::string& body, const std::string& claim, const Reading& reading)
{
    return {body, reading.place, reading.baseline, reading.name, claim};
}

}  // namespace

std::vector<ClaimChange> claim_changes(const std::string& body, const std::string& claim, const Reading& reading, const JudgedReading& a,
                                       const JudgedReading& b)
{
    const ClaimChange row = row_of(body, claim, reading);
    std::vector<ClaimChange> changes;
    for (const JudgedValue& of_a : a.values)
        if (of_a.claim == claim) changes.push_back(compared(named(row, of_a), &of_a, find(b, of_a), b.broke_down));
    for (const JudgedValue& of_b : b.values)
        if (of_b.claim == claim && !find(a, of_b)) changes.push_back(compared(named(row, of_b), nullptr, &of_b, b.broke_down));
    for (const ReadingValues::LeftOut& one : b.left_out)
        if (one.claim == claim) changes.push_back(without_value(row, "no_value", one.reason, one.quantity));
    if (changes.empty()) changes.push_back(without_value(row, "no_value", b.broke_down ? "B breaks down" : "neither reading has a value"));
    return changes;
}

ClaimChange untouched_claim(const std::string& body, const std::string& claim, const Reading& reading, const std::string& reason)
{
    return without_value(row_of(body, claim, reading), "not_touched", reason);
}

const Reading& ReadingComparison::baseline_of(const Reading& reading) const
{
    return *std::ranges::find(readings_, reading.baseline, &Reading::name);
}

void ReadingComparison::measure(const std::vector<std::string>& claims, const Measure& measure)
{
    std::vector<Reading> measured;
    const auto add = [&](const Reading& reading) {
        if (std::ranges::find(measured, reading.name, &Reading::name) == measured.end()) measured.push_back(reading);
    };
    for (const Reading& reading : readings_)
        for (const std::string& claim : claims) {
            if (reading.place.empty() || !untouched_because(claim, reading, baseline_of(reading)).empty()) continue;
            add(baseline_of(reading));
            add(reading);
        }
    const std::vector<JudgedReading> values = measure(measured);
    std::map<std::string, const JudgedReading*> by_name;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        by_name[measured[i].name] = &values.at(i);
        if (values[i].broke_down) breakdown_ += fmt::format("{} ({}). ", measured[i].name, fmt::join(claims, ", "));
    }
    for (const Reading& reading : readings_)
        for (const std::string& claim : claims) {
            if (reading.place.empty()) continue;
            const std::string reason = untouched_because(claim, reading, baseline_of(reading));
            if (reason.empty())
                std::ranges::copy(claim_changes(body_, claim, reading, *by_name.at(reading.baseline), *by_name.at(reading.name)),
                                  std::back_inserter(changes_));
            else
                changes_.push_back(untouched_claim(body_, claim, reading, reason));
        }
}

std::string digest_of(const std::vector<analysis::Claim>& claims)
{
    nlohmann::json all = nlohmann::json::array();
    for (const analysis::Claim& claim : claims) {
        all.push_back({claim.id, static_cast<int>(claim.rule), claim.metrics, claim.deformer, claim.iterations, claim.low, claim.high,
                       claim.share, claim.part, claim.level});
        for (const analysis::QuantityBound& bound : claim.bounds) all.push_back({bound.quantity, bound.low, bound.high});
    }
    return pbs::content_hash(all.dump());
}

std::vector<JudgedValue> judged(const std::vector<analysis::Measurement>& measured)
{
    std::vector<JudgedValue> values;
    for (const analysis::Measurement& one : measured) {
        const analysis::Claim& claim = claim_named(one.claim);
        if (!analysis::is_judged(claim, one)) continue;
        values.push_back({one.claim, one.quantity, one.of, one.unit, analysis::bound_text(analysis::bound_of(claim, one.quantity)),
                          one.value, analysis::extent_of(claim, one), one.limit});
    }
    return values;
}

}  // namespace experiments
