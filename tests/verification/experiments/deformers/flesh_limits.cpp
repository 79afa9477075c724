// Reference: finite elements (deal.II, Newton's method), which share neither the energy nor the solver with these
// deformers, on the same mesh, with the same attachment and material. A deformer that minimises the energy of
// neo-Hookean flesh has to converge to the same solution. With multipliers kept over the steps XPBD does; as published
// it does not.
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace {

using experiments::DeformerSpec;

// The finite element reference's own solution on linear tets for the material of the energy-minimising deformers, in
// one pose of a body.
class FleshReference {
public:
    FleshReference(const std::string& scene, const std::vector<std::string>& settings, int frame, double poisson,
                   experiments::FemAttachment attachment = experiments::FemAttachment::smooth)
        : posed_(experiments::read_scene(scene, settings), {frame})
    {
        DeformerSpec spec = experiments::default_spec("fem");
        auto& fem = experiments::options_of<experiments::FemOptions>(spec);
        fem.model = reference_fem::Model::stable_neo_hookean;
        fem.element_order = 1;
        fem.contact = false;
        fem.poisson = poisson;
        fem.attachment = attachment;
        const experiments::Shapes shapes = posed_.shapes(spec);
        EXPECT_TRUE(shapes.front().finished);
        solution_ = shapes.front().positions;
        distance_of_lbs_ = (experiments::blended(posed_.character(), posed_.pose(0)) - solution_).norm();
    }

    // Root mean square over the vertices, relative to that of LBS.
    double difference(const DeformerSpec& spec) const
    {
        return (posed_.shapes(spec).front().positions - solution_).norm() / distance_of_lbs_;
    }

private:
    experiments::PosedCharacter posed_;
    pbs::Positions solution_;
    double distance_of_lbs_ = 0.0;
};

DeformerSpec spec_of(const std::string& kind, int iterations, double poisson, const std::vector<std::string>& keys)
{
    std::vector<std::string> lines{"deformers.use=[\"" + kind + "\"]", "reference.name=\"\"", kind + ".precision=f64",
                                   kind + ".iterations=" + std::to_string(iterations),
                                   kind + ".poisson=" + std::to_string(poisson)};
    for (const std::string& key : keys) lines.push_back(kind + "." + key);
    return experiments::spec_of(experiments::read_scene("limb_twist", lines), kind);
}

// `times` as many iterations lower the difference to `factor` at least until it is below 1e-6, which the last number of
// them reaches. The rest is the tolerance of the reference's own iteration.
struct FleshMethod {
    std::string kind;
    std::vector<std::string> keys;
    int first, last, times;
    double factor;
};

void expect_convergence(const FleshReference& reference, double poisson, const FleshMethod& method)
{
    double last = 2.0;
    for (int iterations = method.first; iterations <= method.last; iterations *= method.times) {
        const double difference = reference.difference(spec_of(method.kind, iterations, poisson, method.keys));
        if (last > 1e-6) {
            EXPECT_LT(difference, method.factor * last)
                << method.kind << ", " << iterations << " iterations, nu " << poisson;
        }
        last = difference;
    }
    EXPECT_LT(last, 1e-6) << method.kind << ", nu " << poisson;
}

FleshMethod quasi_newton(const std::string& start)
{
    return {"quasi_newton", {"start=" + start}, 4, 1024, 4, 0.5};
}

const FleshMethod relaxed_vbd = {"vbd", {"acceleration=over_relaxation"}, 16, 512, 2, 0.9};
const FleshMethod chebyshev_vbd = {"vbd", {"acceleration=chebyshev"}, 16, 2048, 2, 0.9};
const FleshMethod kept_xpbd = {"xpbd_neo_hookean", {}, 16, 1024, 4, 0.5};

class FleshLimits : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(PoissonsRatios, FleshLimits, testing::Values(0.3, 0.45));

const std::vector<std::string> reference_of_twist = {"motion.angle_deg=90", "motion.frames=2",
                                                     "character.vertices=600"};

TEST_P(FleshLimits, OfTheTwistedLimb)
{
    const FleshReference reference("limb_twist", reference_of_twist, 1, GetParam());
    for (const FleshMethod& method : {quasi_newton("lbs"), relaxed_vbd, chebyshev_vbd, kept_xpbd})
        expect_convergence(reference, GetParam(), method);
}

// The twisted limb has both Poisson's ratios, so that other poses and bodies need only one.
TEST(FleshLimitsOfBodies, OfTheBentLimbAndOfTheHumansCrouch)
{
    const double poisson = 0.45;
    const FleshReference bent("limb_bend", {"motion.angle_deg=60", "motion.frames=2", "character.vertices=600"}, 1,
                              poisson);
    const FleshReference crouch("human_01_01", {}, 164, poisson);
    for (const FleshReference* reference : {&bent, &crouch})
        for (const FleshMethod& method : {quasi_newton("smooth_dqs"), relaxed_vbd, kept_xpbd})
            expect_convergence(*reference, poisson, method);
}

// Bones that are rigid capsules, and bones that hold the flesh that they alone move. With springs of another attachment
// the limit differs.
TEST(FleshAttachments, HaveTheLimitOfTheReferenceWithTheSameSprings)
{
    const std::vector<std::string> rigid = {"attachment=embedded", "core_radius=0.35", "spring_factor=1e4"},
                                   held = {"attachment=held"};
    for (const auto& [attachment, own, other] : {std::tuple(experiments::FemAttachment::embedded, rigid, held),
                                                 std::tuple(experiments::FemAttachment::held, held, rigid)}) {
        SCOPED_TRACE(own.front());
        const FleshReference reference("limb_twist", reference_of_twist, 1, 0.45, attachment);
        expect_convergence(reference, 0.45, {"quasi_newton", own, 4, 1024, 4, 0.5});
        for (const auto& springs : {other, std::vector<std::string>{}})
            EXPECT_GT(reference.difference(spec_of("quasi_newton", 1024, 0.45, springs)), 1e-2);
    }
}

// The control: the multipliers of each step begin at zero and the residual is neglected, or they are reset in each
// iteration.
TEST(XpbdNeoHookeanControls, AsPublishedOrWithResetMultipliersItStopsElsewhere)
{
    const FleshReference reference("limb_twist", reference_of_twist, 1, 0.45);
    for (const std::string multipliers : {"of_step", "reset"}) {
        const DeformerSpec control =
            spec_of("xpbd_neo_hookean", 1024, 0.45, {"multipliers=" + multipliers, "iterations_per_step=4"});
        EXPECT_GT(reference.difference(control), 1e-3) << multipliers;
    }
}

}  // namespace
