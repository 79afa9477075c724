// Data profiles (J. More, S. Wild, Benchmarking derivative-free optimization algorithms, SIAM J. Optim. 20, 2009): the share of poses that
// a deformer solves to a tolerance, against the time per frame. A pose is solved to 5 % within t if a point of the deformer takes at most t
// and has an error of at most 5 % at the joints.
//   const std::vector<ProfileStep> steps = data_profiles(diagrams);   // one step per time at which a share rises
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

inline constexpr std::array<double, 3> profile_tolerances_pct = {10.0, 5.0, 2.0};

struct ProfileStep {
    Comparison comparison = Comparison::packed_f32;
    double tolerance_pct = 0.0;
    std::string group;  // of deformers
    double ms = 0.0;    // from this time per frame on
    int solved = 0, poses = 0;
    int certain = 0;  // of those solved: the error plus the bound on the reference's own error is within the tolerance
    double share_pct = 0.0;
};
extern const analysis::Columns<ProfileStep> data_profile_columns;  // data_profiles.csv

// The least time of a point of the group with an error of at most the tolerance. Nothing: the pose is not solved.
std::optional<double> time_to_solve(const Diagram& diagram, const DeformerGroup& group, double tolerance_pct);
// The same for the error plus the bound on the reference's own error. Nothing where the bound is not known.
std::optional<double> time_to_solve_certainly(const Diagram& diagram, const DeformerGroup& group, double tolerance_pct);

// Over the evaluated poses with a reference; a group that solves none has no steps. Means are no poses.
std::vector<ProfileStep> data_profiles(const std::vector<Diagram>& diagrams);

// The number of evaluated poses that the group solves within a time, and the number of these poses.
struct Solved {
    int solved = 0, poses = 0;
    int certain = 0;  // of those solved
};
std::string text_of(const Solved& solved);  // 3 of 4, 1 certain
Solved solved_within(const std::vector<Diagram>& diagrams, Comparison comparison, const DeformerGroup& group, double tolerance_pct,
                     double ms);

}  // namespace experiments
