// Options of LBS and DQS.
//   options_of<BlendOptions>(spec).precision = pbs::Precision::f32;
#pragma once

#include "pbs/geometry/precision.hpp"

namespace experiments {

struct BlendOptions {
    // Both run pbs::BlendSkinning. f32 blends relative to the middle of the body and differs from f64 by rounding.
    pbs::Precision precision = pbs::Precision::f64;
};

}  // namespace experiments
