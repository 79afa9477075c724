// Makes a limb, writes it, reads it back, holds it at one end and moves it by linear flesh: one call of each component.
// The flesh follows as a whole and keeps its volume. Prints: tets N, bones N, moved to within X m, volume change X %
#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/linear_elasticity.hpp"

#include <cstdio>

int main()
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 500});  // character
    pbs::write_tet_mesh("limb.vtu", limb.mesh);                                          // mesh_io
    const pbs::TetMesh mesh = pbs::read_tet_mesh("limb.vtu").mesh;
    if (mesh.rest != limb.mesh.rest || pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff() <= 0.0) return 3;  // method

    pbs::Positions targets = mesh.rest;
    targets.rowwise() += Eigen::RowVector3d(0.1, 0.2, 0.3);
    const pbs::Positions no_springs(0, 3);
    reference_fem::LinearElasticity fem(mesh, {}, {no_springs, Eigen::VectorXd(), {0}, {}, {}});  // fem
    if (!fem.solve(no_springs, targets).finite) return 4;

    const double error_m = (fem.positions() - targets).cwiseAbs().maxCoeff();
    const auto metrics = analysis::MeshMetrics{mesh.rest, mesh.tets}.measure(fem.positions());  // analysis
    std::printf("tets %d, bones %d, moved to within %.1e m, volume change %.1e %%\n", int(mesh.tets.rows()),
                int(limb.skeleton.bones.size()), error_m, metrics.volume_change_pct);
}
