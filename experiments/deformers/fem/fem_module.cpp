#include "experiments/deformers/fem/fem_module.hpp"

#include "experiments/deformers/fem/fem_deformer.hpp"

experiments::Deformer* pbskin_make_fem(const experiments::FemOptions& options)
{
    return new experiments::FemDeformer(options);
}
