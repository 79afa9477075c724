#include "analysis/metrics/frame_metrics.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>

namespace analysis {
namespace {

void require_closed(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    if (triangles.rows() == 0) throw pbs::InputError("", 0, "triangles", "0", "expected a closed surface");
    if (triangles.minCoeff() < 0 || triangles.maxCoeff() >= points.rows())
        throw pbs::InputError("", 0, "triangles", "", fmt::format("expected 0 <= vertex < {}", points.rows()));
    const auto edge = pbs::open_edge(triangles);
    if (!edge) return;
    throw pbs::InputError("", 0, "edge", fmt::format("{}-{}", edge->first, edge->second), "expected a closed, oriented surface");
}

double volume_within(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    const pbs::Vec3 origin = points.row(triangles(0, 0));  // a nearby origin, so that a surface far from zero loses no digits
    CompensatedSum volume;
    for (Eigen::Index f = 0; f < triangles.rows(); ++f)
        volume += pbs::tet_volume(origin, points.row(triangles(f, 0)), points.row(triangles(f, 1)), points.row(triangles(f, 2)));
    return volume.value();
}

}  // namespace

double enclosed_volume(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    require_closed(points, triangles);
    return volume_within(points, triangles);
}

SurfaceVolume::SurfaceVolume(const pbs::Positions& rest, const pbs::Triangles& triangles)
    : triangles_(triangles), points_(rest.rows()), rest_volume_(enclosed_volume(rest, triangles))
{
    if (!(rest_volume_ > 0.0))
        throw pbs::InputError("", 0, "enclosed rest volume", fmt::format("{} m^3", rest_volume_), "expected > 0: triangles face outward");
}

double SurfaceVolume::change_pct(const pbs::Positions& posed) const
{
    require_points(posed, points_, "the posed surface");
    return 100.0 * (volume_within(posed, triangles_) - rest_volume_) / rest_volume_;
}

std::optional<SurfaceVolume> surface_volume_of(const pbs::Positions& rest, const pbs::Triangles& triangles)
{
    const pbs::Triangles joined = pbs::joined_triangles(rest, triangles);
    if (!pbs::is_closed(joined) || !(volume_within(rest, joined) > 0.0)) return std::nullopt;
    return SurfaceVolume(rest, joined);
}

double surface_volume_change_pct(const pbs::Positions& rest, const pbs::Positions& posed, const pbs::Triangles& triangles)
{
    return SurfaceVolume(rest, triangles).change_pct(posed);
}

}  // namespace analysis
