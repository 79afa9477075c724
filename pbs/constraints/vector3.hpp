// The vector of every constraint; Scalar is float or double.
#pragma once

#include <Eigen/Core>

namespace pbs {

// A position or a gradient, 3 x 1.
template <typename Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

}  // namespace pbs
