#include "experiments/studies/ambiguity/volume_readings.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/program_claims.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace experiments {

const analysis::Columns<VolumeChange> volume_change_columns = {
    {"scene", &VolumeChange::scene, "", "name of the scene"},
    {"place", &VolumeChange::place, "", "place of the paper that can be read in two ways"},
    {"reading_a", &VolumeChange::reading_a, "", "the baseline"},
    {"reading_b", &VolumeChange::reading_b, "", "the other reading"},
    {"quantity", &VolumeChange::quantity, "", "what is compared; its name ends with its unit"},
    {"a", &VolumeChange::a, "", "value by reading A"},
    {"b", &VolumeChange::b, "", "value by reading B"},
    {"change", &VolumeChange::change, "", "b less a"},
    {"verdict_changed", &VolumeChange::verdict_changed, "", "no, or the claims that are judged otherwise"}};

namespace {

const std::vector<std::string> volume_claims = {"C01", "C02"};

// Claims of the volume study whose extent on this scene differs, by metric.
std::string changed_verdicts(const ReadMotion& a, const ReadMotion& b)
{
    std::vector<std::string> changes;
    for (const analysis::Claim& claim : claims()) {
        if (claim.study != "volume") continue;
        const bool of_lbs = claim.deformer == "lbs";
        for (const std::string& metric : claim.metrics) {
            const analysis::Extent before = analysis::judge_case(claim, of_lbs ? a.lbs : a.pbs, metric).extent,
                                   after = analysis::judge_case(claim, of_lbs ? b.lbs : b.pbs, metric).extent;
            if (before != after)
                changes.push_back(fmt::format("{} by {}: {} -> {}", claim.id, metric, analysis::name_of(before), analysis::name_of(after)));
        }
    }
    return changes.empty() ? "no" : fmt::format("{}", fmt::join(changes, "; "));
}

double share_within(const std::vector<double>& change_pct)
{
    constexpr double printed_pct = 0.5;  // Sec. 4
    const auto holds = [](double change) { return std::abs(change) <= printed_pct; };
    return double(std::ranges::count_if(change_pct, holds)) / double(change_pct.size());
}

// Root mean square over frames and vertices of the zone, or all where it is empty [m].
double distance_m(const ReadMotion& a, const ReadMotion& b, const std::vector<bool>& zone)
{
    double sum = 0.0;
    long long count = 0;
    for (std::size_t frame = 0; frame < std::min(a.shapes.size(), b.shapes.size()); ++frame)
        for (Eigen::Index i = 0; i < a.shapes[frame].rows(); ++i) {
            if (!zone.empty() && !zone[i]) continue;
            sum += (a.shapes[frame].row(i) - b.shapes[frame].row(i)).squaredNorm();
            ++count;
        }
    return std::sqrt(sum / double(count));
}

struct Baseline {
    Reading reading;
    ReadMotion moved;
};

void compare_volume(std::vector<ClaimChange>& changes, const std::string& body, const Reading& reading, const Baseline& a,
                    const ReadMotion& b)
{
    for (const std::string& claim : volume_claims)
        if (const std::string reason = untouched_because(claim, reading, a.reading); !reason.empty())
            changes.push_back(untouched_claim(body, claim, reading, reason));
        else
            std::ranges::copy(claim_changes(body, claim, reading, {judged(a.moved), !a.moved.finite}, {judged(b), !b.finite}),
                              std::back_inserter(changes));
}

}  // namespace

nlohmann::json to_json(const VolumeReadings& of)
{
    static const auto fields = OptionFields<VolumeReadings>("volume_readings")
                                   .record("body", &VolumeReadings::body)
                                   .record("scene", &VolumeReadings::scene)
                                   .record("readings", &VolumeReadings::readings)
                                   .complete();
    return fields.json(of);
}

std::vector<VolumeChange> volume_changes(const std::string& scene, const Reading& reading, const ReadMotion& a, const ReadMotion& b,
                                         const ReadMotion& resting, const std::vector<bool>& zone)
{
    using analysis::mean;
    const std::string verdict = changed_verdicts(a, b);
    std::vector<VolumeChange> rows;
    const auto add = [&](const std::string& quantity, double of_a, double of_b) {
        rows.push_back({scene, reading.place, reading.baseline, reading.name, quantity, of_a, of_b, of_b - of_a, verdict});
    };
    add(mean_change, mean(a.pbs.volume_change_pct), mean(b.pbs.volume_change_pct));
    add(mean_abs_change, mean(a.pbs.volume_abs_change_pct), mean(b.pbs.volume_abs_change_pct));
    add("mean_volume_change_of_lbs_pct", mean(a.lbs.volume_change_pct), mean(b.lbs.volume_change_pct));
    add(share_within_printed, share_within(a.pbs.volume_change_pct), share_within(b.pbs.volume_change_pct));
    add("mean_inverted_tets", mean(a.pbs.inverted_tets), mean(b.pbs.inverted_tets));
    for (std::size_t frame = 0; frame < a.pbs.angle_deg.size(); ++frame) {
        const double angle = a.pbs.angle_deg[frame];
        if (std::abs(angle - 90.0) >= 1e-6 && std::abs(angle - 170.0) >= 1e-6) continue;
        add(fmt::format("volume_change_at_{:.0f}_deg_pct", angle), a.pbs.volume_change_pct[frame], b.pbs.volume_change_pct[frame]);
        add(fmt::format("volume_abs_change_at_{:.0f}_deg_pct", angle), a.pbs.volume_abs_change_pct[frame],
            b.pbs.volume_abs_change_pct[frame]);
    }
    add(distance_from_a, 0.0, distance_m(a, b, {}));
    add(distance_by_jiggle, distance_m(a, resting, zone), distance_m(b, resting, zone));
    return rows;
}

std::string record_volume(const VolumeReadings& of, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const std::vector<bool> zone = pbs::jiggle_zone(character.binding);
    std::map<std::string, Baseline> baselines;
    std::vector<VolumeChange> volumes;
    std::vector<ClaimChange> changes;
    std::string breakdown;
    for (const Reading& reading : of.readings) {
        if (reading.options.jiggle && of.scene.motion.clip.empty()) {
            if (reading.place.empty()) continue;
            for (const std::string& claim : volume_claims)
                changes.push_back(untouched_claim(of.body, claim, reading, "a sweep has no speed of its own"));
            continue;
        }
        ReadMotion moved = move(character, of.scene, reading);
        if (!moved.finite) breakdown += reading.name + " is not finite. ";
        if (reading.place.empty()) {
            baselines.emplace(reading.name, Baseline{reading, std::move(moved)});
            continue;
        }
        const Baseline& baseline = baselines.at(reading.baseline);
        std::ranges::copy(volume_changes(of.scene.name, reading, baseline.moved, moved, baselines.at(own_reading).moved, zone),
                          std::back_inserter(volumes));
        compare_volume(changes, of.body, reading, baseline, moved);
    }
    table_of(volume_change_columns, volumes).write(analysis::path_in(folder, "figures.csv"));
    table_of(used_columns(claim_change_columns(), changes), changes).write(analysis::path_in(folder, "ambiguity.csv"));
    return breakdown;
}

}  // namespace experiments
