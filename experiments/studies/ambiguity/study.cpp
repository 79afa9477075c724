// The readings of the paper (cases.toml): how much does each change the values by which claims are judged, and does a
// verdict flip? A reading is a set of keys of a scene. The studies of the claims measure their cases once with each of
// these sets, and the values are compared with those of the baseline. README.md describes the runs and records.
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/headline.hpp"
#include "experiments/run/run.hpp"
#include "experiments/studies/ambiguity/readings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace experiments {

std::vector<Reading> readings_of(const StudyCase& study_case)
{
    const nlohmann::json document = cases_document("ambiguity");
    const auto without = study_case.value<std::vector<std::string>>("without", {});
    const auto is_left_out = [&](const nlohmann::json& table) {
        return std::ranges::count(without, table.at("name").get<std::string>()) > 0;
    };
    std::vector<Reading> readings;
    for (const nlohmann::json& baseline : document.at("baseline")) {
        if (is_left_out(baseline)) continue;
        const std::string of_baseline = baseline.at("name");
        readings.push_back({"", of_baseline, of_baseline, baseline.at("overrides")});
        for (const nlohmann::json& place : document.at("place")) {
            if (is_left_out(place) || place.value("baseline", "as_the_scene") != of_baseline) continue;
            for (const Overrides reading : place.at("readings")) {
                Overrides overrides = baseline.at("overrides");
                overrides.insert(overrides.end(), reading.begin() + 1, reading.end());
                readings.push_back({place.at("name"), reading.front(), of_baseline, overrides});
            }
        }
    }
    return readings;
}

std::vector<ClaimValue> claim_values(const std::vector<std::string>& claims,
                                     const std::vector<analysis::Measurement>& measured)
{
    std::vector<ClaimValue> values;
    for (const std::string& id : claims) {
        const analysis::Claim& claim = claim_named(id);
        for (const std::string& quantity : claim.own.quantities) {
            analysis::Selection own = claim.own;
            own.quantities = {quantity};
            own.of.order = own.of.precision = own.of.variant = "";
            if (own.of.deformer.starts_with("pbs")) own.of.deformer = "pbs";
            for (analysis::JudgedCase judged : analysis::judged(claim, own, measured).cases) {
                judged.of.k_stretch.reset();
                values.push_back({id, quantity, judged});
            }
        }
    }
    return values;
}

const analysis::Columns<ClaimChange>& claim_change_columns()
{
    static const analysis::Columns<ClaimChange> columns =
        within(&ClaimChange::of, analysis::case_key_columns()) +
        MEMBER_COLUMNS(ClaimChange, place, reading_a, reading_b, claim, quantity, unit, bound, a, b, change, b_over_a,
                       holds_a, holds_b, verdict_flips, reason);
    return columns;
}

namespace {

const analysis::JudgedCase* find(const std::vector<ClaimValue>& values, const ClaimValue& wanted)
{
    const auto found = std::ranges::find_if(values, [&](const ClaimValue& value) {
        return value.claim == wanted.claim && value.quantity == wanted.quantity && value.judged.of == wanted.judged.of;
    });
    return found == values.end() ? nullptr : &found->judged;
}

std::string limit_text(const char* which, const analysis::JudgedCase& judged)
{
    return judged.limit == analysis::Limit::none ? "" : fmt::format("{}: {}", which, recorded_name(judged.limit));
}

std::string holds_text(const analysis::JudgedCase& judged)
{
    return judged.holds ? "yes" : "no";
}

// Either a or b may be null.
ClaimChange claim_change(const Reading& reading, const ClaimValue& value, const analysis::JudgedCase* a,
                         const analysis::JudgedCase* b)
{
    ClaimChange row{value.judged.of, reading.place,  reading.baseline,  reading.name,
                    value.claim,     value.quantity, value.judged.unit, threshold_text(value.judged.threshold)};
    if (a) std::tie(row.a, row.holds_a) = std::pair(a->value, holds_text(*a));
    if (b) std::tie(row.b, row.holds_b) = std::pair(b->value, holds_text(*b));
    if (!a || !b) {
        row.verdict_flips = "no_value";
        row.reason = fmt::format("{} has no such value", a ? "B" : "A");
        return row;
    }
    row.change = b->value - a->value;
    if (a->value != 0.0) row.b_over_a = b->value / a->value;
    row.verdict_flips = a->holds == b->holds ? "no" : "yes";
    const std::string limit_a = limit_text("A", *a), limit_b = limit_text("B", *b);
    row.reason = limit_a + (limit_a.empty() || limit_b.empty() ? "" : "; ") + limit_b;
    return row;
}

Study study_of(const std::string& claim)
{
    for (const Study& study :
         {volume_study(), momentum_study(), convergence_study(), artefacts_study(), jiggle_study()})
        if (study.name == claim_named(claim).study) return study;
    throw std::logic_error("no study measures single cases of " + claim);
}

// What the run wrote, as the verdict on a claim reads it.
std::vector<analysis::Measurement> measured_in(const std::string& folder, const analysis::CaseKey& place)
{
    std::vector<analysis::Measurement> measured;
    if (const std::string file = analysis::path_in(folder, "measurements.csv"); std::filesystem::exists(file))
        measured = analysis::measurements(file);
    if (const std::string file = analysis::path_in(folder, "metrics.csv"); std::filesystem::exists(file))
        for (analysis::CaseRecord& record : analysis::case_records(analysis::read_csv(file), folder)) {
            record.place = place;
            std::ranges::move(frame_measurements(record), std::back_inserter(measured));
        }
    return measured;
}

// The values of the case's claims, measured by their study with the overrides of a reading.
std::vector<ClaimValue> values_by(const Reading& reading, const StudyCase& study_case, std::string& breakdown)
{
    const auto claims = study_case.value<std::vector<std::string>>("claims");
    const Study study = study_of(claims.front());
    nlohmann::json values = study_case.values();
    for (const std::string& key_value : reading.overrides) values["overrides"].push_back(key_value);
    StudyPlan plan;
    study.add(StudyCase(study.name, values, true), plan);
    std::vector<analysis::Measurement> measured;
    for (const StudyRun& run : plan.runs) {
        const analysis::ScratchFolder scratch;
        const std::string folder = scratch.path().string();
        const std::string broken = run.work ? run.work(folder) : run_scene(run.scene, folder).failure();
        if (!broken.empty()) breakdown += fmt::format("{}: {} ", reading.name, broken);
        const analysis::CaseKey place{.body = run.scene.character.body, .motion = run.motion};
        std::ranges::move(measured_in(folder, place), std::back_inserter(measured));
    }
    return claim_values(claims, measured);
}

StudyPlan plan(bool full)
{
    return plan_of_cases("ambiguity", full, [](const StudyCase& study_case, StudyPlan& plan) {
        const std::vector<Reading> readings = readings_of(study_case);
        nlohmann::json overrides;
        for (const Reading& reading : readings) overrides[reading.name] = reading.overrides;
        StudyRun& run = plan.runs.emplace_back(StudyRun{.name = study_case.name, .cost_s = study_case.cost_s});
        run.settings = {{"case", study_case.values()}, {"scene", to_json(study_case.scene())}, {"readings", overrides}};
        run.work = [=](const std::string& folder) { return compare_readings(study_case, readings, folder); };
    });
}

bool conclude(const FinishedRuns& finished)
{
    const auto changes = finished.rows(claim_change_columns(), "ambiguity.csv");
    finished.write("ambiguity.csv", used_columns(claim_change_columns(), changes), changes);
    return true;
}

}  // namespace

std::vector<ClaimChange> claim_changes(const Reading& reading, const std::vector<ClaimValue>& a,
                                       const std::vector<ClaimValue>& b)
{
    std::vector<ClaimChange> changes;
    for (const ClaimValue& value : a) changes.push_back(claim_change(reading, value, &value.judged, find(b, value)));
    for (const ClaimValue& value : b)
        if (!find(a, value)) changes.push_back(claim_change(reading, value, nullptr, &value.judged));
    return changes;
}

std::string compare_readings(const StudyCase& study_case, const std::vector<Reading>& readings,
                             const std::string& folder)
{
    std::string breakdown;
    std::map<std::string, std::vector<ClaimValue>> by_name;
    std::vector<ClaimChange> changes;
    for (const Reading& reading : readings) {
        const auto& values = by_name[reading.name] = values_by(reading, study_case, breakdown);
        if (!reading.place.empty())
            std::ranges::move(claim_changes(reading, by_name.at(reading.baseline), values),
                              std::back_inserter(changes));
    }
    table_of(used_columns(claim_change_columns(), changes), changes).write(analysis::path_in(folder, "ambiguity.csv"));
    return breakdown;
}

Study ambiguity_study()
{
    return {"ambiguity", plan, quick_and_full, conclude};
}

}  // namespace experiments
