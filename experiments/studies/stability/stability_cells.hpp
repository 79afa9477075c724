// The cells of the map of stability, by method, how each is run, and the outcomes as records.
#pragma once

#include "analysis/metrics/stability_outcome.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_names.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The shape that the first step receives instead of the blended one. none: the blended one.
enum class Start { none, flattened, mirrored, random, point };

// The body begins at rest in the first pose of its motion and stays in the last. A limb's forearm turns about `axis`
// (rest world axes) to angle_deg in even steps; a character lands from a jump, 36 steps of its clip. In other cells the
// whole body is moved in one step, or its initial shape is broken.
struct Disturbance {
    pbs::Vec3 axis = pbs::Vec3::UnitZ();
    double angle_deg = 90.0;  // 0: a character stays in its rest pose
    int turning_steps = 10;
    double teleport_m = 0.0;  // along (1, 1, 1)
    Start start = Start::none;
    bool stays = false;  // in the last pose from the beginning
};

// Tets that are distorted before anything is bound: a seeded share of the vertices is moved until a tet at each is
// thin.
enum class Defect { none, slivers, needles };

template <>
inline constexpr NameTable<Start, 5> option_names<Start>{{{Start::none, "none"},
                                                          {Start::flattened, "flattened"},
                                                          {Start::mirrored, "mirrored"},
                                                          {Start::random, "random"},
                                                          {Start::point, "point"}}};
template <>
inline constexpr NameTable<Defect, 3> option_names<Defect>{
    {{Defect::none, "none"}, {Defect::slivers, "slivers"}, {Defect::needles, "needles"}}};

// The seed of masses, distorted tets and random initial shapes.
inline constexpr unsigned stability_seed = 20140528;

// A body, a method with its settings, a disturbance, and the factor that the cell varies.
struct StabilityCell {
    std::string body = "limb";  // or a character
    std::string model, factor;  // e.g. pbs_jiggle, time_step
    double value = 0.0;
    std::string unit;
    std::string second_factor = {};  // of a map
    double second_value = 0.0;
    std::string second_unit = {};
    std::string named = {};  // value of a factor without numbers: flattened

    DeformerSpec spec;
    Disturbance disturbance;
    double time_step_s = 0.01;
    int still_steps = 100;
    Defect defect = Defect::none;
    double thinness = 1.0;    // share of the height or edge that the moved vertices keep
    double mass_ratio = 1.0;  // heaviest over lightest particle of a PBS body, seeded
    bool held_end = false;    // a tenth of the limb has infinite mass
    // The whole body is moved along x by this length in every second step, for a method that does not step a pose that
    // equals the last one.
    double nudge_m = 0.0;

    bool as_published =
        false;  // the paper's method with settings that it allows; those in the paper's order and f64 are judged
};

std::string precision_of(const StabilityCell& cell);  // f32, f64
nlohmann::json to_json(const Disturbance& disturbance);
nlohmann::json to_json(const StabilityCell& cell);  // all members
// body, method, place and last pose: all members except those of the way to it
std::string setting_of(const StabilityCell& cell);

void append(std::vector<StabilityCell>& cells, std::vector<StabilityCell> more);

// The cells of a list in cases.toml, for one of the bodies. InputError for an option out of its range.
//   stability_cells("pbs_character", "human");
std::vector<StabilityCell> stability_cells(const std::string& list, const std::string& body = StabilityCell().body);

// The body of a cell and its motion: the pose, the blended shape and the bind points of each step.
//   StabilityBody body(cell);
//   for (int step = 0; step < body.steps(); ++step) driven->advance(body.drive(step), cell.time_step_s);
// A drive is the input of every method in a step.
struct Drive {
    const pbs::Pose& pose;
    const pbs::Positions& blended;      // LBS, or the broken initial shape [m], #V x 3
    const pbs::Positions& bind_points;  // posed q_i [m], #V x 3
};

// The scene of the cells of `body`: a limb, or a character that lands from a jump.
Scene stability_scene(const std::string& body);

// Characters are cached, so that all cells have the same tets.
const pbs::Character& stability_character(const StabilityCell& cell);

class StabilityBody {
public:
    explicit StabilityBody(const StabilityCell& cell);

    const pbs::Character& character() const { return character_; }
    int disturbed_steps() const { return static_cast<int>(way_.size()); }
    int steps() const { return disturbed_steps() + still_steps_; }
    Drive drive(int step);  // valid until the next call
    double diagonal_m() const { return diagonal_m_; }

private:
    const pbs::Character& character_;
    std::vector<pbs::Pose> way_;
    Start start_;
    int still_steps_, posed_ = -1;
    double diagonal_m_;
    pbs::Positions blended_, bind_points_;
};

// A body under one of the methods, driven step by step. All cells use this interface, whatever their method.
//   const auto driven = make_driven_body(cell, character);
//   const pbs::StepSummary step = driven->advance(drive, dt);
class DrivenBody {
public:
    virtual ~DrivenBody() = default;
    virtual pbs::StepSummary advance(const Drive& drive, double dt_s) = 0;
    virtual const pbs::Positions& positions() const = 0;  // [m], #V x 3
};

std::unique_ptr<DrivenBody> make_driven_body(const StabilityCell& cell, const pbs::Character& character);

struct CellResult {
    analysis::StabilityResult stability;
    std::vector<analysis::StabilityStep> steps;
    bool has_undisturbed = false;  // the same body comes to rest when it begins in the last pose
    int steps_not_reached = 0;
    // From a broken initial state: the method's iterations up to and including the first step that was reached. For
    // Newton's method this is the number until the residual was within tolerance, including a first solve that failed.
    // PBS and XPBD always do all their iterations.
    std::optional<int> iterations_until_reached;
    double cpu_s = 0.0;
};
// Runs a cell twice, disturbed and undisturbed, and determines its outcome.
CellResult run_cell(const StabilityCell& cell);
std::string endings_text();  // when a run ends early, as Markdown

// A good mesh made bad on purpose: some vertices are moved so that a tet at each becomes thin, without inverting any
// tet.
//   const pbs::TetMesh spoilt = distorted(mesh, Defect::slivers, 1e-4);
// slivers: a vertex keeps the share `thinness` of its height over the opposite face of one tet. needles: it keeps that
// share of the length of one edge. A seeded twentieth of the vertices is moved, no two of the same tet. Vertices that
// would invert a tet are skipped.
pbs::TetMesh distorted(const pbs::TetMesh& mesh, Defect defect, double thinness);

struct MeasuredCell {
    StabilityCell cell;
    CellResult result;
};

// A row of cells.csv: a cell and its outcome.
struct CellRow {
    StabilityCell of;
    std::optional<double> second_value;
    std::string precision;
    int steps = 0;
    std::string outcome;
    std::optional<int> recovery_steps;
    std::optional<double> recovery_s;
    std::optional<int> iterations_until_reached;
    std::string undisturbed_at_rest;
    double largest_reach_diagonals = 0.0;
    std::optional<double> last_reach_diagonals, last_motion_diagonals, last_from_undisturbed_diagonals;
    int most_inverted_tets = 0;
    std::optional<int> last_inverted_tets;
    int steps_not_reached = 0;
    std::string as_published;
    double cpu_s = 0.0;
};
extern const analysis::Columns<CellRow> cell_columns;
CellRow cell_row(const MeasuredCell& measured);

// The shares of the cells as published, of their controls, and of the deformers that C08 compares, by body, deformer,
// jiggle, order, precision and factor, each with the number of its cells; one row per quantity. Cells at rest are
// bounded or inverted, no vertex moves in the last steps, and the last step is solved; they are counted by the size of
// their time steps. Their share and that of diverged cells have no interval: one cell refutes "unconditionally", and
// all cells are no sample. The shares of inverted cells, of cells in motion (bounded or inverted, and moving until the
// end) and of cells that end as if undisturbed have the 95 % interval of Clopper and Pearson, as if the cells were
// drawn at random from the settings between them.
analysis::CsvTable stability_measurements(const std::vector<MeasuredCell>& cells);

// The text states why the map is unreliable: an outcome that occurs in no cell, or a cell in which the printed sign
// does not diverge. Empty where there is no such defect.
std::string blind_spots(const std::vector<CellRow>& cells);

// The cells of a map, one row each, with both values and the outcome.
analysis::CsvTable map_csv(const std::vector<CellRow>& cells, const std::string& factor,
                           const std::string& second_factor);

// Does a deformer that minimises an energy find its own result again from a broken initial shape, and after how many
// iterations?
//   for (const StabilityCell& cell : stability_cells("broken_starts"))
//       rows.push_back(run_broken_start(cell, most_iterations));
// The deformer runs from the broken shape with 1, 2, 4, ... iterations, up to the most, and once with the most from its
// own initial guess. The result of the latter is its own result. These runs differ from a scene only in the initial
// shape and in the number of iterations. The outcomes in cells.csv cannot show this: there a deformer without memory
// forgets a broken shape after one step.

// The distance from the deformer's own result below which it counts as reached: root mean square over the vertices at
// the joints, over their mean distance to the bones.
inline constexpr double reached_within_pct = 1.0;

// diverged: a vertex is farther than a diagonal of the body from its place in the own result
// (StabilityBounds::farthest).
enum class StartOutcome { reached, not_reached, diverged, not_finite, not_applicable };
template <>
inline constexpr NameTable<StartOutcome, 5> option_names<StartOutcome>{
    {{StartOutcome::reached, "reached"},
     {StartOutcome::not_reached, "not_reached"},
     {StartOutcome::diverged, "diverged"},
     {StartOutcome::not_finite, "not_finite"},
     {StartOutcome::not_applicable, "not_applicable"}}};

// A row of starts.csv.
struct StartRow {
    std::string body, model, precision = {};
    std::string pose = {};                     // bend_90, twist_90
    std::string start = {};                    // flattened, mirrored, random, point
    std::string setting = {};                  // the option that the row changes; empty: all have their defaults
    std::optional<double> setting_value = {};  // its value
    StartOutcome outcome = StartOutcome::not_reached;
    // the first number of iterations from which on all are within the distance
    std::optional<int> iterations_until_reached = {};
    int most_iterations = 0;
    std::optional<double> from_own_result_pct = {};  // after the most iterations; empty: not finite
    // of the own result in the second half of the iterations; empty: not finite
    std::optional<double> own_change_pct = {};
    std::optional<int> inverted_tets = {}, own_inverted_tets = {};
    std::string reason = {};  // why a start is not applicable
    double cpu_s = 0.0;
};
extern const analysis::Columns<StartRow> start_columns;

StartRow run_broken_start(const StabilityCell& cell, int most_iterations);

// The other deformers of the map, with the reason why they have no broken start.
std::vector<StartRow> starts_not_applicable();

std::string start_criteria_text(int most_iterations);  // the definitions in words, as Markdown

}  // namespace experiments
