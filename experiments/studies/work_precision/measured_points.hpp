// The measured points of the study: the meshes of a body, one setting of a deformer that is timed between two poses, the row of each
// setting in points.csv, and all rows of a case.
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/metrics/skin_error.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/work_precision/compared_deformers.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/geometry/cost.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// A mesh of the body: the case's own, or a coarser or finer one. Shapes on it are mapped to the vertices of the case's own mesh, so that
// errors on all meshes are measured at the same points of the flesh and by the same metrics.
//   const BodyMesh coarse(source, 600, base);
//   error_metrics.measure(coarse.on_base(positions), reference);
class BodyMesh {
public:
    explicit BodyMesh(std::shared_ptr<const pbs::Character> base)
        : character_(std::move(base)), base_vertices_(character_->mesh.rest.rows())
    {
    }
    // Another mesh of about so many vertices. Where it ends slightly inside the base's surface, its tets are extended.
    BodyMesh(const pbs::CharacterSource& source, int vertices, const pbs::Character& base);
    // Every tet of the base cut into eight. The first vertices are those of the base.
    static BodyMesh refined(const pbs::Character& base);
    // The base with skinning weights that are harmonic where Eq. 2 blends.
    static BodyMesh with_smooth_weights(const pbs::Character& base);

    const pbs::Character& character() const { return *character_; }
    bool has_base_vertices() const { return !points_; }  // its first vertices are those of the base: nothing has to be transferred
    // The positions of the base's vertices [m], #V_base x 3, from those of its own vertices, #V x 3.
    pbs::Positions on_base(const pbs::Positions& positions) const;
    // The largest distance of a vertex of the base from its tets [m].
    double largest_distance_outside_m() const { return points_ ? points_->largest_distance_outside_m : 0.0; }

private:
    std::shared_ptr<const pbs::Character> character_;
    std::optional<pbs::EmbeddedSurface> points_;  // the base's vertices; nothing: they are the first ones
    Eigen::Index base_vertices_ = 0;
};

// The clock of a point's times. processor: processor time of this process. own: the times that a deformer in another process states itself.
// wall: the wall time of that process, divided by the number of its poses.
enum class FrameClock { processor, own, wall };

template <>
inline constexpr NameTable<FrameClock, 3> option_names<FrameClock>{
    {{FrameClock::processor, "processor"}, {FrameClock::own, "own"}, {FrameClock::wall, "wall"}}};

struct PosePair {
    pbs::Pose pose, neighbour;  // neighbour: of the frame before
    double time_step_s = 0.01;
    std::vector<pbs::Pose> way = {};  // the poses before, through which a deformer with memory goes to its first pose
};

// One setting of one deformer, moving back and forth between a pose and that of the frame before: its shape in the pose, the time per
// frame, and the work per frame. A solver that begins in its last state (finite elements) is thus timed on the motion of one frame, as in a
// clip. A frame ends with the positions of the case's own vertices: where the deformer runs on another mesh, the transfer is part of the
// time.
//   PosedDeformer deformer(setting, mesh, motion);
//   const Shape shape = deformer.reach();      // from rest, however long it takes
//   take_turns({[&] { return deformer.turn(); }}, rounds);
// The time is processor time over all threads of the process, so that other work on the machine affects it less. A deformer that works in
// another process (DeformerTraits::has_own_clock) has the time that it states instead. It runs on the case's own mesh only.
class PosedDeformer {
public:
    // The mesh and the poses outlive it. announced_turns: the number of turns that follow reach(); a program computes them in the same
    // call.
    PosedDeformer(const Setting& setting, const BodyMesh& mesh, const PosePair& poses, int announced_turns = 0);

    Shape reach();  // on its own mesh; a deformer with memory takes the way
    // One number, the time of the next frame [ms]. Not a number where the frame did not arrive, or the one before it did not.
    std::vector<double> turn();
    // The work of the first turn, which does not depend on the number of turns; before it, of reach().
    const pbs::WorkCounters& work() const { return work_; }
    bool has_own_clock() const { return has_own_clock_; }
    FrameClock clock() const;  // of the times; known after reach()

private:
    pbs::StepSummary advance(const pbs::Pose& pose);

    const BodyMesh& mesh_;
    const PosePair& poses_;
    std::unique_ptr<Deformer> deformer_;
    pbs::Positions on_base_;  // [m], of the case's own vertices
    pbs::WorkCounters work_;
    bool has_own_clock_;
    int turns_ = 0;
    bool is_there_ = false;  // in the pose
    bool has_arrived_ = true;
};

// points.csv: one row per setting, with its time, its work, its error, its volume and the reference that it is compared with. members.csv:
// the other references of the family. changes.csv: the rows of PBS and of single changes to it, with their distances from PBS.

// Settings are chosen on the training poses, and the diagrams show the others.
enum class Half { training, evaluation };

template <>
inline constexpr NameTable<Half, 2> option_names<Half>{{{Half::training, "training"}, {Half::evaluation, "evaluation"}}};

inline constexpr std::array<int, 3> budget_iterations = {4, 24, 96};  // of PBS: a change is compared with it in the time of these

// The errors against the members of the family after the first one, in their order.
using MemberErrors = std::array<std::optional<double>, further_members>;

struct PointRow {
    analysis::CaseKey of = {};  // body, motion, and the pose or the angle
    SettingKey key;
    int vertices = 0, tets = 0;
    std::string outcome = {};
    double reach_ms = 0.0;
    int rounds = 0, failed_rounds = 0;
    std::optional<double> ms_median = {}, ms_q1 = {}, ms_q3 = {};
    std::optional<analysis::ErrorNorms> error = {};  // outside the tips of creases; nothing where there is no reference
    std::optional<analysis::SkinError> skin = {};    // outside these tips, against the first reference
    std::optional<analysis::FrameMetrics> metrics = {};
    std::string reference = {};
    std::optional<double> reference_error_joint_pct = {};
    std::optional<bool> below_reference_error = {};
    std::optional<double> masked_share_pct = {};
    Half half = Half::evaluation;
    std::string reason = {};  // why the outcome is not_applicable or over_time_limit; why the reference is not reached
    std::optional<pbs::WorkCounters> work = {};
    std::optional<double> to_linear_elements_pct = {};  // of a point on the case's own tets
    MemberErrors members = {};
    bool is_external = false;              // a deformer of the user's own
    std::optional<FrameClock> clock = {};  // nothing where there is no time
    // Distances from PBS after each of budget_iterations, at the joints outside the tips of creases. Only PBS and its variants have them.
    std::array<std::optional<double>, budget_iterations.size()> from_pbs_pct = {};

    bool is_of_reference() const { return outcome == "reference" || outcome == "not_reached"; }
};
// All columns. The columns of the group "external" are written only if a deformer of the user's own takes part.
extern const analysis::Columns<PointRow> point_columns;
extern const analysis::Columns<PointRow> change_columns;  // changes.csv
analysis::Columns<PointRow> columns_for(const std::vector<PointRow>& rows);

// The shapes of a case's points, so that the distance between any two of them is known when the settings are chosen. They lie next to
// points.csv, in the order of its rows.
//   RecordedShapes::read(shapes.text()).distance_pct(0, 5, 0);
class RecordedShapes {
public:
    RecordedShapes() = default;
    // weights: of each reference (analysis::ErrorMetrics::joint_weights), #V; empty where a reference was not reached. Shapes are kept in
    // single precision, so that distances have an error of 1e-7 m.
    explicit RecordedShapes(const std::vector<Eigen::VectorXd>& weights);

    void add(const pbs::Positions* positions);  // [m], #V x 3; null: the row has no shape
    // The distance of the shapes of two rows, in the norm of error_joint_pct of a reference; nothing where one of these is not there.
    std::optional<double> distance_pct(std::size_t one, std::size_t other, std::size_t reference) const;

    std::string text() const;                             // CBOR
    static RecordedShapes read(const std::string& text);  // an InputError for a text that is damaged

private:
    std::vector<Eigen::VectorXd> weights_;  // of each reference, of the measured vertices
    std::vector<int> measured_;             // vertices that have a weight for some reference
    std::vector<Eigen::MatrixX3f> shapes_;  // of these [m]; empty: none
};

// A further reference of the family, solved with quadratic elements on the case's own tets alone. Its bound is that of the first member's
// own solution on these tets, which is an assumption: the same elements have a similar error.
struct FamilyRow {
    analysis::CaseKey of;
    EnsembleMember member;
    std::string outcome;  // reached, not_reached
    std::optional<double> error_bound_pct = {};
    double masked_share_pct = 0.0;
    double solve_s = 0.0;
};
extern const analysis::Columns<FamilyRow> family_columns;

// The points of one case of the work-precision study: the time and the work per frame and the error of every setting in one pose.
//   const MeasuredPoints points = measure_points(of);
//   table_of(point_columns, points.rows).write("points.csv");
// README.md states the rules: the references, what is left out, the ladders and the limit of the deformers that minimise an
// energy.
// On unrefined tets a reference has no bound, except in the rows of changes to PBS: there it is the distance from linear elements on the
// same tets. It holds if quadratic elements at least halve the error of linear ones, |P2 - x| <= |P1 - x| / 2 <= (|P1 - P2| + |P2 - x|) /
// 2, as they do in the poses of the quick form.

// A case of the study: one body in one pose, and the extent to which it is measured.
//   WorkPrecisionCase of;
//   of.scene = read_scene("limb_twist", {"motion.angle_deg=90", "motion.frames=19"});
//   of.frame = 18;
struct WorkPrecisionCase {
    analysis::CaseKey of;  // body, motion, and the pose or the angle
    Scene scene;           // its character and motion
    int frame = 0;         // of its motion; a timed frame begins in the one before it
    Half half = Half::evaluation;
    SettingRange range = {};
    Rounds rounds = {},
           newton_rounds = {};         // newton_rounds: of the nonlinear laws, which take seconds per frame; a failed round is dropped
    bool reference_is_refined = true;  // solved on tets cut into eight too, without which there is no bound
    std::vector<EnsembleMember> members = {};  // further references of the family
    double longest_frame_ms = 300.0;           // of a ladder of iterations
    std::vector<DeformerSpec> external = {};   // deformers of the user's own (compared_deformers.hpp); they are measured first
};

nlohmann::json to_json(const WorkPrecisionCase& of);  // everything that a run of the study depends on

// samples: [ms] of the rounds, not a number where a round did not reach the pose or began in one that was not reached. The row has no time
// where no round arrived, and no quartiles of fewer than three.
void add_time(PointRow& row, std::vector<double> samples);

struct MeasuredPoints {
    std::vector<PointRow> rows;
    RecordedShapes shapes;          // of these rows
    std::vector<PointRow> changes;  // to PBS, and PBS itself: with SettingRange::changes
    std::vector<FamilyRow> members;
    std::string breakdown;  // PBS, LBS or a deformer of the user's own that is not finite; a reference that is not reached is recorded as
                            // an outcome
};

// solutions: the folder in which the solutions of the references are kept (solutions_of_run); "": none. Throws an InputError if a deformer
// of the user's own fails.
MeasuredPoints measure_points(const WorkPrecisionCase& of, const std::string& solutions = "");

// The length at which an edge has the stiffness k, so that the mean over all edges is k too: then the scaling softens long edges and
// stiffens short ones, and the mesh as a whole is neither softer nor stiffer. Bisection finds it to 1e-12 of the longest edge. It needs
// 0 < k < 1 and at least one edge.
double neutral_length(double k, const std::vector<double>& edge_lengths_m);

}  // namespace experiments
