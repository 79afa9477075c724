// The size up to which frames come in real time, of timings of a ladder of sizes.
//   const RealTimeEnd end = real_time_end({1200, 4800, 20000}, {1.9, 8.1, 37.0});   // 30 frames a second up to end.vertices
#pragma once

#include <vector>

namespace experiments {

// Vertices at which a frame takes 1 / 30 s, on the straight line through log total over log vertices between the two sizes around it, or
// beyond the last two; with the exponent over all sizes.
struct RealTimeEnd {
    double vertices = 0.0;
    bool beyond = false;  // all sizes measured are quicker, or all slower
    double exponent = 0.0;
};
RealTimeEnd real_time_end(const std::vector<double>& vertices, const std::vector<double>& total_ms);  // two sizes or more, in any order

}  // namespace experiments
