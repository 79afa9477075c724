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

const pbs::Character& bar()
{
    static const pbs::Character character = test_support::bar_character({8, 2, 2});
    return character;
}

pbs::Pose bent_by(double degrees)
{
    return pbs::joint_sweep(bar().skeleton, 1, pbs::Vec3::UnitZ(), degrees, 2, 0.01).steps.back();
}

// The deformer as a scene with these lines sets it.
std::unique_ptr<Deformer> vbd(std::vector<std::string> lines)
{
    lines.insert(lines.end(), {"deformers.use=[\"vbd\"]", "reference.name=\"\""});
    std::unique_ptr<Deformer> deformer = make_deformer(spec_of(read_scene("limb_bend", lines), "vbd"));
    deformer->reset(bar());
    return deformer;
}

pbs::Positions bent(const std::vector<std::string>& lines, double degrees)
{
    const auto deformer = vbd(lines);
    EXPECT_EQ(deformer->advance(bent_by(degrees), 0.01).outcome, pbs::Outcome::finished);
    return deformer->positions();
}

// A blend visits each vertex once; a sweep each vertex once, and each tet once for each of its vertices.
TEST(Vbd, CountsItsSweeps)
{
    const pbs::StepSummary step = vbd({"vbd.iterations=3"})->advance(bent_by(30.0), 0.01);
    EXPECT_EQ(step.iterations, 3);
    EXPECT_EQ(step.work, (pbs::WorkCounters{.vertex_visits = 4 * bar().mesh.rest.rows(), .tet_visits = 12 * bar().mesh.tets.rows()}));
}

TEST(Vbd, AFrameDoesNotDependOnTheOneBefore)
{
    const auto deformer = vbd({});
    EXPECT_FALSE(deformer->has_memory());
    deformer->advance(bent_by(80.0), 0.01);
    deformer->advance(bent_by(30.0), 0.01);
    EXPECT_EQ(deformer->positions(), bent({}, 30.0));
}

TEST(Vbd, BeginsAtTheShapeThatItIsGiven)
{
    const auto deformer = vbd({"vbd.iterations=0", "vbd.arithmetic=\"plain_f64\""});
    const pbs::Positions shape = 2.0 * bar().mesh.rest;
    deformer->start_from(shape);
    deformer->advance(bent_by(30.0), 0.01);
    EXPECT_EQ(deformer->positions(), shape);
    deformer->advance(bent_by(30.0), 0.01);
    EXPECT_NE(deformer->positions(), shape) << "only the next frame begins there";
}

TEST(Vbd, ReportsPositionsThatAreNotFinite)
{
    const auto deformer = vbd({});
    deformer->start_from(pbs::Positions::Constant(bar().mesh.rest.rows(), 3, std::numeric_limits<double>::quiet_NaN()));
    EXPECT_EQ(deformer->advance(bent_by(30.0), 0.01).outcome, pbs::Outcome::not_finite);
}

// In float the minimum is that of energies with coefficients that are rounded to 2^-24; the condition of the Hessian is below 1e3.
TEST(Vbd, EveryArithmeticStartAndAccelerationEndsAtOneMinimum)
{
    const pbs::Positions expected = bent({"vbd.iterations=400", "vbd.arithmetic=\"plain_f64\""}, 40.0);
    const double size = (expected - bar().mesh.rest).norm();
    EXPECT_LT((bent({"vbd.iterations=400", "vbd.arithmetic=\"packed_f64\""}, 40.0) - expected).norm(), 1e-9 * size);
    EXPECT_LT((bent({"vbd.iterations=400", "vbd.arithmetic=\"packed_f64\"", "vbd.start=\"lbs\""}, 40.0) - expected).norm(), 1e-9 * size);
    EXPECT_LT((bent({"vbd.iterations=400", "vbd.arithmetic=\"packed_f32\""}, 40.0) - expected).norm(), 1e-4 * size);
    EXPECT_LT((bent({"vbd.iterations=2000", "vbd.acceleration=\"chebyshev\"", "vbd.arithmetic=\"packed_f64\""}, 40.0) - expected).norm(),
              1e-9 * size);
    EXPECT_GT((bent({"vbd.iterations=400", "vbd.poisson=0.3"}, 40.0) - expected).norm(), 1e-3 * size) << "another material";
}

TEST(Vbd, RefusesRelaxationThatDoesNotConverge)
{
    EXPECT_THROW(vbd({"vbd.omega=2.0"}), pbs::InputError);
    EXPECT_THROW(vbd({"vbd.rho=1.0"}), pbs::InputError);
    EXPECT_THROW(vbd({"vbd.acceleration=\"none\""}), pbs::InputError);
}

}  // namespace
