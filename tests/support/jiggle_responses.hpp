// Invented responses of flesh to a jolt, from which the values of C09 are computed.
#pragma once

#include "experiments/studies/jiggle/jiggle_records.hpp"

namespace test_support {

inline experiments::MeasuredJiggle swinging(const experiments::JiggleSetting& setting, double hz, double width = 0.1)
{
    experiments::MeasuredJiggle measured{setting, {}};
    measured.response.swing.outcome = analysis::OscillationOutcome::found;
    measured.response.swing.frequency_hz = {hz, (1.0 - width) * hz, (1.0 + width) * hz};
    measured.response.swing.damping_ratio = {0.1, 0.08, 0.12};
    measured.response.overshoot_over_jolt = 0.3;
    return measured;
}

inline experiments::MeasuredJiggle creeping(const experiments::JiggleSetting& setting)
{
    experiments::MeasuredJiggle measured = swinging(setting, 0.0);
    measured.response.swing = {};
    measured.response.swing.outcome = analysis::OscillationOutcome::overdamped;
    return measured;
}

}  // namespace test_support
