#include "pbs/flesh/volume_projection.hpp"

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
    const auto others = [&](double y) {
        const double kappa = y * (s(2) - y);
        return std::pair(larger_root(s(0), kappa), larger_root(s(1), kappa));
    };
    const auto excess = [&](double y) {
        const auto [a, b] = others(y);
        return y * a * b - 1.0;
    };
    double low = std::max(s(2), 0.0), high = low;
    if (excess(low) < 0.0)  // volume must grow, y > s_3; y^3 <= y a b there
        for (high = std::max(2.0 * low, 1.0); excess(high) < 0.0;) low = high, high *= 2.0;
    else
        for (low = 0.5 * high; excess(low) > 0.0;) high = low, low *= 0.5;
    for (int step = 0; step < 200 && high - low > std::numeric_limits<double>::epsilon() * high; ++step) {
        const double f_low = excess(low), f_high = excess(high), width = high - low;
        double y = low - f_low * width / (f_high - f_low);                   // false position,
        if (step % 3 == 2 || !(y > low && y < high)) y = low + 0.5 * width;  // and bisection
        if (!(y > low && y < high)) break;                                   // neighbouring numbers
        (excess(y) < 0.0 ? low : high) = y;
    }
    const auto [a, b] = others(high);
    return {a, b, high};
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
