#include "analysis/power_law_end.hpp"

#include "analysis/line_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace analysis {

PowerLawEnd power_law_end(const std::vector<double>& sizes, const std::vector<double>& costs, double limit)
{
    std::vector<std::pair<double, double>> points;  // size, cost
    for (std::size_t i = 0; i < sizes.size(); ++i) points.emplace_back(sizes[i], costs[i]);
    if (points.size() < 2) throw std::invalid_argument("power_law_end: fewer than two sizes");
    std::sort(points.begin(), points.end());
    std::size_t next = 1;  // the line passes through points[next - 1] and points[next]
    while (next + 1 < points.size() && points[next].second < limit) ++next;
    const auto [below, below_cost] = points[next - 1];
    const auto [above, above_cost] = points[next];
    const double slope = std::log(above_cost / below_cost) / std::log(above / below);
    PowerLawEnd end;
    end.size = below * std::pow(limit / below_cost, 1.0 / slope);
    end.beyond = end.size < points.front().first || end.size > points.back().first;
    end.exponent = observed_order(sizes, costs).slope.estimate;
    return end;
}

}  // namespace analysis
