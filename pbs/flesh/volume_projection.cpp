#include "pbs/flesh/projective_dynamics.hpp"

#include "pbs/geometry/nearest_rotation.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pbs {
namespace {

// The larger root y of y^2 - s y + kappa = 0, without cancellation where s < 0.
double larger_root(double s, double kappa)
{
    const double root = std::sqrt(std::max(s * s - 4.0 * kappa, 0.0));
    if (s >= 0.0) return 0.5 * (s + root);
    return root > s ? -2.0 * kappa / (root - s) : 0.0;
}

}  // namespace

// The smallest number's result y determines kappa = y (s_3 - y), and the others are the larger roots. y (their product) grows with y where
// it passes one for the first time below s_3, or above it.
Vec3 nearest_unit_product(const Vec3& s)
{
    const auto at = [&](double y) {
        const double kappa = y * (s(2) - y);
        return Vec3(larger_root(s(0), kappa), larger_root(s(1), kappa), y);
    };
    double low = std::max(s(2), 0.0), high = low;
    if (at(low).prod() < 1.0)  // volume must grow: y > s_3
        for (high = std::max(2.0 * low, 1.0); at(high).prod() < 1.0;) low = high, high *= 2.0;
    else
        for (low = 0.5 * high; at(low).prod() > 1.0;) high = low, low *= 0.5;
    double y = high;
    for (int step = 0; step < 100; ++step) {
        const Vec3 now = at(y);
        const double excess = now.prod() - 1.0, change = s(2) - 2.0 * y;  // d kappa / dy
        (excess < 0.0 ? low : high) = y;
        // The larger root r of r^2 - s r + kappa = 0 changes by -1 / (2 r - s) with kappa.
        const double slope = now(0) * now(1) - y * change * (now(1) / (2.0 * now(0) - s(0)) + now(0) / (2.0 * now(1) - s(1)));
        double next = y - excess / slope;                                   // Newton's method between
        if (!(next > low && next < high)) next = low + 0.5 * (high - low);  // bounds
        if (std::abs(next - y) <= std::numeric_limits<double>::epsilon() * y) break;
        y = next;
    }
    return at(y);
}

LocalShapes local_shapes(const Eigen::Matrix3d& f)
{
    LocalShapes result;
    result.rotation = nearest_rotation(f);
    if (!result.rotation.allFinite()) return {result.rotation, result.rotation};
    const Eigen::Matrix3d stretch = result.rotation.transpose() * f;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (stretch + stretch.transpose()));
    const Vec3 s = eigen.eigenvalues().reverse();  // the smallest last; the one of a reflection is the smallest in magnitude, too
    const Eigen::Matrix3d axes = eigen.eigenvectors().rowwise().reverse();
    result.unit_volume = result.rotation * axes * nearest_unit_product(s).asDiagonal() * axes.transpose();
    return result;
}

}  // namespace pbs
