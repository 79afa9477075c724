// The deformers that minimise the energy of elastic flesh. Reference: the definitions in pbs/geometry/cost.hpp, counted
// by hand on a bar, the contract of experiments/deformers/deformer.hpp, and the plain code.
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace experiments;
using pbs::WorkCounters;

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
std::unique_ptr<Deformer> flesh(const std::string& kind, const std::vector<std::string>& keys)
{
    std::vector<std::string> lines{"deformers.use=[\"" + kind + "\"]", "reference.name=\"\""};
    for (const std::string& key : keys) lines.push_back(kind + "." + key);
    std::unique_ptr<Deformer> deformer = make_deformer(spec_of(read_scene("limb_bend", lines), kind));
    deformer->reset(straight_bar());
    return deformer;
}

pbs::Positions turned(const std::string& kind, const std::vector<std::string>& keys, double degrees = 40.0)
{
    const auto deformer = flesh(kind, keys);
    EXPECT_EQ(deformer->advance(turned_by(degrees), 0.01).outcome, pbs::Outcome::finished);
    return deformer->positions();
}

class Flesh : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Method, Flesh,
                         testing::Values("quasi_newton", "vbd", "warped_newton", "xpbd_neo_hookean",
                                         "projective_dynamics"));

TEST_P(Flesh, BeginsAtTheShapeThatItIsGiven)
{
    const auto deformer = flesh(GetParam(), {"iterations=0", "packed=false"});
    const pbs::Positions shape = 2.0 * straight_bar().mesh.rest;
    deformer->start_from(shape);
    deformer->advance(turned_by(30.0), 0.01);
    EXPECT_EQ(deformer->positions(), shape);
    deformer->advance(turned_by(30.0), 0.01);
    EXPECT_NE(deformer->positions(), shape) << "only the next frame begins there";
}

// The initial guess of the minimisers, with the springs that hold their flesh by default.
TEST(StartShape, OfPbsAndXpbdCanBeThatOfTheMinimisers)
{
    const pbs::Positions guess = turned("quasi_newton", {"iterations=0", "packed=false"});
    const auto started = [](const std::string& kind, const std::string& start) {
        std::vector<std::string> lines{"deformers.use=[\"" + kind + "\"]", "reference.name=\"\"", "pbs.iterations=0",
                                       "pbs.precision=f64"};
        if (!start.empty()) lines.push_back(start);
        const auto deformer = make_deformer(spec_of(read_scene("limb_bend", lines), kind));
        deformer->reset(straight_bar());
        EXPECT_EQ(deformer->advance(turned_by(40.0), 0.01).outcome, pbs::Outcome::finished);
        return deformer->positions();
    };
    EXPECT_EQ(started("pbs", "pbs.improved.start=smooth_dqs"), guess);
    EXPECT_EQ(started("xpbd", "xpbd.start=smooth_dqs"), guess);
    EXPECT_EQ(started("pbs", ""), turned("lbs", {}));
    EXPECT_GT((guess - turned("lbs", {})).norm(), 0.01);
}

TEST_P(Flesh, ReportsPositionsThatAreNotFinite)
{
    const auto deformer = flesh(GetParam(), {});
    deformer->start_from(
        pbs::Positions::Constant(straight_bar().mesh.rest.rows(), 3, std::numeric_limits<double>::quiet_NaN()));
    EXPECT_EQ(deformer->advance(turned_by(30.0), 0.01).outcome, pbs::Outcome::not_finite);
}

// In float the minimum is that of energies with coefficients that are rounded to 2^-24, and the condition of the
// Hessian is below 1e3. In XPBD the rounding of the positions acts as a force on the masses, which a time step of 0.8
// and the softest motion of the bar magnify by some thousands.
struct Minimum {
    const char* kind;
    std::vector<std::string> keys;
    double share;  // of the displacement
};

TEST(FleshMinimum, IsTheSameForEveryCodeStartAndAcceleration)
{
    const std::string many = "iterations=800";
    for (const char* kind : {"vbd", "xpbd_neo_hookean"}) {
        const pbs::Positions expected = turned(kind, {many, "packed=false"});
        const double size = (expected - straight_bar().mesh.rest).norm();
        const auto share = [&](const std::vector<std::string>& keys) {
            return (turned(kind, keys) - expected).norm() / size;
        };
        for (const Minimum& one :
             std::vector<Minimum>{{kind, {many, "precision=f64"}, 1e-9},
                                  {kind, {many, "precision=f64", "start=\"lbs\""}, 1e-9},
                                  {"vbd", {"iterations=400", "precision=f32"}, 1e-4},
                                  {"vbd", {"iterations=2000", "acceleration=\"chebyshev\"", "precision=f64"}, 1e-9},
                                  {"xpbd_neo_hookean", {"iterations=100", "precision=f32"}, 3e-3}})
            if (one.kind == std::string(kind)) {
                EXPECT_LT(share(one.keys), one.share) << kind << " " << one.keys.back();
            }
        EXPECT_GT(share({"iterations=100", "poisson=0.3"}), 3e-3) << "another material";
    }
}

// An iteration rounds positions to 2^-24 of a body of 2 m, and the next ones damp what it adds.
TEST(ProjectiveDynamics, EveryCodeHasTheSameIterates)
{
    const auto distance = [plain =
                               turned("projective_dynamics", {"packed=false"})](const std::vector<std::string>& keys) {
        return (turned("projective_dynamics", keys) - plain).cwiseAbs().maxCoeff();
    };
    EXPECT_LT(distance({"precision=f64"}), 1e-11);
    EXPECT_LT(distance({}), 100 * 0x1p-24 * 2.0);
    EXPECT_GT(distance({}), 0.0) << "the default is packed code in f32";
}

TEST(ProjectiveDynamics, ReportsThatItsStepIsStillLarge)
{
    const auto outcome = [](const std::string& iterations) {
        return flesh("projective_dynamics", {iterations, "stop_step=0.001"})->advance(turned_by(40.0), 0.01).outcome;
    };
    EXPECT_EQ(outcome("iterations=1"), pbs::Outcome::not_converged);
    EXPECT_EQ(outcome("iterations=1000"), pbs::Outcome::finished);
}

// VBD: a blend visits each vertex once; a sweep each vertex once, and each tet once for each of its vertices. XPBD:
// each iteration visits each tet once, and projects its two constraints and the three components of each of the bones'
// constraints.
TEST(FleshWork, IsThatOfThreeIterations)
{
    const std::int64_t vertices = straight_bar().mesh.rest.rows(), tets = straight_bar().mesh.tets.rows();
    const auto work = [](const char* kind) {
        const pbs::StepSummary step = flesh(kind, {"iterations=3"})->advance(turned_by(30.0), 0.01);
        EXPECT_EQ(step.iterations, 3);
        return step.work;
    };
    EXPECT_EQ(work("vbd"), (WorkCounters{.vertex_visits = 4 * vertices, .tet_visits = 12 * tets}));
    EXPECT_EQ(work("projective_dynamics"),
              (WorkCounters{.gradients = 3, .vertex_visits = vertices, .tet_visits = 3 * tets, .linear_solves = 3}));
    const auto of_bones =
        flesh("xpbd_neo_hookean", {})->record().at("linear_constraints_of_the_bones").get<std::int64_t>();
    EXPECT_GT(of_bones, 0);
    EXPECT_EQ(
        work("xpbd_neo_hookean"),
        (WorkCounters{.vertex_visits = vertices, .tet_visits = 3 * tets, .projections = 3 * (2 * tets + of_bones)}));
}

// The keys of an earlier release are still read, as the ones that replace them.
TEST(FleshKeys, ThatAreRenamedAreStillRead)
{
    const auto traits = [](const std::string& key) {
        return traits_of(
            spec_of(read_scene("limb_bend", {"deformers.use=[\"vbd\"]", "reference.name=\"\"", key}), "vbd"));
    };
    EXPECT_EQ(traits("vbd.arithmetic=packed_f64").precision, "f64");
    EXPECT_TRUE(traits("vbd.arithmetic=packed_f64").packed);
    EXPECT_FALSE(traits("vbd.arithmetic=\"plain_f64\"").packed);
    EXPECT_EQ(traits("vbd.packed=false").precision, "f64") << "plain code exists in f64 alone";
    EXPECT_THROW(traits("vbd.arithmetic=f16"), pbs::InputError);
    EXPECT_THROW(read_scene("limb_bend", {"vbd.precision=f32", "vbd.packed=false", "deformers.use=[\"vbd\"]",
                                          "reference.name=\"\""}),
                 pbs::InputError);
}

}  // namespace
