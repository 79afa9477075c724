// Reference: the definitions in pbs/geometry/cost.hpp, counted by hand on a bar, and the plain implementation.
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

const pbs::Character& projected_bar()
{
    static const pbs::Character character = test_support::bar_character({8, 2, 2});
    return character;
}

pbs::StepSummary advanced(std::vector<std::string> lines, pbs::Positions& positions)
{
    lines.insert(lines.end(), {"deformers.use=[\"projective_dynamics\"]", "reference.name=\"\""});
    const auto deformer = make_deformer(spec_of(read_scene("limb_bend", lines), "projective_dynamics"));
    deformer->reset(projected_bar());
    const pbs::StepSummary summary =
        deformer->advance(pbs::joint_sweep(projected_bar().skeleton, 1, pbs::Vec3::UnitZ(), 40.0, 2, 0.01).steps.back(), 0.01);
    positions = deformer->positions();
    return summary;
}

TEST(ProjectiveDynamicsDeformer, CountsItsIterations)
{
    pbs::Positions positions;
    const pbs::StepSummary step = advanced({"projective_dynamics.iterations=3"}, positions);
    EXPECT_EQ(step.work, (pbs::WorkCounters{.gradients = 3,
                                            .vertex_visits = projected_bar().mesh.rest.rows(),
                                            .tet_visits = 3 * projected_bar().mesh.tets.rows(),
                                            .linear_solves = 3}));
}

// An iteration rounds positions to 2^-24 of a body of 2 m, and the next ones damp what it adds.
TEST(ProjectiveDynamicsDeformer, EveryArithmeticHasTheSameIterates)
{
    pbs::Positions plain, packed;
    advanced({"projective_dynamics.arithmetic=\"plain_f64\""}, plain);
    advanced({"projective_dynamics.arithmetic=\"packed_f64\""}, packed);
    EXPECT_LT((packed - plain).cwiseAbs().maxCoeff(), 1e-11);
    advanced({}, packed);
    EXPECT_LT((packed - plain).cwiseAbs().maxCoeff(), 100 * 0x1p-24 * 2.0);
    EXPECT_GT((packed - plain).cwiseAbs().maxCoeff(), 0.0) << "the default is packed_f32";
}

TEST(ProjectiveDynamicsDeformer, ReportsThatItsStepIsStillLarge)
{
    pbs::Positions positions;
    EXPECT_EQ(advanced({"projective_dynamics.iterations=1", "projective_dynamics.stop_step=0.001"}, positions).outcome,
              pbs::Outcome::not_converged);
    EXPECT_EQ(advanced({"projective_dynamics.iterations=1000", "projective_dynamics.stop_step=0.001"}, positions).outcome,
              pbs::Outcome::finished);
    EXPECT_THROW(advanced({"projective_dynamics.arithmetic=\"f16\""}, positions), pbs::InputError);
}

}  // namespace
