// The solutions that are compared with the reference, and the use of their differences. Reference: the grid convergence index evaluated by
// hand; substitutes for the reference with known results: LBS, which is the same at a vertex on every mesh, and PBS, solved on the refined
// limb by hand. Six and three times a number are rounded once, on both sides, and the number itself may be rounded differently there.
#include "experiments/run/reference_error_bar.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/character/character.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

// The reference that ReferenceErrorBar refines, with the positions of another deformer: lbs or pbs.
DeformerSpec spec_of(const std::string& kind, int element_order = 2)
{
    static const bool registered = [] {
        for (const char* name : {"lbs", "pbs"})
            add_deformer_kind({.name = std::string("stand_in_") + name, .meaning = name, .make = [name](const DeformerSpec&) {
                                   return make_deformer(default_spec(name));
                               }});
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

// PBS on the limb's own tets and on refined ones.
class ErrorBarOfPbs : public ErrorBarOfALimb {
protected:
    ReferenceErrorBar advanced(ErrorBar kind) const
    {
        ReferenceErrorBar bar(kind, spec_of("pbs"), limb);
        bar.advance(pose, 0.01);
        return bar;
    }
    const pbs::Positions reference = solved("pbs", limb);
    const analysis::ErrorNorms difference = measurer.difference(reference, solved("pbs", pbs::refined(limb)).topRows(reference.rows()));
};

TEST_F(ErrorBarOfALimb, IsZeroWhereTheMeshMakesNoDifference)
{
    const pbs::Positions reference = solved("lbs", limb);
    for (const ErrorBar kind : {ErrorBar::orders, ErrorBar::refined, ErrorBar::both}) {
        ReferenceErrorBar bar(kind, spec_of("lbs"), limb);
        bar.advance(pose, 0.01);
        const auto bound = bar.bound(reference, measurer);
        ASSERT_TRUE(bound);
        EXPECT_EQ(bound->l2_pct, 0.0);
        EXPECT_EQ(bound->joint_pct, 0.0);
        EXPECT_EQ(bound->linf_m, 0.0);
    }
}

// Two grids of ratio 2, order 1: the coarser is 2 differences from the limit, times 3.
TEST_F(ErrorBarOfPbs, IsSixTimesTheDifferenceToTheRefinedSolution)
{
    ReferenceErrorBar bar = advanced(ErrorBar::refined);
    const auto bound = bar.bound(reference, measurer);
    ASSERT_TRUE(bound);
    EXPECT_GT(difference.joint_pct, 0.1);
    EXPECT_DOUBLE_EQ(bound->l2_pct, 6.0 * difference.l2_pct);
    EXPECT_DOUBLE_EQ(bound->joint_pct, 6.0 * difference.joint_pct);
    EXPECT_DOUBLE_EQ(bound->linf_m, 6.0 * difference.linf_m);
}

// PBS does not depend on the element order: on each mesh the solutions of order 1 and 2 are equal. The refined linear one is then equal to
// the finest solution, the observed order is infinite and not credible, and the bound is that of order 1, in which the difference is the
// error of the finest solution, times 3. The reference is one difference farther.
TEST_F(ErrorBarOfPbs, OfSolutionsThatShowNoCredibleOrderHasTheLargerFactor)
{
    ReferenceErrorBar bar = advanced(ErrorBar::both);
    EXPECT_DOUBLE_EQ(bar.bound(reference, measurer)->joint_pct, 4.0 * difference.joint_pct);
    EXPECT_EQ(bar.method()["frames_of_reliable_order"], 0);
}

// Moves the rest shape along x by an error that depends on the elements: 16 mm and 4 mm for linear ones on the limb's tets and on the
// refined ones, 1 mm and 0 for quadratic ones.
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

// By hand: order 2, credible with the smooth attachment. The finest is 1.25 x 1 mm / 3 from the limit, and the reference is 1 mm or 16 mm
// farther away.
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
        ReferenceErrorBar bar(ErrorBar::both, spec, limb);
        bar.advance(pose, 0.01);
        const double own_m = element_order == 1 ? 16e-3 : 1e-3, bound_m = bar.bound(reference.positions(), measurer)->linf_m;
        EXPECT_NEAR(bound_m, own_m + 1.25 * 1e-3 / 3.0, test_support::rounding_error(8, 1.0));
        EXPECT_EQ(bar.method()["frames_of_reliable_order"], 1);
    }
}

// Orders 1, 2 on the same tets: nodes are V and V + E. Three cube roots, of at most eight roundings each in the C library's manual, and two
// quotients.
TEST_F(ErrorBarOfALimb, SaysWhichSolutionsAndRatios)
{
    const double vertices = static_cast<double>(limb.mesh.rest.rows());
    const double between_orders = std::cbrt((vertices + static_cast<double>(pbs::edges_of(limb.mesh.tets).rows())) / vertices);
    const auto method = [&](ErrorBar kind, int element_order) {
        return ReferenceErrorBar(kind, spec_of("lbs", element_order), limb).method();
    };

    for (const int order : {1, 2}) {
        const auto orders = method(ErrorBar::orders, order), refined = method(ErrorBar::refined, order);
        ASSERT_EQ(orders["solutions"].size(), 2u);
        EXPECT_NEAR(orders["ratios"][0].get<double>(), between_orders, test_support::rounding_error(3 * 8 + 2, between_orders));
        EXPECT_EQ(orders["solutions"][0]["element_order"], 2);  // the finest comes first
        EXPECT_EQ(orders["solutions"][2 - order]["is_reference"], true);
        EXPECT_EQ(refined["ratios"], nlohmann::json({2.0}));
        EXPECT_EQ(refined["solutions"][0]["tets"], 8 * limb.mesh.tets.rows());
        EXPECT_EQ(refined["solutions"][0]["element_order"], order);
        EXPECT_EQ(refined["safety_factor"], 3.0);
        EXPECT_EQ(method(ErrorBar::both, order)["solutions"].size(), 4u);
        EXPECT_EQ(method(ErrorBar::both, order)["safety_factor"], 3.0);
        EXPECT_EQ(method(ErrorBar::both, order)["safety_factor_of_reliable_order"], 1.25);
    }
    // From the finest: order 2 refined, order 1 refined, whose nodes are those of order 2, then order 2 and 1.
    const auto first = method(ErrorBar::both, 1)["solutions"], second = method(ErrorBar::both, 2)["solutions"];
    EXPECT_EQ(first[3]["is_reference"], true);
    for (const auto& solutions : {first, second}) {
        EXPECT_EQ(solutions[0]["refinements"], 1);
        EXPECT_EQ(solutions[0]["element_order"], 2);
        EXPECT_EQ(solutions[3]["element_order"], 1);
    }
}

TEST_F(ErrorBarOfALimb, OfASolutionThatBrokeDownIsNone)
{
    ReferenceErrorBar bar(ErrorBar::refined, spec_of("pbs"), limb);
    pbs::Pose broken = pose;
    broken[1].translation()(0) = std::nan("");
    bar.advance(broken, 0.01);
    EXPECT_FALSE(bar.bound(limb.mesh.rest, measurer));
    EXPECT_EQ(bar.method()["frames_without"], 1);
}

}  // namespace
