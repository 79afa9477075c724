// Reference: the definitions in pbs/geometry/cost.hpp, counted by hand on a bar, and the contract of
// experiments/deformers/deformer.hpp.
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace experiments;

const pbs::Character& straight_bar()
{
    static const pbs::Character character = test_support::bar_character({8, 2, 2});
    return character;
}

pbs::Pose turned_by(double degrees)
{
    return pbs::joint_sweep(straight_bar().skeleton, 1, pbs::Vec3::UnitZ(), degrees, 2, 0.01).steps.back();
}

// The deformer as a scene with these keys of its table sets it.
std::unique_ptr<Deformer> xpbd(const std::vector<std::string>& keys)
{
    std::vector<std::string> lines{"deformers.use=[\"xpbd_neo_hookean\"]", "reference.name=\"\""};
    for (const std::string& key : keys) lines.push_back("xpbd_neo_hookean." + key);
    std::unique_ptr<Deformer> deformer = make_deformer(spec_of(read_scene("limb_bend", lines), "xpbd_neo_hookean"));
    deformer->reset(straight_bar());
    return deformer;
}

pbs::Positions turned(const std::vector<std::string>& keys, double degrees)
{
    const auto deformer = xpbd(keys);
    EXPECT_EQ(deformer->advance(turned_by(degrees), 0.01).outcome, pbs::Outcome::finished);
    return deformer->positions();
}

// Each iteration visits each tet once, and projects its two constraints and the three components of each of the bones' constraints.
TEST(XpbdNeoHookeanDeformer, CountsItsIterations)
{
    const auto deformer = xpbd({"iterations=3"});
    const pbs::StepSummary step = deformer->advance(turned_by(30.0), 0.01);
    const auto of_bones = deformer->record().at("linear_constraints_of_the_bones").get<std::int64_t>();
    const std::int64_t tets = straight_bar().mesh.tets.rows();
    EXPECT_EQ(step.iterations, 3);
    EXPECT_GT(of_bones, 0);
    EXPECT_EQ(step.work,
              (pbs::WorkCounters{
                  .vertex_visits = straight_bar().mesh.rest.rows(), .tet_visits = 3 * tets, .projections = 3 * (2 * tets + of_bones)}));
}

TEST(XpbdNeoHookeanDeformer, AFrameDoesNotDependOnTheOneBefore)
{
    const auto deformer = xpbd({});
    EXPECT_FALSE(deformer->has_memory());
    deformer->advance(turned_by(80.0), 0.01);
    deformer->advance(turned_by(30.0), 0.01);
    EXPECT_EQ(deformer->positions(), turned({}, 30.0));
}

TEST(XpbdNeoHookeanDeformer, BeginsAtTheShapeThatItIsGiven)
{
    const auto deformer = xpbd({"iterations=0", "arithmetic=\"plain_f64\""});
    const pbs::Positions shape = 2.0 * straight_bar().mesh.rest;
    deformer->start_from(shape);
    deformer->advance(turned_by(30.0), 0.01);
    EXPECT_EQ(deformer->positions(), shape);
    deformer->advance(turned_by(30.0), 0.01);
    EXPECT_NE(deformer->positions(), shape) << "only the next frame begins there";
}

TEST(XpbdNeoHookeanDeformer, ReportsPositionsThatAreNotFinite)
{
    const auto deformer = xpbd({});
    deformer->start_from(pbs::Positions::Constant(straight_bar().mesh.rest.rows(), 3, std::numeric_limits<double>::quiet_NaN()));
    EXPECT_EQ(deformer->advance(turned_by(30.0), 0.01).outcome, pbs::Outcome::not_finite);
}

// In float, the rounding of the positions acts as a force on the masses. A time step of 0.8 and the softest motion of the bar magnify it
// by some thousands.
TEST(XpbdNeoHookeanDeformer, EveryArithmeticAndStartEndsAtOneMinimum)
{
    const pbs::Positions expected = turned({"iterations=800", "arithmetic=\"plain_f64\""}, 40.0);
    const double size = (expected - straight_bar().mesh.rest).norm();
    EXPECT_LT((turned({"iterations=800", "arithmetic=\"packed_f64\""}, 40.0) - expected).norm(), 1e-9 * size);
    EXPECT_LT((turned({"iterations=800", "arithmetic=\"packed_f64\"", "start=\"lbs\""}, 40.0) - expected).norm(), 1e-9 * size);
    EXPECT_LT((turned({"iterations=100", "arithmetic=\"packed_f32\""}, 40.0) - expected).norm(), 3e-3 * size);
    EXPECT_GT((turned({"iterations=100", "poisson=0.3"}, 40.0) - expected).norm(), 3e-3 * size) << "another material";
}

TEST(XpbdNeoHookeanDeformer, RefusesSettingsOutsideTheirRange)
{
    EXPECT_THROW(xpbd({"time_step=0.0"}), pbs::InputError);
    EXPECT_THROW(xpbd({"iterations_per_step=0"}), pbs::InputError);
    EXPECT_THROW(xpbd({"multipliers=\"forgotten\""}), pbs::InputError);
}

}  // namespace
