// The timings of frames as records: beside Table 1 of the paper where a mesh was made to its counts, as figures of claim C10, and the size
// up to which it is real time.
#pragma once

#include "analysis/case_record.hpp"
#include "analysis/csv_table.hpp"
#include "experiments/audit/table_1.hpp"
#include "experiments/timing/frame_timing.hpp"

#include <string>
#include <vector>

namespace experiments {

struct TimedMesh {
    std::string name;        // man_1654
    std::string body;        // man
    std::string model;       // of Table 1 whose number of vertices it was made to; empty: a step of the ladder of sizes
    bool stands_in = false;  // the body is not the one that the model names
    int vertices = 0, edges = 0, tets = 0, surface_vertices = 0;
    std::vector<FrameTiming> timings = {};
};

// Columns: mesh, body, model, vertices, edges, tets, *_over_table_1, variant, precision, rounds, and of LBS, bind, stretch, volume, rest,
// total, total_wall, surface: *_ms with quartiles *_ms_low, *_ms_high; frames_per_s; paper_frames_per_s, paper_ms (of a frame, by its frame
// rate), paper_ct_ms (of a step, by its CT total of 100 steps). Empty where there is none.
analysis::CsvTable timing_table(const TimedMesh& mesh);

// C10, of a mesh made to Table 1: frames a second with quartiles, over the paper's, and milliseconds of each part. By processor time.
std::vector<analysis::Measurement> timing_measurements(const TimedMesh& mesh);

// Of the ladder's rows of one variant: vertices at which a frame takes 1 / 30 s, on the straight line through log total over log vertices
// between the two sizes around it, or beyond the last two; with the exponent over all sizes.
struct RealTimeEnd {
    double vertices = 0.0;
    bool beyond = false;  // all sizes measured are quicker, or all slower
    double exponent = 0.0;
};
RealTimeEnd real_time_end(const std::vector<double>& vertices, const std::vector<double>& total_ms);

// Of all rows put together.
std::string timing_markdown(const analysis::CsvTable& table);
std::string timing_text(const analysis::CsvTable& table);

}  // namespace experiments
