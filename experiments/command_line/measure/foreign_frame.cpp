#include "experiments/command_line/measure/foreign_frame.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace experiments {
namespace {

using Corners = std::array<int, 4>;

pbs::Tets sorted_corners(const pbs::Tets& tets)
{
    std::vector<Corners> all;
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        Corners corners = {tets(t, 0), tets(t, 1), tets(t, 2), tets(t, 3)};
        std::sort(corners.begin(), corners.end());
        all.push_back(corners);
    }
    std::sort(all.begin(), all.end());
    pbs::Tets sorted(tets.rows(), 4);
    for (Eigen::Index t = 0; t < tets.rows(); ++t) sorted.row(t) << all[t][0], all[t][1], all[t][2], all[t][3];
    return sorted;
}

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

}  // namespace

RestMesh::RestMesh(const pbs::MeshReading& reading)
    : mesh_(reading.mesh),
      file_vertex_(reading.file_vertex),
      file_vertices_(reading.file_vertices),
      edges_(pbs::edges_of(mesh_.tets)),
      corners_(sorted_corners(mesh_.tets.unaryExpr([this](int vertex) { return file_vertex_[vertex]; })))
{
}

pbs::Positions RestMesh::read_frame(const std::string& path) const
{
    const pbs::TetMesh frame = pbs::read_tet_frame(path);
    if (frame.rest.rows() != file_vertices_)
        throw pbs::InputError(
            path, 0, "vertices", std::to_string(frame.rest.rows()),
            fmt::format("expected the rest mesh's {}: exporters that join, split or leave out points change the number", file_vertices_));
    require_same_tets(path, frame.tets);
    const pbs::Positions positions = frame.rest(file_vertex_, Eigen::all);
    require_same_units(path, positions);
    return positions;
}

void RestMesh::require_same_tets(const std::string& path, const pbs::Tets& tets) const
{
    if (tets.rows() != corners_.rows())
        throw pbs::InputError(path, 0, "tets", std::to_string(tets.rows()), fmt::format("expected the rest mesh's {}", corners_.rows()));
    const pbs::Tets corners = sorted_corners(tets);
    for (Eigen::Index t = 0; t < corners.rows(); ++t)
        if (corners.row(t) != corners_.row(t))
            throw pbs::InputError(path, 0, "tets", "",
                                  fmt::format("expected the rest mesh's, on the same vertices; it has a tet on {} {} {} {}, and this frame "
                                              "does not: was the order of the vertices kept on export?",
                                              corners_(t, 0), corners_(t, 1), corners_(t, 2), corners_(t, 3)));
}

void RestMesh::require_same_units(const std::string& path, const pbs::Positions& positions) const
{
    const double ratio = analysis::median_edge_ratio(mesh_.rest, edges_, positions);
    if (ratio < twofold && ratio > 1.0 / twofold) return;
    for (const Unit& unit : units)
        for (const double factor : {unit.factor, 1.0 / unit.factor})
            if (std::abs(ratio / factor - 1.0) <= nearness)
                throw pbs::InputError(path, 0, "median edge", fmt::format("{:.4g} times the rest mesh's", ratio),
                                      fmt::format("expected the rest mesh's unit; a factor of {:.5g}, as of {}{}", factor, unit.what,
                                                  factor < 1.0 ? " (the other way round)" : ""));
}

}  // namespace experiments
