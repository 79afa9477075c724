// Reference: another code. CalculiX on the same nodes, tets and data; its elements C3D4 and C3D10 are our P1 and P2, so both solve the same
// system, and what differs is rounding. Tolerance of the linear problems: sqrt(n) eps cond(K) = 4e-8 for the cantilever, whose condition
// number 4e6 is the stiffness of an edge, 5 E h, over that of the slowest mode, 12.4 E I / L^3 over a third of the nodes; twice that is
// asked. At large strain CalculiX stops Newton at 1e-9 of the mean force, and quadratic convergence takes the displacements beyond.
// Skipped where ccx is not on the PATH.
#include "experiments/studies/verification/held_frame.hpp"
#include "pbs/character/bodies.hpp"
#include "reference_fem/verification/calculix/loaded_cantilever.hpp"
#include "reference_fem/verification/calculix/second_opinion.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using namespace reference_fem;

constexpr ElasticMaterial flesh{.young_pa = 1e5, .poisson = 0.3};
constexpr double tolerance = 1e-7;

class Calculix : public testing::TestWithParam<int> {
protected:
    void SetUp() override
    {
        program_ = calculix_on_path();
        if (!program_) GTEST_SKIP() << "ccx is not on the PATH: install calculix-ccx";
    }

    SecondOpinion opinion_on(const AnsweredProblem& ours, const DeckOptions& options = {})
    {
        EXPECT_TRUE(ours.answered);
        const SecondOpinion opinion = second_opinion(*program_, ours, options);
        EXPECT_EQ(opinion.outcome, CalculixOutcome::finished) << opinion.last_words;
        EXPECT_TRUE(opinion.in_double);
        RecordProperty("relative_difference_1e_15", std::to_string(1e15 * opinion.relative_difference()));
        return opinion;
    }

    std::optional<std::string> program_;
};

HeldFrame frame_of(const pbs::Character& limb, const pbs::Vec3& axis, double angle_deg, FrameModel model = FrameModel::linear)
{
    return {flesh, 0.6, model, [&limb, axis, angle_deg](double fraction) {
                return pbs::joint_sweep(limb.skeleton, 1, axis, fraction * angle_deg, 2, 0.01).steps.back();
            }};
}

AnsweredProblem small_cantilever(int element_order)
{
    const LoadedCantilever loads{flesh, 1000.0, {0, 1e-3, -1e-2}, {0.3, 0, -0.5}};
    return answered_cantilever(test_support::structured_bar({0, 0, 0}, {10, 1, 1}, {24, 3, 3}), element_order, loads);
}

TEST_P(Calculix, AgreesOnTheCantilever)
{
    EXPECT_LT(opinion_on(small_cantilever(GetParam())).relative_difference(), tolerance);
}

TEST_P(Calculix, AgreesOnTheLimb)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 600});
    for (const pbs::Vec3& axis : {pbs::Vec3::UnitX().eval(), pbs::Vec3::UnitZ().eval()})
        EXPECT_LT(opinion_on(answered_frame(limb, GetParam(), frame_of(limb, axis, 90.0))).relative_difference(), tolerance);
}

TEST_P(Calculix, AgreesOnTheLimbAtLargeStrain)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 350});
    const auto model = GetParam() == 1 ? FrameModel::st_venant_kirchhoff : FrameModel::st_venant_kirchhoff_at_four_points;
    const AnsweredProblem ours = answered_frame(limb, GetParam(), frame_of(limb, pbs::Vec3::UnitZ(), 30.0, model));
    const SecondOpinion opinion = opinion_on(ours, {.analysis = CalculixAnalysis::large_strain, .first_increment = 0.25});
    EXPECT_LT(opinion.relative_difference(), tolerance);
}

// The comparison can fail: a Poisson's ratio of 0.31 in place of 0.3 stiffens against bending by the share of the volume, some 1e-3.
TEST_P(Calculix, DisagreesWithAnotherMaterial)
{
    AnsweredProblem ours = small_cantilever(GetParam());
    ours.problem.material.poisson = 0.31;
    EXPECT_GT(opinion_on(ours).relative_difference(), 1e-4);
}

TEST_P(Calculix, ARefusedDeckIsAnOutcome)
{
    AnsweredProblem ours = small_cantilever(GetParam());
    ours.problem.tets(0, 0) = 1000000;
    const SecondOpinion opinion = second_opinion(*program_, ours);
    EXPECT_EQ(opinion.outcome, CalculixOutcome::refused);
    EXPECT_NE(opinion.last_words, "");
}

INSTANTIATE_TEST_SUITE_P(ElementOrders, Calculix, testing::Values(1, 2));

}  // namespace
