// The measurements of the study `timing`: the cost of a frame and of its parts, the cost of each optional feature of a
// scene, and the time that each order of projection takes to an equal answer. study.cpp has the list of the runs;
// bench.hpp is a measurement of its own.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/solver/options.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The cost of a frame of a character on one core, and its parts: LBS, the three classes of constraints over 24
// iterations, the whole frame as a deformer computes it, and the same with the embedded surface. The variants take
// turns.
//   const std::vector<FrameTiming> timings = time_frames(character, motion, 0.9, {.seconds = 2.0});
// Every turn continues in the motion by a few frames. Whole frames are measured in wall time, from which a frame rate
// follows, and in processor time of the thread; parts are measured in processor time. A class is timed over its 24
// iterations without the other classes in between, so that the clock is read twice per class. Its work does not depend
// on its values, but small meshes stay in the cache, so the parts need not add up.

inline constexpr int usual_frames_per_turn = 2;

struct FrameTiming {
    std::string variant = {}, precision = {};  // plain, ordered; f32, f64
    Spread lbs_ms = {}, bind_ms = {}, stretch_ms = {}, volume_ms = {};
    // a step without iterations: bind points, prediction, copies in and out, velocities
    Spread rest_ms = {};
    Spread total_ms = {}, total_wall_ms = {};  // with LBS
    // the embedded surface, which is not part of the total; empty without a surface
    std::optional<Spread> surface_ms = {};
    std::optional<Spread> drawn_wall_ms = {};  // total_wall_ms and the surface; empty without a surface
};

// plain f64, plain f32, ordered f32. k_jiggle: stiffness of the stretch constraints in the jiggling zone, as in
// Table 1.
std::vector<FrameTiming> time_frames(const pbs::Character& character, const pbs::Motion& motion, double k_jiggle,
                                     const Rounds& rounds, int frames_per_turn = usual_frames_per_turn);

// The records of the study: what a run depends on, the table timing.csv next to Table 1 of the paper, and the values of
// claim C10.
//   const std::vector<TimingRow> rows = timing_rows(mesh, time_frames(character, motion, 0.9, rounds));
//   table_of(timing_columns, rows).write("timing.csv");
//   measurement_table(timing_measurements(rows)).write("measurements.csv");
struct TimedCase {
    std::string name;  // of the mesh: man_1654
    Scene scene;       // the character and its motion
    // the row of Table 1 whose number of vertices the mesh is made to; empty: a step of the ladder of sizes
    std::string model = {};
    bool stands_in = false;  // the body is not the one that the model names
    double k_jiggle = 0.9;   // as for time_frames
    double seconds = 2.0;    // of one core for all rounds, about
    int fewest_rounds = 3;   // however long they take
};
// Includes the processor, since times of two processors do not belong together.
nlohmann::json to_json(const TimedCase& timed_case);

// One variant on one mesh. The values next to the paper's are empty for a mesh of the ladder.
struct TimingRow {
    std::string mesh, body, model = {};  // mesh: its name; the others as in TimedCase
    bool stands_in = false;
    bool is_refined = false;  // every tet of the body is cut into eight: a mesh beyond real time
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

// C10, for meshes made to Table 1 (variant table_1): frames per second by wall time, LBS included, with quartiles. The
// plain order in f64 is judged. For comparison: the other variants, processor time, and the milliseconds of each part.
// A refined mesh (variant refined) has the frame rate that is judged, as a control. The conclusions follow.
std::vector<analysis::Measurement> timing_measurements(const std::vector<TimingRow>& rows);

// The ratio of each frame rate of the method to the paper's in the same row of Table 1 (C10b).
std::vector<analysis::Measurement> timing_conclusions(const std::vector<analysis::Measurement>& measured);

// The frame rate of the later code of the paper's first author (pbs/author) with its own number of iterations,
// likewise. mesh: as above.
analysis::Measurement author_frame_rate(const TimingRow& mesh, const pbs::Character& character,
                                        const pbs::Motion& motion, const Rounds& rounds);

// real_time.csv: the size at which the ladder leaves real time. timings: timing.csv.
analysis::CsvTable real_time_ends(const analysis::CsvTable& timings);

// The work of a run: writes timing.csv, and measurements.csv for a mesh made to Table 1.
std::string measure_frames(const TimedCase& timed_case, const std::string& folder);

// The optional features of a scene, as pairs of scenes that differ in one feature alone.

// A scene's settings on top of the bare scene: PBS alone, no reference, no frames on disk and no metrics except the
// volume.
struct Variant {
    std::vector<std::string> overrides = {};  // key=value
    int threads = 1;
    bool progress = false;  // a progress bar on a terminal

    bool operator==(const Variant&) const = default;
};

// A pair of scenes that differ in one feature alone.
struct Feature {
    std::string name;
    Variant without = {}, with = {};
    bool changes_result = false;  // the positions; how far they move is measured too
};

// The features of a case of cases.toml: features = [{ name = "sleep", with = ["pbs.sleep=true"], changes_result = true
// }, ...]. Further keys of a feature: without, threads and progress (of the second scene), and only = "human" for one
// of the case's bodies.
std::vector<Feature> features_of(const StudyCase& study_case);

Scene scene_of(const std::string& name, const std::vector<std::string>& cut, const Variant& variant);

// The cost of a feature: time and memory of both scenes of the pair, and how far the result moves.
//   const Samples with = take_turns(...)[0];   // each turn is costs_of_run(run_scene_alone(scene, folder), scene)
//   table_of(feature_columns, {feature_row("limb", feature, without, with)}).write("features.csv");

// A scene with features. `scene` and `cut` are a built-in scene and its overrides.
struct FeaturesCase {
    std::string name, scene;
    std::vector<std::string> cut;
    std::vector<Feature> features = {};
    Rounds rounds = {};
};
nlohmann::json to_json(const Variant& variant);
nlohmann::json to_json(const Feature& feature);
nlohmann::json to_json(const FeaturesCase& features_case);

struct Compared {
    Spread without, with, ratio;  // ratio: with / without in the same round
};
// std::logic_error unless both have the same number of rounds, at least one.
Compared compare(const std::vector<double>& without, const std::vector<double>& with);

// How far the result is from the one without the feature, over the frames.
struct ResultChange {
    double distance_m = 0.0;             // largest of a vertex
    double volume_difference_pct = 0.0;  // largest |difference of volume_change_pct|
};
ResultChange change_between(const Scene& without, const Scene& with);  // of their PBS deformers

struct FeatureRow {
    std::string scene, feature;
    int rounds = 0;
    Compared frame_ms, frame_cpu_ms, step_ms, step_cpu_ms, start_s, peak_mb;
    int shared_objects_without = 0, shared_objects_with = 0;
    std::optional<ResultChange> change;
};
extern const analysis::Columns<FeatureRow> feature_columns;

// The costs of one run of a scene from its run.json, in the order of FeatureRow: frame_ms to peak_mb, then the shared
// objects.
std::vector<double> costs_of_run(const nlohmann::json& run, const Scene& scene);

FeatureRow feature_row(const std::string& scene, const std::string& feature, const Samples& without,
                       const Samples& with, const std::optional<ResultChange>& change = {});

// The work of a run: writes features.csv. Each scene runs in a process of its own, and they take turns. Returns the
// first breakdown, or "".
std::string measure_features(const FeaturesCase& features_case, const std::string& folder);

// Measures the residuals and volume changes of every order of projection, in both precisions and for several sequences
// of the constraints, and the time until they are reached. The case is one body in one pose, and the initial guess is
// LBS.
//   const std::vector<TargetRow> rows = target_rows(of.of, measure_orders(of));
// The sequences: file order, spread (that of bench's plain_spread) and random ones. `poses` projects sixteen poses side
// by side. The results of each are bit-identical to those of `ordered`, and only the time differs.

// A limb that tapers, of 2,025 vertices and 9,216 tets on a regular grid: the body on which the order of projection
// matters most. The bodies of the mesher list their tets in no particular order; here the file order is a sweep through
// the body.
//   (======______)    x from -1 to 1 m, radius from 0.24 to 0.12 m, bones as those of the limb: o=====o=====o
// 25 layers of 9 x 9 vertices; each cube is cut into six tets along a diagonal. Weights by Eq. 2.
pbs::Character tapered_limb();

struct EqualQualityCase {
    analysis::CaseKey
        of;         // body, motion, and angle or pose; the body tapered_limb takes the place of the scene's character
    Scene scene;    // its character, motion and options of PBS
    int frame = 0;  // of its motion
    std::vector<int> random = {};  // seeds of the random sequences
    int most_iterations = 1000;    // where the limit is read
    Rounds rounds = {};            // of the timings
};
nlohmann::json to_json(const EqualQualityCase& quality_case);

inline const std::string file_sequence = "file", spread_sequence = "spread";

struct MeasuredOrder {
    std::string order;           // plain, ordered, poses
    std::string precision = {};  // f32, f64
    std::string sequence = {};   // file, spread, random_1, ...
    IterationPath path = {};
    Spread ms_iteration = {};  // per pose, processor time of one thread
};

// The first one is `plain` in file order.
std::vector<MeasuredOrder> measure_orders(const EqualQualityCase& quality_case);

// orders.csv, one row per order, precision and sequence: the answer after the paper's 24 iterations and in the limit.
struct OrderRow {
    analysis::CaseKey of;  // body, motion, angle or pose, order, precision
    std::string sequence;
    Spread ms_iteration;
    Look after_24, limit,
        half;  // limit: after the last iteration, which is reached if half of the iterations give the same
};
extern const analysis::Columns<OrderRow> order_columns;
std::vector<OrderRow> order_rows(const analysis::CaseKey& key, const std::vector<MeasuredOrder>& measured);

// targets.csv, one row per order, precision, sequence and target: when it first reaches the target. A target is a
// residual or an absolute volume change: those that `plain` has after 24 iterations in file order in the same
// precision, and the paper's 0.5 % and 2 %. It is reached at the first iteration at which the value is not above it.
// Where an order does not reach a target within all iterations, the record states the limit, which lies above the
// bound.
struct TargetRow {
    analysis::CaseKey of;
    std::string sequence;
    std::string target;  // residual_of_plain, volume_of_plain, volume_2_pct, volume_05_pct
    double bound = 0.0;  // a ratio, or per cent
    bool reached = false;
    std::optional<int> iterations = {};  // nothing if it was not reached
    std::optional<double> ms = {};       // those iterations in the median time of one
    double limit = 0.0;                  // the value that the order converges to
};
extern const analysis::Columns<TargetRow> target_columns;
// std::logic_error without `plain` in file order.
std::vector<TargetRow> target_rows(const analysis::CaseKey& key, const std::vector<MeasuredOrder>& measured);

// The first look at which the value is not above the bound.
std::optional<int> first_within(const IterationPath& path, double Look::*value, double bound);

// answers.csv of the study, one row per case, order, precision and target in file order. A speed-up is the ratio of the
// times to the target. There is none where either never reaches it.
// targets: targets.csv. InputError without `plain` in both sequences.
analysis::CsvTable equal_answers(const analysis::CsvTable& targets);

// The work of a run: writes orders.csv and targets.csv. Returns what broke down, or "".
std::string measure_equal_quality(const EqualQualityCase& quality_case, const std::string& folder);

}  // namespace experiments
