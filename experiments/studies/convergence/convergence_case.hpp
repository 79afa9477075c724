// A body in some poses, iterated from each initial guess, in some orders and precisions and on some meshes (claims C03,
// C12).
//   const ConvergenceResult result = measure_convergence(case_of_the_limb);
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/solver/options.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The initial guesses from which the solver may begin a frame (claim C03). The bind points are always those of the
// frame; only the particles differ when lines 10-14 of Algorithm 1 begin. Nothing jiggles, so the guess is the first
// argument of PbsSolver::advance.
//   lbs             linear blend skinning, as in the paper
//   previous_frame  the solver's result in the previous frame, which began from the one before it, and so on from the
//                   motion's beginning
//   rest_pose       the rest positions, wherever the character is
//   rigid_bind      every vertex moved by its nearest bone alone
// Two further ones are controls: LBS once more, and random positions in the box around the LBS shape, from a fixed
// seed.
//   for (const FrameStarts& frame : starts_of(character, motion, {164, 708}, options))
//       frame.shapes[int(SolverStart::rest_pose)];
enum class SolverStart { lbs, previous_frame, rest_pose, rigid_bind };
inline constexpr std::array<SolverStart, 4> all_starts = {SolverStart::lbs, SolverStart::previous_frame,
                                                          SolverStart::rest_pose, SolverStart::rigid_bind};

const char* name_of(SolverStart start);  // lbs, previous_frame, ..., as in records and keys

struct FrameStarts {
    pbs::Positions bind_points;            // posed q_i [m], #V x 3
    std::array<pbs::Positions, 4> shapes;  // by SolverStart [m], #V x 3
    pbs::Positions random;                 // [m], #V x 3
};

// frames: of the motion, increasing. options: for the bind points, and for the steps that lead to previous_frame, whose
// own bind points are always the bones' material points. Before the first frame previous_frame is LBS.
std::vector<FrameStarts> starts_of(const pbs::Character& character, const pbs::Motion& motion,
                                   const std::vector<int>& frames, const pbs::PbsOptions& options);

// The path of the later code of the paper's first author (pbs/author) in a pose, as in its first frame: from its own
// LBS shape, without velocities. The metrics are those of the paper's constraints.
IterationPath author_path(const pbs::Character& character, const pbs::Pose& pose, int most,
                          const IterationMetrics& iteration_metrics);

struct NamedFrame {
    int frame = 0;
    std::string name;            // twist_90, 01_01_crouch
    analysis::CaseKey key = {};  // motion, angle, time or pose
    bool twist = false;          // about a bone's own axis, which no constraint feels
    bool compared = false;       // with the reference
};

struct ProjectionSetting {
    pbs::Order order = pbs::Order::ordered;
    pbs::Precision precision = pbs::Precision::f32;
};

struct ConvergenceCase {
    Scene scene;
    std::vector<NamedFrame> frames = {};           // increasing
    std::vector<double> k_stretch = {};            // the first one is the scene's
    std::vector<ProjectionSetting> settings = {};  // on the scene's own mesh; on the others only the first one
    std::vector<int> other_vertices = {};          // further meshes by their wanted size
    int every_setting_to = 0;                      // further meshes up to this wanted size take all settings
    bool ladder = false;  // other_vertices are a ladder of sizes with values of their own; otherwise their spread is
                          // the uncertainty
    bool from_lbs_alone = false;  // without the other initial guesses
    int most_iterations = 1000;
    bool exponents = false;       // of a ladder: how the iterations grow with its sizes, which needs all of them
    DeformerSpec reference = {};  // as PosedReference takes it, solved on the scene's own mesh and on those of a ladder
    ReferenceEffort effort = ReferenceEffort::other_tets;  // a ladder has own_tets
    int reference_to = 100000;  // vertices: larger meshes have no reference, and rates.csv states why
};

nlohmann::json to_json(const NamedFrame& frame);
nlohmann::json to_json(const ProjectionSetting& setting);
nlohmann::json to_json(const ConvergenceCase& convergence_case);  // everything that a run of the study depends on

// The quality of a path's reference. Empty where there is none. The bound needs all of its nested solutions.
struct ReferenceQuality {
    std::optional<double> masked_share_pct = {}, bound_pct = {};
};

// A body in a pose, a setting of the solver and, in a row of a record, the initial guess.
struct PathCase {
    std::string body, pose;
    int vertices = 0, tets = 0;
    bool own_mesh = true;  // the scene's
    std::string order, precision;
    double k_stretch = 0.0;
    std::string start = {};
};

struct ConvergencePaths {
    PathCase of;
    analysis::CaseKey key = {};             // of the pose, as NamedFrame has it
    bool character = false, twist = false;  // character: in a clip; twist: see NamedFrame
    std::string reference = {};             // its name, or why there is none
    ReferenceQuality quality = {};
    std::vector<IterationPath> paths = {};  // by SolverStart
    // In the paper's order and precision alone, outside of twists and ladders: from LBS once more and from random
    // positions, and on a character the author's later code. None of them changes the floor of the residual.
    std::vector<IterationPath> controls = {};
    std::optional<IterationPath> author = {};
};

struct ConvergenceResult {
    std::vector<ConvergencePaths> all;
    bool ladder = false;         // as in the case
    std::string breakdown = {};  // paths that ceased to be finite; `reference` states one that was not reached
};

// solutions: the folder in which the solutions of the references are kept (solutions_of_run); "": none.
ConvergenceResult measure_convergence(const ConvergenceCase& convergence_case, const std::string& solutions = "");

// The records of convergence: residuals by iteration, one row per path, and the error to the reference by iteration.

// A path in numbers. Those from the initial guesses are the rows of rates.csv. The columns leave out what the values of
// the claims need too.
enum class PathKind { guess, control, author };
struct RateRow {
    PathKind kind = PathKind::guess;
    analysis::CaseKey key = {};             // as in ConvergencePaths
    bool character = false, twist = false;  // likewise
    PathCase of = {};
    int iterations = 0;
    std::string outcome = {};
    double floor = 0.0;
    double rate = 0.0;  // rate_of
    Reached residual = {}, volume = {};
    Look paper = {}, nearest = {}, last = {};  // after 24 iterations, with the least error, and the last one
    std::string reference = {};
    ReferenceQuality quality = {};
};
extern const analysis::Columns<RateRow> rate_columns;

// residuals.csv and towards.csv: a look of a path.
struct LookRow {
    PathCase of;
    Look look;
};
extern const analysis::Columns<LookRow> residual_columns, towards_columns;

std::vector<LookRow> look_rows(const ConvergenceResult& result);  // thinned to five looks per decade
std::vector<LookRow> towards_rows(std::vector<LookRow> looks);    // those with an error
// One per path: those of a mesh, order and precision follow each other, LBS first, then the controls and the author's
// later code.
std::vector<RateRow> rate_rows(const ConvergenceResult& result);

// The values by which C03 and C12 are judged, from the rows of a case: one per order and precision. The scene's own
// mesh gives the value, and the other meshes of about that size give its range. Where a tolerance is never reached, the
// number of iterations that were tried takes its place and `limit` marks it, so that a ratio is a bound. Where neither
// initial guess reaches the tolerance there is no value; where this happens on another mesh, the range is open. The
// iterations of limbs have a quantity of their own, and so have ratios in twists, in which the rest pose already
// satisfies all constraints. A ladder has no ratios, since its sizes are no independent cases.
std::vector<analysis::Measurement> convergence_values(const std::vector<RateRow>& rows, bool ladder = false);

// The exponent of iterations ~ vertices^exponent follows from these values, over at least three sizes that reach the
// tolerance.
std::vector<analysis::Measurement> convergence_conclusions(const std::vector<analysis::Measurement>& measured);

}  // namespace experiments
