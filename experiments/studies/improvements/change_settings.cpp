#include "experiments/studies/improvements/change_settings.hpp"

#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "experiments/settings/option_fields.hpp"

#include <fmt/format.h>

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
                                   .record("edge_lengths", &RangeOfChanges::edge_lengths)
                                   .record("k_stretch", &RangeOfChanges::k_stretch)
                                   .record("k_bind", &RangeOfChanges::k_bind)
                                   .complete();
    return fields.json(range);
}

std::vector<ChangeSetting> change_settings(const PbsOptions& scene, double mean_edge_m, const RangeOfChanges& range)
{
    Settings settings(scene);
    settings.add(baseline, "", [](PbsOptions&) {});
    settings.add("smooth_weights", "", [](PbsOptions&) {});
    settings.all.back().weights = pbs::WeightKind::smooth;
    for (const double k : range.k_bind_to_blended)
        settings.add("bind_to_blended_position", fmt::format("k_bind {:g}", k), [&](PbsOptions& options) {
            options.bind_to = pbs::BindTo::blended_position;
            options.k_bind = k;
        });
    for (const auto& [of, change] :
         {std::pair{pbs::VolumeOf::regions, "region_volumes"}, {pbs::VolumeOf::tets_and_regions, "tet_and_region_volumes"}})
        for (const int tets : range.region_tets)
            settings.add(change, fmt::format("region_tets {}", tets), [&, of = of](PbsOptions& options) {
                options.volume_of = of;
                options.region_tets = tets;
            });
    for (const double length : range.edge_lengths)
        settings.add("k_by_edge_length", fmt::format("length {:g} mean edges", length),
                     [&](PbsOptions& options) { options.k_stretch_length_m = length * mean_edge_m; });
    for (const auto& [order, name] : OptionNames<pbs::Order>::table)
        if (order != scene.order) settings.add("another_order", name, [&, order = order](PbsOptions& options) { options.order = order; });
    for (const double k : range.k_stretch)
        settings.add(control, fmt::format("k_stretch {:g}", k), [&](PbsOptions& options) { options.k_stretch = k; });
    for (const double k : range.k_bind)
        settings.add(control, fmt::format("k_bind {:g}", k), [&](PbsOptions& options) { options.k_bind = k; });
    return settings.all;
}

}  // namespace experiments
