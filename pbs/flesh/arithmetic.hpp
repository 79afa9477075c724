// How a deformer computes. plain_f64: one number after the other, as the equations read, in double. packed_f32 and packed_f64: several
// elements side by side in the registers of the machine, in float or double. In float, positions are relative to the middle of the body.
#pragma once

namespace pbs {

enum class Arithmetic { packed_f32, packed_f64, plain_f64 };

}  // namespace pbs
