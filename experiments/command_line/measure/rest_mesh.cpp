#include "experiments/command_line/measure/rest_mesh.hpp"

#include "experiments/command_line/measure/frame_points.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace experiments {

RestMesh::RestMesh(const pbs::MeshReading& reading, std::string displacement)
    : mesh_(reading.mesh),
      file_vertex_(reading.file_vertex),
      file_vertices_(reading.file_vertices),
      edges_(pbs::edges_of(mesh_.tets)),
      corners_(sorted_corners(mesh_.tets.unaryExpr([this](int vertex) { return file_vertex_[vertex]; }))),
      displacement_(std::move(displacement))
{
    if (reading.listed_at.empty()) return;
    for (const int vertex : file_vertex_) listed_vertex_.push_back(reading.listed_at[vertex]);
    listed_corners_ = sorted_corners(mesh_.tets.unaryExpr([this](int vertex) { return listed_vertex_[vertex]; }));
}

pbs::Positions RestMesh::read_frame(const std::string& path, bool* is_displaced) const
{
    const FramePoints frame = points_in(path);
    if (displacement_.empty() && are_at_rest(frame.points, mesh_.rest)) {
        const FileShape shape = shape_of(path, frame);
        if (is_displaced && !are_at_rest(shape.positions, mesh_.rest)) *is_displaced = true;
        if (!shape.is_at_rest) {
            require_same_units(path, mesh_.rest, edges_, shape.positions);
            return shape.positions;
        }
    }
    const pbs::Positions positions = shape_of_frame(path, frame.points, mesh_.rest, frame.places, displacement_);
    require_same_units(path, mesh_.rest, edges_, positions);
    return positions;
}

FileShape RestMesh::read_shape(const std::string& path) const
{
    return shape_of(path, points_in(path));
}

std::vector<RestMesh::Corners> RestMesh::sorted_corners(const pbs::Tets& tets)
{
    std::vector<Corners> all;
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        Corners corners = {tets(t, 0), tets(t, 1), tets(t, 2), tets(t, 3)};
        std::sort(corners.begin(), corners.end());
        all.push_back(corners);
    }
    std::sort(all.begin(), all.end());
    return all;
}

RestMesh::FramePoints RestMesh::points_in(const std::string& path) const
{
    const pbs::TetMesh frame = pbs::read_tet_frame(path);
    require_as_many_points(path, frame.rest.rows(), file_vertices_);
    const std::vector<int>& places = places_in(path, frame.tets);
    pbs::Positions points = frame.rest(places, Eigen::all);
    require_same_units(path, mesh_.rest, edges_, points);
    return {std::move(points), places};
}

FileShape RestMesh::shape_of(const std::string& path, const FramePoints& frame) const
{
    FileShape shape{.positions = frame.points,
                    .is_at_rest = are_at_rest(frame.points, mesh_.rest),
                    .fields = read_plain_fields(path)};
    for (auto& [name, values] : shape.fields.of_points) {
        if (values.rows() != file_vertices_)
            throw pbs::InputError(path, 0, name, fmt::format("{} rows", values.rows()),
                                  fmt::format("expected {}", file_vertices_));
        values = values(frame.places, Eigen::all).eval();
    }
    const auto displacement = shape.fields.of_points.find("displacement");
    if (!shape.is_at_rest || displacement == shape.fields.of_points.end()) return shape;
    if (displacement->second.cols() != 3)
        throw pbs::InputError(path, 0, "components of displacement", std::to_string(displacement->second.cols()),
                              "expected 3");
    shape.positions = mesh_.rest + displacement->second;
    shape.is_at_rest = false;
    return shape;
}

const std::vector<int>& RestMesh::places_in(const std::string& path, const pbs::Tets& tets) const
{
    const std::vector<Corners> corners = sorted_corners(tets);
    if (!listed_corners_.empty() && corners == listed_corners_) return listed_vertex_;
    if (corners.size() != corners_.size())
        throw pbs::InputError(path, 0, "tets", std::to_string(corners.size()),
                              fmt::format("expected the rest mesh's {}", corners_.size()));
    if (const auto other = std::ranges::mismatch(corners_, corners).in1; other != corners_.end())
        throw pbs::InputError(
            path, 0, "tets", "",
            fmt::format("expected the rest mesh's, on the same vertices; it has a tet on {}, and this frame "
                        "does not: was the order of the vertices kept on export?",
                        fmt::join(*other, " ")));
    return file_vertex_;
}

}  // namespace experiments
