// One particle that hangs from three fixed ones by the edges of a tet; it is small enough for linear algebra by hand.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"

#include <Eigen/Geometry>

#include <vector>

namespace test_support {

struct HangingTet {
    pbs::TetMesh mesh;  // vertex 3 hangs from 0, 1, 2
    std::vector<bool> held = {true, true, true, false}, free = {false, false, false, true};
};

inline HangingTet hanging_tet()
{
    HangingTet tet;
    tet.mesh.rest.resize(4, 3);
    tet.mesh.rest << 0.0, 0.0, 0.0, 1.0, 0.1, 0.0, 0.2, 1.1, 0.1, 0.4, 0.3, -0.9;
    tet.mesh.tets.resize(1, 4);
    tet.mesh.tets << 0, 2, 1, 3;
    return tet;
}

inline pbs::PbsOptions stretch_alone(int iterations, double k_stretch)
{
    pbs::PbsOptions options;
    options.iterations = iterations;
    options.k_stretch = k_stretch;
    options.k_volume = options.k_bind = 0.0;
    options.precision = pbs::Precision::f64;
    options.order = pbs::Order::plain;  // the order of the step matrix below
    return options;
}

// The matrix by which the iterations reduce a small displacement of the particle: an edge of unit direction n leaves (I
// - k n n^T), one edge after the other.
inline Eigen::Matrix3d step_matrix(const HangingTet& tet, int iterations, double k_stretch)
{
    Eigen::Matrix3d sweep = Eigen::Matrix3d::Identity(), step = sweep;
    for (int corner = 0; corner < 3; ++corner) {
        const pbs::Vec3 direction = (tet.mesh.rest.row(3) - tet.mesh.rest.row(corner)).normalized();
        sweep = (Eigen::Matrix3d::Identity() - k_stretch * direction * direction.transpose()) * sweep;
    }
    for (int i = 0; i < iterations; ++i) step = sweep * step;
    return step;
}

}  // namespace test_support
