#include "reference_fem/distributed/elastic_problem.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/attachment.hpp"
#include "reference_fem/options.hpp"

namespace reference_fem {
namespace {

struct HeldPoints {
    std::vector<pbs::Vec3> points;
    std::vector<int> tets;
};

void add_held_faces(const pbs::TetMesh& mesh, const std::vector<int>& held_vertices, HeldPoints& held)
{
    std::vector<bool> flags(mesh.rest.rows(), false);
    for (const int v : held_vertices) flags[v] = true;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const auto corners = mesh.tets.row(t);
        if (std::count_if(corners.begin(), corners.end(), [&](int v) { return flags[v]; }) < 3) continue;
        for (const int v : corners) {
            if (!flags[v]) continue;
            held.points.emplace_back(mesh.rest.row(v));
            held.tets.push_back(static_cast<int>(t));
        }
    }
}

void add_attached(const pbs::TetMesh& mesh, const Attachment& attachment, HeldPoints& held)
{
    for (const int tet : attachment.prescribed_tets)
        for (const int v : mesh.tets.row(tet)) {
            held.points.emplace_back(mesh.rest.row(v));
            held.tets.push_back(tet);
        }
    if (attachment.spring_points.rows() == 0) return;
    const pbs::PointLocation where(mesh);
    for (Eigen::Index s = 0; s < attachment.spring_points.rows(); ++s) {
        held.points.emplace_back(attachment.spring_points.row(s));
        held.tets.push_back(where.locate(held.points.back()).tet);
    }
}

void require_vertices(const pbs::TetMesh& mesh, const std::vector<int>& vertices, const char* field)
{
    for (const int v : vertices) require(v >= 0 && v < mesh.rest.rows(), field, v, "expected an index below the number of vertices");
}

}  // namespace

void check_problem(const pbs::TetMesh& mesh, const ElasticProblem& problem)
{
    const LinearOptions& options = problem.options;
    lame_parameters(options.young_pa, options.poisson);
    require(options.element_order == 1 || options.element_order == 2, "element_order", options.element_order, "expected 1 or 2");
    require(options.density_kg_m3 >= 0.0 && std::isfinite(options.density_kg_m3), "density_kg_m3", options.density_kg_m3,
            "expected a finite density >= 0");
    require(options.gravity_m_s2.allFinite(), "gravity_m_s2", options.gravity_m_s2.transpose(), "expected finite components");
    require(problem.traction_pa.allFinite(), "traction_pa", problem.traction_pa.transpose(), "expected finite components");
    check_mesh(mesh);
    check_attachment(mesh, problem.attachment);
    require(problem.attachment.bind_distance.size() == 0, "bind_distance", problem.attachment.bind_distance.size(),
            "expected none: the bind constraint is not linear");
    require(problem.spring_targets.rows() == problem.attachment.spring_points.rows(), "spring_targets", problem.spring_targets.rows(),
            "expected one a spring point");
    require(problem.attachment.prescribed_tets.empty() || problem.vertex_targets.rows() == mesh.rest.rows(), "vertex_targets",
            problem.vertex_targets.rows(), "expected one a vertex");
    require_vertices(mesh, problem.held_vertices, "held_vertices");
    require_vertices(mesh, problem.pulled_vertices, "pulled_vertices");

    HeldPoints held;
    add_held_faces(mesh, problem.held_vertices, held);
    add_attached(mesh, problem.attachment, held);
    pbs::Positions points(held.points.size(), 3);
    for (std::size_t p = 0; p < held.points.size(); ++p) points.row(p) = held.points[p];
    require_held(mesh, points, held.tets);
}

}  // namespace reference_fem
