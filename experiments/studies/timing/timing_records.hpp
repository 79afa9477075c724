// The records of the study: what a run depends on, the table timing.csv next to Table 1 of the paper, and the values of claim C10.
//   const std::vector<TimingRow> rows = timing_rows(mesh, time_frames(character, motion, timed, rounds));
//   table_of(timing_columns, rows).write("timing.csv");
//   measurement_table(timing_measurements(rows)).write("measurements.csv");
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/timing/frame_timing.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct TimedCase {
    Scene scene;             // the character and its motion
    std::string model = {};  // the row of Table 1 whose number of vertices the mesh is made to; empty: a step of the ladder of sizes
    bool stands_in = false;  // the body is not the one that the model names
    double k_jiggle = 0.9;   // as TimedFrames
    double seconds = 2.0;    // of one core for all rounds, about

    std::string name() const;  // man_1654
};

// Includes the processor, since times of two processors do not belong together.
nlohmann::json to_json(const TimedCase& of);

struct TimedMesh {
    std::string name, body, model = {};  // as TimedCase
    bool stands_in = false;
    int vertices = 0, edges = 0, tets = 0, surface_vertices = 0;
    std::string cpu_model = {};
};

// One variant on one mesh. The values next to the paper's are empty for a mesh of the ladder.
struct TimingRow {
    TimedMesh mesh;
    FrameTiming timing;
    double frames_per_s = 0.0;  // by wall time, as drawn_frames_per_s
    std::optional<double> drawn_frames_per_s = {}, paper_frames_per_s = {};
    std::optional<double> vertices_over_table_1 = {}, edges_over_table_1 = {}, tets_over_table_1 = {};
    std::optional<double> paper_ms = {}, paper_ct_ms = {};  // by the paper's frame rate, and by its CT
};
extern const analysis::Columns<TimingRow> timing_columns;

std::vector<TimingRow> timing_rows(const TimedMesh& mesh, const std::vector<FrameTiming>& timings);

// C10, for meshes made to Table 1: frames per second by wall time, LBS included, with quartiles. The plain order in f64 is judged. For
// comparison: the other variants, processor time, the ratio to the paper's frame rate, and the milliseconds of each part.
std::vector<analysis::Measurement> timing_measurements(const std::vector<TimingRow>& rows);

// All meshes: a page, and a short table for the terminal, each with the size at which the ladder leaves real time.
std::string timing_markdown(const std::vector<TimingRow>& rows);
std::string timing_text(const std::vector<TimingRow>& rows);

}  // namespace experiments
