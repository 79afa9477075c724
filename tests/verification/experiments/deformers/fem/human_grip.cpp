// Truth: what stiff springs must do on the real character, whatever its mesh: grip every bone, with an error that falls like 1/q and is
// below 1e-3 of the motion at q = 1e4 (theory: 1/q times the flesh's own stiffness over E, of order 1 to 10). Forearm turned by 10 degrees,
// P1, nu 0.45. Needs Debian's assimp-testmodels, which set-up installs.
#include "experiments/deformers/fem/fem_deformer.hpp"
#include "pbs/character/bodies.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

TEST(HumanGrip, EveryBoneIsGrippedAndTheErrorFallsWithTheSprings)
{
    const pbs::Character human = pbs::make_character({.body = "human"});
    int forearm = -1;
    for (std::size_t j = 0; j < human.skeleton.bones.size(); ++j)
        if (forearm < 0 && human.skeleton.bones[j].name.find("forearm_upper") != std::string::npos) forearm = static_cast<int>(j);
    ASSERT_GE(forearm, 0);
    const pbs::Pose pose = pbs::joint_sweep(human.skeleton, forearm, pbs::Vec3::UnitX(), 10.0, 2, 0.01).steps.back();

    std::vector<double> errors;
    std::vector<pbs::Positions> positions;
    for (const double q : {1e2, 1e3, 1e4, 2e4}) {
        FemDeformer fem({.element_order = 1, .spring_factor = q});
        fem.reset(human);
        ASSERT_EQ(fem.advance(pose, 0.01).outcome, pbs::Outcome::finished);
        const nlohmann::json record = fem.record();
        errors.push_back(record["grip_error_over_motion"]);
        positions.push_back(fem.positions());
        EXPECT_LT(record["largest_residual"].get<double>(), 1e-12);
        for (const auto& bone : record["attachment"]["bones"]) EXPECT_GT(bone["inside"].get<int>(), 0) << bone;
        if (std::getenv("PBS_VERBOSE")) std::printf("q %g: %s\n", q, record.dump(1).c_str());
    }
    EXPECT_LT(errors[1], errors[0]);
    EXPECT_LT(errors[2], errors[1]);
    EXPECT_LT(errors[2], 1e-3);
    const double diagonal = (human.mesh.rest.colwise().maxCoeff() - human.mesh.rest.colwise().minCoeff()).norm();
    const double change = (positions[3] - positions[2]).rowwise().norm().maxCoeff();
    if (std::getenv("PBS_VERBOSE"))
        std::printf("errors %g %g %g %g; changes %g %g m of %g\n", errors[0], errors[1], errors[2], errors[3],
                    (positions[2] - positions[1]).rowwise().norm().maxCoeff(), change, diagonal);
    EXPECT_LT(change, 1e-4 * diagonal) << "doubling q changes nothing that is reported";
}

}  // namespace
