// The readings of the paper (cases.toml): how much each changes the values that claims are judged by, and whether it turns a verdict round.
// A reading differs from the scene in one place, as keys of the scene. Every value is measured by its claim's own study (Study::read), with
// two exceptions: C01 and C02 take steps of the scene without the study's further deformers, and C10 takes a frame's processor time, where
// its study takes wall time.
//
//   limb_twist, limb_bend       C01, C02: the scenes' sweeps, each step by itself
//   human                       C01, C02: the clip 01_01, five frames per second, each step by itself
//   human_moving                C01, C02: what remembers the last step, every step of six seconds of the clip (--full: of all of it)
//   BODY_joint_twist, _bend     C04, C05: sections of the limb's joint, of the human's elbow
//   BODY_starts                 C03, C12: iterations from four initial guesses, on the limb bent by 90 degrees and in the human's crouch
//   BODY_step                   C07, C09, C10: momentum of projections there, a jolt, and the time per frame in turns (the human's: --full)
//
// Writes DIR/ambiguity/RUN/ambiguity.csv and, for the first four, figures.csv (volume, jiggling, distance); and both for all of them.
#include "analysis/records/record_files.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/ambiguity/moved_readings.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

// The values by each reading, measured by the study of the claims, which has `read`, or as above.
std::vector<JudgedReading> values_of(const Study& study, const StudyCase& of, const std::vector<Reading>& readings)
{
    std::vector<Overrides> overrides;
    for (const Reading& reading : readings) overrides.push_back(reading.overrides);
    if (!study.read) return values_of_frames(of, overrides);
    std::vector<JudgedReading> all;
    for (const ReadingValues& read : study.read(of, overrides)) all.push_back({judged(read.values), read.broke_down, read.left_out});
    return all;
}

// Claims of one study are measured together.
std::string record_claims(const StudyCase& of, const std::vector<Reading>& readings, const std::string& folder)
{
    ReadingComparison comparison(of.value<std::string>("body"), readings);
    const auto claims = of.value<std::vector<std::string>>("claims");
    for (const Study& study : studies()) {
        std::vector<std::string> own;
        std::ranges::copy_if(claims, std::back_inserter(own), [&](const std::string& id) { return claim_named(id).study == study.name; });
        if (!own.empty()) comparison.measure(own, [&](const std::vector<Reading>& touching) { return values_of(study, of, touching); });
    }
    table_of(used_columns(claim_change_columns(), comparison.changes()), comparison.changes())
        .write(analysis::path_in(folder, "ambiguity.csv"));
    return comparison.breakdown();
}

// A run repeats when its case, a reading or a bound of its claims changes.
nlohmann::json settings_of(const StudyCase& of, const std::vector<Reading>& readings)
{
    std::vector<analysis::Claim> judging;
    for (const std::string& claim : of.value<std::vector<std::string>>("claims")) judging.push_back(claim_named(claim));
    nlohmann::json recorded = nlohmann::json::array();
    for (const Reading& reading : readings)
        recorded.push_back({{"name", reading.name}, {"baseline", reading.baseline}, {"settings", reading.settings}});
    return {{"case", of.values()}, {"scene", to_json(of.scene())}, {"readings", recorded}, {"bounds", digest_of(judging)}};
}

StudyPlan plan(bool full)
{
    return plan_of_cases("ambiguity", full, [](const StudyCase& of, StudyPlan& plan) {
        const bool of_volume = of.has("readings");
        const std::vector<Reading> readings = readings_of(of, of.value<std::string>("readings", "all"));
        StudyRun run{.name = of.name, .cost_s = of.cost_s};
        run.settings = settings_of(of, readings);
        run.work = [=](const std::string& folder) { return (of_volume ? record_volume : record_claims)(of, readings, folder); };
        plan.runs.push_back(run);
    });
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    const auto changes = finished.rows(claim_change_columns(), "ambiguity.csv");
    finished.write("ambiguity.csv", used_columns(claim_change_columns(), changes), changes);
    finished.write("figures.csv", volume_change_columns, finished.rows(volume_change_columns, "figures.csv"));
    std::string text;
    for (const analysis::Claim& claim : claims()) {
        const auto count = [&](const std::string& flips) {
            return std::ranges::count_if(changes,
                                         [&](const ClaimChange& row) { return row.claim == claim.id && row.verdict_flips == flips; });
        };
        if (const auto values = count("yes") + count("no"); values > 0)
            text += fmt::format("{}: {} of {} values flip\n", claim.id, count("yes"), values);
    }
    return {text, !finished.none()};
}

}  // namespace

Study ambiguity_study()
{
    return {"ambiguity", plan, quick_and_full, conclude};
}

}  // namespace experiments
