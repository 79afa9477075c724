// The points of one case of the work-precision study: the time and the work per frame and the error of every setting in one pose.
//   const MeasuredPoints points = measure_points(of);
//   table_of(point_columns, points.rows).write("points.csv");
// The reference is that of shared/posed_reference.hpp, with its bound. Errors are measured outside the part of the body that
// overlaps itself and, as one more column, on the whole body. A point whose error is not above the bound may be as good as the reference
// and is marked. Further references of the family (shared/posed_reference.hpp) decide how far an order of deformers depends on the
// choice of the reference. The error of PBS is split into solver, model and discretisation (ensemble/ensemble.hpp). A ladder of
// iterations ends where a frame takes longer than the limit. The limit of the deformers that minimise an energy, from which their distance
// is measured, is the point of linear elements with their law on the case's own tets (Setting::is_limit_of_deformers).
// On unrefined tets a reference has no bound, except in the rows of changes to PBS: there it is the distance from linear elements on the
// same tets. It holds if quadratic elements at least halve the error of linear ones, |P2 - x| <= |P1 - x| / 2 <= (|P1 - P2| + |P2 - x|) /
// 2, as they do in the poses of the quick form.
#pragma once

#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/work_precision/point_row.hpp"

namespace experiments {

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
    int converged_iterations = 8000;           // of PBS for the parts of its error; 0: no parts
    double longest_frame_ms = 300.0;           // of a ladder of iterations
    std::vector<DeformerSpec> external = {};   // deformers of the user's own (compared_deformers.hpp); they are measured first
};

nlohmann::json to_json(const WorkPrecisionCase& of);  // everything that a run of the study depends on

// The rows of points.csv: of a setting that reached the pose, of one without an answer (outcome is over_time_limit or not_applicable), and
// of the reference itself (outcome is reference, or not_reached).
PointRow point_row(const ReachedPoint& point);
PointRow row_without_answer(const Setting& setting, const BodyMesh& mesh, const std::string& outcome, const std::string& reason);
PointRow reference_row(const pbs::TetMesh& mesh, const PosedReference& reference);
void add_reference(PointRow& row, const PosedReference& reference);  // and whether the error, if there is one, is below its bound

struct FrameTime {
    std::optional<Spread> ms;  // nothing where no round arrived
    int failed_rounds = 0;     // rounds that did not reach the pose, or began in one that was not reached
};
// samples: [ms], not a number where a round failed.
FrameTime frame_time(std::vector<double> samples);

inline constexpr int fewest_for_quartiles = 3;  // rounds
void add_time(PointRow& row, const FrameTime& time);

struct MeasuredPoints {
    std::vector<PointRow> rows;
    std::vector<PointRow> changes;  // to PBS, and PBS itself: with SettingRange::changes
    std::vector<FamilyRow> members;
    std::string breakdown;  // PBS, LBS or a deformer of the user's own that is not finite; a reference that is not reached is recorded as
                            // an outcome
};

// Throws an InputError if a deformer of the user's own fails.
MeasuredPoints measure_points(const WorkPrecisionCase& of);

// The length at which an edge has the stiffness k, so that the mean over all edges is k too: then the scaling softens long edges and
// stiffens short ones, and the mesh as a whole is neither softer nor stiffer. By bisection, to 1e-12 of the longest edge; 0 < k < 1, some
// edges.
double neutral_length(double k, const std::vector<double>& edge_lengths_m);

}  // namespace experiments
