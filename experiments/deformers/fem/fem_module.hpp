// The entry for deformers into the module lib/libpbskin_fem.so, which carries deal.II and is loaded when a scene first uses a reference.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/fem/fem_options.hpp"

extern "C" experiments::Deformer* pbskin_make_fem(const experiments::FemOptions& options);  // the caller owns it
