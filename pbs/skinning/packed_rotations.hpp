// The parts that the deformers in packed code share: rows of four numbers, the vertices whose rotation the formulae refuse, and the way
// back to positions in the world.
#pragma once

#include "pbs/skinning/pose.hpp"
#include "pbs/skinning/skinning_kernels.hpp"

#include <vector>

namespace pbs {

// Rows x, y, z, `fourth` of points relative to an origin.
template <class Scalar>
std::vector<Scalar> padded_rows(const Positions& points, const Vec3& origin, Scalar fourth = 0);

// The middle of the box around the points [m]; zero of no points.
Vec3 middle_of_box(const Positions& points);

// Where the first bone of a pose moves the middle of the rest shape: an origin near the posed body.
Vec3 posed_origin(const Pose& pose, const Vec3& middle);

// Rows x, y, z relative to the origin as positions in the world.
template <class Scalar>
void to_world(const std::vector<Scalar>& rows, const Vec3& origin, Positions& positions);

// Room for refused rotations of #V vertices.
template <class Scalar>
class PackedRotations {
public:
    explicit PackedRotations(Eigen::Index vertices) : vertex_(vertices), covariance_(9 * vertices) {}

    RefusedRotations<Scalar> none_yet();

    // Adds R detail to each of them, R by nearest_rotation. detail: rows of four; posed: rows of three.
    static void turn(const RefusedRotations<Scalar>& refused, const std::vector<Scalar>& detail, std::vector<Scalar>& posed);

private:
    std::vector<int> vertex_;
    std::vector<Scalar> covariance_;
};

}  // namespace pbs
