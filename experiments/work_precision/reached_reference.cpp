#include "experiments/work_precision/reached_reference.hpp"

#include "analysis/grid_convergence.hpp"
#include "pbs/geometry/topology.hpp"

#include <cmath>

namespace experiments {
namespace {

double nodes_along(const ReachedPoint& point)
{
    const pbs::TetMesh& mesh = point.mesh->character().mesh;
    const Eigen::Index midpoints = point.setting->spec.fem.element_order == 2 ? pbs::edges_of(mesh.tets).rows() : 0;
    return std::cbrt(double(mesh.rest.rows() + midpoints));
}

// The finished stable neo-Hookean solution of that element order on the case's own mesh, or on the finest coarser one.
const ReachedPoint* solution(const std::vector<ReachedPoint>& points, int element_order, bool on_base)
{
    const ReachedPoint* found = nullptr;
    Eigen::Index base = 0;
    for (const ReachedPoint& point : points)
        if (point.setting->vertices == 0) base = point.mesh->character().mesh.rest.rows();
    for (const ReachedPoint& point : points) {
        const DeformerSpec& spec = point.setting->spec;
        if (!point.shape.finished || spec.kind != "fem" || spec.fem.model != reference_fem::Model::stable_neo_hookean) continue;
        if (spec.fem.element_order != element_order || (point.setting->vertices == 0) != on_base) continue;
        const Eigen::Index vertices = point.mesh->character().mesh.rest.rows();
        if (!on_base && vertices >= base) continue;
        if (!found || vertices > found->mesh->character().mesh.rest.rows()) found = &point;
    }
    return found;
}

}  // namespace

ReachedReference choose_reference(const std::vector<ReachedPoint>& points, const analysis::ErrorRuler& ruler)
{
    const ReachedPoint *quadratic = solution(points, 2, true), *linear = solution(points, 1, true), *coarse = solution(points, 1, false);
    ReachedReference reference{quadratic ? quadratic : linear, quadratic ? linear : linear ? coarse : nullptr, {}};
    if (!reference.beside) return reference;
    constexpr double presumed_order = 1.0;
    const double ratio = nodes_along(*reference.point) / nodes_along(*reference.beside);
    const analysis::ErrorNorms difference = ruler.measure(reference.point->on_base, reference.beside->on_base);
    const auto bound = [&](double distance) { return analysis::two_fields(distance, ratio, presumed_order).bounds[0]; };
    reference.bar = {bound(difference.l2_pct), bound(difference.joint_pct), bound(difference.linf_m)};
    return reference;
}

}  // namespace experiments
