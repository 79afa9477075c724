// The readings of the paper (cases.toml): how much each changes the values that claims are judged by, and whether it
// turns a verdict round. A reading differs from the scene in one place, as keys of the scene. README.md describes the
// runs and records. Every value is measured by its claim's own study (Study::read), with two exceptions: C01 and C02
// take steps of the scene without the study's further deformers, and C10 takes a frame's processor time, where its
// study takes wall time.
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/headline.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/ambiguity/readings.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace experiments {

std::vector<Reading> readings_of(const StudyCase& study_case, const std::string& which)
{
    const nlohmann::json document = cases_document("ambiguity");
    std::vector<Reading> readings;
    const auto add = [&](const std::string& place, const std::string& name, const std::string& baseline,
                         const Overrides& overrides) {
        const Scene scene = study_case.scene(overrides);
        nlohmann::json settings = to_json(spec_of(scene, "pbs")).at("options");
        settings["weights"] = scene.resolved.at("skinning").at("weights");
        settings["time_step_s"] = scene.motion.time_step_s;
        readings.push_back({place, name, baseline, overrides, settings});
    };
    for (const nlohmann::json& place : document.at("place")) {
        if (which != "all" && (which == "of_motion") != place.value("motion", false)) continue;
        const std::string baseline = place.value("baseline", own_reading);
        const auto& baselines = document.at("baseline");
        const auto named =
            std::ranges::find_if(baselines, [&](const nlohmann::json& table) { return table.at("name") == baseline; });
        const Overrides common = named->at("overrides");
        if (std::ranges::find(readings, baseline, &Reading::name) == readings.end())
            add("", baseline, baseline, common);
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
            rule.contains("settings") &&
            std::ranges::all_of(differing, [&](const std::string& name) { return has("settings", name); });
        const bool lacks_the_cause =
            rule.contains("only") &&
            std::ranges::none_of(differing, [&](const std::string& name) { return has("only", name); });
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
        body = {"case_body", &analysis::CaseKey::body};
        body.group = body.name;
        return MEMBER_COLUMNS(ClaimChange, body, place, reading_a, reading_b, claim, quantity) +
               within(&ClaimChange::of, of_case) +
               MEMBER_COLUMNS(ClaimChange, unit, bound, a, b, change, b_over_a, holds_a, holds_b, verdict_flips,
                              reason);
    }();
    return columns;
}

namespace {

const JudgedValue* find(const JudgedReading& judged_reading, const JudgedValue& wanted)
{
    const auto found = std::ranges::find_if(judged_reading.values, [&](const JudgedValue& value) {
        return value.claim == wanted.claim && value.quantity == wanted.quantity && value.of == wanted.of;
    });
    return found == judged_reading.values.end() ? nullptr : &*found;
}

std::string why(const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    if (b_broke_down) return "B breaks down";
    if (!a || !b) return std::string(a ? "B" : "A") + " has no such value";
    const auto limit = [](const char* which, const JudgedValue& value) {
        return value.limit == analysis::Limit::none ? ""
                                                    : std::string(which) + ": " + analysis::recorded_name(value.limit);
    };
    const std::string of_a = limit("A", *a), of_b = limit("B", *b);
    return of_a + (of_a.empty() || of_b.empty() ? "" : "; ") + of_b;
}

std::string flips(const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    if (a && !b && b_broke_down) return a->holds ? "yes" : "no";
    if (!a || !b) return "no_value";
    return a->holds == b->holds ? "no" : "yes";
}

// Either may be null.
ClaimChange compared(ClaimChange row, const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    const JudgedValue* either = a ? a : b;
    if (!either) return row;
    row.quantity = either->quantity, row.of = either->of, row.unit = either->unit, row.bound = either->bound;
    if (a) row.a = a->value, row.holds_a = a->holds ? "yes" : "no";
    if (b) row.b = b->value, row.holds_b = b->holds ? "yes" : "no";
    if (a && b) row.change = b->value - a->value;
    if (a && b && a->value != 0.0) row.b_over_a = b->value / a->value;
    row.verdict_flips = flips(a, b, b_broke_down);
    row.reason = why(a, b, b_broke_down);
    return row;
}

ClaimChange without_value(ClaimChange row, const std::string& verdict_flips, const std::string& reason,
                          const std::string& quantity = "")
{
    row.quantity = quantity, row.verdict_flips = verdict_flips, row.reason = reason;
    return row;
}

ClaimChange row_of(const std::string& body, const std::string& claim, const Reading& reading)
{
    return {body, reading.place, reading.baseline, reading.name, claim};
}

// The values by each reading, measured by the study of the claims, which has `read`, or as above.
std::vector<JudgedReading> values_of(const Study& study, const StudyCase& study_case,
                                     const std::vector<Reading>& readings)
{
    std::vector<Overrides> overrides;
    for (const Reading& reading : readings) overrides.push_back(reading.overrides);
    if (!study.read) return values_of_frames(study_case, overrides);
    std::vector<JudgedReading> judged_readings;
    for (const ReadingValues& read : study.read(study_case, overrides))
        judged_readings.push_back({judged(read.values), read.broke_down, read.left_out});
    return judged_readings;
}

// Moves the body of a case by each reading in turn, and writes figures.csv.
std::string measure_volume(const StudyCase& study_case, ReadingComparison& comparison, const std::string& folder)
{
    const Scene scene = study_case.scene();
    const pbs::Character character = pbs::make_character(scene.character);
    const std::vector<bool> zone = pbs::jiggle_zone(character.binding);
    if (scene.motion.clip.empty()) comparison.without_jiggle = "a sweep has no speed of its own";
    std::map<std::string, ReadMotion> moved;
    std::vector<VolumeChange> volumes;
    std::string breakdown;
    for (const Reading& reading : comparison.readings) {
        if (reading.jiggles() && !comparison.without_jiggle.empty()) continue;
        Scene read = study_case.scene(reading.overrides);
        read.name = study_case.name;
        const ReadMotion& b = moved.emplace(reading.name, move(reweighted(character, read), read)).first->second;
        if (!b.finite) breakdown += reading.name + " is not finite. ";
        if (!reading.place.empty())
            std::ranges::copy(
                volume_changes(study_case.name, reading, moved.at(reading.baseline), b, moved.at(own_reading), zone),
                std::back_inserter(volumes));
    }
    comparison.measure(study_case.value<std::vector<std::string>>("claims"), [&](const std::vector<Reading>& readings) {
        std::vector<JudgedReading> judged_readings;
        for (const Reading& reading : readings) {
            const ReadMotion& of_reading = moved.at(reading.name);
            std::vector<analysis::Measurement> measured = frame_measurements(of_reading.pbs);
            std::ranges::move(frame_measurements(of_reading.lbs), std::back_inserter(measured));
            judged_readings.push_back({judged(measured), !of_reading.finite});
        }
        return judged_readings;
    });
    table_of(volume_change_columns, volumes).write(analysis::path_in(folder, "figures.csv"));
    return breakdown;
}

// Claims of one study are measured together.
std::string measure_claims(const StudyCase& study_case, ReadingComparison& comparison)
{
    const auto claims = study_case.value<std::vector<std::string>>("claims");
    for (const Study& study : studies()) {
        std::vector<std::string> own;
        std::ranges::copy_if(claims, std::back_inserter(own),
                             [&](const std::string& id) { return claim_named(id).study == study.name; });
        if (!own.empty())
            comparison.measure(
                own, [&](const std::vector<Reading>& touching) { return values_of(study, study_case, touching); });
    }
    return comparison.breakdown;
}

// A run repeats when its case, a reading or a bound of its claims changes.
nlohmann::json settings_of(const StudyCase& study_case, const std::vector<Reading>& readings)
{
    std::vector<analysis::Claim> judging;
    for (const std::string& claim : study_case.value<std::vector<std::string>>("claims"))
        judging.push_back(claim_named(claim));
    nlohmann::json recorded = nlohmann::json::array();
    for (const Reading& reading : readings)
        recorded.push_back({{"name", reading.name}, {"baseline", reading.baseline}, {"settings", reading.settings}});
    return {{"case", study_case.values()},
            {"scene", to_json(study_case.scene())},
            {"readings", recorded},
            {"bounds", digest_of(judging)}};
}

StudyPlan plan(bool full)
{
    return plan_of_cases("ambiguity", full, [](const StudyCase& study_case, StudyPlan& plan) {
        const bool is_moved = study_case.has("readings");
        const std::vector<Reading> readings = readings_of(study_case, study_case.value<std::string>("readings", "all"));
        StudyRun run{.name = study_case.name, .cost_s = study_case.cost_s};
        run.settings = settings_of(study_case, readings);
        run.work = [=](const std::string& folder) {
            ReadingComparison comparison{study_case.value<std::string>("body"), readings};
            const std::string breakdown =
                is_moved ? measure_volume(study_case, comparison, folder) : measure_claims(study_case, comparison);
            table_of(used_columns(claim_change_columns(), comparison.changes), comparison.changes)
                .write(analysis::path_in(folder, "ambiguity.csv"));
            return breakdown;
        };
        plan.runs.push_back(run);
    });
}

bool conclude(const FinishedRuns& finished)
{
    const auto changes = finished.rows(claim_change_columns(), "ambiguity.csv");
    finished.write("ambiguity.csv", used_columns(claim_change_columns(), changes), changes);
    finished.write("figures.csv", volume_change_columns, finished.rows(volume_change_columns, "figures.csv"));
    return true;
}

}  // namespace

std::vector<ClaimChange> claim_changes(const std::string& body, const std::string& claim, const Reading& reading,
                                       const JudgedReading& a, const JudgedReading& b)
{
    const ClaimChange row = row_of(body, claim, reading);
    std::vector<ClaimChange> changes;
    for (const JudgedValue& of_a : a.values)
        if (of_a.claim == claim) changes.push_back(compared(row, &of_a, find(b, of_a), b.broke_down));
    for (const JudgedValue& of_b : b.values)
        if (of_b.claim == claim && !find(a, of_b)) changes.push_back(compared(row, nullptr, &of_b, b.broke_down));
    for (const ReadingValues::LeftOut& left_out : b.left_out)
        if (left_out.claim == claim)
            changes.push_back(without_value(row, "no_value", left_out.reason, left_out.quantity));
    if (changes.empty())
        changes.push_back(
            without_value(row, "no_value", b.broke_down ? "B breaks down" : "neither reading has a value"));
    return changes;
}

ClaimChange untouched_claim(const std::string& body, const std::string& claim, const Reading& reading,
                            const std::string& reason)
{
    return without_value(row_of(body, claim, reading), "not_touched", reason);
}

void ReadingComparison::measure(const std::vector<std::string>& claims, const Measure& measure)
{
    struct Pair {
        const Reading &reading, &baseline;
        std::string claim, untouched_because;
    };
    std::vector<Pair> pairs;
    std::vector<Reading> measured;
    for (const Reading& reading : readings) {
        if (reading.place.empty()) continue;
        const Reading& baseline = *std::ranges::find(readings, reading.baseline, &Reading::name);
        const bool is_left_out = reading.jiggles() && !without_jiggle.empty();
        for (const std::string& claim : claims) {
            pairs.push_back(
                {reading, baseline, claim, is_left_out ? without_jiggle : untouched_because(claim, reading, baseline)});
            if (!pairs.back().untouched_because.empty()) continue;
            for (const Reading* compared_reading : {&baseline, &reading})
                if (std::ranges::find(measured, compared_reading->name, &Reading::name) == measured.end())
                    measured.push_back(*compared_reading);
        }
    }
    const std::vector<JudgedReading> values = measure(measured);
    std::map<std::string, const JudgedReading*> by_name;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        by_name[measured[i].name] = &values.at(i);
        if (values[i].broke_down) breakdown += fmt::format("{} ({}). ", measured[i].name, fmt::join(claims, ", "));
    }
    for (const auto& [reading, baseline, claim, reason] : pairs)
        if (reason.empty())
            std::ranges::copy(
                claim_changes(body, claim, reading, *by_name.at(baseline.name), *by_name.at(reading.name)),
                std::back_inserter(changes));
        else
            changes.push_back(untouched_claim(body, claim, reading, reason));
}

std::string digest_of(const std::vector<analysis::Claim>& claims)
{
    nlohmann::json table = nlohmann::json::array();
    for (const analysis::Claim& claim : claims) {
        table.push_back({claim.id, static_cast<int>(claim.rule), claim.own.quantities, to_json_of(claim.own.of),
                         to_json_of(claim.own.over), claim.case_fields, static_cast<int>(claim.mean)});
        for (const analysis::Threshold& threshold : claim.own.thresholds)
            table.push_back({threshold.quantity, threshold.low, threshold.high, to_json_of(threshold.of)});
    }
    return pbs::content_hash(table.dump());
}

std::vector<JudgedValue> judged(const std::vector<analysis::Measurement>& measured)
{
    std::vector<JudgedValue> values;
    for (const analysis::Claim& claim : claims())
        for (const std::string& quantity : claim.own.quantities) {
            analysis::Selection own = claim.own;
            own.quantities = {quantity};
            own.of.order = own.of.precision = own.of.variant = own.of.masses = "";  // a reading sets what it is
            own.of.iterations.reset();
            if (own.of.deformer.starts_with("pbs")) own.of.deformer = "pbs";
            for (const analysis::JudgedCase& judged_case : analysis::judged(claim, own, measured).cases)
                values.push_back({claim.id, quantity, judged_case.of, judged_case.unit,
                                  threshold_text(judged_case.threshold), judged_case.value, judged_case.holds,
                                  judged_case.limit});
        }
    return values;
}

Study ambiguity_study()
{
    return {"ambiguity", plan, quick_and_full, conclude};
}

}  // namespace experiments
