// The paper's solver with deliberate defects, which the values of a claim must distinguish from the correct solver.
//   options = test_support::broken(options, Broken::volume_sign);
#pragma once

#include "analysis/verdicts/measurement.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/solver/options.hpp"

#include <array>
#include <string>
#include <vector>

namespace test_support {

// The printed volume equation is projected only in the order plain, so volume_sign is compared with
// nothing_in_plain_order.
enum class Broken {
    nothing,
    nothing_in_plain_order,
    volume_sign,
    bind_dropped,
    stretch_dropped,
    volume_dropped,
    nothing_projected
};
inline constexpr std::array every_broken = {Broken::volume_sign, Broken::bind_dropped, Broken::stretch_dropped,
                                            Broken::volume_dropped, Broken::nothing_projected};

inline std::string name_of(Broken how)
{
    static constexpr const char* names[] = {"as it is",        "as it is, plain", "volume sign",      "bind dropped",
                                            "stretch dropped", "volume dropped",  "nothing projected"};
    return names[static_cast<int>(how)];
}

inline Broken sound_beside(Broken how)
{
    return how == Broken::volume_sign ? Broken::nothing_in_plain_order : Broken::nothing;
}

inline pbs::PbsOptions broken(pbs::PbsOptions options, Broken how)
{
    const bool all = how == Broken::nothing_projected;
    if (how == Broken::volume_sign) options.volume_form = pbs::VolumeForm::sign;
    if (how == Broken::volume_sign || how == Broken::nothing_in_plain_order) options.order = pbs::Order::plain;
    if (all || how == Broken::volume_dropped) options.k_volume = 0.0;
    if (all || how == Broken::bind_dropped) options.k_bind = 0.0;
    if (all || how == Broken::stretch_dropped) options.k_stretch = 0.0;
    if (!options.jiggle) return options;
    if (options.k_bind == 0.0) options.jiggle->k_bind = 0.0;
    if (options.k_stretch == 0.0) options.jiggle->k_stretch = 0.0;
    return options;
}

inline experiments::Scene broken(experiments::Scene scene, Broken how)
{
    for (experiments::DeformerSpec& spec : scene.deformers)
        if (const auto* options = experiments::options_if<pbs::PbsOptions>(spec)) spec.options = broken(*options, how);
    return scene;
}

// The measurements of the quantity whose key has these fields.
inline std::vector<analysis::Measurement> values_of(const std::vector<analysis::Measurement>& measured,
                                                    const std::string& quantity, const analysis::CaseKey& of = {})
{
    std::vector<analysis::Measurement> found;
    for (const analysis::Measurement& measurement : measured)
        if (measurement.quantity == quantity && analysis::matches(measurement.of, of)) found.push_back(measurement);
    return found;
}

}  // namespace test_support
