// Options of LBS and DQS.
//   options_of<BlendOptions>(spec).precision = pbs::Precision::f32;
#pragma once

#include "pbs/geometry/precision.hpp"

namespace experiments {

struct BlendOptions {
    // f32 blends relative to the middle of the body and differs from f64 by rounding.
    pbs::Precision precision = pbs::Precision::f64;
    // true: pbs::BlendSkinning. false: the blends of pbs/skinning/blend.hpp, one vertex after the other, in double only.
    bool packed = true;
};

}  // namespace experiments
