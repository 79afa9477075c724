#include "experiments/command_line/measure/frame_points.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

namespace experiments {
namespace {

// The ratio of a length in one unit to the same length in another. The inverse ratio is tested too.
struct Unit {
    double factor;
    const char* what;
};
constexpr std::array units = {Unit{10.0, "millimetres against centimetres"}, Unit{100.0, "centimetres against metres"},
                              Unit{1000.0, "millimetres against metres"},    Unit{39.3701, "inches against metres"},
                              Unit{3.28084, "feet against metres"},          Unit{25.4, "millimetres against inches"},
                              Unit{2.54, "centimetres against inches"}};

// The median edge of a body is never stretched or compressed by a factor of two, and hardly by exactly the factor of a unit.
constexpr double nearness = 0.1, twofold = 2.0;

double rounding_m(const pbs::Positions& rest)
{
    constexpr double same_point = 1e-6;  // of the body's diagonal: coordinates in single precision
    return same_point * (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
}

std::map<std::string, pbs::Positions> vectors_of(const std::string& path, const std::string& name, const std::vector<int>& file_point)
{
    auto vectors = pbs::read_guarded(path, [&](const std::string& file) { return pbs::read_point_vectors(file, name); });
    for (auto& [of, values] : vectors) {
        if (values.rows() <= std::ranges::max(file_point))
            throw pbs::InputError(path, 0, of, fmt::format("{} rows", values.rows()), "expected one for each point");
        values = values(file_point, Eigen::all).eval();
    }
    return vectors;
}

// A vector that moves the points: not zero, not the points themselves, and by its name no other quantity.
bool may_be_displacement(const std::string& name, const pbs::Positions& values, const pbs::Positions& rest)
{
    static const std::regex other("veloc|accel|force|normal|position|coord", std::regex::icase);
    return !std::regex_search(name, other) && !(values.cwiseAbs().maxCoeff() <= 2.0 * rounding_m(rest)) &&
           !((values - rest).cwiseAbs().maxCoeff() <= rounding_m(rest));
}

void require_no_displacement(const std::string& path, const pbs::Positions& rest, const std::vector<int>& file_point)
{
    if (pbs::content_extension(path) == ".msh" && pbs::read_text_file(path, pbs::most_mesh_bytes).find("$NodeData") != std::string::npos)
        throw pbs::InputError(
            path, 0, "points", "those of the rest mesh",
            "expected deformed points: the $NodeData of a .msh is not read; write the frame as .vtu, or add --displacement "
            "none if it is at rest");
    std::vector<std::string> names;
    for (const auto& [name, values] : vectors_of(path, "", file_point))
        if (may_be_displacement(name, values, rest)) names.push_back(name);
    if (names.empty()) return;
    throw pbs::InputError(
        path, 0, "points", "those of the rest mesh",
        fmt::format("expected deformed points, but the deformation seems to be in the points' vector {}: add --displacement "
                    "{}, or --displacement none if the frame is at rest",
                    fmt::join(names, " or "), names.front()));
}

std::string known_vectors(const std::string& path, const std::vector<int>& file_point)
{
    std::vector<std::string> names;
    for (const auto& [name, values] : vectors_of(path, "", file_point)) names.push_back(name);
    return names.empty() ? "it has none; .vtu, .vtk and .vtp can have them" : fmt::format("it has {}", fmt::join(names, ", "));
}

}  // namespace

void require_as_many_points(const std::string& path, Eigen::Index points, Eigen::Index expected)
{
    if (points != expected)
        throw pbs::InputError(
            path, 0, "vertices", std::to_string(points),
            fmt::format("expected the rest mesh's {}: exporters that join, split or leave out points change the number", expected));
}

void require_same_units(const std::string& path, const pbs::Positions& rest, const pbs::Edges& edges, const pbs::Positions& positions)
{
    const double ratio = analysis::median_edge_ratio(rest, edges, positions);
    if (ratio < twofold && ratio > 1.0 / twofold) return;
    for (const Unit& unit : units)
        for (const double factor : {unit.factor, 1.0 / unit.factor})
            if (std::abs(ratio / factor - 1.0) <= nearness)
                throw pbs::InputError(path, 0, "median edge", fmt::format("{:.4g} times the rest mesh's", ratio),
                                      fmt::format("expected the rest mesh's unit; a factor of {:.5g}, as of {}{}", factor, unit.what,
                                                  factor < 1.0 ? " (the other way round)" : ""));
}

bool are_at_rest(const pbs::Positions& points, const pbs::Positions& rest)
{
    return (points - rest).cwiseAbs().maxCoeff() <= rounding_m(rest);
}

pbs::Positions shape_of_frame(const std::string& path, const pbs::Positions& points, const pbs::Positions& rest,
                              const std::vector<int>& file_point, const std::string& displacement)
{
    if (displacement == "none") return points;
    const bool is_at_rest = are_at_rest(points, rest);
    if (displacement.empty()) {
        if (is_at_rest) require_no_displacement(path, rest, file_point);
        return points;
    }
    if (!is_at_rest)
        throw pbs::InputError(path, 0, "points", "other than the rest mesh's",
                              "expected those of the rest mesh with --displacement: points that are deformed already need no such option");
    const auto vectors = vectors_of(path, displacement, file_point);
    const auto found = vectors.find(displacement);
    if (found == vectors.end())
        throw pbs::InputError(path, 0, "--displacement", displacement,
                              "expected a vector of the points: " + known_vectors(path, file_point));
    if (!found->second.allFinite()) throw pbs::InputError(path, 0, displacement, "", "expected finite numbers");
    return rest + found->second;
}

}  // namespace experiments
