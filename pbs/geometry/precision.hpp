// The floating point of methods that compute in float or in double.
#pragma once

namespace pbs {

enum class Precision { f32, f64 };

}  // namespace pbs
