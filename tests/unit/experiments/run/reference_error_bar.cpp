// The solutions that are compared with the reference, and the use of their differences. Reference: Richardson's
// estimate by hand; substitutes for the reference with known results: LBS, which is the same at a vertex on every mesh,
// and PBS, solved on the refined limb by hand. Three times a number is rounded once, on both sides, and the number
// itself may be rounded differently there.
#include "experiments/run/reference_error_bar.hpp"

#include "experiments/characters/bodies.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace reference_error_bar_tests {
namespace {

using namespace experiments;

// The reference that ReferenceErrorBar refines, with the positions of another deformer: lbs or pbs.
DeformerSpec spec_of(const std::string& kind, int element_order = 2)
{
    static const bool registered = [] {
        for (const char* name : {"lbs", "pbs"})
            add_deformer_kind({.name = std::string("stand_in_") + name,
                               .meaning = name,
                               .make = [name](const DeformerSpec&) { return make_deformer(default_spec(name)); }});
        return true;
    }();
    EXPECT_TRUE(registered);
    FemOptions options{.attachment = FemAttachment::embedded};  // whose order is 1
    options.element_order = element_order;
    return {.name = kind, .kind = "stand_in_" + kind, .label = kind, .options = options};
}

pbs::Pose bent(const pbs::Character& character)
{
    return pbs::joint_sweep(character.skeleton, 1, pbs::Vec3::UnitZ(), 40.0, 2, 0.01).steps.back();
}

pbs::Positions solved(const std::string& kind, const pbs::Character& character)
{
    const auto deformer = make_deformer(spec_of(kind));
    deformer->reset(character);
    deformer->advance(bent(character), 0.01);
    return deformer->positions();
}

class ErrorBarOfALimb : public testing::Test {
protected:
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 400});
    const FrameMeasurer measurer{limb, {}, {}};
    const pbs::Pose pose = bent(limb);
};

TEST_F(ErrorBarOfALimb, IsZeroWhereTheMeshMakesNoDifference)
{
    const pbs::Positions reference = solved("lbs", limb);
    ReferenceErrorBar bar(spec_of("lbs"), limb);
    bar.advance(pose, 0.01);
    const auto bound = bar.bound(reference, measurer);
    ASSERT_TRUE(bound);
    EXPECT_EQ(bound->l2_pct, 0.0);
    EXPECT_EQ(bound->joint_pct, 0.0);
    EXPECT_EQ(bound->linf_m, 0.0);
}

// PBS does not depend on the element order: on each mesh the solutions of order 1 and 2 are equal. The refined linear
// one is then equal to the finest solution, the observed order is infinite and not credible, and the bound is that of
// order 1, in which the difference is the error of the finest solution, times 3. The reference is one difference
// farther.
TEST_F(ErrorBarOfALimb, OfSolutionsThatShowNoCredibleOrderHasTheLargerFactor)
{
    const pbs::Positions reference = solved("pbs", limb);
    const analysis::ErrorNorms difference =
        measurer.difference(reference, solved("pbs", pbs::refined(limb)).topRows(reference.rows()));
    EXPECT_GT(difference.joint_pct, 0.1);
    ReferenceErrorBar bar(spec_of("pbs"), limb);
    bar.advance(pose, 0.01);
    EXPECT_DOUBLE_EQ(bar.bound(reference, measurer)->joint_pct, 4.0 * difference.joint_pct);
    EXPECT_EQ(bar.method()["frames_of_reliable_order"], 0);
}

// Moves the rest shape along x by an error that depends on the elements: 16 mm and 4 mm for linear ones on the limb's
// tets and on the refined ones, 1 mm and 0 for quadratic ones.
class KnownError : public Deformer {
public:
    explicit KnownError(int element_order) : element_order_(element_order) {}
    void reset(const pbs::Character& character) override
    {
        positions_ = character.mesh.rest;
        const bool refined = character.refinements > 0;
        positions_.col(0).array() += element_order_ == 1 ? (refined ? 4e-3 : 16e-3) : (refined ? 0.0 : 1e-3);
    }
    pbs::StepSummary advance(const pbs::Pose&, double) override { return {}; }
    const pbs::Positions& positions() const override { return positions_; }

private:
    int element_order_;
    pbs::Positions positions_;
};

// By hand: order 2, credible with the smooth attachment. The finest is 1.25 x 1 mm / 3 from the limit, and the
// reference is 1 mm or 16 mm farther away.
TEST_F(ErrorBarOfALimb, OfFourSolutionsTakesTheOrderOfTheLinearOnesAndTheDifferenceOfTheQuadraticOnes)
{
    add_deformer_kind({.name = "known_error", .meaning = "rest and an error", .make = [](const DeformerSpec& spec) {
                           return std::make_unique<KnownError>(options_of<FemOptions>(spec).element_order);
                       }});
    for (const int element_order : {1, 2}) {
        const FemOptions options{.element_order = element_order, .attachment = FemAttachment::smooth};
        const DeformerSpec spec{.name = "known", .kind = "known_error", .label = "known", .options = options};
        KnownError reference(element_order);
        reference.reset(limb);
        ReferenceErrorBar bar(spec, limb);
        bar.advance(pose, 0.01);
        const double own_m = element_order == 1 ? 16e-3 : 1e-3,
                     bound_m = bar.bound(reference.positions(), measurer)->linf_m;
        EXPECT_NEAR(bound_m, own_m + 1.25 * 1e-3 / 3.0, test_support::rounding_error(8, 1.0));
        EXPECT_EQ(bar.method()["frames_of_reliable_order"], 1);
    }
}

TEST_F(ErrorBarOfALimb, SaysWhichSolutionsItCompares)
{
    for (const int order : {1, 2}) {
        const nlohmann::json method = ReferenceErrorBar(spec_of("lbs", order), limb).method();
        const auto& solutions = method["solutions"];
        ASSERT_EQ(solutions.size(), 4u);
        EXPECT_EQ(solutions[0]["element_order"], 2);  // the finest comes first
        EXPECT_EQ(solutions[0]["refinements"], 1);
        EXPECT_EQ(solutions[0]["tets"], 8 * limb.mesh.tets.rows());
        EXPECT_EQ(solutions[3]["element_order"], 1);
        for (const std::size_t i : {0, 1, 2, 3}) EXPECT_EQ(solutions[i]["is_reference"], i == (order == 1 ? 3u : 1u));
        EXPECT_EQ(method["safety_factor"], 3.0);
        EXPECT_EQ(method["safety_factor_of_reliable_order"], 1.25);
    }
}

TEST_F(ErrorBarOfALimb, OfASolutionThatBrokeDownIsNone)
{
    ReferenceErrorBar bar(spec_of("pbs"), limb);
    pbs::Pose broken = pose;
    broken[1].translation()(0) = std::nan("");
    bar.advance(broken, 0.01);
    EXPECT_FALSE(bar.bound(limb.mesh.rest, measurer));
    EXPECT_EQ(bar.method()["frames_without"], 1);
}

}  // namespace
}  // namespace reference_error_bar_tests
