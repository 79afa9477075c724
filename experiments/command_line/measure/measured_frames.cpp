#include "experiments/command_line/measure/measured_frames.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace experiments {
namespace {

// Prints the bounds that do not hold in a frame on stderr. Returns whether all hold.
bool report_broken(const std::vector<analysis::FrameBound>& bounds, const std::string& path,
                   const analysis::FrameValues& values)
{
    bool all_hold = true;
    for (const analysis::FrameBound& bound : bounds) {
        const std::string broken = broken_text(bound, values);
        if (!broken.empty()) fmt::print(stderr, "pbskin: {}: {}\n", path, broken);
        all_hold = all_hold && broken.empty();
    }
    return all_hold;
}

bool has_bound(const MeasureArguments& arguments)
{
    return std::ranges::any_of(arguments.bounds,
                               [](const analysis::FrameBound& bound) { return bound.value.has_value(); });
}

// An option that was not given.
std::string next_step(const MeasureArguments& arguments, const std::string& explanation)
{
    if (!has_bound(arguments)) return explanation + "; --max-volume-change 0.5 holds the volume to a bound";
    if (arguments.reports.junit.empty())
        return explanation + "; --junit FILE writes a report for continuous integration";
    return explanation + (arguments.csv.empty() ? "; --csv FILE writes the values" : "");
}

}  // namespace

void require_separate_outputs(const MeasureArguments& arguments, const std::vector<std::string>& frames)
{
    std::vector<std::string> inputs = frames;
    inputs.push_back(arguments.rest);
    if (!arguments.reference.empty())
        for (const std::string& reference : frame_files({arguments.reference})) inputs.push_back(reference);
    analysis::require_separate(
        {{"--csv", arguments.csv}, {"--shells", arguments.shells}, {"--junit", arguments.reports.junit}}, inputs);
}

MeasuredFrames measure_each(const MeasureArguments& arguments, const std::vector<std::string>& paths,
                            const std::vector<std::string>& names,
                            const std::function<analysis::FrameValues(std::size_t)>& measure_frame)
{
    MeasuredFrames measured;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        try {
            measured.frames.push_back({names[i], measure_frame(i)});
            measured.all_hold =
                report_broken(arguments.bounds, paths[i], measured.frames.back().values) && measured.all_hold;
        } catch (const pbs::InputError& error) {
            fmt::print(stderr, "pbskin: {}\n", error.what());
            measured.refused.push_back({names[i], error.what()});
        }
    }
    return measured;
}

int reported(const MeasureArguments& arguments, const MeasuredFrames& measured, const std::string& explanation)
{
    const std::string suite = std::filesystem::path(arguments.rest).filename().string();
    analysis::CheckSuite report =
        frame_suite(suite, arguments.bounds, measured.frames, measured.refused, measured.stopwatch.seconds());
    report.properties = measured.properties;
    const bool is_judged = measured.not_judged.empty() || !has_bound(arguments);
    if (!is_judged) report.cases.push_back({suite, "whole body", analysis::CheckState::refused, measured.not_judged});
    write_reports(arguments.reports, {report});
    if (!arguments.quiet)
        fmt::print("{}{}\n", is_judged ? "" : "what was measured ",
                   frame_summary(arguments.bounds, measured.frames, measured.refused.size()));
    if (!is_judged)
        throw pbs::InputError(arguments.rest, 0, "", "", "the whole body was not judged: " + measured.not_judged);
    if (!measured.refused.empty()) return exit_input;
    say_next(next_step(arguments, explanation));
    return measured.all_hold ? exit_finished : exit_bound;
}

}  // namespace experiments
