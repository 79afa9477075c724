#include "experiments/studies/improvements/change_settings.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace experiments {
namespace {

using pbs::PbsOptions;

class Settings {
public:
    explicit Settings(const PbsOptions& scene) : scene_(scene) {}

    // change_of(options) changes a copy of the scene's options.
    template <typename Change>
    void add(const std::string& change, const std::string& setting, const Change& change_of)
    {
        all.push_back({change, setting, pbs::WeightKind::paper, scene_});
        change_of(all.back().options);
    }

    std::vector<ChangeSetting> all;

private:
    const PbsOptions& scene_;
};

}  // namespace

nlohmann::json to_json(const RangeOfChanges& range)
{
    static const auto fields = OptionFields<RangeOfChanges>("range")
                                   .record("iterations", &RangeOfChanges::iterations)
                                   .record("k_bind_to_blended", &RangeOfChanges::k_bind_to_blended)
                                   .record("region_tets", &RangeOfChanges::region_tets)
                                   .record("k_stretch", &RangeOfChanges::k_stretch)
                                   .record("k_bind", &RangeOfChanges::k_bind)
                                   .complete();
    return fields.json(range);
}

double neutral_length(double k, const std::vector<double>& edge_lengths_m)
{
    const double longest = std::ranges::max(edge_lengths_m);
    const auto mean_k = [&](double length_m) {
        double sum = 0.0;
        for (const double l : edge_lengths_m) sum += pbs::stiffness_at_length(k, l, length_m);
        return sum / double(edge_lengths_m.size());
    };
    double low = std::ranges::min(edge_lengths_m), high = longest;  // all are at most k, at least k
    while (high - low > 1e-12 * longest) {
        const double middle = std::midpoint(low, high);
        (mean_k(middle) < k ? low : high) = middle;
    }
    return high;
}

std::vector<ChangeSetting> change_settings(const PbsOptions& scene, const std::vector<double>& edge_lengths_m, const RangeOfChanges& range)
{
    Settings settings(scene);
    settings.add(baseline, "", [](PbsOptions&) {});
    settings.add("smooth_weights", "", [](PbsOptions&) {});
    settings.all.back().weights = pbs::WeightKind::smooth;
    for (const double k : range.k_bind_to_blended)
        settings.add("bind_to_blended_position", fmt::format("k_bind_{:g}", k), [&](PbsOptions& options) {
            options.bind_to = pbs::BindTo::blended_position;
            options.k_bind = k;
        });
    for (const auto& [of, change] :
         {std::pair{pbs::VolumeOf::regions, "region_volumes"}, {pbs::VolumeOf::tets_and_regions, "tet_and_region_volumes"}})
        for (const int tets : range.region_tets)
            settings.add(change, fmt::format("region_tets_{}", tets), [&, of = of](PbsOptions& options) {
                options.volume_of = of;
                options.region_tets = tets;
            });
    settings.add("k_by_edge_length", "",
                 [&](PbsOptions& options) { options.k_stretch_length_m = neutral_length(scene.k_stretch, edge_lengths_m); });
    for (const auto& [order, name] : OptionNames<pbs::Order>::table)
        if (order != scene.order) settings.add("another_order", name, [&, order = order](PbsOptions& options) { options.order = order; });
    for (const double k : range.k_stretch)
        settings.add(control, fmt::format("k_stretch_{:g}", k), [&](PbsOptions& options) { options.k_stretch = k; });
    for (const double k : range.k_bind)
        settings.add(control, fmt::format("k_bind_{:g}", k), [&](PbsOptions& options) { options.k_bind = k; });
    return settings.all;
}

}  // namespace experiments
