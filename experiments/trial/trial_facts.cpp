// The summary of a trial, from the records of its run.
#include "analysis/metrics/skin_error.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/characters/json_file.hpp"
#include "experiments/run/parts_of_one_bone.hpp"
#include "experiments/trial/trial.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using analysis::CsvTable;

constexpr const char* reference_name = "nh_p1";  // in the scene of a trial
constexpr double least_visible_pct =
    0.01;  // changes of volume and errors below it are no difference between two methods

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
        nlohmann::json& deformer = facts[metrics.text_at(row, "deformer")];
        if (deformer.is_null())
            deformer = {{"lowest_pct", *change_pct}, {"highest_pct", *change_pct}, {"most_inverted_tets", inverted}};
        deformer["lowest_pct"] = std::min(deformer["lowest_pct"].get<double>(), *change_pct);
        deformer["highest_pct"] = std::max(deformer["highest_pct"].get<double>(), *change_pct);
        deformer["most_inverted_tets"] = std::max(deformer["most_inverted_tets"].get<long long>(), inverted);
    }
    return facts;
}

nlohmann::json frame_ms(const CsvTable& metrics)
{
    std::map<std::string, std::vector<double>> times;
    for (int row = 0; row < metrics.rows(); ++row)
        times[metrics.text_at(row, "deformer")].push_back(metrics.number(row, "step_ms"));
    nlohmann::json facts;
    for (const auto& [deformer, ms] : times) facts[deformer] = analysis::median(ms);
    return facts;
}

// Over the frames whose bound is known; null without an error bar.
nlohmann::json error_bar_facts(const CsvTable& metrics, const pbs::JsonFile& run)
{
    constexpr const char* bound = "reference_error_joint_pct";
    if (!metrics.has_column(bound)) return nullptr;
    std::vector<double> bounds_pct;
    int frames = 0;
    for (int row = 0; row < metrics.rows(); ++row) {
        if (metrics.text_at(row, "deformer") != reference_name) continue;
        ++frames;
        if (const auto bound_pct = finite(metrics, row, bound)) bounds_pct.push_back(*bound_pct);
    }
    const nlohmann::json& seconds = run.at(run.at("cost"), "seconds");
    const double total_s = seconds.value("error_bar", 0.0) + seconds.value("error_bar_set_up", 0.0);
    nlohmann::json facts = {
        {"frames", bounds_pct.size()}, {"of", frames}, {"seconds", total_s}, {"largest_pct", nullptr}};
    if (!bounds_pct.empty()) facts["largest_pct"] = std::ranges::max(bounds_pct);
    return facts;
}

// Whether some flesh changes its shape: a rigid motion leaves every tet its volume.
bool deforms(const CsvTable& metrics)
{
    if (!metrics.has_column("volume_abs_change_pct")) return true;
    for (int row = 0; row < metrics.rows(); ++row)
        if (finite(metrics, row, "volume_abs_change_pct").value_or(least_visible_pct) >= least_visible_pct) return true;
    return false;
}

// By frame and deformer, in frames in which somebody has a visible error.
using FrameErrors = std::map<long long, std::map<std::string, double>>;

FrameErrors errors_of(const CsvTable& metrics, const std::string& column)
{
    FrameErrors errors;
    if (!metrics.has_column(column)) return errors;
    for (int row = 0; row < metrics.rows(); ++row)
        if (const auto error = finite(metrics, row, column))
            if (const std::string& deformer = metrics.text_at(row, "deformer"); deformer != reference_name)
                errors[metrics.integer(row, "frame")][deformer] = *error;
    std::erase_if(errors, [](const auto& frame) {
        return std::ranges::all_of(frame.second,
                                   [](const auto& deformer) { return deformer.second < least_visible_pct; });
    });
    return errors;
}

// A method turns too much inside out if its inverted tets exceed those of lbs by more than this share of the tets in
// more than this share of the frames. A few of thousands of tets say nothing about the distance from the reference.
constexpr double most_inverted_share = 0.005, most_inverted_frames = 0.1;

// Of each method the most inverted tets in a frame, and whether it is excluded for them.
nlohmann::json inverting_methods(const CsvTable& metrics, long long tets)
{
    std::map<long long, long long> of_lbs;
    for (int row = 0; row < metrics.rows(); ++row)
        if (metrics.text_at(row, "deformer") == "lbs")
            of_lbs[metrics.integer(row, "frame")] = metrics.integer(row, "inverted_tets");
    struct Inverted {
        long long most = 0;
        int frames = 0, beyond = 0;
    };
    std::map<std::string, Inverted> methods;
    for (int row = 0; row < metrics.rows(); ++row) {
        const auto lbs = of_lbs.find(metrics.integer(row, "frame"));
        const auto inverted = metrics.integer(row, "inverted_tets");
        if (metrics.text_at(row, "deformer") == reference_name || lbs == of_lbs.end()) continue;
        Inverted& method = methods[metrics.text_at(row, "deformer")];
        method.most = std::max(method.most, inverted);
        ++method.frames;
        method.beyond += static_cast<double>(inverted - lbs->second) > most_inverted_share * static_cast<double>(tets);
    }
    nlohmann::json facts = nlohmann::json::object();
    for (const auto& [name, method] : methods)
        if (method.most > 0)
            facts[name] = {{"most_inverted_tets", method.most},
                           {"share_of_tets_pct", 100.0 * static_cast<double>(method.most) / static_cast<double>(tets)},
                           {"is_excluded", method.beyond > most_inverted_frames * method.frames}};
    return facts;
}

// The methods that are not excluded, the least median error first, with the frames in which each of them is nearest. A
// method that fails in the hard frames would look best by the others: only frames in which all have an error count.
nlohmann::json ranking(const FrameErrors& errors, const nlohmann::json& inverting)
{
    const auto most = std::ranges::max_element(errors, {}, [](const auto& frame) { return frame.second.size(); });
    std::map<std::string, std::vector<double>> own;
    std::map<std::string, int> nearest_in;
    int frames = 0;
    for (const auto& [frame, errors_of_frame] : errors) {
        if (errors_of_frame.size() < most->second.size()) continue;
        std::map<double, std::string> compared;
        for (const auto& [deformer, error] : errors_of_frame) {
            const auto inverted = inverting.find(deformer);
            if (inverted != inverting.end() && inverted->at("is_excluded").get<bool>()) continue;
            own[deformer].push_back(error);
            compared.emplace(error, deformer);
        }
        if (compared.empty()) continue;
        ++frames;
        ++nearest_in[compared.begin()->second];
    }
    std::vector<std::pair<double, std::string>> sorted;
    for (const auto& [deformer, errors_of_method] : own)
        sorted.emplace_back(analysis::median(errors_of_method), deformer);
    std::ranges::sort(sorted);
    nlohmann::json methods = nlohmann::json::array();
    for (const auto& [median_pct, deformer] : sorted)
        methods.push_back({{"deformer", deformer}, {"median_pct", median_pct}, {"nearest_in", nearest_in[deformer]}});
    return {{"frames", frames}, {"methods", methods}};
}

// At the joints, or over the body where no frame has an error there. Null where no frame has an error; without methods
// where all are excluded.
nlohmann::json nearest_facts(const CsvTable& metrics, const nlohmann::json& inverting)
{
    const FrameErrors at_joints = errors_of(metrics, "error_joint_pct"), over_body = errors_of(metrics, "error_l2_pct");
    if (at_joints.empty() && over_body.empty()) return nullptr;
    nlohmann::json nearest = ranking(at_joints.empty() ? over_body : at_joints, inverting);
    nearest["place"] = at_joints.empty() ? "body" : "joints";
    return nearest;
}

// Why the reference may be another pose than the motion's, so that no method is called nearest: far_from_all or lag;
// null: it is not.
nlohmann::json doubt_of_reference(const nlohmann::json& nearest, const nlohmann::json& lag)
{
    constexpr double most_error_pct = 50.0;
    if (!lag.is_null() && lag.at("lagging_frames").get<double>() > most_lagging_frames * lag.at("frames").get<double>())
        return "lag";
    if (!nearest.is_null() && !nearest.at("methods").empty() &&
        nearest.at("methods").front().at("median_pct") > most_error_pct)
        return "far_from_all";
    return nullptr;
}

// The skin's distance from the reference under lbs and pbs, rms over the frames in which both have one.
nlohmann::json skin_facts(const CsvTable& metrics)
{
    if (!metrics.has_column("skin_rms_mm")) return nullptr;
    struct Distances {
        double mm = 0.0, pct = 0.0;
    };
    std::map<long long, std::map<std::string, Distances>> frames;
    for (int row = 0; row < metrics.rows(); ++row) {
        const auto mm = finite(metrics, row, "skin_rms_mm"), pct = finite(metrics, row, "skin_rms_pct");
        if (mm && pct) frames[metrics.integer(row, "frame")][metrics.text_at(row, "deformer")] = {*mm, *pct};
    }
    std::erase_if(frames,
                  [](const auto& frame) { return frame.second.count("lbs") == 0 || frame.second.count("pbs") == 0; });
    const auto rms = [&](const char* deformer, double Distances::*distance) {
        double squares = 0.0;
        for (const auto& [frame, distances] : frames)
            squares += distances.at(deformer).*distance * (distances.at(deformer).*distance);
        return std::sqrt(squares / static_cast<double>(frames.size()));
    };
    if (frames.empty() || rms("lbs", &Distances::pct) < least_visible_pct) return nullptr;
    const double lbs_mm = rms("lbs", &Distances::mm), pbs_mm = rms("pbs", &Distances::mm);
    return {{"lbs_mm", lbs_mm}, {"pbs_mm", pbs_mm}, {"removed_pct", analysis::removed_share_pct(lbs_mm, pbs_mm)}};
}

// The frame in which the surfaces of pbs and lbs are farthest apart (rms); null where they never differ.
nlohmann::json widest_frame(const CsvTable& distances)
{
    double widest_mm = 0.0;
    nlohmann::json frame;
    for (int row = 0; row < distances.rows(); ++row)
        if (const double mm = finite(distances, row, "rms_mm").value_or(0.0);
            mm > widest_mm && distances.text_at(row, "deformer") == "pbs" && distances.text_at(row, "other") == "lbs")
            widest_mm = mm, frame = distances.integer(row, "frame");
    return frame;
}

struct JointChange {
    std::string name;
    double share_pct = 0.0;                    // of the body's volume
    std::map<std::string, double> change_pct;  // of the body's volume, by deformer
};

// The two joints, of a bone and its parent, at which lbs loses most of the body's volume.
nlohmann::json joint_facts(const CsvTable& regions, const CsvTable& bones)
{
    std::map<std::string, std::string> parent;
    for (int row = 0; row < bones.rows(); ++row) parent[bones.text_at(row, "bone")] = bones.text_at(row, "parent");
    std::map<std::string, JointChange> joints;
    for (int row = 0; row < regions.rows(); ++row) {
        if (regions.text_at(row, "kind") != "joint") continue;
        const std::string &bone = regions.text_at(row, "bone"), &second = regions.text_at(row, "second_bone");
        // their flesh meets, but no joint connects them
        if (parent[second] != bone && parent[bone] != second) continue;
        const std::string name = bone + " - " + second;
        JointChange& joint = joints[name];
        joint.name = name;
        joint.share_pct = regions.number(row, "rest_share_pct");
        joint.change_pct[regions.text_at(row, "deformer")] = regions.number(row, "change_pct");
    }
    std::vector<JointChange> sorted;
    for (const auto& [name, joint] : joints)
        if (joint.change_pct.count("lbs") > 0 && joint.change_pct.count("pbs") > 0) sorted.push_back(joint);
    std::ranges::sort(sorted, {}, [](const JointChange& joint) { return joint.change_pct.at("lbs"); });
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
    const CsvTable metrics = analysis::read_csv(folder + "/metrics.csv"),
                   regions = analysis::read_csv(folder + "/regions.csv"),
                   bones = analysis::read_csv(folder + "/bones_rest.csv");
    const std::string distances = folder + "/distances.csv";
    const nlohmann::json &outcome = run.at("outcome"), &character = run.at("character");
    const nlohmann::json inverting = inverting_methods(metrics, run.at(character, "tets").get<long long>());
    const nlohmann::json nearest = nearest_facts(metrics, inverting),
                         lag = outcome.value("reference_lag", nlohmann::json());
    return {{"schema", 1},
            {"model", run.at(character, "model")},
            {"tets", run.at(character, "tets")},
            {"vertices", run.at(character, "vertices")},
            {"motion", run.at(outcome, "motion")},
            {"frames", run.at(outcome, "frames")},
            {"warnings", run.at(outcome, "warnings")},
            {"from_artist", outcome.value("from_artist", nlohmann::json())},
            {"notes", run.at(outcome, "notes")},
            {"deforms", deforms(metrics)},
            {"volume", volume_facts(metrics)},
            {"joints", joint_facts(regions, bones)},
            {"nearest", nearest},
            {"doubtful_reference", doubt_of_reference(nearest, lag)},
            {"inverting", inverting},
            {"skin", skin_facts(metrics)},
            {"widest_frame", fs::exists(distances) ? widest_frame(analysis::read_csv(distances)) : nullptr},
            {"frame_ms", frame_ms(metrics)},
            {"error_bar", error_bar_facts(metrics, run)},
            {"reference_frames", outcome.value("reference_frames", nlohmann::json())},
            {"interrupted", outcome.value("interrupted", false)},
            {"reference_lag", lag},
            {"control", fs::exists(folder + "/skin/artist.pvd") ? nlohmann::json("skin/artist_*.vtp") : nullptr}};
}

}  // namespace experiments
