#include "pbs/solver/xpbd_solver.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace pbs {
namespace {

// A sixth of the rest volume of the tets around each edge [m^3]. The sum is the volume of the body.
std::map<std::pair<int, int>, double> edge_volumes(const Tets& tets, const Eigen::VectorXd& tet_volumes)
{
    std::map<std::pair<int, int>, double> volumes;
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int a = 0; a < 4; ++a)
            for (int b = a + 1; b < 4; ++b) volumes[std::minmax({tets(t, a), tets(t, b)})] += tet_volumes(t) / 6.0;
    return volumes;
}

}  // namespace

XpbdConstraints make_xpbd_constraints(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const XpbdOptions& options,
                                      const std::vector<bool>& held)
{
    if (!(options.poisson >= 0.25 && options.poisson < 0.5))
        throw InputError("xpbd", 0, "poisson", std::to_string(options.poisson), "expected 1/4 <= poisson < 1/2");
    const double mu = options.young_pa / (2.0 * (1.0 + options.poisson));
    const double missing_bulk = options.young_pa / (3.0 * (1.0 - 2.0 * options.poisson)) - 5.0 / 3.0 * mu;
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets), lumped = lumped_volumes(mesh.rest, mesh.tets);

    XpbdConstraints constraints;
    for (Eigen::Index i = 0; i < lumped.size(); ++i) {
        const bool is_held = !held.empty() && held[i];
        constraints.inverse_mass.push_back(is_held || !(lumped(i) > 0.0) ? 0.0 : 1.0 / (options.density_kg_m3 * lumped(i)));
    }
    for (Eigen::Index i = 0; i < bind_distance.size(); ++i) constraints.bind.push_back({{static_cast<int>(i), bind_distance(i), 1.0}});
    for (const auto& [edge, volume] : edge_volumes(mesh.tets, volumes)) {
        const double length = (mesh.rest.row(edge.first) - mesh.rest.row(edge.second)).norm();
        constraints.stretch.push_back({{{edge.first, edge.second}, length, 1.0}, length * length / (15.0 * mu * volume)});
    }
    for (Eigen::Index t = 0; t < mesh.tets.rows() && missing_bulk > 0.0; ++t)
        constraints.volume.push_back(
            {{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, volumes(t), 1.0}, volumes(t) / missing_bulk});
    return constraints;
}

}  // namespace pbs
