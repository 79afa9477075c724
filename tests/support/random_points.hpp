// Random points and rigid motions with a fixed seed, the same in every run.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <random>

namespace test_support {

class RandomPoints {
public:
    explicit RandomPoints(unsigned seed) : engine_(seed) {}

    double number(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(engine_); }
    pbs::Vec3 point(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
    Eigen::Isometry3d rigid_motion(double distance)
    {
        const Eigen::Vector4d coefficients(number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1));
        Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
        motion.linear() = Eigen::Quaterniond(coefficients).normalized().toRotationMatrix();
        motion.translation() = point(distance);
        return motion;
    }

private:
    std::mt19937 engine_;
};

inline pbs::Positions transformed(const pbs::Positions& points, const Eigen::Isometry3d& motion)
{
    return ((points * motion.linear().transpose()).rowwise() + motion.translation().transpose()).eval();
}

}  // namespace test_support
