// The one entry of the module lib/libpbskin_fem.so, which carries deal.II: loaded when a scene first asks for a reference.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/fem/fem_options.hpp"

extern "C" experiments::Deformer* pbskin_make_fem(const experiments::FemOptions& options);  // the caller owns it
