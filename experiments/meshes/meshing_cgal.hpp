// CGAL's mesher (Mesh_3), compiled once for all bodies, which answer its questions. Only the meshing .cpp files include
// this.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pbs {

// Exact predicates, double coordinates.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// A body to be meshed. Its skin consists of patches, numbered from 1, which may meet in edges that the mesh keeps.
class MeshedBody {
public:
    using SkinPoint = std::pair<Point, int>;  // and its patch
    using Line = std::variant<Kernel::Segment_3, Kernel::Ray_3, Kernel::Line_3>;
    using Edge = std::pair<std::vector<Point>, std::set<int>>;  // a polyline and the patches that meet there

    virtual ~MeshedBody() = default;
    virtual CGAL::Bbox_3 box() const = 0;
    virtual bool contains(const Point& p) const = 0;
    virtual std::optional<SkinPoint> crossing(const Line& line) const = 0;
    virtual std::vector<Edge> edges() const { return {}; }

    // Where the refinement begins if there are no edges. CGAL's own points are random: where two fall close together, a
    // short edge stays.
    virtual std::vector<SkinPoint> initial_points() const = 0;
    // Asked where the refinement cannot begin with these points; false if there are no more.
    virtual bool double_initial_points() { return false; }

    // The size of cells near a point, as a factor of MeshCriteria's sizes.
    virtual double relative_size(const Point&) const { return 1.0; }
    virtual double relative_facet_size(const Point& p) const { return relative_size(p); }
};

// What triangles enclose, counterclockwise from outside: three vertices and the patch.
using PatchTriangle = std::array<unsigned, 4>;
std::unique_ptr<MeshedBody> make_enclosed_body(const std::vector<Point>& points,
                                               const std::vector<PatchTriangle>& triangles);

struct MeshCriteria {
    double facet_size = 0.0, cell_size = 0.0;  // times the relative size: bounds on the radius [m]
    double facet_distance = 0.0;               // [m] between a facet and the skin
    double radius_edge_ratio = 2.0;
    bool is_manifold = false;  // the mesh of a skin of one patch
    // perturb and exude; dihedral angles above it are good enough; 0: as good as they get
    std::optional<double> sliver_bound_deg;
    std::size_t most_vertices = 0;   // a refinement that reaches so many ends with TooManyVertices; 0: no bound
    std::size_t most_questions = 0;  // of the perturbation, for each 4,000 vertices begun; 0: no bound
};
struct TooManyVertices {
    std::string vertices;  // how many, in words
};
struct PointTwice {  // a refinement would put a point where a vertex is: rounding in a layer that is too thin
    std::size_t vertices = 0;
};
// it asked too many questions: that of CGAL 6.0 moves the vertices of some coarse meshes to and fro
struct EndlessPerturbation {};
constexpr const char* endless_perturbation = "CGAL moves their vertices to and fro without end to improve flat tets";
TetMesh mesh_body(MeshedBody& body, const MeshCriteria& criteria);

}  // namespace pbs
