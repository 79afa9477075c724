// A surface at rest and its frames from files. They have the points of the surface at rest, in the same order and in
// the same unit.
//   const RestSurface rest("rest.obj", pbs::read_surface_frame("rest.obj").mesh, analysis::Holes::cap);
//   const pbs::Positions points = rest.read_frame("frame_0001.obj", "", remarks);
#pragma once

#include "analysis/metrics/closed_shells.hpp"
#include "experiments/meshes/mesh_io.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The points of a mesh in a file with several, from `first` to the next one's.
struct NamedPoints {
    std::string name;
    Eigen::Index first = 0;
};

class RestSurface {
public:
    // meshes: in the order of their points; empty: the file does not name them. InputError for a surface without a
    // closed shell. holes: whether open shells are capped and counted, or excluded because the user asks for the closed
    // ones alone.
    RestSurface(std::string path, pbs::SurfaceMesh surface, analysis::Holes holes,
                std::vector<NamedPoints> meshes = {});

    // [m], #P x 3. InputErrors: another number of points, other triangles except where a polygon is cut into triangles
    // in another way, another unit, a skin, since the surface would be that of the bind pose, and those of
    // shape_of_frame (frame_points.hpp). remarks: what the reader left out, without the file's name.
    pbs::Positions read_frame(const std::string& path, const std::string& displacement,
                              std::vector<std::string>& remarks) const;

    const pbs::Positions& points() const { return surface_.points; }  // [m], #P x 3
    const analysis::ClosedShells& shells() const { return shells_; }
    const pbs::Edges& edges() const { return edges_; }        // of the closed shells
    std::string mesh_of(const analysis::Shell& shell) const;  // its name; empty: not known
    // Pairs of triangles of the closed shells that meet; nothing: a build without CGAL. points: [m], #P x 3.
    std::optional<int> self_intersections(const pbs::Positions& points) const;

    // Why a limit on what is measured is none on the whole body: open shells that cannot be capped. Empty: it is one,
    // or the user has asked for the closed shells alone.
    std::string not_whole() const;

    // One sentence for each change to the file's surface: points that were joined, faces that were turned, shells that
    // were left out.
    std::vector<std::string> remarks() const;

private:
    std::string name_of(int shell) const;  // "3 (Eyes)"
    std::string listed(const std::vector<int>& shells) const;

    std::string path_;
    pbs::SurfaceMesh surface_;
    std::vector<NamedPoints> meshes_;
    analysis::Holes holes_;
    analysis::ClosedShells shells_;
    pbs::Edges edges_;
};

}  // namespace experiments
