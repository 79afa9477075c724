// One row of points.csv: a setting, its time, its error, its volume, the reference it is measured by.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/work_precision/reached_reference.hpp"

namespace experiments {

// PBS's error at the joints in three parts [%]; the third is the reference's own.
struct PbsParts {
    double solver_pct = 0.0, model_pct = 0.0;
    double not_converged_pct = 0.0;  // between the converged shape and that after half of its iterations
};

struct FrameTime {
    std::optional<Spread> ms;  // nothing where no round arrived
    int failed_rounds = 0;     // that did not arrive, or set out from where the one before did not
};
// Of samples [ms], not a number where a round failed.
FrameTime frame_time(std::vector<double> samples);

constexpr int fewest_for_quartiles = 3;  // rounds

struct PointFigures {
    std::string body, pose;
    FrameTime time;
    std::optional<analysis::ErrorNorms> error;  // nothing for the reference, and where there is none
    std::optional<double> beside_pct;           // error at the joints against the second solution
    std::optional<PbsParts> parts;
    bool reference_self_intersects = false;
};

const std::vector<std::string>& point_columns();
std::vector<analysis::CsvTable::Cell> point_row(const ReachedPoint& point, const ReachedReference& reference, const PointFigures& figures);

}  // namespace experiments
