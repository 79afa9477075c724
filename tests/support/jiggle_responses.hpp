// Invented responses of flesh to a jolt, from which the values of C09 are computed.
#pragma once

#include "experiments/studies/jiggle/jiggle_records.hpp"

namespace test_support {

inline experiments::ResponseRow swinging(experiments::ResponseRow setting, double hz, double width = 0.1)
{
    setting.response = {.overshoot_over_jolt = 0.3};
    setting.response.swing.outcome = analysis::OscillationOutcome::found;
    setting.response.swing.frequency_hz = {hz, (1.0 - width) * hz, (1.0 + width) * hz};
    setting.response.swing.damping_ratio = {0.1, 0.08, 0.12};
    return setting;
}

inline experiments::ResponseRow creeping(const experiments::ResponseRow& setting)
{
    experiments::ResponseRow measured = swinging(setting, 0.0);
    measured.response.swing = {};
    measured.response.swing.outcome = analysis::OscillationOutcome::overdamped;
    return measured;
}

}  // namespace test_support
