// The registration of the finite element reference.
#include "experiments/deformers/fem/fem_module.hpp"
#include "experiments/deformers/fem/fem_settings.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/blas_kernels.hpp"

namespace experiments {
namespace {

// Loads deal.II and some 200 shared objects, when a scene first uses a reference.
std::unique_ptr<Deformer> make_fem(const DeformerSpec& spec)
{
    const auto make = load_module_with_blas("pbskin_fem").function<decltype(pbskin_make_fem)>("pbskin_make_fem");
    return std::unique_ptr<Deformer>(make(options_of<FemOptions>(spec)));
}

DeformerTraits fem_traits(const DeformerSpec& spec)
{
    const bool linear = options_of<FemOptions>(spec).model == reference_fem::Model::linear;
    return {.has_small_strain = linear, .is_negative_control = linear, .solves_equations = true};
}

}  // namespace

DeformerKind fem_kind()
{
    return {.name = "fem",
            .meaning =
                "finite elements on the same tets (deal.II, CHOLMOD): linear (fictitious strain 1 - cos(rotation)), corotational, "
                "neo-Hookean (also stable), St Venant-Kirchhoff; in equilibrium or in time; a frame that is not reached is marked "
                "not_converged",
            .make = make_fem,
            .options = FemOptions{},
            .keys = fem_fields().keys(),
            .has_list = true,
            .needs_list = true,
            .read = read_fem,
            .options_json = [](const DeformerSpec& spec) { return fem_fields().json(options_of<FemOptions>(spec)); },
            .traits = fem_traits};
}

}  // namespace experiments
