#include "experiments/studies/bench/scaling.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

bool of_same_kind(const ProjectionTiming& a, const ProjectionTiming& b)
{
    return a.variant == b.variant && a.precision == b.precision && a.threads == b.threads;
}

nlohmann::json bound(double value)
{
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

}  // namespace

std::vector<ScalingFit> fit_scaling(const std::vector<MeshTimings>& meshes)
{
    std::vector<ScalingFit> fits;
    if (meshes.size() < 2) return fits;
    for (const ProjectionTiming& kind : meshes.front().projections) {
        std::vector<double> constraints, ms_step;
        for (const MeshTimings& mesh : meshes) {
            const auto found = std::find_if(mesh.projections.begin(), mesh.projections.end(),
                                            [&](const ProjectionTiming& timing) { return of_same_kind(timing, kind); });
            if (found == mesh.projections.end()) continue;
            constraints.push_back(mesh.constraints());
            ms_step.push_back(found->ms_step.median);
        }
        if (constraints.size() == meshes.size())
            fits.push_back({kind.variant, kind.precision, kind.threads, analysis::observed_order(constraints, ms_step).slope});
    }
    return fits;
}

void to_json(nlohmann::json& json, const ScalingFit& fit)
{
    json = {{"variant", fit.variant},
            {"precision", fit.precision},
            {"threads", fit.threads},
            {"exponent", fit.exponent.estimate},
            {"interval", {bound(fit.exponent.low), bound(fit.exponent.high)}},
            {"level", fit.exponent.level},
            {"sizes", fit.exponent.n}};
}

}  // namespace experiments
