#include "experiments/command_line/measure/frame_points.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/meshes/guarded_reading.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
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

// The median edge of a body is never stretched or compressed by a factor of two, and hardly by exactly the factor of a
// unit.
constexpr double nearness = 0.1, twofold = 2.0;

double rounding_m(const pbs::Positions& rest)
{
    constexpr double same_point = 1e-6;  // of the body's diagonal: coordinates in single precision
    return same_point * pbs::diagonal_m(rest);
}

struct PointVector {
    pbs::Positions values;           // #V x 3
    std::string of_components = {};  // the names of the arrays, if each component is one of its own
};
using PointVectors = std::map<std::string, PointVector>;

// The name of a vector whose first component is called so: u for ux, u_x and u:0, U for U1, D for DX, and u for u, v
// and w. Empty: it is none.
std::string stem_of(const std::string& name)
{
    if (name == "u" || name == "U") return name;
    if (name.size() < 2) return "";
    const char last = static_cast<char>(std::tolower(static_cast<unsigned char>(name.back())));
    if (last != 'x' && last != '1' && last != '0') return "";
    std::string stem = name.substr(0, name.size() - 1);
    while (!stem.empty() && std::string(" _.:-").find(stem.back()) != std::string::npos) stem.pop_back();
    return stem;
}

// Three scalars that are named as the components of a vector which the file does not have itself.
void add_vectors_of_components(const std::map<std::string, Eigen::MatrixXd>& arrays, PointVectors& vectors)
{
    for (const auto& [x, values] : arrays) {
        const std::string stem = stem_of(x);
        if (stem.empty() || values.cols() != 1) continue;
        std::array components = {x, x, x};
        for (std::size_t axis = 1; axis < 3; ++axis)
            components[axis].back() = static_cast<char>(x.back() + static_cast<char>(axis));
        const auto y = arrays.find(components[1]), z = arrays.find(components[2]);
        if (y == arrays.end() || z == arrays.end() || y->second.size() != values.size() ||
            z->second.size() != values.size())
            continue;
        pbs::Positions rows(values.rows(), 3);
        rows << values, y->second, z->second;
        vectors.try_emplace(stem, PointVector{rows, fmt::format("{}", fmt::join(components, ", "))});
    }
}

bool is_named_displacement(const std::string& name)
{
    static const std::regex displacement("u|d|.*(disp|depl|deform|translation).*", std::regex::icase);
    return std::regex_match(name, displacement);
}

// name: that vector alone, if it is an array of the file. Without a name, views of a .msh that do not state one value
// of each point have no rows.
PointVectors vectors_of(const std::string& path, const std::string& name, const std::vector<int>& file_point)
{
    const auto arrays = pbs::read_guarded(path, "arrays " + name,
                                          [&](const std::string& file) { return pbs::read_point_arrays(file, name); });
    PointVectors vectors;
    for (const auto& [array, values] : arrays)
        if (values.cols() == 3) vectors.emplace(array, PointVector{values});
    add_vectors_of_components(arrays, vectors);
    for (auto& [own_name, vector] : vectors) {
        if (name.empty() && vector.values.rows() == 0) continue;
        if (vector.values.rows() <= std::ranges::max(file_point))
            throw pbs::InputError(path, 0, own_name, fmt::format("{} rows", vector.values.rows()),
                                  "expected one for each point");
        vector.values = vector.values(file_point, Eigen::all).eval();
    }
    return vectors;
}

// For a vector without rows, whose array is read by its name for the reason.
[[noreturn]] void refuse(const std::string& path, const std::string& name, const PointVector& vector,
                         const std::vector<int>& file_point)
{
    vectors_of(path, name, file_point);
    throw pbs::InputError(path, 0, name, vector.of_components, "expected one value of each point");
}

// A vector that moves the points: not zero, not the points themselves, and by its name no other quantity. Scalars are
// compared with the names of displacements, for programs write many quantities as scalars: forces RF1, rotations UR1,
// stresses S11.
bool may_be_displacement(const std::string& name, const PointVector& vector, const pbs::Positions& rest)
{
    static const std::regex other("veloc|accel|force|normal|position|coord", std::regex::icase);
    return !std::regex_search(name, other) && (vector.of_components.empty() || is_named_displacement(name)) &&
           !(vector.values.cwiseAbs().maxCoeff() <= 2.0 * rounding_m(rest)) &&
           !((vector.values - rest).cwiseAbs().maxCoeff() <= rounding_m(rest));
}

void require_no_displacement(const std::string& path, const pbs::Positions& rest, const std::vector<int>& file_point)
{
    std::vector<std::string> names, texts;
    for (const auto& [name, vector] : vectors_of(path, "", file_point)) {
        if (vector.values.rows() == 0 && is_named_displacement(name)) refuse(path, name, vector, file_point);
        if (vector.values.rows() == 0 || !may_be_displacement(name, vector, rest)) continue;
        const auto place = is_named_displacement(name) ? 0 : std::ssize(names);
        names.insert(names.begin() + place, name);
        texts.insert(texts.begin() + place,
                     vector.of_components.empty() ? name : fmt::format("{} ({})", name, vector.of_components));
    }
    if (names.empty()) return;
    const std::string quote = names.front().find(' ') == std::string::npos ? "" : "'";
    throw pbs::InputError(
        path, 0, "points", "those of the rest mesh",
        fmt::format(
            "expected deformed points, but the deformation seems to be in the points' vector {}: add --displacement "
            "{}, or --displacement none if the frame is at rest",
            fmt::join(texts, " or "), quote + names.front() + quote));
}

std::string known_vectors(const PointVectors& vectors)
{
    std::vector<std::string> names;
    for (const auto& [name, vector] : vectors) names.push_back(name);
    return names.empty() ? "it has none; .vtu, .vtk, .vtp and .msh can have them"
                         : fmt::format("it has {}", fmt::join(names, ", "));
}

}  // namespace

void require_as_many_points(const std::string& path, Eigen::Index points, Eigen::Index expected)
{
    if (points != expected)
        throw pbs::InputError(
            path, 0, "vertices", std::to_string(points),
            fmt::format("expected the rest mesh's {}: exporters that join, split or leave out points change the number",
                        expected));
}

void require_same_units(const std::string& path, const pbs::Positions& rest, const pbs::Edges& edges,
                        const pbs::Positions& positions)
{
    const double ratio = analysis::median_edge_ratio(rest, edges, positions);
    if (ratio < twofold && ratio > 1.0 / twofold) return;
    for (const Unit& unit : units)
        for (const double factor : {unit.factor, 1.0 / unit.factor})
            if (std::abs(ratio / factor - 1.0) <= nearness)
                throw pbs::InputError(path, 0, "median edge", fmt::format("{:.4g} times the rest mesh's", ratio),
                                      fmt::format("expected the rest mesh's unit; a factor of {:.5g}, as of {}{}",
                                                  factor, unit.what, factor < 1.0 ? " (the other way round)" : ""));
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
                              "expected those of the rest mesh with --displacement: points that are deformed already "
                              "need no such option");
    PointVectors vectors = vectors_of(path, displacement, file_point);
    if (!vectors.contains(displacement)) vectors = vectors_of(path, "", file_point);
    const auto vector = vectors.find(displacement);
    if (vector == vectors.end())
        throw pbs::InputError(path, 0, "--displacement", displacement,
                              "expected a vector of the points: " + known_vectors(vectors));
    if (vector->second.values.rows() == 0) refuse(path, displacement, vector->second, file_point);
    if (!vector->second.values.allFinite()) throw pbs::InputError(path, 0, displacement, "", "expected finite numbers");
    return rest + vector->second.values;
}

}  // namespace experiments
