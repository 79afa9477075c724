// Surface -> alpha wrap -> Mesh_3 with a cell size proportional to the local thickness -> perturb -> exude -> checks.
// Alpha wrap: Portaneri et al., ACM TOG 41(4), 2022. Delaunay refinement, perturbation, exudation: Jamin et al., ACM
// TOMS 41(4), 2015.
#include "experiments/meshes/meshing.hpp"
#include "pbs/geometry/extent.hpp"

#include "experiments/meshes/cgal_versions.hpp"
#include "experiments/meshes/meshing_attempts.hpp"
#include "experiments/meshes/meshing_cgal.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/system/child_process.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/boost/graph/iterator.h>

#include <boost/graph/connected_components.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <utility>

namespace pbs {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Surface = CGAL::Surface_mesh<Point>;
using Tree = CGAL::AABB_tree<CgalTreeTraits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Surface>>>;

// The vertices of each connected part, ascending; parts in the order of their first vertices.
std::vector<std::vector<Surface::Vertex_index>> vertices_of_parts(const Surface& surface)
{
    std::vector<int> part(surface.number_of_vertices());
    const auto part_of = boost::make_iterator_property_map(part.begin(), get(boost::vertex_index, surface));
    std::vector<std::vector<Surface::Vertex_index>> parts(boost::connected_components(surface, part_of));
    for (const auto vertex : surface.vertices()) parts[part_of[vertex]].push_back(vertex);
    return parts;
}

// What a closed surface encloses. Its property "f:patch_id" numbers the patches.
class EnclosedBody : public MeshedBody {
public:
    explicit EnclosedBody(Surface surface)
        : surface_(std::move(surface)),
          patches_(get(CGAL::face_patch_id_t<int>(), surface_)),
          domain_(surface_),
          parts_(vertices_of_parts(surface_))
    {
    }

    CGAL::Bbox_3 box() const override { return domain_.bbox(); }
    bool contains(const Point& p) const override { return domain_.is_in_domain_object()(p).has_value(); }

    std::optional<SkinPoint> crossing(const Line& line) const override
    {
        const auto crossing = [this](const auto& query) { return domain_.construct_intersection_object()(query); };
        const auto [point, patch, dimension] = std::visit(crossing, line);
        return dimension == 0 ? std::nullopt : std::optional(SkinPoint(point, patch));
    }

    // Where two patches meet.
    std::vector<Edge> edges() const override
    {
        std::map<std::pair<Surface::Vertex_index, Surface::Vertex_index>, std::set<int>> patches_at;
        for (const auto along : surface_.halfedges())
            patches_at[std::minmax(surface_.source(along), surface_.target(along))].insert(
                patches_[surface_.face(along)]);
        std::vector<Edge> edges;
        for (const auto& [ends, patches] : patches_at)
            if (patches.size() == 2)
                edges.push_back({{surface_.point(ends.first), surface_.point(ends.second)}, patches});
        return edges;
    }

    // Vertices of the surface as far from each other as can be. A part on which there are none would be lost.
    std::vector<SkinPoint> initial_points() const override
    {
        std::vector<SkinPoint> points;
        for (const auto& part : parts_) {
            std::vector<double> distance(part.size(), std::numeric_limits<double>::infinity());
            std::size_t next = 0;
            for (int i = 0; i < points_a_part_ && distance[next] > 0.0; ++i) {
                const Point& point = surface_.point(part[next]);
                points.emplace_back(point, patches_[surface_.face(surface_.halfedge(part[next]))]);
                for (std::size_t v = 0; v < part.size(); ++v)
                    distance[v] = std::min(distance[v], CGAL::squared_distance(surface_.point(part[v]), point));
                next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
            }
        }
        return points;
    }

    // False once there are as many as the surface has vertices.
    bool double_initial_points() override
    {
        points_a_part_ *= 2;
        return points_a_part_ <= static_cast<int>(surface_.number_of_vertices());
    }

protected:
    Surface surface_;
    int points_a_part_ = 12;

private:
    Surface::Property_map<Surface::Face_index, int> patches_;
    CGAL::Polyhedral_mesh_domain_3<Surface, Kernel, CGAL::Default, int> domain_;
    std::vector<std::vector<Surface::Vertex_index>> parts_;
};

// |V| / diagonal^3 is 0.19 of the cube. Rounding leaves 1e-16 of a flat surface; a body so thin would be all wrap.
constexpr double flat_surface = 1e-12;
constexpr double smallest_m =
    1e-9;  // squares and cubes of cells of a smaller surface leave the range that CGAL can compare
constexpr double sheet_thickness = 0.05;  // over the diagonal: some tets across it at the default number of vertices
constexpr double grading = 1.0 / 3.0;     // of facets outside a FineBall
constexpr const char *boundary_not_manifold = "the boundary is not manifold", *no_tets = "no tets";

// Bounds on the work, far above what a sound mesh takes. They count points, so that a slow machine makes the same
// meshes. A thin layer is refined down to its thickness, whatever cells are wanted: an open tube gets 18,000 vertices
// instead of 2,000. Otherwise the search overshoots most where the first size fits 2,000 vertices and far more are
// wanted: its slope of -2.5 instead of -3 gives 2.2 times 99,900 and 5.5 times 10 million. A vertex takes up to 3 kB.
// The wrap of a thin layer has 10,000 points, that of a bulky body some 40,000.
constexpr std::size_t least_bound = 30'000, bound_over_wanted = 6, least_in_all = 45'000, in_all_over_wanted = 30,
                      most_wrap_points = 1'000'000;

struct WrapVisitor : CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
    template <typename Wrapper, typename NewPoint>
    void before_Steiner_point_insertion(const Wrapper&, const NewPoint&)
    {
        if (++points > most_wrap_points)
            throw InputError("", 0, "points of the wrap", "more than " + std::to_string(most_wrap_points),
                             "expected fewer: a larger alpha (--wrap-alpha)");
    }
    std::size_t points = 0;
};

Surface wrap(const SurfaceMesh& surface, double alpha, double offset)
{
    const Stage stage("wrapping the surface");
    std::vector<Point> points;
    std::vector<std::array<std::size_t, 3>> triangles;
    for (Eigen::Index i = 0; i < surface.points.rows(); ++i)
        points.emplace_back(surface.points(i, 0), surface.points(i, 1), surface.points(i, 2));
    for (Eigen::Index f = 0; f < surface.triangles.rows(); ++f)
        triangles.push_back({static_cast<std::size_t>(surface.triangles(f, 0)),
                             static_cast<std::size_t>(surface.triangles(f, 1)),
                             static_cast<std::size_t>(surface.triangles(f, 2))});
    Surface wrapped;
    WrapVisitor visitor;
    CGAL::alpha_wrap_3(points, triangles, alpha, offset, wrapped, CGAL::parameters::default_values(),
                       CGAL::parameters::visitor(std::ref(visitor)));
    return wrapped;
}

// How far an inward ray from the middle of each face travels through the body [m], #F; averaged three times with the
// neighbours.
std::vector<double> local_thickness(const Surface& surface, const Tree& tree, double diagonal)
{
    std::vector<double> thickness(surface.number_of_faces(), diagonal);
    for (const auto face : surface.faces()) {
        const auto edge = surface.halfedge(face);
        const Point middle = CGAL::centroid(surface.point(surface.source(edge)), surface.point(surface.target(edge)),
                                            surface.point(surface.target(surface.next(edge))));
        const Kernel::Vector_3 normal = pmp::compute_face_normal(face, surface);
        const auto hit =
            tree.first_intersection(Kernel::Ray_3(middle, -normal), [face](auto other) { return other == face; });
        if (!hit) continue;
        if (const Point* point = alternative<Point>(hit->first))
            thickness[face.idx()] = std::sqrt(CGAL::squared_distance(*point, middle));
    }
    for (int pass = 0; pass < 3; ++pass) {
        const std::vector<double> before = thickness;
        for (const auto face : surface.faces()) {
            double sum = before[face.idx()];
            int count = 1;
            for (const auto neighbour : CGAL::faces_around_face(surface.halfedge(face), surface)) {
                sum += before[neighbour.idx()];
                ++count;
            }
            thickness[face.idx()] = sum / count;
        }
    }
    return thickness;
}

// A wrapped body, ready to be meshed at any cell size.
class WrappedBody : public EnclosedBody {
public:
    WrappedBody(const SurfaceMesh& surface, double alpha, double offset, const SurfaceMeshing& options)
        : EnclosedBody(wrap(surface, alpha, offset)),
          options_(options),
          diagonal_(diagonal_m(surface.points)),
          tree_(faces(surface_).begin(), faces(surface_).end(), surface_)
    {
        tree_.accelerate_distance_queries();
        thickness_ = local_thickness(surface_, tree_, diagonal_);
    }

    double volume() const { return CGAL::to_double(pmp::volume(surface_)); }
    int euler() const
    {
        return static_cast<int>(num_vertices(surface_)) - static_cast<int>(num_edges(surface_)) +
               static_cast<int>(num_faces(surface_));
    }

    double relative_size(const Point& p) const override
    {
        const double thickness = thickness_[tree_.closest_point_and_primitive(p).second.idx()];
        return std::clamp(thickness / options_.cells_across, options_.smallest_facet * diagonal_,
                          options_.largest_facet * diagonal_);
    }

    // size 1: cells as in the options; distance 1: facets as near to the wrap as there. sliver_bound_deg: see
    // MeshCriteria.
    MeshCriteria criteria(double size, double distance, std::optional<double> sliver_bound_deg = {}) const
    {
        return {.facet_size = size,
                .cell_size = options_.inside_to_skin * size,
                .facet_distance = options_.facet_distance * diagonal_ * distance * size,
                .radius_edge_ratio = options_.radius_edge_ratio,
                .is_manifold = true,
                .sliver_bound_deg = sliver_bound_deg,
                .most_questions = options_.most_questions};
    }

private:
    const SurfaceMeshing& options_;
    double diagonal_;
    Tree tree_;
    std::vector<double> thickness_;
};

Surface surface_of(const std::vector<Point>& points, const std::vector<PatchTriangle>& triangles)
{
    Surface surface;
    auto patches = get(CGAL::face_patch_id_t<int>(), surface);
    for (const Point& point : points) surface.add_vertex(point);
    for (const auto& [a, b, c, patch] : triangles)
        patches[surface.add_face(Surface::Vertex_index(a), Surface::Vertex_index(b), Surface::Vertex_index(c))] = patch;
    return surface;
}

Surface boundary_surface(const TetMesh& mesh)
{
    Triangles boundary = boundary_of(mesh.tets);
    std::vector<Point> points;
    for (const int v : renumbered(boundary, mesh.rest.rows()))
        points.emplace_back(mesh.rest(v, 0), mesh.rest(v, 1), mesh.rest(v, 2));
    std::vector<PatchTriangle> triangles;
    for (const auto& face : boundary.cast<unsigned>().rowwise()) triangles.push_back({face(0), face(1), face(2), 1});
    return surface_of(points, triangles);
}

// The inside of a mesh's boundary.
class RemeshedBody : public EnclosedBody {
public:
    RemeshedBody(Surface surface, const Remeshing& options)
        : EnclosedBody(std::move(surface)),
          options_(options),
          tree_(faces(surface_).begin(), faces(surface_).end(), surface_)
    {
        points_a_part_ = static_cast<int>(surface_.number_of_vertices());
        tree_.accelerate_distance_queries();
        std::mt19937 random(options.seed);
        for (const auto face : surface_.faces()) {
            double sum = 0.0;
            for (const auto edge : CGAL::halfedges_around_face(surface_.halfedge(face), surface_))
                sum += pmp::edge_length(edge, surface_);
            factor_.push_back(
                1.0 + (options.seed == 0 ? 0.0 : options.most_change * (2.0 * random() / std::mt19937::max() - 1.0)));
            size_.push_back(factor_.back() * sum / 3.0);
        }
    }

    double mean_size() const
    {
        return std::accumulate(size_.begin(), size_.end(), 0.0) / static_cast<double>(size_.size());
    }

    // The skin alone is finer: cells follow it by their shapes.
    double relative_size(const Point& p) const override
    {
        return size_[tree_.closest_point_and_primitive(p).second.idx()];
    }
    double relative_facet_size(const Point& p) const override
    {
        const std::size_t face = tree_.closest_point_and_primitive(p).second.idx();
        double size = size_[face];
        for (const FineBall& ball : options_.fine) {
            const double outside = (Vec3(p.x(), p.y(), p.z()) - ball.centre).norm() - ball.radius_m;
            size = std::min(size, factor_[face] * ball.size_m + grading * std::max(outside, 0.0));
        }
        return size;
    }

private:
    const Remeshing& options_;
    Tree tree_;
    std::vector<double> size_, factor_;  // of each face
};

struct Effort {
    std::size_t most,
        left;  // of vertices: what each refinement of a wrap may take, and what all together may still take
};

// Empty where the refinement fails; TooManyVertices and EndlessPerturbation where a bound is reached.
TetMesh mesh_within(Effort& effort, MeshedBody& body, MeshCriteria criteria)
{
    criteria.most_vertices = std::min(effort.most, effort.left);
    if (effort.left == 0) throw TooManyVertices{"too many in all attempts"};
    effort.left -= criteria.most_vertices;  // all of them, if it ends with TooManyVertices
    try {
        TetMesh mesh = mesh_body(body, criteria);
        effort.left += criteria.most_vertices - static_cast<std::size_t>(mesh.rest.rows());
        return mesh;
    } catch (const PointTwice& failed) {
        effort.left += criteria.most_vertices - std::min(criteria.most_vertices, failed.vertices);
        return {};
    } catch (const EndlessPerturbation&) {  // whose own bound ends it
        effort.left += criteria.most_vertices;
        throw;
    }
}

// An open sheet is wrapped on both sides: its wrap holds far less, or far more, than the surface seems to enclose.
bool is_far_off(double volume_ratio)
{
    return !(volume_ratio > 0.5 && volume_ratio < 2.0);
}

std::string advice(double volume_ratio)
{
    if (!is_far_off(volume_ratio)) return "the body has parts thinner than its cells; ask for more vertices";
    if (!std::isfinite(volume_ratio)) return "the surface encloses no volume; give it a thickness";
    return "its wrap holds " + number_text(volume_ratio, 2) +
           " times what the surface seems to enclose; close it, or give it a thickness";
}

// A defect of the wrap remains at every cell size.
void check_wrap(const WrappedBody& body, const SurfaceMeshing& options)
{
    if (options.boundary_euler && body.euler() != *options.boundary_euler)
        throw InputError(
            "", 0, "Euler number of the wrapped surface", std::to_string(body.euler()),
            "expected " + std::to_string(*options.boundary_euler) + ": another wrap_alpha_m, or ask for this number");
    for (std::size_t i = 0; i < options.inside.size(); ++i)
        if (!body.contains(Point(options.inside[i](0), options.inside[i](1), options.inside[i](2))))
            throw InputError("", 0, "point " + std::to_string(i) + " asked inside", "", "expected inside the surface");
}

// The cell size that refines to the wanted number of vertices; optimising hardly changes it. TooManyVertices where far
// larger cells are hardly fewer, so that the number cannot be reached.
double size_of(WrappedBody& body, int vertices, double distance, Effort& effort)
{
    double nearest_size = 1.0, nearest_miss = std::numeric_limits<double>::infinity(), last_size = 0.0,
           last_count = 0.0;
    mesh_at_vertex_count(vertices, 1.0, [&](double size) {
        TetMesh mesh = mesh_within(effort, body, body.criteria(size, distance));
        const double count = static_cast<double>(mesh.rest.rows()), miss = std::abs(count - vertices);
        if (last_count > 0.0 && size > 2.0 * last_size && count > 0.9 * last_count && count > 4.0 * vertices)
            throw TooManyVertices{number_text(count) + " with larger cells too"};
        last_size = size;
        last_count = count;
        if (miss < nearest_miss) {
            nearest_miss = miss;
            nearest_size = size;
        }
        return mesh;
    });
    return nearest_size;
}

// The first thing wrong with the mesh, which perturbing and exuding may have undone; empty when it is
// boundary-manifold, in one piece, of the wanted Euler number and dihedral angle, free of self-intersections, and all
// points lie inside.
std::string breach_of(const TetMesh& mesh, const SurfaceMeshing& options)
{
    if (mesh.tets.rows() == 0) return no_tets;
    const Quality quality = quality_of(mesh);
    if (!quality.topology.boundary_manifold) return boundary_not_manifold;
    if (options.is_one_piece && quality.topology.components != 1)
        return std::to_string(quality.topology.components) + " pieces";
    if (options.boundary_euler && quality.topology.boundary_euler != *options.boundary_euler)
        return "Euler number of the boundary " + std::to_string(quality.topology.boundary_euler) + ", expected " +
               std::to_string(*options.boundary_euler);
    if (quality.min_dihedral_deg < options.min_dihedral_deg)
        return "smallest dihedral angle " + std::to_string(quality.min_dihedral_deg) + " deg";

    const Triangles boundary = boundary_of(mesh.tets);
    if (self_intersects(mesh.rest, boundary)) return "the boundary intersects itself";
    if (options.inside.empty()) return "";
    const std::vector<bool> inside = points_inside(mesh.rest, boundary, options.inside);
    const auto outside = std::count(inside.begin(), inside.end(), false);
    if (outside == 0) return "";
    const auto first = std::find(inside.begin(), inside.end(), false) - inside.begin();
    return std::to_string(outside) + " of the points asked inside are outside, the first is number " +
           std::to_string(first);
}

// The first mesh of the quality asked; nothing, and why, where none of the distances gives one. is_open: gives up
// sooner without tets or at a boundary that is not manifold, which is what becomes of a layer too thin to be meshed.
// is_exceeded: becomes true where a bound is reached.
std::optional<TetMesh> mesh_wrapped(const SurfaceMesh& surface, double alpha, double offset, bool is_open,
                                    const SurfaceMeshing& options, bool& is_exceeded, std::optional<InputError>& why)
{
    const auto wanted = static_cast<std::size_t>(options.vertices);
    Effort effort = {std::max(least_bound, bound_over_wanted * wanted),
                     std::max(least_in_all, in_all_over_wanted * wanted)};
    WrappedBody body(surface, alpha, offset, options);
    const double ratio = body.volume() / std::abs(fan_volume(surface.points, surface.triangles));
    if (options.is_closed && is_far_off(ratio))
        throw InputError("", 0, "wrapped volume / enclosed volume", std::to_string(ratio),
                         "expected 0.5 to 2: a closed or nearly closed surface, its triangles oriented one way");
    check_wrap(body, options);
    int too_thin = 0, attempt = 0;
    for (const double distance : {1.0, 0.8, 1.25, 0.65, 1.5, 0.5}) try {
            const Stage stage("filling the wrap with tets, attempt " + std::to_string(++attempt));
            const double size = size_of(body, options.vertices, distance, effort);
            TetMesh mesh = mesh_within(effort, body, body.criteria(size, distance, options.good_dihedral_deg));
            const std::string breach = breach_of(mesh, options);
            if (breach.empty()) return mesh;
            why.emplace("", 0, "surface", "",
                        "could not be meshed with the quality asked: " + breach + "; " + advice(ratio));
            too_thin += breach == boundary_not_manifold || breach == no_tets;
            if (is_open && too_thin == 2) break;
        } catch (const TooManyVertices& reached) {  // as with every other distance
            is_exceeded = true;
            why.emplace("", 0, "vertices of the tets", reached.vertices,
                        "expected about " + std::to_string(options.vertices) + " (--vertices): " + advice(ratio));
            break;
        } catch (const EndlessPerturbation&) {
            why.emplace("", 0, "vertices of the tets", std::to_string(options.vertices),
                        std::string(endless_perturbation) + ": expected another number (--vertices)");
        }
    return std::nullopt;
}

void check_surface(const SurfaceMesh& surface, const SurfaceMeshing& options)
{
    if (options.vertices < 150)
        throw InputError("", 0, "vertices", std::to_string(options.vertices), "expected at least 150");
    if (surface.triangles.rows() < 4)
        throw InputError("", 0, "triangles", std::to_string(surface.triangles.rows()),
                         "expected a closed surface: at least 4");
    if (!surface.points.allFinite()) throw InputError("", 0, "points", "", "expected finite coordinates [m]");
    if (surface.triangles.minCoeff() < 0 || surface.triangles.maxCoeff() >= surface.points.rows())
        throw InputError("", 0, "triangles", "", "expected indices of points");
    const double diagonal = diagonal_m(surface.points);
    if (!(diagonal >= smallest_m))
        throw InputError("", 0, "diagonal of the surface [m]", number_text(diagonal),
                         "expected at least " + number_text(smallest_m));
    if (options.is_closed && sheet_offset_m(surface) > 0.0)
        throw InputError("", 0, "enclosed volume [m^3]", number_text(fan_volume(surface.points, surface.triangles)),
                         "expected a closed surface round a volume, neither flat nor open");
}

}  // namespace

double sheet_offset_m(const SurfaceMesh& surface)
{
    const double diagonal = diagonal_m(surface.points);
    const bool has_volume =
        std::abs(fan_volume(surface.points, surface.triangles)) > flat_surface * diagonal * diagonal * diagonal;
    return has_volume ? 0.0 : diagonal * sheet_thickness / 2.0;
}

std::unique_ptr<MeshedBody> make_enclosed_body(const std::vector<Point>& points,
                                               const std::vector<PatchTriangle>& triangles)
{
    return std::make_unique<EnclosedBody>(surface_of(points, triangles));
}

TetMesh mesh_surface(const SurfaceMesh& surface, const SurfaceMeshing& options)
{
    check_surface(surface, options);
    const double sheet_m = sheet_offset_m(surface);
    const double alpha = options.wrap_alpha_m > 0.0 ? options.wrap_alpha_m
                         : sheet_m > 0.0            ? sheet_m
                                                    : diagonal_m(surface.points) / 170.0;
    const double offset = options.wrap_offset_m > 0.0 ? options.wrap_offset_m : sheet_m > 0.0 ? sheet_m : alpha / 3.0;

    // A sheet of the surface, such as hair or a cape, becomes a layer between the offsets on both sides. Where that is
    // too thin to be meshed, the offset grows; where it takes too many vertices, to the largest one at once.
    const bool is_open =
        options.wrap_offset_m == 0.0 && !is_watertight(joined_triangles(surface.points, surface.triangles));
    bool is_exceeded = false;
    std::optional<InputError> why;
    for (const double growth : {1.0, 3.0, 6.0}) {
        if (growth > 1.0 && (!is_open || (growth < 6.0 && is_exceeded))) continue;
        is_exceeded = false;
        if (const auto mesh = mesh_wrapped(surface, alpha, growth * offset, is_open, options, is_exceeded, why))
            return *mesh;
    }
    if (is_exceeded) throw TooManyTets(*why);
    throw InputError(*why);
}

TetMesh mesh_anew(const TetMesh& mesh, const Remeshing& options)
{
    const Topology topology = topology_of(mesh.tets, mesh.rest.rows());
    if (mesh.tets.rows() == 0 || !topology.boundary_manifold)
        throw InputError("", 0, "tets", std::to_string(mesh.tets.rows()),
                         "expected some with a manifold boundary, to mesh its inside anew");
    RemeshedBody body(boundary_surface(mesh), options);
    const SurfaceMeshing required = {.boundary_euler = topology.boundary_euler,
                                     .is_one_piece = topology.components == 1};
    const MeshCriteria criteria = {.facet_size = options.facet_size,
                                   .cell_size = options.cell_size,
                                   .facet_distance = options.facet_distance * body.mean_size(),
                                   .radius_edge_ratio = required.radius_edge_ratio,
                                   .is_manifold = true,
                                   .sliver_bound_deg = required.good_dihedral_deg,
                                   .most_questions = required.most_questions};
    const std::size_t most = std::max(least_bound, bound_over_wanted * static_cast<std::size_t>(mesh.rest.rows()));
    Effort effort = {most, most};
    std::string breach;
    try {
        TetMesh other = mesh_within(effort, body, criteria);
        breach = breach_of(other, required);
        if (breach.empty()) return other;
    } catch (const TooManyVertices& reached) {
        breach = reached.vertices + " vertices";
    } catch (const EndlessPerturbation&) {
        breach = endless_perturbation;
    }
    throw InputError("", 0, "tets", "", "their inside could not be meshed anew: " + breach);
}

}  // namespace pbs
