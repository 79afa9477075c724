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
std::optional<double> finite(const CsvTable::Row& row, const std::string& column)
{
    const auto value = row.number_or_nothing(column);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

CsvTable with_finite(const CsvTable& table, const std::string& column)
{
    return table.where([&](const CsvTable::Row& row) { return finite(row, column).has_value(); });
}

std::vector<long long> inverted_tets(const CsvTable& frames)
{
    return frames.map([](const CsvTable::Row& row) { return row.integer("inverted_tets"); });
}

nlohmann::json volume_facts(const CsvTable& metrics)
{
    nlohmann::json facts;
    for (const CsvTable& frames : with_finite(metrics, "volume_change_pct").groups({"deformer"})) {
        const auto [lowest_pct, highest_pct] = std::ranges::minmax(frames.numbers("volume_change_pct"));
        facts[frames[0].text("deformer")] = {{"lowest_pct", lowest_pct},
                                             {"highest_pct", highest_pct},
                                             {"most_inverted_tets", std::ranges::max(inverted_tets(frames))}};
    }
    return facts;
}

nlohmann::json frame_ms(const CsvTable& metrics)
{
    nlohmann::json facts;
    for (const CsvTable& frames : metrics.groups({"deformer"}))
        facts[frames[0].text("deformer")] = analysis::median(frames.numbers("step_ms"));
    return facts;
}

// Over the frames whose bound is known; null without an error bar.
nlohmann::json error_bar_facts(const CsvTable& metrics, const pbs::JsonFile& run)
{
    constexpr const char* bound = "reference_error_joint_pct";
    if (!metrics.has_column(bound)) return nullptr;
    const CsvTable frames = metrics.where("deformer", reference_name);
    const std::vector<double> bounds_pct = with_finite(frames, bound).numbers(bound);
    const nlohmann::json& seconds = run.at(run.at("cost"), "seconds");
    const double total_s = seconds.value("error_bar", 0.0) + seconds.value("error_bar_set_up", 0.0);
    nlohmann::json facts = {
        {"frames", bounds_pct.size()}, {"of", frames.rows()}, {"seconds", total_s}, {"largest_pct", nullptr}};
    if (!bounds_pct.empty()) facts["largest_pct"] = std::ranges::max(bounds_pct);
    return facts;
}

// Whether some flesh changes its shape: a rigid motion leaves every tet its volume.
bool deforms(const CsvTable& metrics)
{
    if (!metrics.has_column("volume_abs_change_pct")) return true;
    return std::ranges::any_of(metrics, [](const CsvTable::Row& row) {
        return finite(row, "volume_abs_change_pct").value_or(least_visible_pct) >= least_visible_pct;
    });
}

// The rows with an error, by frame: those of frames in which somebody has a visible error.
std::vector<CsvTable> frames_with_errors(const CsvTable& metrics, const std::string& column)
{
    if (!metrics.has_column(column)) return {};
    const CsvTable errors = with_finite(metrics, column).where([](const CsvTable::Row& row) {
        return row.text("deformer") != reference_name;
    });
    std::vector<CsvTable> frames = errors.groups({"frame"});
    std::erase_if(frames,
                  [&](const CsvTable& frame) { return std::ranges::max(frame.numbers(column)) < least_visible_pct; });
    return frames;
}

// A method turns too much inside out if its inverted tets exceed those of lbs by more than this share of the tets in
// more than this share of the frames. A few of thousands of tets say nothing about the distance from the reference.
constexpr double most_inverted_share = 0.005, most_inverted_frames = 0.1;

// Of each method the most inverted tets in a frame, and whether it is excluded for them.
nlohmann::json inverting_methods(const CsvTable& metrics, long long tets)
{
    const auto lbs = metrics.where("deformer", "lbs").by("frame");
    const CsvTable compared = metrics.where([&](const CsvTable::Row& row) {
        return row.text("deformer") != reference_name && lbs.contains(row.text("frame"));
    });
    nlohmann::json facts = nlohmann::json::object();
    for (const CsvTable& frames : compared.groups({"deformer"})) {
        const long long most = std::ranges::max(inverted_tets(frames));
        const auto beyond = std::ranges::count_if(frames, [&](const CsvTable::Row& row) {
            const long long more = row.integer("inverted_tets") - lbs.at(row.text("frame")).integer("inverted_tets");
            return static_cast<double>(more) > most_inverted_share * static_cast<double>(tets);
        });
        if (most > 0)
            facts[frames[0].text("deformer")] = {
                {"most_inverted_tets", most},
                {"share_of_tets_pct", 100.0 * static_cast<double>(most) / static_cast<double>(tets)},
                {"is_excluded", static_cast<double>(beyond) > most_inverted_frames * frames.rows()}};
    }
    return facts;
}

// The methods that are not excluded, the least median error first, with the frames in which each of them is nearest. A
// method that fails in the hard frames would look best by the others: only frames in which all have an error count.
nlohmann::json ranking(const std::vector<CsvTable>& errors, const std::string& column, const nlohmann::json& inverting)
{
    const int most = std::ranges::max(errors, {}, &CsvTable::rows).rows();
    CsvTable compared{{}};
    std::map<std::string, int> nearest_in;
    int frames = 0;
    for (const CsvTable& frame : errors) {
        const CsvTable ranked = frame.where([&](const CsvTable::Row& row) {
            const auto inverted = inverting.find(row.text("deformer"));
            return inverted == inverting.end() || !inverted->at("is_excluded").get<bool>();
        });
        if (frame.rows() < most || ranked.rows() == 0) continue;
        ++frames;
        ++nearest_in[std::ranges::min(ranked.map([&](const CsvTable::Row& row) {
                         return std::pair(row.number(column), row.text("deformer"));
                     })).second];
        compared.append(ranked);
    }
    std::vector<std::pair<double, std::string>> sorted;
    if (frames > 0)
        for (const CsvTable& method : compared.groups({"deformer"}))
            sorted.emplace_back(analysis::median(method.numbers(column)), method[0].text("deformer"));
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
    for (const auto& [place, column] : {std::pair("joints", "error_joint_pct"), {"body", "error_l2_pct"}})
        if (const auto errors = frames_with_errors(metrics, column); !errors.empty()) {
            nlohmann::json nearest = ranking(errors, column, inverting);
            nearest["place"] = place;
            return nearest;
        }
    return nullptr;
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
    const CsvTable measured = with_finite(with_finite(metrics, "skin_rms_mm"), "skin_rms_pct");
    const auto in_frames_of = [&](const char* deformer, const char* other) {
        const auto frames = measured.where("deformer", other).by("frame");
        return measured.where([&](const CsvTable::Row& row) {
            return row.text("deformer") == deformer && frames.contains(row.text("frame"));
        });
    };
    const auto rms = [](const CsvTable& frames, const char* column) {
        double squares = 0.0;
        for (const double distance : frames.numbers(column)) squares += distance * distance;
        return std::sqrt(squares / frames.rows());
    };
    const CsvTable lbs = in_frames_of("lbs", "pbs"), pbs = in_frames_of("pbs", "lbs");
    if (lbs.rows() == 0 || rms(lbs, "skin_rms_pct") < least_visible_pct) return nullptr;
    const double lbs_mm = rms(lbs, "skin_rms_mm"), pbs_mm = rms(pbs, "skin_rms_mm");
    return {{"lbs_mm", lbs_mm}, {"pbs_mm", pbs_mm}, {"removed_pct", analysis::removed_share_pct(lbs_mm, pbs_mm)}};
}

// The frame in which the surfaces of pbs and lbs are farthest apart (rms); null where they never differ.
nlohmann::json widest_frame(const CsvTable& distances)
{
    double widest_mm = 0.0;
    nlohmann::json frame;
    for (const CsvTable::Row& row : distances.where({{"deformer", "pbs"}, {"other", "lbs"}}))
        if (const double mm = finite(row, "rms_mm").value_or(0.0); mm > widest_mm) {
            widest_mm = mm;
            frame = row.integer("frame");
        }
    return frame;
}

// The two joints, of a bone and its parent, at which lbs loses most of the body's volume.
nlohmann::json joint_facts(const CsvTable& regions, const CsvTable& bones)
{
    const auto bone = bones.by("bone");
    const auto is_child = [&](const std::string& child, const std::string& parent) {
        return bone.contains(child) && bone.at(child).text("parent") == parent;
    };
    struct JointChange {
        double lbs_pct, pbs_pct, share_pct;  // of the body's volume
        std::string name;
        auto operator<=>(const JointChange&) const = default;
    };
    std::vector<JointChange> joints;
    for (const CsvTable& joint : regions.where("kind", "joint").groups({"bone", "second_bone"})) {
        const std::string &first = joint[0].text("bone"), &second = joint[0].text("second_bone");
        // otherwise their flesh meets, but no joint connects them
        if (!is_child(first, second) && !is_child(second, first)) continue;
        const auto lbs = joint.find({{"deformer", "lbs"}}), pbs = joint.find({{"deformer", "pbs"}});
        if (lbs && pbs)
            joints.push_back({lbs->number("change_pct"), pbs->number("change_pct"), lbs->number("rest_share_pct"),
                              first + " - " + second});
    }
    std::ranges::sort(joints);
    joints.resize(std::min<std::size_t>(joints.size(), 2));
    nlohmann::json names = nlohmann::json::array();
    double share_pct = 0.0, lbs_pct = 0.0, pbs_pct = 0.0;
    for (const JointChange& joint : joints) {
        names.push_back(joint.name);
        share_pct += joint.share_pct;
        lbs_pct += joint.lbs_pct;
        pbs_pct += joint.pbs_pct;
    }
    if (!(share_pct > 0.0)) return nullptr;
    return {{"names", names}, {"lbs_pct", 100.0 * lbs_pct / share_pct}, {"pbs_pct", 100.0 * pbs_pct / share_pct}};
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
