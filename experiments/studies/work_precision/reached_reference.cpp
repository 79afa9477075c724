#include "experiments/studies/work_precision/reached_reference.hpp"

#include "analysis/grid_convergence.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/run/reference_error_bar.hpp"
#include "pbs/character/refined_character.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

double nodes_along(const ReachedPoint& point)
{
    const pbs::TetMesh& mesh = point.mesh->character().mesh;
    const Eigen::Index midpoints = options_of<FemOptions>(point.setting->spec).element_order == 2 ? pbs::edges_of(mesh.tets).rows() : 0;
    return std::cbrt(double(mesh.rest.rows() + midpoints));
}

Eigen::Index vertices_of(const ReachedPoint& point)
{
    return point.mesh->character().mesh.rest.rows();
}

enum class On { own_tets, refined_tets, coarser_mesh };

bool lies(const ReachedPoint& point, On where, Eigen::Index base_vertices)
{
    if (where == On::own_tets) return point.setting->on_own_mesh();
    if (where == On::refined_tets) return point.setting->refined;
    return point.setting->vertices > 0 && vertices_of(point) < base_vertices;
}

// The finished stable neo-Hookean solution of that element order there; on the finest mesh if there are several.
const ReachedPoint* solution(const std::vector<ReachedPoint>& points, int element_order, On where, Eigen::Index base_vertices)
{
    const ReachedPoint* found = nullptr;
    for (const ReachedPoint& point : points) {
        const DeformerSpec& spec = point.setting->spec;
        const FemOptions* fem = options_if<FemOptions>(spec);
        const bool is_law = fem && fem->model == reference_fem::Model::stable_neo_hookean;
        if (!point.shape.finished || !is_law || fem->element_order != element_order || !lies(point, where, base_vertices)) continue;
        if (!found || vertices_of(point) > vertices_of(*found)) found = &point;
    }
    return found;
}

// The second solution: of the same element order, or else of the other.
const ReachedPoint* solution_beside(const std::vector<ReachedPoint>& points, int element_order, Eigen::Index base_vertices)
{
    const std::pair<int, On> quadratic[] = {{2, On::coarser_mesh}, {1, On::own_tets}},
                             linear[] = {{1, On::refined_tets}, {1, On::coarser_mesh}};
    for (const auto& [order, where] : element_order == 2 ? quadratic : linear)
        if (const ReachedPoint* found = solution(points, order, where, base_vertices)) return found;
    return nullptr;
}

}  // namespace

BodyMesh::BodyMesh(pbs::CharacterSource source, int vertices, const pbs::Character& base) : base_vertices_(base.mesh.rest.rows())
{
    source.vertices = vertices;
    character_ = std::make_shared<pbs::Character>(pbs::make_character(source));
    points_ = pbs::embed(base.mesh.rest, pbs::Triangles(0, 3), character_->mesh);
}

BodyMesh BodyMesh::refined(const pbs::Character& base)
{
    BodyMesh fine(std::make_shared<pbs::Character>(pbs::refined(base)));
    fine.base_vertices_ = base.mesh.rest.rows();
    return fine;
}

pbs::Positions BodyMesh::on_base(const pbs::Positions& positions) const
{
    return points_ ? pbs::embedded_positions(*points_, positions, character_->mesh.tets)
                   : pbs::Positions(positions.topRows(base_vertices_));
}

ReachedReference choose_reference(const std::vector<ReachedPoint>& points, Eigen::Index base_vertices,
                                  const analysis::ErrorMetrics& error_metrics)
{
    ReachedReference reference;
    reference.point = solution(points, 2, On::own_tets, base_vertices);
    if (!reference.point) reference.point = solution(points, 1, On::own_tets, base_vertices);
    if (reference.point)
        reference.beside = solution_beside(points, options_of<FemOptions>(reference.point->setting->spec).element_order, base_vertices);
    if (!reference.beside) return reference;

    const double assumed_order = convergence_order(options_of<FemOptions>(reference.point->setting->spec).attachment);
    const double nodes = nodes_along(*reference.point), nodes_beside = nodes_along(*reference.beside);
    const double ratio = std::max(nodes, nodes_beside) / std::min(nodes, nodes_beside);
    const int place = nodes > nodes_beside ? 0 : 1;  // the finer one comes first
    const analysis::ErrorNorms difference = error_metrics.measure(reference.point->on_base, reference.beside->on_base);
    const auto bound = [&](double distance) { return analysis::two_fields(distance, ratio, assumed_order).bounds[place]; };
    reference.bar = {bound(difference.l2_pct), bound(difference.joint_pct), bound(difference.linf_m)};
    return reference;
}

}  // namespace experiments
