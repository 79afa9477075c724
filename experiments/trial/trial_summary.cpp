#include "experiments/trial/trial_summary.hpp"

#include "analysis/records/tables.hpp"
#include "analysis/statistics/statistics.hpp"
#include "pbs/character/json_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace experiments {
namespace {

using analysis::CsvTable;

// The number of a cell; nothing for an empty cell and for one that is not finite, as of a frame that broke down.
std::optional<double> finite(const CsvTable& table, int row, const std::string& column)
{
    const auto value = table.number_or_nothing(row, column);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

nlohmann::json volume_facts(const CsvTable& metrics)
{
    nlohmann::json facts;
    for (int row = 0; row < metrics.rows(); ++row) {
        const auto change_pct = finite(metrics, row, "volume_change_pct");
        if (!change_pct) continue;
        const auto inverted = metrics.integer(row, "inverted_tets");
        nlohmann::json& of = facts[metrics.text_at(row, "deformer")];
        if (of.is_null()) of = {{"lowest_pct", *change_pct}, {"highest_pct", *change_pct}, {"most_inverted_tets", inverted}};
        of["lowest_pct"] = std::min(of["lowest_pct"].get<double>(), *change_pct);
        of["highest_pct"] = std::max(of["highest_pct"].get<double>(), *change_pct);
        of["most_inverted_tets"] = std::max(of["most_inverted_tets"].get<long long>(), inverted);
    }
    return facts;
}

nlohmann::json frame_ms(const CsvTable& metrics)
{
    std::map<std::string, std::vector<double>> times;
    for (int row = 0; row < metrics.rows(); ++row) times[metrics.text_at(row, "deformer")].push_back(metrics.number(row, "step_ms"));
    nlohmann::json facts;
    for (const auto& [deformer, ms] : times) facts[deformer] = analysis::median(ms);
    return facts;
}

// Frames in which both have an error at the joints, and those of them in which that of pbs is smaller.
nlohmann::json nearer_frames(const CsvTable& metrics)
{
    if (!metrics.has_column("error_joint_pct")) return nullptr;
    std::map<long long, std::map<std::string, double>> errors;
    for (int row = 0; row < metrics.rows(); ++row)
        if (const auto error = finite(metrics, row, "error_joint_pct"))
            errors[metrics.integer(row, "frame")][metrics.text_at(row, "deformer")] = *error;
    int compared = 0, nearer = 0;
    for (const auto& [frame, of] : errors) {
        if (of.count("lbs") == 0 || of.count("pbs") == 0) continue;
        ++compared;
        nearer += of.at("pbs") < of.at("lbs");
    }
    if (compared == 0) return nullptr;
    return {{"frames", nearer}, {"of", compared}};
}

struct JointChange {
    std::string name;
    double share_pct = 0.0;                    // of the body's volume
    std::map<std::string, double> change_pct;  // of the body's volume, by deformer
};

// The two joints at which lbs loses most of the body's volume.
nlohmann::json joint_facts(const CsvTable& regions)
{
    std::map<std::string, JointChange> joints;
    for (int row = 0; row < regions.rows(); ++row) {
        if (regions.text_at(row, "kind") != "joint") continue;
        const std::string name = regions.text_at(row, "bone") + " - " + regions.text_at(row, "second_bone");
        JointChange& joint = joints[name];
        joint.name = name;
        joint.share_pct = regions.number(row, "rest_share_pct");
        joint.change_pct[regions.text_at(row, "deformer")] = regions.number(row, "change_pct");
    }
    std::vector<JointChange> sorted;
    for (const auto& [name, joint] : joints)
        if (joint.change_pct.count("lbs") > 0 && joint.change_pct.count("pbs") > 0) sorted.push_back(joint);
    std::sort(sorted.begin(), sorted.end(),
              [](const JointChange& a, const JointChange& b) { return a.change_pct.at("lbs") < b.change_pct.at("lbs"); });
    sorted.resize(std::min<std::size_t>(sorted.size(), 2));
    if (sorted.empty()) return nullptr;
    nlohmann::json facts = {{"names", nlohmann::json::array()}};
    double share_pct = 0.0, lbs_pct = 0.0, pbs_pct = 0.0;
    for (const JointChange& joint : sorted) {
        facts["names"].push_back(joint.name);
        share_pct += joint.share_pct;
        lbs_pct += joint.change_pct.at("lbs");
        pbs_pct += joint.change_pct.at("pbs");
    }
    if (!(share_pct > 0.0)) return nullptr;
    facts["lbs_pct"] = 100.0 * lbs_pct / share_pct;
    facts["pbs_pct"] = 100.0 * pbs_pct / share_pct;
    return facts;
}

}  // namespace

nlohmann::json trial_facts(const std::string& folder)
{
    const pbs::JsonFile run(folder + "/run.json");
    const CsvTable metrics = analysis::read_csv(folder + "/metrics.csv"), regions = analysis::read_csv(folder + "/regions.csv");
    const nlohmann::json &outcome = run.at("outcome"), &character = run.at("character");
    return {{"schema", 1},
            {"model", run.at(character, "model")},
            {"tets", run.at(character, "tets")},
            {"vertices", run.at(character, "vertices")},
            {"motion", run.at(outcome, "motion")},
            {"frames", run.at(outcome, "frames")},
            {"warnings", run.at(outcome, "warnings")},
            {"volume", volume_facts(metrics)},
            {"joints", joint_facts(regions)},
            {"nearer", nearer_frames(metrics)},
            {"frame_ms", frame_ms(metrics)}};
}

std::string trial_sentence(const nlohmann::json& facts)
{
    // With a sign and one decimal place; + 0.0 takes the minus from a zero.
    const auto per_cent = [](double value) { return fmt::format("{:+.1f}", std::round(10.0 * value) / 10.0 + 0.0); };
    const auto range = [&](const char* deformer) {
        const nlohmann::json& of = facts.at("volume").at(deformer);
        return fmt::format("{} to {} %", per_cent(of.at("lowest_pct")), per_cent(of.at("highest_pct")));
    };
    if (!facts.at("volume").contains("pbs") || !facts.at("volume").contains("lbs")) return "PBS or LBS broke down in every frame.";
    std::string text = fmt::format("PBS changes the volume by {}, LBS by {}", range("pbs"), range("lbs"));
    if (const nlohmann::json& joints = facts.at("joints"); !joints.is_null()) {
        const auto& names = joints.at("names");
        std::string at = names[0].get<std::string>();
        if (names.size() > 1) at += " and " + names[1].get<std::string>();
        text += fmt::format("; at the joints {} by {} % instead of {} % on average", at, per_cent(joints.at("pbs_pct")),
                            per_cent(joints.at("lbs_pct")));
    }
    if (const nlohmann::json& nearer = facts.at("nearer"); !nearer.is_null())
        text += fmt::format("; it is closer to the finite elements in {} of {} frames", nearer.at("frames").get<int>(),
                            nearer.at("of").get<int>());
    const double ms = facts.at("frame_ms").at("pbs");
    return text + (ms < 10.0 ? fmt::format("; a frame takes {:.2g} ms.", ms) : fmt::format("; a frame takes {:.0f} ms.", ms));
}

}  // namespace experiments
