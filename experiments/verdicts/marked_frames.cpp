#include "experiments/verdicts/marked_frames.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/run/broken_frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <map>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// "3 inverted, 1 not converged"
std::string kinds_of(const std::vector<BrokenFrame>& broken)
{
    std::map<std::string, int> counts;
    for (const BrokenFrame& frame : broken) ++counts[what_of(frame)];
    std::vector<std::string> kinds;
    for (const auto& [what, count] : counts) kinds.push_back(fmt::format("{} {}", count, what));
    return fmt::format("{}", fmt::join(kinds, ", "));
}

std::string broken_line(const json& of_deformer, int frames)
{
    const auto broken = of_deformer.get<std::vector<BrokenFrame>>();
    return fmt::format("broke down in {} of {} frames ({}), the first {}", broken.size(), frames, kinds_of(broken),
                       text_of(of_deformer.at(0).get<BrokenFrame>()));
}

std::string marks_of(const json& outcome, const std::string& run)
{
    std::string lines;
    const json none = json::object(), below = outcome.value("frames_below_reference_error", none),
               broken = outcome.value("broken_frames", none);
    if (const int count = outcome.value("frames_with_overlap", 0); count > 0)
        lines += fmt::format("     {}: the reference overlaps itself in {} of {} frames; errors leave out up to {:.2g} % of the volume\n",
                             run, count, outcome.at("frames").get<int>(), outcome.at("largest_masked_share_pct").get<double>());
    for (const auto& [label, count] : below.items())
        lines += fmt::format("     {}: the error of {} at the joints is not above the reference's own in {} of {} frames\n", run, label,
                             count.get<int>(), outcome.at("frames").get<int>());
    for (const auto& [label, frames] : broken.items())
        lines += fmt::format("     {}: {} {}\n", run, label, broken_line(frames, outcome.at("frames").get<int>()));
    return lines;
}

}  // namespace

std::string marked_frames(const std::vector<std::string>& folders)
{
    std::string lines;
    for (const std::string& folder : folders)
        lines += analysis::from_record((fs::path(folder) / "run.json").string(),
                                       [&](const json& run) { return marks_of(run.at("outcome"), fs::path(folder).filename().string()); });
    return lines;
}

}  // namespace experiments
