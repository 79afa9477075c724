// Points of the study of improvements, with times and errors that a test can predict.
#pragma once

#include "experiments/studies/improvements/measured_changes.hpp"

#include <cmath>

namespace test_support {

using analysis::CaseKey;
using experiments::ChangePoint;

inline const CaseKey limb_twist_pose = {.body = "limb", .motion = "twist", .angle_deg = 90.0},
                     limb_bend_pose = {.body = "limb", .motion = "bend", .angle_deg = 60.0},
                     human_crouch_pose = {.body = "human", .motion = "01_01", .pose = "crouch"},
                     human_standing_pose = {.body = "human", .motion = "01_01", .pose = "standing"};

inline ChangePoint change_point(const CaseKey& of, const std::string& change, const std::string& setting, int iterations, double ms,
                                double error_pct, std::optional<double> bound_pct = 0.01, double distance_pct = 1.0)
{
    ChangePoint point;
    point.of = of;
    point.change = change;
    point.setting = setting;
    point.iterations = iterations;
    point.ms.median = ms;
    if (std::isfinite(error_pct)) point.error_joint_pct = error_pct;
    point.distance_pct.fill(distance_pct);
    point.reference_error_joint_pct = bound_pct;
    return point;
}

// The baseline takes 1, 6 and 24 ms for 4, 24 and 96 iterations and has an error of 10 % throughout.
inline void add_baseline(std::vector<ChangePoint>& points, const CaseKey& of)
{
    for (const int iterations : experiments::budget_iterations)
        points.push_back(change_point(of, experiments::baseline, "", iterations, iterations / 4.0, 10.0));
}

}  // namespace test_support
