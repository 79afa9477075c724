#include "analysis/cross_section.hpp"

#include "analysis/compensated_sum.hpp"
#include "analysis/rest_mesh_checks.hpp"
#include "pbs/geometry/input_error.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <array>

namespace analysis {
namespace {

using pbs::Vec3;

struct SplitTet {
    std::array<Vec3, 4> above, below;  // corners by side of the plane; heights > 0 and <= 0
    std::array<double, 4> height_above, height_below;
    int count_above = 0, count_below = 0;

    Vec3 cut(int a, int b) const  // the point at which the plane cuts the edge between the a-th corner above and the b-th below
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
    for (int corner = 0; corner < 4; ++corner) above += (Vec3(positions.row(tets(t, corner))) - plane.point).dot(plane.normal) > 0.0;
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
        if (t < 0 || t >= tets) throw pbs::InputError("", 0, name, fmt::format("tet {}", t), fmt::format("expected 0 <= tet < {}", tets));
}

}  // namespace

double cross_section_area(const pbs::Positions& positions, const pbs::Tets& tets, const std::vector<int>& chosen, const Plane& plane)
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
        const double rest_area =
            station.rest_area_m2 > 0.0 ? station.rest_area_m2 : cross_section_area(rest, tets, station.tets, station.rest);
        if (!(rest_area > 0.0)) throw pbs::InputError("", 0, fmt::format("station {}", i), "", "its plane misses its tets at rest");
        result.area_m2.push_back(cross_section_area(positions, tets, station.tets, station.posed));
        result.ratio.push_back(result.area_m2.back() / rest_area);
        if (result.smallest < 0 || result.ratio.back() < result.ratio[result.smallest]) result.smallest = static_cast<int>(i);
        if (result.largest < 0 || result.ratio.back() > result.ratio[result.largest]) result.largest = static_cast<int>(i);
    }
    if (result.smallest >= 0) result.smallest_ratio = result.ratio[result.smallest];
    if (result.largest >= 0) result.largest_ratio = result.ratio[result.largest];
    return result;
}

}  // namespace analysis
