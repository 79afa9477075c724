// Measures the residuals and volume changes of every order of projection, in both precisions and for several sequences of the constraints,
// and the time until they are reached. The case is one body in one pose, and the initial guess is LBS.
//   const std::vector<TargetRow> rows = target_rows(of.of, measure_orders(of));
// The sequences: file order, spread (that of bench's plain_spread) and random ones. `poses` projects sixteen poses side by side. The
// results of each are bit-identical to those of `ordered`, and only the time differs.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/character/character.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// A limb that tapers, of 2,025 vertices and 9,216 tets on a regular grid: the body on which the order of projection matters most. The
// bodies of the mesher list their tets in no particular order; here the file order is a sweep through the body.
//   (======______)    x from -1 to 1 m, radius from 0.24 to 0.12 m, bones as those of the limb: o=====o=====o
// 25 layers of 9 x 9 vertices; each cube is cut into six tets along a diagonal. Weights by Eq. 2.
pbs::Character tapered_limb();

struct EqualQualityCase {
    analysis::CaseKey of;          // body, motion, and angle or pose; the body tapered_limb takes the place of the scene's character
    Scene scene;                   // its character, motion and options of PBS
    int frame = 0;                 // of its motion
    std::vector<int> random = {};  // seeds of the random sequences
    int most_iterations = 1000;    // where the limit is read
    Rounds rounds = {};            // of the timings
};
nlohmann::json to_json(const EqualQualityCase& of);

inline constexpr int paper_iterations = 24;
inline const std::string file_sequence = "file", spread_sequence = "spread";

struct MeasuredOrder {
    std::string order;           // plain, ordered, grouped, poses
    std::string precision = {};  // f32, f64
    std::string sequence = {};   // file, spread, random_1, ...
    IterationPath path = {};
    Spread ms_iteration = {};  // per pose, processor time of one thread
};

// The first one is `plain` in file order.
std::vector<MeasuredOrder> measure_orders(const EqualQualityCase& of);

// orders.csv, one row per order, precision and sequence: the answer after the paper's 24 iterations and in the limit.
struct OrderRow {
    analysis::CaseKey of;  // body, motion, angle or pose, order, precision
    std::string sequence;
    Spread ms_iteration;
    Look after_24, limit, half;  // limit: after the last iteration, which is reached if half of the iterations give the same
};
extern const analysis::Columns<OrderRow> order_columns;
std::vector<OrderRow> order_rows(const analysis::CaseKey& of, const std::vector<MeasuredOrder>& measured);

// targets.csv, one row per order, precision, sequence and target: when it first reaches the target. A target is a residual or an absolute
// volume change: those that `plain` has after 24 iterations in file order in the same precision, and the paper's 0.5 % and 2 %. It is
// reached at the first iteration at which the value is not above it. Where an order does not reach a target within all iterations, the
// record states the limit, which lies above the bound.
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
std::vector<TargetRow> target_rows(const analysis::CaseKey& of, const std::vector<MeasuredOrder>& measured);

// The first look at which the value is not above the bound.
std::optional<int> first_within(const IterationPath& path, double Look::*value, double bound);

// answers.csv of the study, one row per case, order, precision and target in file order. A speed-up is the ratio of the times to the
// target. There is none where either never reaches it.
struct EqualAnswer {
    TargetRow row;
    std::optional<double> speedup_to_plain = {};         // plain in file order
    std::optional<double> speedup_to_plain_spread = {};  // plain in the spread sequence
};
extern const analysis::Columns<EqualAnswer> answer_columns;
// std::out_of_range without `plain` in both sequences.
std::vector<EqualAnswer> equal_answers(const std::vector<TargetRow>& rows);

// The work of a run: writes orders.csv and targets.csv. Returns what broke down, or "".
std::string measure_equal_quality(const EqualQualityCase& of, const std::string& folder);

}  // namespace experiments
