// Records of the study work_precision with a few points, made by hand.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

#include <optional>
#include <string>
#include <vector>

namespace test_support {

struct HandPoint {
    experiments::SettingKey key;
    double ms;
    std::optional<double> error_pct;
    std::string outcome = "finished";
};

// A case whose reference has an own error of up to bar_pct.
inline experiments::CaseRows hand_case(const analysis::CaseKey& of, const std::vector<HandPoint>& points,
                                       experiments::Half half = experiments::Half::evaluation, double bar_pct = 6.0)
{
    experiments::CaseRows rows;
    for (const HandPoint& point : points) {
        experiments::PointRow& row = rows.emplace_back();
        row.of = of;
        row.key = point.key;
        row.half = half;
        row.outcome = point.outcome;
        if (point.outcome == "finished") row.ms_median = point.ms;
        if (point.error_pct) row.error = {.joint_pct = *point.error_pct};
        row.reach_ms = 10.0 * point.ms;
        row.reference = "neo_hookean";
        row.reference_error_joint_pct = bar_pct;
        row.masked_share_pct = of.pose == "folded" ? 12.0 : 0.0;
    }
    return rows;
}

inline HandPoint hand_reference()
{
    return {{.deformer = "reference", .element_order = 2, .refined = true}, 900.0, std::nullopt, "reference"};
}

// Every point is chosen, in the comparison that it takes part in.
inline std::vector<experiments::Diagram> hand_diagrams(const std::vector<experiments::CaseRows>& cases)
{
    std::vector<experiments::CaseRecords> records;
    for (const experiments::CaseRows& rows : cases) records.push_back({rows});
    return experiments::diagrams_of(records, experiments::choose_settings(cases));
}

inline const analysis::CaseKey bent_limb = {.body = "limb", .motion = "bend", .angle_deg = 90.0};

inline experiments::SettingKey in_f64(experiments::SettingKey key)
{
    key.precision = "f64";
    return key;
}
inline const experiments::SettingKey pbs_24 = in_f64({"pbs", 24, 0.2, "ordered"});

// Seven deformers and the reference, all in plain f64, which takes part in both comparisons; the first diagrams are those of packed_f32.
inline std::vector<HandPoint> seven_points(double mush_pct)
{
    return {{in_f64({"lbs"}), 0.01, 60.0},
            {in_f64({"dqs"}), 0.02, 50.0},
            {in_f64({"delta_mush", 20}), 0.5, mush_pct},
            {pbs_24, 0.7, 20.0},
            {in_f64({"xpbd", 8}), 0.65, 25.0},
            {in_f64({.deformer = "fem_linear", .element_order = 1}), 5.0, 30.0},
            {in_f64({.deformer = "fem_corotational", .element_order = 1}), 100.0, 5.0},
            hand_reference()};
}

inline experiments::Diagram diagram_of_seven(double mush_pct)
{
    return hand_diagrams({hand_case(bent_limb, seven_points(mush_pct))}).front();
}

}  // namespace test_support
