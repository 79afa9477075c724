// Reference: the definitions in pbs/geometry/cost.hpp, counted by hand on a bar.
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using pbs::WorkCounters;

const pbs::Character& bar()
{
    static const pbs::Character character = test_support::bar_character({4, 2, 2});
    return character;
}

pbs::StepSummary bent(const DeformerSpec& spec)
{
    const auto deformer = make_deformer(spec);
    deformer->reset(bar());
    return deformer->advance(pbs::joint_sweep(bar().skeleton, 1, pbs::Vec3::UnitZ(), 30.0, 2, 0.01).steps.back(), 0.01);
}

template <typename Options>
DeformerSpec with(const char* kind, void (*change)(Options& options))
{
    DeformerSpec spec = default_spec(kind);
    change(options_of<Options>(spec));
    return spec;
}

TEST(CountedWork, IsThatOfTheMethod)
{
    const std::int64_t vertices = bar().mesh.rest.rows(), tets = bar().mesh.tets.rows(),
                       edges = pbs::edges_of(bar().mesh.tets).rows();
    const WorkCounters each_vertex_once{.vertex_visits = vertices};
    const auto projected = [&](std::int64_t times) {
        return WorkCounters{
            .vertex_visits = vertices, .tet_visits = times * tets, .projections = times * (vertices + edges + tets)};
    };
    struct Row {
        std::string name;
        DeformerSpec spec;
        WorkCounters work;
    };
    std::vector<Row> rows = {
        {"lbs", default_spec("lbs"), each_vertex_once},
        {"dqs", default_spec("dqs"), each_vertex_once},
        {"delta mush blends, smooths five times and rotates",
         with<pbs::DeltaMushOptions>("delta_mush", [](auto& options) { options.iterations = 5; }),
         {.vertex_visits = 7 * vertices}},
        {"direct delta mush has smoothed before the first pose",
         with<pbs::DirectDeltaMushOptions>("direct_delta_mush", [](auto& options) { options.iterations = 5; }),
         each_vertex_once},
        {"pbs", with<pbs::PbsOptions>("pbs", [](auto& options) { options.iterations = 3; }), projected(3)},
        {"pbs_author", with<pbs::AuthorOptions>("pbs_author", [](auto& options) { options.iterations = 3; }),
         projected(3)},
        // Its matrix and factor are kept from the first frame on: no frame visits a tet.
        {"linear fem",
         with<FemOptions>("fem",
                          [](auto& options) { options = {.model = reference_fem::Model::linear, .element_order = 1}; }),
         {.linear_solves = 1}}};
    for (const char* kind : {"xpbd", "xpbd_small_steps"})
        for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered}) {
            DeformerSpec spec =
                with<pbs::XpbdOptions>(kind, [](auto& options) { options.iterations = 3, options.substeps = 2; });
            options_of<pbs::XpbdOptions>(spec).order = order;
            rows.push_back({kind, spec, projected(6)});
        }
    for (const auto& [name, spec, work] : rows) EXPECT_EQ(bent(spec).work, work) << name;
}

// A pose that equals the last one is not stepped, so that there is no work.
TEST(CountedWork, PbsAuthorDoesNothingWhenTheCharacterStops)
{
    const auto deformer = make_deformer(default_spec("pbs_author"));
    deformer->reset(bar());
    const pbs::Pose pose = pbs::joint_sweep(bar().skeleton, 1, pbs::Vec3::UnitZ(), 30.0, 2, 0.01).steps.back();
    EXPECT_GT(deformer->advance(pose, 0.01).work.projections, 0);
    EXPECT_EQ(deformer->advance(pose, 0.01).work, WorkCounters{});
}

// One solve per iteration; a gradient, in which each tet is visited, at the beginning and for each trial of the line
// search.
TEST(CountedWork, QuasiNewtonEvaluatesAndSolves)
{
    const pbs::StepSummary step = bent(default_spec("quasi_newton"));
    ASSERT_EQ(step.outcome, pbs::Outcome::finished);
    EXPECT_EQ(step.work.linear_solves, step.iterations);
    EXPECT_GE(step.work.gradients, step.iterations + 1);
    EXPECT_EQ(step.work.tet_visits, step.work.gradients * bar().mesh.tets.rows());
    EXPECT_EQ(step.work.vertex_visits, bar().mesh.rest.rows());
    EXPECT_EQ(step.work.projections + step.work.factorisations, 0);
}

// Each state on the way has a gradient; each of Newton's steps has one solve or more, and none has more than two
// factorisations.
TEST(CountedWork, NewtonsStepsAreCountedWithTheirSolves)
{
    DeformerSpec spec = default_spec("fem");
    options_of<FemOptions>(spec) = {.model = reference_fem::Model::stable_neo_hookean, .element_order = 1};
    const pbs::StepSummary step = bent(spec);
    ASSERT_EQ(step.outcome, pbs::Outcome::finished);
    ASSERT_GT(step.iterations, 1);
    EXPECT_GT(step.work.gradients, step.iterations);
    EXPECT_GE(step.work.linear_solves, step.iterations);
    EXPECT_LE(step.work.factorisations, 2 * step.work.linear_solves);
    EXPECT_GE(step.work.factorisations, 1);
    EXPECT_EQ(step.work.tet_visits % bar().mesh.tets.rows(), 0);
    EXPECT_GE(step.work.tet_visits, step.work.gradients * bar().mesh.tets.rows());
}

}  // namespace
