// `pbskin measure` for frames of any kind: each is measured and compared with the bounds, and the result is reported.
//   const auto values = [&](std::size_t frame) { return values_of(read(paths[frame])); };
//   MeasuredFrames measured = measure_each(arguments, paths, names, values);
//   return reported(arguments, measured, "pbskin explain volume_change_pct explains a column");
#pragma once

#include "analysis/check/check.hpp"
#include "experiments/verdicts/check/check_run.hpp"
#include "pbs/geometry/cost.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct MeasureArguments {
    std::string rest, csv, shells, reference, displacement, animation;
    std::vector<std::string> frames;
    std::optional<int> most_frames = {};  // of an animation; nothing: 60
    bool any_step = false, quiet = false;
    bool closed_only = false;  // of a surface: open shells are excluded, and limits judge the others
    std::vector<analysis::FrameBound> bounds = analysis::known_frame_bounds();
    CheckReports reports;
};

struct MeasuredFrames {
    std::vector<analysis::MeasuredFrame> frames;
    std::vector<analysis::RefusedFrame> refused;
    bool all_hold = true;
    // why the limits say nothing of the whole body; empty: they do
    std::string not_judged = {};
    std::vector<std::pair<std::string, std::string>> properties = {};  // of the report: name, value
    pbs::Stopwatch stopwatch = {};
};

// InputError if --csv, --shells or --junit names the rest, a frame, a reference or one file twice.
void require_separate_outputs(const MeasureArguments& arguments, const std::vector<std::string>& frames);

// measure_frame returns the values of a frame and prints its row; an InputError of it is reported, and the other frames
// are measured. paths: of the frames in messages; names: in reports.
MeasuredFrames measure_each(const MeasureArguments& arguments, const std::vector<std::string>& paths,
                            const std::vector<std::string>& names,
                            const std::function<analysis::FrameValues(std::size_t)>& measure_frame);

// Writes the reports and prints the result in one line and what to do next. Returns the exit status.
int reported(const MeasureArguments& arguments, const MeasuredFrames& measured, const std::string& explanation);

// Measures a rest tet mesh and its frames; a surface and its frames; a rigged model along its animation. Each returns
// the exit status.
int measure_tets(const MeasureArguments& arguments);
int measure_surfaces(const MeasureArguments& arguments);
int measure_rig(const MeasureArguments& arguments);

}  // namespace experiments
