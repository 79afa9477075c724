// A bar with two bones, bent by 90 degrees: the volume that linear blend skinning loses, and how much of it position
// based skinning recovers in 24 iterations. It uses nothing but the installed method.
//
//   ______________________              ___________
//  |    .     |     .     |   -->      |     .     |     prints: tets 1920, lbs -x.xxx %, pbs -x.xxx %
//  |__________|___________|            |_____    . |
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <cstdio>
#include <utility>

namespace {

// Cubes of 0.1 m, each split into six tets that follow paths from its lowest to its highest corner; x from -1 to 1 m.
pbs::TetMesh bar()
{
    constexpr int nx = 20, n = 4;
    const auto vertex = [](int i, int j, int k) { return i + (nx + 1) * (j + (n + 1) * k); };
    pbs::TetMesh mesh;
    mesh.rest.resize((nx + 1) * (n + 1) * (n + 1), 3);
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= nx; ++i) mesh.rest.row(vertex(i, j, k)) << 0.1 * i - 1.0, 0.1 * j - 0.2, 0.1 * k - 0.2;

    constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    mesh.tets.resize(6 * nx * n * n, 4);
    for (int t = 0; t < mesh.tets.rows(); ++t) {
        const int cube = t / 6;
        int corner[3] = {cube % nx, cube / nx % n, cube / nx / n};
        for (int c = 0; c < 4; ++c) {
            mesh.tets(t, c) = vertex(corner[0], corner[1], corner[2]);
            if (c < 3) ++corner[orders[t % 6][c]];
        }
        if (t % 6 >= 3) std::swap(mesh.tets(t, 2), mesh.tets(t, 3));  // positively oriented
    }
    return mesh;
}

}  // namespace

int main()
{
    const pbs::TetMesh mesh = bar();
    pbs::Skeleton skeleton;
    skeleton.bones = {{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"lower", 0, {0, 0, 0}, {1, 0, 0}}};
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(mesh.rest, skeleton);
    const pbs::Weights weights = pbs::paper_weights(binding, skeleton);
    const pbs::Motion motion = pbs::joint_sweep(skeleton, 1, {0, 0, 1}, 90.0, 10, 0.01);

    pbs::PbsSolver solver(mesh, binding.distance, {}, pbs::PbsOptions{});
    pbs::Positions lbs;
    for (const pbs::Pose& pose : motion.steps) {
        pbs::linear_blend_skinning(mesh.rest, weights, pose, lbs);
        if (solver.advance(lbs, pbs::posed_bind_points(binding, pose), motion.time_step_s).outcome !=
            pbs::Outcome::finished)
            return 3;
    }
    const double rest = pbs::tet_volumes(mesh.rest, mesh.tets).sum();
    const auto change_pct = [&](const pbs::Positions& posed) {
        return 100.0 * (pbs::tet_volumes(posed, mesh.tets).sum() / rest - 1.0);
    };
    std::printf("tets %d, lbs %.3f %%, pbs %.3f %%\n", int(mesh.tets.rows()), change_pct(lbs),
                change_pct(solver.positions()));
}
