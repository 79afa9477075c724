// The measurements of the study: the error of each setting against every kept reference of a body, its time, and the
// same along a clip.
//   const Measurements measurements = measure(of);
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/studies/reference_poses.hpp"
#include "experiments/studies/work_precision/methods.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The flesh that a method is given. none: it takes none. own: that of the reference with which it is compared.
// standard: that of the first member, whatever the reference is. start: that of the first member, with another start or
// a wrong material (OtherStart).
enum class GivenFlesh { none, own, standard, start };
NAMED_OPTIONS(GivenFlesh, none, own, standard, start)

// The clock of a method's times. processor: processor time of this process. own: the times that a deformer in another
// process states itself. wall: the wall time of that process, divided by the number of its poses.
enum class FrameClock { processor, own, wall };
NAMED_OPTIONS(FrameClock, processor, own, wall)

inline constexpr std::size_t members_of_family = 1 + further_members;
using MemberErrors = std::array<std::optional<double>, members_of_family>;
analysis::Columns<MemberErrors> member_error_columns();  // smooth_pct, ...: error_joint_pct against each member

// points.csv: one setting in one pose, begun without a frame before (cold).
struct PointRow {
    std::string pose, body = {};
    Stratum stratum = Stratum::movement;
    std::string method = {};
    GivenFlesh flesh = GivenFlesh::none;
    std::string setting = {};
    std::string outcome = {};       // finished, not_finite
    std::optional<double> ms = {};  // median of several frames
    // over the time of PBS with 24 iterations in plain code, measured right after
    std::optional<double> times_pbs = {};
    FrameClock clock = FrameClock::processor;
    std::optional<double> skin_mm = {};  // root mean square over the skin, on a body of 1.7 m: median over the members
    int inverted = 0;                    // tets
    MemberErrors errors = {};            // nothing where the member was not reached
};
extern const analysis::Columns<PointRow> point_columns;

// played.csv: one setting in one frame of a clip.
enum class FrameGuess { cold, frame_before };
NAMED_OPTIONS(FrameGuess, cold, frame_before)
extern const std::vector<std::string> played_columns;  // ms: median over the frames before

// What a run measures. training: all settings in the training poses, with the flesh of training_members(). evaluation:
// the chosen settings in all other poses, with the flesh of every member. played: the chosen settings along a clip.
enum class Measured { training, evaluation, played };
NAMED_OPTIONS(Measured, training, evaluation, played)

struct ComparisonCase {
    std::string name = {}, body = {};
    Measured what = Measured::evaluation;
    std::string clip = {};  // of played
    std::vector<ReferencePose> poses = {};
    std::vector<ChosenSetting> settings = {};   // that are evaluated or played
    std::vector<ComparedMethod> external = {};  // deformers of the user's own
    int rounds = 3;                             // timed frames per pose
};
nlohmann::json to_json(const ComparisonCase& comparison);

struct Measurements {
    std::vector<PointRow> points = {};
    analysis::CsvTable played{played_columns, "played.csv"};
    std::string breakdown = {};  // PBS, LBS or a deformer of the user's own that is not finite
};
// InputError as read_references, and where a deformer of the user's own fails.
Measurements measure(const ComparisonCase& comparison);

}  // namespace experiments
