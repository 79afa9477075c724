// Measures the residuals and volume changes of every order of projection, in both precisions and for several sequences of the constraints,
// and the time until they are reached. The case is one body in one pose, and the initial guess is LBS.
//   const std::vector<MeasuredOrder> measured = measure_orders(of);
// The sequences: file order, spread (that of bench's plain_spread) and random ones. `poses` projects sixteen poses side by side. The
// results of each are bit-identical to those of `ordered`, and only the time differs.
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"

#include <string>
#include <vector>

namespace experiments {

struct EqualQualityCase {
    analysis::CaseKey of;          // body, motion, and angle or pose
    Scene scene;                   // its character, motion and options of PBS
    int frame = 0;                 // of its motion
    bool is_tapered = false;       // tapered_limb() takes the place of the scene's character
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

}  // namespace experiments
