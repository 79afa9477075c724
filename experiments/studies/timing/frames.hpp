// The cost of a frame of a character on one core, and its parts: LBS, the three classes of constraints over 24 iterations, the whole frame
// as a deformer computes it, and the same with the embedded surface. The variants take turns.
//   const std::vector<FrameTiming> timings = time_frames(character, motion, 0.9, {.seconds = 2.0});
// Every turn continues in the motion by a few frames. Whole frames are measured in wall time, from which a frame rate follows, and in
// processor time of the thread; parts are measured in processor time. A class is timed over its 24 iterations without the other classes in
// between, so that the clock is read twice per class. Its work does not depend on its values, but small meshes stay in the cache, so the
// parts need not add up.
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/character/character.hpp"
#include "pbs/solver/options.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

inline constexpr int timed_iterations = 24;

inline constexpr int usual_frames_per_turn = 2;

struct FrameTiming {
    std::string variant = {}, precision = {};  // plain, ordered; f32, f64
    Spread lbs_ms = {}, bind_ms = {}, stretch_ms = {}, volume_ms = {};
    Spread rest_ms = {};                       // a step without iterations: bind points, prediction, copies in and out, velocities
    Spread total_ms = {}, total_wall_ms = {};  // with LBS
    std::optional<Spread> surface_ms = {};     // the embedded surface, which is not part of the total; empty without a surface
    std::optional<Spread> drawn_wall_ms = {};  // total_wall_ms and the surface; empty without a surface
};

// plain f64, plain f32, ordered f32. k_jiggle: stiffness of the stretch constraints in the jiggling zone, as in Table 1.
std::vector<FrameTiming> time_frames(const pbs::Character& character, const pbs::Motion& motion, double k_jiggle, const Rounds& rounds,
                                     int frames_per_turn = usual_frames_per_turn);

// The records of the study: what a run depends on, the table timing.csv next to Table 1 of the paper, and the values of claim C10.
//   const std::vector<TimingRow> rows = timing_rows(mesh, time_frames(character, motion, 0.9, rounds));
//   table_of(timing_columns, rows).write("timing.csv");
//   measurement_table(timing_measurements(rows)).write("measurements.csv");
struct TimedCase {
    std::string name;        // of the mesh: man_1654
    Scene scene;             // the character and its motion
    std::string model = {};  // the row of Table 1 whose number of vertices the mesh is made to; empty: a step of the ladder of sizes
    bool stands_in = false;  // the body is not the one that the model names
    double k_jiggle = 0.9;   // as for time_frames
    double seconds = 2.0;    // of one core for all rounds, about
};
// Includes the processor, since times of two processors do not belong together.
nlohmann::json to_json(const TimedCase& of);

// One variant on one mesh. The values next to the paper's are empty for a mesh of the ladder.
struct TimingRow {
    std::string mesh, body, model = {};  // mesh: its name; the others as in TimedCase
    bool stands_in = false;
    int vertices = 0, edges = 0, tets = 0, surface_vertices = 0;
    std::string cpu_model = {};
    FrameTiming timing = {};
    double frames_per_s = 0.0;  // by wall time, as drawn_frames_per_s
    std::optional<double> drawn_frames_per_s = {}, paper_frames_per_s = {};
    std::optional<double> vertices_over_table_1 = {}, edges_over_table_1 = {}, tets_over_table_1 = {};
    std::optional<double> paper_ms = {}, paper_ct_ms = {};  // by the paper's frame rate, and by its CT
};
extern const analysis::Columns<TimingRow> timing_columns;

struct TableOneRow;
const TableOneRow* table_1_row(const std::string& model);  // null: there is none

// One row per timing. mesh: the values that all of them have.
std::vector<TimingRow> timing_rows(const TimingRow& mesh, const std::vector<FrameTiming>& timings);

// C10, for meshes made to Table 1: frames per second by wall time, LBS included, with quartiles. The plain order in f64 is judged. For
// comparison: the other variants, processor time, the ratio to the paper's frame rate, and the milliseconds of each part.
std::vector<analysis::Measurement> timing_measurements(const std::vector<TimingRow>& rows);

// real_time.csv: the size at which the ladder leaves real time.
struct RealTimeEnd {
    std::string variant, precision;
    double vertices = 0.0;
    bool is_beyond = false;
    double exponent = 0.0;
};
extern const analysis::Columns<RealTimeEnd> real_time_columns;
std::vector<RealTimeEnd> real_time_ends(const std::vector<TimingRow>& rows);

// All meshes and the end of real time, for the terminal.
std::string timing_text(const std::vector<TimingRow>& rows);

// The work of a run: writes timing.csv, and measurements.csv for a mesh made to Table 1.
std::string measure_frames(const TimedCase& of, const std::string& folder);

}  // namespace experiments
