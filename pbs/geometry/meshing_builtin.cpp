// The built-in bodies: a capsule from its distance function, a bar from its eight corners.
#include "pbs/geometry/meshing.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/meshing_attempts.hpp"
#include "pbs/geometry/meshing_cgal.hpp"

#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/boost/graph/generators.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pbs {
namespace {

namespace parameters = CGAL::parameters;
using Point = Kernel::Point_3;

constexpr double half_length = 1.0;  // [m]
constexpr double radius = 0.15;      // [m], half the bar's width
constexpr double sliver_bound_deg = 0.0;

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

// CGAL starts the refinement from a dozen random points; where two fall close together a short edge stays, whatever the cell size. Here
// it starts from the poles and three rings of three.
struct CapsuleDomain : CGAL::Labeled_mesh_domain_3<Kernel> {
    using Base = CGAL::Labeled_mesh_domain_3<Kernel>;

    CapsuleDomain()
        : Base(create_implicit_mesh_domain(capsule_distance, Kernel::Sphere_3(Point(0, 0, 0), 4.0),  // centre, squared radius
                                           parameters::relative_error_bound = 1e-9))
    {
    }

    struct InitialPoints {
        const CapsuleDomain& domain;

        template <typename Output>
        Output operator()(Output output, int = 0) const
        {
            const Index skin = domain.index_from_surface_patch_index({0, 1});
            const auto add = [&](double x, double y, double z) { *output++ = std::pair(Point(x, y, z), skin); };
            add(-half_length - radius, 0.0, 0.0);
            add(half_length + radius, 0.0, 0.0);
            for (int ring = -1; ring <= 1; ++ring)
                for (int k = 0; k < 3; ++k) {
                    const double angle = std::numbers::pi / 3.0 * (2 * k + ring);
                    add(0.7 * half_length * ring, radius * std::cos(angle), radius * std::sin(angle));
                }
            return output;
        }
    };
    InitialPoints construct_initial_points_object() const { return {*this}; }
};

TetMesh capsule_at(double size)
{
    using Triangulation = CGAL::Mesh_triangulation_3<CapsuleDomain>::type;
    using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
    using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

    const CapsuleDomain domain;
    const Criteria criteria(parameters::facet_angle = 25, parameters::facet_size = size, parameters::facet_distance = 0.1 * size,
                            parameters::cell_radius_edge_ratio = 2, parameters::cell_size = size);
    Complex complex = refine_mesh<Complex>(domain, criteria);
    optimise_mesh(complex, domain, sliver_bound_deg);
    return tet_mesh_of(complex);
}

TetMesh bar_at(double size)
{
    using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
    using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
    using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
    using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

    Domain::Polyhedron box;
    const double x = half_length, r = radius;
    CGAL::make_hexahedron(Point(-x, -r, -r), Point(x, -r, -r), Point(x, r, -r), Point(-x, r, -r), Point(-x, r, r), Point(-x, -r, r),
                          Point(x, -r, r), Point(x, r, r), box);
    CGAL::Polygon_mesh_processing::triangulate_faces(box);
    Domain domain(box);
    domain.detect_features();
    const Criteria criteria(parameters::edge_size = size, parameters::facet_angle = 25, parameters::facet_size = size,
                            parameters::facet_distance = 0.1 * size, parameters::cell_radius_edge_ratio = 2, parameters::cell_size = size);
    Complex complex = refine_mesh<Complex>(domain, criteria);
    optimise_mesh(complex, domain, sliver_bound_deg);
    return tet_mesh_of(complex);
}

}  // namespace

TetMesh mesh_limb(int vertices)
{
    require_vertices(vertices, 300);  // below, cells as large as the limb is thick, and no vertex inside
    return mesh_at_vertex_count(vertices, 0.78 * std::pow(vertices, -0.36), capsule_at);
}

TetMesh mesh_bar(int vertices)
{
    require_vertices(vertices, 150);
    return mesh_at_vertex_count(vertices, 0.78 * std::pow(vertices, -0.36), bar_at);
}

}  // namespace pbs
