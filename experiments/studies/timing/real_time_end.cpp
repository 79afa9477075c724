#include "experiments/studies/timing/real_time_end.hpp"

#include "analysis/line_fit.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {

RealTimeEnd real_time_end(const std::vector<double>& vertices, const std::vector<double>& total_ms)
{
    constexpr double real_time_ms = 1e3 / 30.0;
    std::vector<std::size_t> order(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return vertices[a] < vertices[b]; });
    std::size_t next = 1;  // the line through order[next - 1] and order[next]
    while (next + 1 < order.size() && total_ms[order[next]] < real_time_ms) ++next;
    const std::size_t a = order[next - 1], b = order[next];
    const double slope = std::log(total_ms[b] / total_ms[a]) / std::log(vertices[b] / vertices[a]);
    RealTimeEnd end;
    end.vertices = vertices[a] * std::pow(real_time_ms / total_ms[a], 1.0 / slope);
    end.beyond = end.vertices < vertices[order.front()] || end.vertices > vertices[order.back()];
    end.exponent = analysis::observed_order(vertices, total_ms).slope.estimate;
    return end;
}

}  // namespace experiments
