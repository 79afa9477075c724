#include "experiments/run/broken_frames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace experiments {
namespace {

void find_vertices(BrokenFrame& broken, const pbs::Positions& positions)
{
    for (Eigen::Index v = 0; v < positions.rows(); ++v) {
        if (positions.row(v).allFinite()) continue;
        if (broken.vertex < 0) broken.vertex = static_cast<int>(v);
        ++broken.vertices;
    }
}

void find_tet(BrokenFrame& broken, const Eigen::VectorXd& volume_ratios)
{
    if (volume_ratios.size() == 0) return;
    Eigen::Index tet = 0;
    broken.volume_ratio = volume_ratios.minCoeff(&tet);
    broken.tet = static_cast<int>(tet);
    broken.inverted_tets = static_cast<int>((volume_ratios.array() <= 0.0).count());
}

bool is_finite(const BrokenFrame& broken)
{
    return broken.what != pbs::to_string(pbs::Outcome::not_finite);
}

}  // namespace

BrokenFrame broken_frame(int frame, pbs::Outcome outcome, const pbs::Positions& positions,
                         const Eigen::VectorXd& volume_ratios)
{
    BrokenFrame broken{.frame = frame,
                       .what = outcome == pbs::Outcome::finished ? "inverted" : pbs::to_string(outcome)};
    find_vertices(broken, positions);
    if (broken.vertices == 0) find_tet(broken, volume_ratios);
    return broken;
}

std::string worst_element(const BrokenFrame& broken)
{
    if (broken.vertices > 0) return fmt::format("first at vertex {}, {} not finite", broken.vertex, broken.vertices);
    return fmt::format("worst tet {} of volume ratio {:.3g}, {} inverted", broken.tet, broken.volume_ratio,
                       broken.inverted_tets);
}

std::string what_of(const BrokenFrame& broken)
{
    std::string what = broken.what;
    std::replace(what.begin(), what.end(), '_', ' ');
    return what;
}

std::string text_of(const BrokenFrame& broken)
{
    const std::string step = broken.step < 0 ? "" : fmt::format(" (in step {}, before it)", broken.step);
    return fmt::format("{} in frame {}{}: {}", what_of(broken), broken.frame, step, worst_element(broken));
}

void to_json(nlohmann::json& json, const BrokenFrame& broken)
{
    json = {{"frame", broken.frame}, {"what", broken.what}};
    if (broken.step >= 0) json["step"] = broken.step;
    if (broken.vertices > 0)
        json.update({{"first_vertex", broken.vertex}, {"vertices_not_finite", broken.vertices}});
    else
        json.update({{"worst_tet", broken.tet},
                     {"volume_ratio", broken.volume_ratio},
                     {"inverted_tets", broken.inverted_tets}});
}

void from_json(const nlohmann::json& json, BrokenFrame& broken)
{
    json.at("frame").get_to(broken.frame);
    json.at("what").get_to(broken.what);
    broken.step = json.value("step", -1);
    if (json.contains("first_vertex")) {
        json.at("first_vertex").get_to(broken.vertex);
        json.at("vertices_not_finite").get_to(broken.vertices);
    } else {
        json.at("worst_tet").get_to(broken.tet);
        json.at("volume_ratio").get_to(broken.volume_ratio);
        json.at("inverted_tets").get_to(broken.inverted_tets);
    }
}

const BrokenFrames::Entry* BrokenFrames::first_unexpected(bool finite) const
{
    const auto first = std::ranges::find_if(
        entries_, [&](const Entry& entry) { return !entry.is_expected && is_finite(entry.frame) == finite; });
    return first == entries_.end() ? nullptr : &*first;
}

std::string BrokenFrames::breakdown() const
{
    const Entry* first = first_unexpected(false);
    return first ? fmt::format("{} is {}", first->label, text_of(first->frame)) : "";
}

std::string BrokenFrames::bad_frame(int frames) const
{
    const Entry* first = first_unexpected(true);
    if (!first) return "";
    std::map<std::string, int> broken;  // of each deformer, also those that were not finite
    std::set<std::string> bad_labels;
    for (const Entry& entry : entries_) {
        ++broken[entry.label];
        if (!entry.is_expected && is_finite(entry.frame)) bad_labels.insert(entry.label);
    }
    std::vector<std::string> counts;  // "3 of 31 frames of nh_p1"
    for (const std::string& label : bad_labels)
        counts.push_back(fmt::format("{} of {} frames of {}", broken.at(label), frames, label));
    const bool was_reached = first->frame.what != pbs::to_string(pbs::Outcome::not_converged);
    return fmt::format("{}: {} is {}; {} broke down", was_reached ? "inverted tets" : "pose not reached", first->label,
                       text_of(first->frame), fmt::join(counts, ", "));
}

std::map<std::string, std::vector<int>> BrokenFrames::frames_with(pbs::Outcome outcome) const
{
    std::map<std::string, std::vector<int>> frames;
    for (const Entry& entry : entries_)
        if (entry.frame.what == pbs::to_string(outcome)) frames[entry.label].push_back(entry.frame.frame);
    return frames;
}

nlohmann::json BrokenFrames::record(int frames) const
{
    std::map<std::string, std::vector<BrokenFrame>> broken;
    for (const Entry& entry : entries_) broken[entry.label].push_back(entry.frame);
    return {{"breakdown", breakdown()},
            {"bad_frame", bad_frame(frames)},
            {"breakdowns", frames_with(pbs::Outcome::not_finite)},
            {"not_converged", frames_with(pbs::Outcome::not_converged)},
            {"broken_frames", broken}};
}

}  // namespace experiments
