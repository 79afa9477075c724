#include "experiments/deformers/fem/fem_module.hpp"

#include "experiments/deformers/fem/elastic_fem_deformer.hpp"
#include "experiments/deformers/fem/linear_fem_deformer.hpp"

experiments::Deformer* pbskin_make_fem(const experiments::FemOptions& options)
{
    const bool linear = options.model == reference_fem::Model::linear && options.dynamics == reference_fem::Dynamics::quasi_static;
    if (linear) return new experiments::LinearFemDeformer(options);
    return new experiments::ElasticFemDeformer(options);
}
