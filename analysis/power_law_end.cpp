#include "analysis/power_law_end.hpp"

#include "analysis/line_fit.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace analysis {

PowerLawEnd power_law_end(const std::vector<double>& sizes, const std::vector<double>& costs, double limit)
{
    const auto refuse = [](const std::string& field, double value, const char* rule) {
        throw pbs::InputError("", 0, field, fmt::format("{}", value), rule);
    };
    if (costs.size() != sizes.size()) refuse("costs", double(costs.size()), "expected as many as sizes");
    std::vector<std::pair<double, double>> points;  // size, cost
    for (std::size_t i = 0; i < sizes.size(); ++i) points.emplace_back(sizes[i], costs[i]);
    if (points.size() < 2) throw pbs::InputError("", 0, "sizes", fmt::format("{}", points.size()), "expected two or more");
    std::sort(points.begin(), points.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!(points[i].first > 0.0)) refuse("sizes", points[i].first, "expected sizes above 0");
        if (!(points[i].second > 0.0)) refuse("costs", points[i].second, "expected costs above 0");
        if (i > 0 && points[i].first == points[i - 1].first) refuse("sizes", points[i].first, "expected different sizes");
    }
    std::size_t next = 1;  // the line passes through points[next - 1] and points[next]
    while (next + 1 < points.size() && points[next].second < limit) ++next;
    const auto [below, below_cost] = points[next - 1];
    const auto [above, above_cost] = points[next];
    if (above_cost == below_cost) refuse("costs", below_cost, "expected different costs at the sizes around the limit");
    const double slope = std::log(above_cost / below_cost) / std::log(above / below);
    PowerLawEnd end;
    end.size = below * std::pow(limit / below_cost, 1.0 / slope);
    end.beyond = end.size < points.front().first || end.size > points.back().first;
    end.exponent = observed_order(sizes, costs).slope.estimate;
    return end;
}

}  // namespace analysis
