#include "analysis/metrics/cross_section.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "pbs/geometry/input_error.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace analysis {
namespace {

using pbs::Vec3;

struct SplitTet {
    std::array<Vec3, 4> above, below;  // corners by side of the plane; heights > 0 and <= 0
    std::array<double, 4> height_above, height_below;
    int count_above = 0, count_below = 0;

    // the point at which the plane cuts the edge between the a-th corner above and the b-th below
    Vec3 cut(int a, int b) const
    {
        const double s = height_above[a] / (height_above[a] - height_below[b]);
        return above[a] + s * (below[b] - above[a]);
    }
};

SplitTet split(const pbs::Positions& positions, const pbs::Tets& tets, int t, const Plane& plane)
{
    SplitTet parts;
    for (int corner = 0; corner < 4; ++corner) {
        const Vec3 point = positions.row(tets(t, corner));
        const double height = (point - plane.point).dot(plane.normal);
        if (height > 0.0) {
            parts.height_above[parts.count_above] = height;
            parts.above[parts.count_above++] = point;
        } else {
            parts.height_below[parts.count_below] = height;
            parts.below[parts.count_below++] = point;
        }
    }
    return parts;
}

// Most tets lie on one side of the plane; for these, nothing is copied.
bool is_cut(const pbs::Positions& positions, const pbs::Tets& tets, int t, const Plane& plane)
{
    int above = 0;
    for (int corner = 0; corner < 4; ++corner)
        above += (Vec3(positions.row(tets(t, corner))) - plane.point).dot(plane.normal) > 0.0;
    return above % 4 != 0;
}

// Half the cross product of the diagonals, or of two sides for a triangle.
double half_cross(const Vec3& a, const Vec3& b)
{
    return 0.5 * a.cross(b).norm();
}

double cut_area(const SplitTet& tet)
{
    if (tet.count_above == 1) return half_cross(tet.cut(0, 1) - tet.cut(0, 0), tet.cut(0, 2) - tet.cut(0, 0));
    if (tet.count_above == 3) return half_cross(tet.cut(1, 0) - tet.cut(0, 0), tet.cut(2, 0) - tet.cut(0, 0));
    if (tet.count_above == 2) return half_cross(tet.cut(1, 1) - tet.cut(0, 0), tet.cut(1, 0) - tet.cut(0, 1));
    return 0.0;
}

void require_station(const SectionStation& station, std::size_t number, Eigen::Index tets)
{
    const std::string name = fmt::format("station {}", number);
    if (!(station.rest.normal.norm() > 0.0) || !(station.posed.normal.norm() > 0.0))
        throw pbs::InputError("", 0, name, "", "expected normals that are not zero");
    for (int t : station.tets)
        if (t < 0 || t >= tets)
            throw pbs::InputError("", 0, name, fmt::format("tet {}", t), fmt::format("expected 0 <= tet < {}", tets));
}

using pbs::Positions;

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

struct EdgeCrossing {
    Vec3 point;
    bool is_chosen;  // the nearer vertex of its edge
};

std::vector<EdgeCrossing> crossings_of(const Plane& plane, const pbs::Positions& positions, const pbs::Triangles& skin,
                                       const std::vector<bool>& chosen)
{
    const Eigen::VectorXd height = (positions.rowwise() - plane.point.transpose()) * plane.normal;
    std::vector<EdgeCrossing> crossings;
    for (Eigen::Index t = 0; t < skin.rows(); ++t)
        for (int corner = 0; corner < 3; ++corner) {
            const int a = skin(t, corner), b = skin(t, (corner + 1) % 3);
            // the neighbouring triangle has the edge from b to a
            if (a > b || (height(a) >= 0.0) == (height(b) >= 0.0)) continue;
            const double share = height(a) / (height(a) - height(b));
            crossings.push_back(
                {positions.row(a) + share * (positions.row(b) - positions.row(a)), chosen[share < 0.5 ? a : b]});
        }
    return crossings;
}

bool is_on_chosen(const std::vector<EdgeCrossing>& crossings, const Vec3& point)
{
    const auto nearest =
        std::min_element(crossings.begin(), crossings.end(), [&](const EdgeCrossing& a, const EdgeCrossing& b) {
            return (a.point - point).squaredNorm() < (b.point - point).squaredNorm();
        });
    return nearest != crossings.end() && nearest->is_chosen;
}

}  // namespace

double cross_section_area(const pbs::Positions& positions, const pbs::Tets& tets, const std::vector<int>& chosen,
                          const Plane& plane)
{
    CompensatedSum area;
    for (int t : chosen)
        if (is_cut(positions, tets, t, plane)) area += cut_area(split(positions, tets, t, plane));
    return area.value();
}

SectionExtremes section_extremes(const pbs::Positions& rest, const pbs::Positions& positions, const pbs::Tets& tets,
                                 const std::vector<SectionStation>& stations)
{
    require_points(positions, rest.rows(), "the frame");
    SectionExtremes result;
    for (std::size_t i = 0; i < stations.size(); ++i) {
        const SectionStation& station = stations[i];
        require_station(station, i, tets.rows());
        const double rest_area = station.rest_area_m2 > 0.0
                                     ? station.rest_area_m2
                                     : cross_section_area(rest, tets, station.tets, station.rest);
        if (!(rest_area > 0.0))
            throw pbs::InputError("", 0, fmt::format("station {}", i), "", "its plane misses its tets at rest");
        result.area_m2.push_back(cross_section_area(positions, tets, station.tets, station.posed));
        result.ratio.push_back(result.area_m2.back() / rest_area);
        if (result.smallest < 0 || result.ratio.back() < result.ratio[result.smallest])
            result.smallest = static_cast<int>(i);
        if (result.largest < 0 || result.ratio.back() > result.ratio[result.largest])
            result.largest = static_cast<int>(i);
    }
    if (result.smallest >= 0) result.smallest_ratio = result.ratio[result.smallest];
    if (result.largest >= 0) result.largest_ratio = result.ratio[result.largest];
    return result;
}

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

double share_of_outline(const pbs::Positions& outline, const Plane& plane, const pbs::Positions& positions,
                        const pbs::Triangles& skin, const std::vector<bool>& chosen)
{
    const std::vector<EdgeCrossing> crossings = crossings_of(plane, positions, skin, chosen);
    double own = 0.0, all = 0.0;
    for (Eigen::Index i = 0; i < outline.rows(); ++i) {
        const Vec3 before = outline.row((i + outline.rows() - 1) % outline.rows()), point = outline.row(i),
                   after = outline.row((i + 1) % outline.rows());
        const double length = 0.5 * ((point - before).norm() + (after - point).norm());
        all += length;
        if (is_on_chosen(crossings, point)) own += length;
    }
    return all > 0.0 ? own / all : 1.0;
}

}  // namespace analysis
