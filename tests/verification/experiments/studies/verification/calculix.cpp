// Reference: another code. CalculiX's kept displacements for the same problems; its elements C3D4 and C3D10 are our P1
// and P2, so both solve the same system, and what differs is rounding and the last Newton steps of both. The row of
// each problem has its tolerance with the derivation: for the smooth attachment by the condition number of this very
// matrix. The comparison fails for each error that is put into the reference here.
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/studies/verification/problem.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace {

using namespace experiments;

pbs::Character limb_with(int vertices)
{
    return pbs::make_character({.body = "limb", .vertices = vertices});
}

std::vector<CalculixLimb> bounded_limbs()
{
    std::vector<CalculixLimb> limbs = calculix_limbs(false);
    std::erase_if(limbs, [](const CalculixLimb& limb) {
        return limb.model == BodyModel::st_venant_kirchhoff && limb.element_order == 2;
    });
    return limbs;
}

class CalculixLimbs : public testing::TestWithParam<CalculixLimb> {};
INSTANTIATE_TEST_SUITE_P(Kept, CalculixLimbs, testing::ValuesIn(bounded_limbs()),
                         [](const auto& info) { return info.param.problem(); });

TEST_P(CalculixLimbs, AreSolvedAlike)
{
    const pbs::Character character = limb_with(GetParam().vertices);
    const VerificationRow row = calculix_row(character, GetParam(), held_body(character, GetParam(), calculix_flesh));
    EXPECT_TRUE(holds(row).value_or(false))
        << row.value << ", at most " << row.high.value_or(0.0) << ": " << row.bound_from;
    EXPECT_LT(row.high.value_or(1.0), 1e-4) << "a bound that the errors below would pass";
}

class CalculixSmoothLimb : public testing::TestWithParam<int> {
protected:
    // With the error that `change` puts into the reference.
    double difference(const std::function<void(HeldBody& body)>& change) const
    {
        HeldBody body = held_body(character_, limb_, calculix_flesh);
        change(body);
        return calculix_row(character_, limb_, body).value;
    }

    const CalculixLimb limb_{400, "bent", 10, BodyModel::linear, GetParam(), FemAttachment::smooth};
    const pbs::Character character_ = limb_with(limb_.vertices);
};
INSTANTIATE_TEST_SUITE_P(ElementOrders, CalculixSmoothLimb, testing::Values(1, 2));

// The springs of each of the two bones are attached to the other, of which one is at rest and one turns, so the flesh
// around the one turns instead of that around the other.
TEST_P(CalculixSmoothLimb, DiffersWithSpringsOfTheWrongBone)
{
    BoneAttachment bones = bone_attachment(character_, {.attachment = FemAttachment::smooth});
    for (int& bone : bones.spring_bone) bone = bone == 0 ? 1 : 0;
    const pbs::Pose bent = pbs::joint_sweep(character_.skeleton, 1, pbs::Vec3::UnitZ(), 10.0, 2, 0.01).steps.back();
    EXPECT_GT(difference([&](HeldBody& body) {
                  body.targets_at = [&](double) { return targets(bones, character_.mesh.rest, bent); };
              }),
              0.5);
}

// A kernel that is not normalised has density 2 on the axis. The springs yield to the flesh near the joint by some 1e-2
// of the displacement, of which a doubled density leaves half.
TEST_P(CalculixSmoothLimb, DiffersWithAKernelOfTwiceTheDensity)
{
    EXPECT_GT(difference([](HeldBody& body) { body.attachment.spring_stiffness *= 2.0; }), 1e-3);
}

// The poses of the bones alone determine rigid flesh; how far it yields depends on Poisson's ratio.
TEST_P(CalculixSmoothLimb, DiffersWithAnotherPoissonsRatio)
{
    EXPECT_GT(difference([](HeldBody& body) { body.material.poisson = 0.31; }), 1e-4);
}

TEST(CalculixDisplacements, ThatAreDamagedOrOfOtherNodesAreRefused)
{
    const CalculixLimb limb{400, "bent", 10, BodyModel::linear, 1, FemAttachment::smooth};
    const pbs::Character character = limb_with(limb.vertices), other = limb_with(600);
    const test_support::ScratchFolder folder;
    const std::string file = folder / ("calculix/" + limb.problem() + ".f64");
    std::filesystem::copy(pbs::references_folder() + "/calculix", folder / "calculix");
    const test_support::EnvironmentVariable in_use("PBSKIN_REFERENCES", folder.path());
    const auto refusal = [&](const pbs::Character& body) {
        return test_support::refusal_of([&] { calculix_row(body, limb, held_body(body, limb, calculix_flesh)); });
    };
    EXPECT_EQ(refusal(character), "accepted");
    EXPECT_EQ(refusal(other), file + ": bytes = 9528: expected " + std::to_string(24 * other.mesh.rest.rows()) + ": " +
                                  std::to_string(other.mesh.rest.rows()) + " nodes x 3 numbers of 8 bytes");
    std::ofstream(file, std::ios::binary | std::ios::app) << "x";
    EXPECT_EQ(refusal(character), file + ": damaged: expected the hash that answers.csv states");
}

}  // namespace
