// What a projection moves: one vertex of the mesh.
#pragma once

#include <Eigen/Core>

namespace pbs {

template <typename Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

// Position and inverse mass side by side, so that a projection loads both at once. All ones is the paper (m_i = 1); zero is pinned.
template <typename Scalar>
struct Particle {
    Vector3<Scalar> position;  // p_i [m]
    Scalar inverse_mass;       // 1 / m_i, in any unit that is the same for all
};

}  // namespace pbs
