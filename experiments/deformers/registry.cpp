#include "experiments/deformers/registry.hpp"

#include "experiments/deformers/blend/blend_deformer.hpp"
#include "experiments/deformers/delta_mush/delta_mush_deformer.hpp"
#include "experiments/deformers/fem/fem_module.hpp"
#include "experiments/deformers/pbs/pbs_deformer.hpp"
#include "experiments/deformers/xpbd/xpbd_deformer.hpp"
#include "pbs/geometry/module.hpp"

#include <algorithm>
#include <stdexcept>

namespace experiments {
namespace {

using Made = std::unique_ptr<Deformer>;

Made make_lbs(const DeformerSpec&)
{
    return std::make_unique<BlendDeformer>(&pbs::BlendSkinning<double>::linear);
}
Made make_dqs(const DeformerSpec&)
{
    return std::make_unique<BlendDeformer>(&pbs::BlendSkinning<double>::dual_quaternion);
}
Made make_pbs(const DeformerSpec& spec)
{
    return std::make_unique<PbsDeformer>(spec.pbs);
}
Made make_xpbd(const DeformerSpec& spec)
{
    return std::make_unique<XpbdDeformer>(spec.xpbd);
}
Made make_delta_mush(const DeformerSpec& spec)
{
    return std::make_unique<DeltaMushDeformer>(spec.delta_mush);
}

// deal.II and some 200 shared objects: loaded when a scene first asks for a reference.
Made make_fem(const DeformerSpec& spec)
{
    const auto make = pbs::load_module("pbskin_fem").function<decltype(pbskin_make_fem)>("pbskin_make_fem");
    return Made(make(spec.fem));
}

}  // namespace

const std::vector<DeformerKind>& deformer_kinds()
{
    static const std::vector<DeformerKind> kinds = {
        {"lbs", "linear blend skinning, Eq. 1", false, make_lbs},
        {"dqs", "dual quaternion skinning (Kavan 2007), the paper's comparison", false, make_dqs},
        {"pbs", "the paper: LBS, then bind, stretch and volume constraints (Algorithm 1)", true, make_pbs},
        {"xpbd", "LBS, then extended position based dynamics (Macklin 2016) with an elastic material: multipliers kept through a step",
         true, make_xpbd},
        {"xpbd_small_steps", "the same in as many substeps of one iteration (Macklin 2019): equal cost", true, make_xpbd},
        {"delta_mush", "LBS, smoothed, with the rest shape's detail put back (Mancewicz 2014): geometry alone", true, make_delta_mush},
        {"fem",
         "finite elements on the same tets (deal.II, CHOLMOD): linear (fictitious strain 1 - cos(rotation)), corotational, neo-Hookean "
         "(also "
         "stable), St Venant-Kirchhoff; in equilibrium or in time; a frame that is not reached is marked not_converged",
         true, make_fem},
    };
    return kinds;
}

std::unique_ptr<Deformer> make_deformer(const DeformerSpec& spec)
{
    const auto& kinds = deformer_kinds();
    const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const DeformerKind& kind) { return kind.kind == spec.kind; });
    if (found == kinds.end()) throw std::logic_error("unregistered deformer kind " + spec.kind);
    return found->make(spec);
}

}  // namespace experiments
