#include "experiments/studies/jiggle/jiggle_settings.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/option_fields.hpp"

#include <fmt/format.h>

namespace experiments {

std::vector<JiggleSetting> jiggle_settings()
{
    std::vector<JiggleSetting> settings = {{}};
    for (const double k : {0.05, 0.2, 0.35, 0.5, 0.7, 0.9, 1.0}) settings.push_back({.k_stretch = k});
    for (const double dt_s : {0.0025, 0.005, 0.02, 0.04}) settings.push_back({.time_step_s = dt_s});
    for (const int iterations : {6, 12, 48, 96}) settings.push_back({.iterations = iterations});
    settings.push_back({.k_bind = 0.0});
    settings.push_back({.masses = pbs::Masses::lumped});
    return settings;
}

bool is_of_the_paper(const JiggleSetting& setting)
{
    return setting.k_bind == JiggleSetting{}.k_bind && setting.masses == JiggleSetting{}.masses;
}

DeformerSpec jiggling(DeformerSpec pbs, const JiggleSetting& setting)
{
    auto& options = options_of<pbs::PbsOptions>(pbs);
    options.k_stretch = 1.0;
    options.jiggle = pbs::Jiggle{.k_stretch = setting.k_stretch, .k_bind = setting.k_bind};
    options.iterations = setting.iterations;
    options.masses = setting.masses;
    return pbs;
}

analysis::CaseKey key_of(const std::string& body, const JiggleSetting& setting)
{
    analysis::CaseKey key = {.body = body,
                             .k_stretch = setting.k_stretch,
                             .masses = name_of(setting.masses),
                             .iterations = setting.iterations,
                             .time_step_s = setting.time_step_s};
    if (setting.k_bind < 1.0) key.k_bind = setting.k_bind;
    return key;
}

std::string text_of(const JiggleSetting& setting)
{
    const std::string bind = setting.k_bind < 1.0 ? fmt::format(", k_bind {}", setting.k_bind) : "";
    return fmt::format("k_stretch {}, {} ms, {} iterations, {} masses", setting.k_stretch, 1e3 * setting.time_step_s, setting.iterations,
                       name_of(setting.masses)) +
           bind;
}

nlohmann::json to_json(const JiggleSetting& setting)
{
    static const auto fields = OptionFields<JiggleSetting>("setting")
                                   .record("k_stretch", &JiggleSetting::k_stretch)
                                   .record("time_step_s", &JiggleSetting::time_step_s)
                                   .record("iterations", &JiggleSetting::iterations)
                                   .record("k_bind", &JiggleSetting::k_bind)
                                   .record("masses", &JiggleSetting::masses)
                                   .complete();
    return fields.json(setting);
}

}  // namespace experiments
