// The built-in bodies: a capsule from its distance function, a bar from its eight corners.
#include "pbs/geometry/meshing.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/meshing_cgal.hpp"
#include "pbs/geometry/meshing_count.hpp"

#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/boost/graph/generators.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

namespace parameters = CGAL::parameters;
using Point = Kernel::Point_3;

constexpr double half_length = 1.0;  // [m]
constexpr double radius = 0.15;      // [m], half the bar's width

void require_vertices(int vertices, int least)
{
    if (vertices < least) throw InputError("", 0, "vertices", std::to_string(vertices), "expected at least " + std::to_string(least));
}

// Signed distance to the capsule round the segment (-1,0,0) -> (1,0,0).
double capsule_distance(const Point& p)
{
    const double along = p.x() - std::clamp(p.x(), -half_length, half_length);
    return std::sqrt(along * along + p.y() * p.y() + p.z() * p.z()) - radius;
}

TetMesh capsule_at(double size)
{
    using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
    using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
    using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
    using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

    fix_meshing_seed();
    const Kernel::Sphere_3 bounds(Point(0, 0, 0), 4.0);  // centre, squared radius
    const Domain domain = Domain::create_implicit_mesh_domain(capsule_distance, bounds, parameters::relative_error_bound = 1e-9);
    const Criteria criteria(parameters::facet_angle = 25, parameters::facet_size = size, parameters::facet_distance = 0.1 * size,
                            parameters::cell_radius_edge_ratio = 2, parameters::cell_size = size);
    return tet_mesh_of(CGAL::make_mesh_3<Complex>(domain, criteria, parameters::perturb(), parameters::exude()));
}

TetMesh bar_at(double size)
{
    using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
    using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
    using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
    using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

    fix_meshing_seed();
    Domain::Polyhedron box;
    const double x = half_length, r = radius;
    CGAL::make_hexahedron(Point(-x, -r, -r), Point(x, -r, -r), Point(x, r, -r), Point(-x, r, -r), Point(-x, r, r), Point(-x, -r, r),
                          Point(x, -r, r), Point(x, r, r), box);
    CGAL::Polygon_mesh_processing::triangulate_faces(box);
    Domain domain(box);
    domain.detect_features();
    const Criteria criteria(parameters::edge_size = size, parameters::facet_angle = 25, parameters::facet_size = size,
                            parameters::facet_distance = 0.1 * size, parameters::cell_radius_edge_ratio = 2, parameters::cell_size = size);
    return tet_mesh_of(CGAL::make_mesh_3<Complex>(domain, criteria, parameters::perturb(), parameters::exude()));
}

}  // namespace

TetMesh mesh_limb(int vertices)
{
    require_vertices(vertices, 150);
    return mesh_at_vertex_count(vertices, 0.78 * std::pow(vertices, -0.36), capsule_at);
}

TetMesh mesh_bar(int vertices)
{
    require_vertices(vertices, 150);
    return mesh_at_vertex_count(vertices, 0.78 * std::pow(vertices, -0.36), bar_at);
}

}  // namespace pbs
