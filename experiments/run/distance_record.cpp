#include "experiments/run/distance_record.hpp"

#include <cmath>

namespace experiments {

void DistanceRecord::add(int frame, double time_s, const std::string& label, const std::string& of, const pbs::Positions& points)
{
    if (frame != frame_) before_.clear();
    frame_ = frame;
    for (const auto& [other, there] : before_) {
        const Eigen::VectorXd squares = (points - there).rowwise().squaredNorm();
        table_.add_row({frame, time_s, label, other, of, static_cast<int>(points.rows()), 1e3 * std::sqrt(squares.mean()),
                        1e3 * std::sqrt(squares.maxCoeff())});
    }
    before_.emplace_back(label, points);
}

}  // namespace experiments
