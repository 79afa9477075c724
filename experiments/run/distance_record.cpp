#include "experiments/run/distance_record.hpp"

#include <cmath>

namespace experiments {

const analysis::Columns<DeformerDistance> distance_columns = {
    {"frame", &DeformerDistance::frame, "", "number of the frame, from 0"},
    {"time_s", &DeformerDistance::time_s, "s", "time since the motion began"},
    {"deformer", &DeformerDistance::deformer, "", "label of one deformer"},
    {"other", &DeformerDistance::other, "", "label of the other deformer"},
    {"of", &DeformerDistance::of, "", "what the points belong to: rendered surface, or mesh where the body has none"},
    {"points", &DeformerDistance::points, "", "number of points"},
    {"rms_mm", &DeformerDistance::rms_mm, "mm", "root mean square of the distances"},
    {"largest_mm", &DeformerDistance::largest_mm, "mm", "largest distance"}};

void DistanceRecord::add(int frame, double time_s, const std::string& label, const std::string& of, const pbs::Positions& points)
{
    if (frame != frame_) before_.clear();
    frame_ = frame;
    for (const auto& [other, there] : before_) {
        const Eigen::VectorXd squares = (points - there).rowwise().squaredNorm();
        distances_.push_back({frame, time_s, label, other, of, static_cast<int>(points.rows()), 1e3 * std::sqrt(squares.mean()),
                              1e3 * std::sqrt(squares.maxCoeff())});
    }
    before_.emplace_back(label, points);
}

}  // namespace experiments
