// CGAL's mesher, and the built-in bodies: a capsule from its distance function, a bar from its eight corners.
#include "experiments/meshes/meshing_cgal.hpp"

#include "experiments/meshes/cgal_versions.hpp"
#include "experiments/meshes/meshing.hpp"
#include "experiments/meshes/meshing_attempts.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CGAL/Intersections_3/Iso_cuboid_3_Line_3.h>
#include <CGAL/Intersections_3/Iso_cuboid_3_Ray_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>
#include <variant>
#include <vector>

namespace pbs {
namespace {

namespace parameters = CGAL::parameters;

// A body as CGAL's concept MeshDomain_3.
struct AskedBody {
    using R = Kernel;
    using Point_3 = Point;
    using Index = int;
    using Subdomain_index = int;
    using Subdomain = CgalOptional<int>;
    using Surface_patch_index = int;
    using Intersection = std::tuple<Point, Index, int>;  // and its dimension, 0 where there is none
    using Construct_intersection = AskedBody;

    explicit AskedBody(const MeshedBody* asked) : body(asked) {}

    CGAL::Bbox_3 bbox() const { return body->box(); }
    auto construct_initial_points_object() const
    {
        return [this](auto output, int = 0) {
            const auto points = body->initial_points();
            return std::copy(points.begin(), points.end(), output);
        };
    }
    auto is_in_domain_object() const
    {
        return [this](const Point& p) {
            if (questions_left-- == 0) throw EndlessPerturbation{};
            return body->contains(p) ? Subdomain(1) : Subdomain();
        };
    }
    const AskedBody& construct_intersection_object() const { return *this; }
    Intersection operator()(const MeshedBody::Line& line) const
    {
        const auto crossing = body->crossing(line);
        return crossing ? Intersection(crossing->first, crossing->second, 2) : Intersection();
    }

    const MeshedBody* body;
    mutable std::size_t questions_left = unlimited;
    static constexpr auto unlimited = std::numeric_limits<std::size_t>::max();
};

using Domain = CGAL::Mesh_domain_with_polyline_features_3<AskedBody>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

}  // namespace
}  // namespace pbs

namespace CGAL {

// Mesh_3 calls it where a point that it is to insert is a vertex already, before it fails. CGAL's own writes two files
// into the current folder; argument-dependent lookup prefers this one. Mesh_3 also calls it with an empty prefix, for a
// dump that was not asked for.
static void dump_c3t3(const pbs::Complex& complex, const std::string& prefix)
{
    if (!prefix.empty()) throw pbs::PointTwice{complex.triangulation().number_of_vertices()};
}

}  // namespace CGAL

namespace pbs {
namespace {

// Refines and no more. make_mesh_3 would limit the optimisers to the seconds that the refinement took; called by
// themselves they end by themselves, and the same way each time.
Complex refined(const Domain& domain, const MeshCriteria& wanted)
{
    const auto sized = [&domain](double size) {
        return
            [&domain, size](const Point& p, int, const Domain::Index&) { return size * domain.body->relative_size(p); };
    };
    const auto facet_size = [&](const Point& p, int, const Domain::Index&) {
        return wanted.facet_size * domain.body->relative_facet_size(p);
    };
    const Criteria criteria(parameters::edge_size = sized(wanted.facet_size), parameters::facet_angle = 25,
                            parameters::facet_size = facet_size, parameters::facet_distance = wanted.facet_distance,
                            parameters::facet_topology = wanted.is_manifold ? CGAL::FACET_VERTICES_ON_SAME_SURFACE_PATCH
                                                                            : CGAL::FACET_VERTICES_ON_SURFACE,
                            parameters::cell_radius_edge_ratio = wanted.radius_edge_ratio,
                            parameters::cell_size = sized(wanted.cell_size));
    // CGAL seeds it with the clock; a fixed seed makes meshing repeat to the bit
    CGAL::get_default_random() = CGAL::Random(0);
    // CGAL prints a warning when no refinement can begin. Such an empty complex is refined again from other points.
    const auto previous = CGAL::set_warning_handler([](const char*, const char*, const char*, int, const char*) {});
    const std::shared_ptr<void> quiet(nullptr, [previous](void*) { CGAL::set_warning_handler(previous); });
    CGAL::Mesh_error_code end = CGAL::CGAL_MESH_3_NO_ERROR;
    Complex complex = CGAL::make_mesh_3<Complex>(
        domain, criteria, parameters::no_perturb(), parameters::no_exude(),
        wanted.is_manifold ? parameters::manifold() : parameters::non_manifold(),
        domain.maximal_curve_index() > 0 ? parameters::features() : parameters::no_features(),
        parameters::mesh_3_options(parameters::maximal_number_of_vertices = wanted.most_vertices,
                                   parameters::pointer_to_error_code = &end));
    if (end != CGAL::CGAL_MESH_3_NO_ERROR) throw TooManyVertices{"more than " + std::to_string(wanted.most_vertices)};
    return complex;
}

// A count ends the perturbation at the same place each time, which seconds would not.
void perturb(Complex& complex, const Domain& domain, const MeshCriteria& wanted)
{
    if (wanted.most_questions > 0)
        domain.questions_left = wanted.most_questions * (1 + complex.triangulation().number_of_vertices() / 4000);
    CGAL::perturb_mesh_3(complex, domain, parameters::sliver_bound = *wanted.sliver_bound_deg);
    domain.questions_left = Domain::unlimited;
}

// Vertices are numbered as the cells first name them; cells come in the order of the triangulation's container.
TetMesh tet_mesh_of(const Complex& complex)
{
    TetMesh mesh;
    mesh.tets.resize(static_cast<Eigen::Index>(complex.number_of_cells_in_complex()), 4);
    std::unordered_map<const void*, int> index_of;
    std::vector<Vec3> points;
    Eigen::Index t = 0;
    for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell, ++t)
        for (int corner = 0; corner < 4; ++corner) {
            const auto vertex = cell->vertex(corner);
            const auto [entry, is_new] = index_of.emplace(&*vertex, static_cast<int>(points.size()));
            if (is_new) points.emplace_back(vertex->point().x(), vertex->point().y(), vertex->point().z());
            mesh.tets(t, corner) = entry->second;
        }
    mesh.rest.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) mesh.rest.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    return mesh;
}

constexpr double half_length = 1.0;  // [m]
constexpr double radius = 0.15;      // [m], half the bar's width

// Signed distance to the capsule round the segment (-1,0,0) -> (1,0,0).
double capsule_distance(const Point& p)
{
    const double along = p.x() - std::clamp(p.x(), -half_length, half_length);
    return std::sqrt(along * along + p.y() * p.y() + p.z() * p.z()) - radius;
}

class Capsule : public MeshedBody {
public:
    CGAL::Bbox_3 box() const override { return box_.bbox(); }
    bool contains(const Point& p) const override { return capsule_distance(p) < 0.0; }

    std::optional<SkinPoint> crossing(const Line& line) const override
    {
        if (const auto* segment = std::get_if<Kernel::Segment_3>(&line)) return crossing(*segment);
        const auto clipped = [this](const auto& whole) -> std::optional<SkinPoint> {
            const auto part = CGAL::intersection(whole, box_);
            const auto* segment = part ? alternative<Kernel::Segment_3>(*part) : nullptr;
            return segment ? crossing(*segment) : std::nullopt;
        };
        return std::visit(clipped, line);
    }

    // The poles and three rings of three.
    std::vector<SkinPoint> initial_points() const override
    {
        std::vector<SkinPoint> points = {{Point(-half_length - radius, 0, 0), 1},
                                         {Point(half_length + radius, 0, 0), 1}};
        for (int ring = -1; ring <= 1; ++ring)
            for (int k = 0; k < 3; ++k) {
                const double angle = std::numbers::pi / 3.0 * (2 * k + ring);
                points.emplace_back(Point(0.7 * half_length * ring, radius * std::cos(angle), radius * std::sin(angle)),
                                    1);
            }
        return points;
    }

private:
    // By bisection.
    std::optional<SkinPoint> crossing(const Kernel::Segment_3& segment) const
    {
        Point p = segment.source(), q = segment.target();
        const bool begins_inside = contains(p);
        if (contains(q) == begins_inside) return std::nullopt;
        Point middle = CGAL::midpoint(p, q);
        while (CGAL::squared_distance(p, q) >= squared_error_) {
            (contains(middle) == begins_inside ? p : q) = middle;
            middle = CGAL::midpoint(p, q);
        }
        return SkinPoint(middle, 1);
    }

    Kernel::Iso_cuboid_3 box_{Kernel::Sphere_3(Point(0, 0, 0), 4.0).bbox()};  // centre, squared radius
    double squared_error_ = CGAL::squared_distance(box_.min(), box_.max()) * 1e-9 * 1e-9 / 4;
};

std::unique_ptr<MeshedBody> make_bar()
{
    const double x = half_length, r = radius;
    const std::vector<Point> corners = {{-x, -r, -r}, {x, -r, -r}, {x, r, -r}, {-x, r, -r},
                                        {-x, r, r},   {-x, -r, r}, {x, -r, r}, {x, r, r}};
    const std::vector<PatchTriangle> triangles = {{6, 4, 5, 1}, {2, 0, 3, 2}, {7, 1, 2, 3}, {6, 0, 1, 4},
                                                  {5, 3, 0, 5}, {4, 2, 3, 6}, {4, 6, 7, 1}, {0, 2, 1, 2},
                                                  {1, 7, 6, 3}, {0, 6, 5, 4}, {3, 5, 4, 5}, {2, 4, 7, 6}};
    return make_enclosed_body(corners, triangles);
}

// vertices: see mesh_limb. least: below, cells as large as the body is thick, and no vertex inside.
TetMesh mesh_builtin(MeshedBody& body, int vertices, int least)
{
    if (vertices < least)
        throw InputError("", 0, "vertices", std::to_string(vertices), "expected at least " + std::to_string(least));
    TetMesh mesh = mesh_at_vertex_count(vertices, 0.78 * std::pow(vertices, -0.36), [&](double size) -> TetMesh {
        try {
            return mesh_body(body, {.facet_size = size,
                                    .cell_size = size,
                                    .facet_distance = 0.1 * size,
                                    .sliver_bound_deg = 0.0,
                                    .most_questions = SurfaceMeshing().most_questions});
        } catch (const EndlessPerturbation&) {
            return {};
        }
    });
    if (mesh.tets.rows() == 0)
        throw InputError("", 0, "vertices", std::to_string(vertices),
                         std::string(endless_perturbation) + ": expected another number");
    return mesh;
}

}  // namespace

TetMesh mesh_body(MeshedBody& body, const MeshCriteria& criteria)
{
    const MeshedBody* asked = &body;
    Domain domain(asked);
    const std::vector<MeshedBody::Edge> edges = body.edges();
    domain.add_features_and_incidences(edges.begin(), edges.end(), CGAL::First_of_pair_property_map<MeshedBody::Edge>(),
                                       CGAL::Second_of_pair_property_map<MeshedBody::Edge>());
    Complex complex = refined(domain, criteria);
    while (complex.number_of_facets_in_complex() == 0 && body.double_initial_points())
        complex = refined(domain, criteria);
    if (criteria.sliver_bound_deg) {
        perturb(complex, domain, criteria);
        CGAL::exude_mesh_3(complex, parameters::sliver_bound = *criteria.sliver_bound_deg);
    }
    return tet_mesh_of(complex);
}

TetMesh mesh_limb(int vertices)
{
    Capsule capsule;
    return mesh_builtin(capsule, vertices, 300);
}

TetMesh mesh_bar(int vertices)
{
    return mesh_builtin(*make_bar(), vertices, 200);
}

}  // namespace pbs
