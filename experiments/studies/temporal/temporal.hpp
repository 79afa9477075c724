// This measures a deformer along a clip, as an application runs it: the jitter of the skin, the time and the error per
// frame. A deformer that can begin a frame at the shape of the frame before is measured with both starts.
//   table_of(temporal_columns, measure_temporal(of).summary).write("summary.csv");
// With x_t the skin in frame t and y_t the shape of LBS, which is a smooth function of the pose, the jitter of a frame
// is the difference of the second differences, (x_{t+1} - 2 x_t + x_{t-1}) - (y_{t+1} - 2 y_t + y_{t-1}), over the skin
// in millimetres (analysis/metrics/skin_error.hpp).
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_names.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// own: as the method states. frame_before: at the shape of the frame before, which LBS carries with the bones from that
// pose to this one.
enum class FrameStart { own, frame_before };
NAMED_OPTIONS(FrameStart, own, frame_before)

struct TemporalCase {
    analysis::CaseKey of;  // body, motion
    Scene scene;           // its character and motion
    std::vector<DeformerSpec> cold = {}, warm = {};
    DeformerSpec flesh = {};  // of the compared frames
    int compared_every = 30;  // frames, from one that is compared with flesh to the next
};
nlohmann::json to_json(const TemporalCase& temporal_case);

// The values of one frame. The last frame has no jitter, nor have the first 24, in which a deformer with memory leaves
// the rest pose.
struct TemporalFrame {
    std::string deformer;
    FrameStart start = FrameStart::own;
    int frame = 0;
    double ms = 0.0;  // processor time
    std::optional<double> jitter_mm = {}, largest_jitter_mm = {}, error_joint_pct = {};
};
extern const analysis::Columns<TemporalFrame> temporal_frame_columns;  // frames.csv

// Over the clip.
struct TemporalRow {
    analysis::CaseKey of;
    std::string deformer;
    FrameStart start = FrameStart::own;
    int frames = 0;
    double ms_median = 0.0, ms_p95 = 0.0;
    double jitter_mm = 0.0,
           jitter_p95_mm = 0.0;      // root mean square over the frames, and the value that 95 % do not exceed
    double largest_jitter_mm = 0.0;  // of any vertex in any frame
    int largest_in_frame = 0;
    double pose_mm = 0.0;          // root mean square of the second differences of LBS
    int compared = 0;              // frames with flesh that was reached
    double error_joint_pct = 0.0;  // mean over these
    // of these, with the start at the frame before; nothing for the own start
    std::optional<int> worse_than_cold_frames = {};
};
extern const analysis::Columns<TemporalRow> temporal_columns;  // summary.csv

struct TemporalRecords {
    std::vector<TemporalFrame> frames;
    std::vector<TemporalRow> summary;
    std::string breakdown;  // deformers that are not finite
};
TemporalRecords measure_temporal(const TemporalCase& temporal_case);

}  // namespace experiments
