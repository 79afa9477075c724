#include "analysis/section_outline.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace analysis {
namespace {

using pbs::Positions;
using pbs::Vec3;

Vec3 point_of(const Positions& outline, Eigen::Index i)
{
    return outline.row(i % outline.rows());
}

double distance_to_segment(const Vec3& point, const Vec3& a, const Vec3& b)
{
    const double length_2 = (b - a).squaredNorm();
    const double s = length_2 > 0.0 ? std::clamp((point - a).dot(b - a) / length_2, 0.0, 1.0) : 0.0;
    return (point - a - s * (b - a)).norm();
}

double distance_to_outline(const Positions& outline, const Vec3& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < outline.rows(); ++i)
        least = std::min(least, distance_to_segment(point, point_of(outline, i), point_of(outline, i + 1)));
    return least;
}

Vec3 centroid_of_length(const Positions& outline)
{
    Vec3 sum = Vec3::Zero();
    double length = 0.0;
    for (Eigen::Index i = 0; i < outline.rows(); ++i) {
        const Vec3 a = point_of(outline, i), b = point_of(outline, i + 1);
        sum += (b - a).norm() * 0.5 * (a + b);
        length += (b - a).norm();
    }
    return length > 0.0 ? Vec3(sum / length) : point_of(outline, 0);
}

}  // namespace

OutlineSize outline_size(const Positions& outline)
{
    OutlineSize size;
    if (outline.rows() == 0) return size;
    const Vec3 centre = centroid_of_length(outline);
    Vec3 twice_area = Vec3::Zero();
    for (Eigen::Index i = 0; i < outline.rows(); ++i) {
        twice_area += (point_of(outline, i) - centre).cross(point_of(outline, i + 1) - centre);
        size.largest_radius_m = std::max(size.largest_radius_m, (point_of(outline, i) - centre).norm());
    }
    size.area_m2 = 0.5 * twice_area.norm();
    size.smallest_radius_m = distance_to_outline(outline, centre);
    return size;
}

int winding_number(const Positions& outline, const Plane& plane)
{
    const Vec3 normal = plane.normal.normalized();
    double turned = 0.0;
    for (Eigen::Index i = 0; i < outline.rows(); ++i) {
        const Vec3 a = point_of(outline, i) - plane.point, b = point_of(outline, i + 1) - plane.point;
        turned += std::atan2(a.cross(b).dot(normal), a.dot(b));
    }
    return static_cast<int>(std::lround(turned / (2.0 * std::numbers::pi)));
}

const Positions* enclosing_outline(const std::vector<Positions>& outlines, const Plane& plane)
{
    const Positions* best = nullptr;
    bool best_encloses = false;
    double best_distance = 0.0;
    for (const Positions& outline : outlines) {
        const bool encloses = winding_number(outline, plane) != 0;
        const double distance = distance_to_outline(outline, plane.point);
        if (best && (best_encloses > encloses || (best_encloses == encloses && best_distance <= distance))) continue;
        best = &outline;
        best_encloses = encloses;
        best_distance = distance;
    }
    return best;
}

}  // namespace analysis
