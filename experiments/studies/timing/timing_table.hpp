// The timings of frames as records: beside Table 1 of the paper where a mesh was made to its counts, and as figures of claim C10.
//   timing_table(mesh).write("timing.csv");   measurement_table(timing_measurements(mesh)).write("measurements.csv");
#pragma once

#include "analysis/case_record.hpp"
#include "analysis/records/csv_table.hpp"
#include "experiments/studies/shared/table_1.hpp"
#include "experiments/studies/timing/frame_timing.hpp"

#include <string>
#include <vector>

namespace experiments {

struct TimedMesh {
    std::string name;        // man_1654
    std::string body;        // man
    std::string model;       // of Table 1 whose number of vertices it was made to; empty: a step of the ladder of sizes
    bool stands_in = false;  // the body is not the one that the model names
    int vertices = 0, edges = 0, tets = 0, surface_vertices = 0;
    std::string cpu_model = {};  // that it was timed on
    std::vector<FrameTiming> timings = {};
};

// Columns: mesh, body, model, stands_in, vertices, edges, tets, surface_vertices, *_over_table_1, variant, precision, rounds; *_ms with
// quartiles *_ms_low, *_ms_high of lbs, bind, stretch, volume, rest, total and surface in processor time, of total_wall and drawn_wall
// (with the surface) in wall time; frames_per_s and drawn_frames_per_s by wall time; paper_frames_per_s, paper_ms (of a frame, by its frame
// rate), paper_ct_ms (of a step, by its CT total of 100 steps); cpu_model. Empty where there is none.
analysis::CsvTable timing_table(const TimedMesh& mesh);

// C10, of a mesh made to Table 1: frames a second, LBS included, by wall time with quartiles, of the plain order in f64, which is judged;
// beside it of the other variants, by processor time, and over the paper's; and milliseconds of each part by processor time.
std::vector<analysis::Measurement> timing_measurements(const TimedMesh& mesh);

}  // namespace experiments
