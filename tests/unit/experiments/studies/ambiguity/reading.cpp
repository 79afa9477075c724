// Reference: a reading belongs to a place and differs from its baseline, which comes before it.

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/ambiguity/reading.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using experiments::Reading;

// All that its motion depends on, without its names.
nlohmann::json all_of(const Reading& reading)
{
    nlohmann::json settings = experiments::to_json(reading);
    for (const char* name : {"place", "name", "baseline"}) settings.erase(name);
    return settings;
}

void expect_readings(const std::vector<Reading>& readings)
{
    std::set<std::string> names;
    const Reading* baseline = nullptr;
    for (const Reading& reading : readings) {
        EXPECT_TRUE(names.insert(reading.name).second) << reading.name;
        if (reading.place.empty()) {
            baseline = &reading;
            continue;
        }
        ASSERT_NE(baseline, nullptr);
        EXPECT_EQ(reading.baseline, baseline->name);
        EXPECT_NE(all_of(reading), all_of(*baseline)) << reading.name;
    }
}

pbs::PbsOptions falling()
{
    pbs::PbsOptions options;
    options.gravity_m_s2 = {0, -9.81, 0};
    return options;
}

TEST(Readings, OfAStepDifferFromTheirBaseline)
{
    expect_readings(experiments::readings_of_a_step(falling()));
}

TEST(Readings, OfMotionDifferFromTheirBaseline)
{
    expect_readings(experiments::readings_of_motion(falling()));
}

TEST(Readings, OfAStepRememberNothing)
{
    for (const Reading& reading : experiments::readings_of_a_step(falling())) {
        EXPECT_FALSE(reading.options.jiggle.has_value()) << reading.name;
        EXPECT_EQ(reading.options.lbs_entry, pbs::LbsEntry::start) << reading.name;
    }
}

// Reference: how each claim's values are measured (reading_values.hpp).

using experiments::untouched_because;

Reading own()
{
    return {.place = "", .name = "own", .baseline = "own", .options = {}};
}

Reading jiggling()
{
    Reading reading = own();
    reading.options.jiggle = pbs::Jiggle{.k_stretch = 0.9};
    return reading;
}

template <typename Change>
bool touches(const std::string& claim, const Reading& baseline, const Change& change)
{
    Reading reading = baseline;
    reading.place = "a place";
    reading.name = "B";
    change(reading);
    return untouched_because(claim, reading, baseline).empty();
}

TEST(Untouched, IsWhatDoesNotDifferFromItsBaseline)
{
    for (const char* claim : {"C01", "C03", "C04", "C07", "C09", "C10"}) EXPECT_FALSE(touches(claim, own(), [](Reading&) {}));
}

TEST(Untouched, IsLbsByWhatTheSolverAloneIsTold)
{
    EXPECT_FALSE(touches("C01", own(), [](Reading& r) { r.options.k_stretch = 0.9; }));
    EXPECT_TRUE(touches("C02", own(), [](Reading& r) { r.options.k_stretch = 0.9; }));
    EXPECT_TRUE(touches("C01", own(), [](Reading& r) { r.blended_bones = experiments::BlendedBones::either_end; }));
}

TEST(Untouched, IsMomentumByBindAndByTheOrderOfClasses)
{
    EXPECT_FALSE(touches("C07", own(), [](Reading& r) { r.options.k_bind = 0.5; }));
    EXPECT_FALSE(touches("C07", own(), [](Reading& r) { r.options.class_order = pbs::ClassOrder::volume_bind_stretch; }));
    EXPECT_TRUE(touches("C07", own(), [](Reading& r) { r.options.masses = pbs::Masses::lumped; }));
    EXPECT_TRUE(touches("C07", own(), [](Reading& r) { r.blended_bones = experiments::BlendedBones::either_end; }));
}

TEST(Untouched, AreSectionsAndStartsWhereSomethingJiggles)
{
    const auto by_bone = [](Reading& r) { r.zone_mean = experiments::ZoneMean::of_bone; };
    for (const char* claim : {"C03", "C12", "C04", "C05"}) EXPECT_FALSE(touches(claim, jiggling(), by_bone));
    EXPECT_TRUE(touches("C09", jiggling(), by_bone));
    const auto increment = [](Reading& r) { r.options.lbs_entry = pbs::LbsEntry::increment; };
    EXPECT_FALSE(touches("C03", own(), increment));
    EXPECT_TRUE(touches("C04", own(), increment));
}

TEST(Untouched, IsTheJoltByGravityAndByWhatTurningBonesAloneMake)
{
    EXPECT_FALSE(touches("C09", jiggling(), [](Reading& r) { r.options.gravity_m_s2 = {0, 1, 0}; }));
    EXPECT_FALSE(touches("C09", own(), [](Reading& r) { r.bind_point = experiments::BindPoint::reprojected; }));
    EXPECT_TRUE(touches("C09", jiggling(), [](Reading& r) { r.substeps = 2; }));
}

// A stiffness of zero leaves a class out, which is less work.
TEST(Untouched, IsTheTimeOfAFrameByFactorsOtherThanZero)
{
    EXPECT_FALSE(touches("C10", own(), [](Reading& r) { r.options.k_stretch = 0.9; }));
    EXPECT_FALSE(touches("C10", jiggling(), [](Reading& r) { r.options.jiggle->k_stretch = 0.6; }));
    EXPECT_TRUE(touches("C10", jiggling(), [](Reading& r) { r.options.jiggle->k_bind = 0.0; }));
    EXPECT_TRUE(touches("C10", jiggling(), [](Reading& r) { r.substeps = 2; }));
}

// Reference: the registered deformer, which is the paper's own reading, and the functions that a reading names.

using experiments::ReadDeformer;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
const pbs::Character character = test_support::character_of(limb);

pbs::Positions posed_by(const Reading& reading)
{
    ReadDeformer deformer(reading);
    deformer.reset(character);
    deformer.advance(limb.pose, 0.01);
    return deformer.positions();
}

TEST(ReadDeformer, OfThePapersReadingIsTheRegisteredOne)
{
    const auto registered = experiments::make_deformer(experiments::default_spec("pbs"));
    registered->reset(character);
    registered->advance(limb.pose, 0.01);
    EXPECT_EQ(posed_by(own()), registered->positions());
}

TEST(ReadDeformer, TakesTheReadingsWeightsAndBindPoints)
{
    Reading either = own(), anew = own();
    either.blended_bones = experiments::BlendedBones::either_end;
    anew.bind_point = experiments::BindPoint::reprojected;
    EXPECT_NE(posed_by(either), posed_by(own()));
    EXPECT_NE(posed_by(anew), posed_by(own()));
    EXPECT_EQ(experiments::bind_points_of(character, own(), limb.pose, limb.mesh.rest), pbs::posed_bind_points(limb.binding, limb.pose));
}

TEST(ReadDeformer, HasMemoryWhereParticlesAreIntegrated)
{
    Reading jiggling = own(), increment = own();
    jiggling.options.jiggle = pbs::Jiggle{};
    increment.options.lbs_entry = pbs::LbsEntry::increment;
    EXPECT_FALSE(ReadDeformer(own()).has_memory());
    EXPECT_TRUE(ReadDeformer(jiggling).has_memory());
    EXPECT_TRUE(ReadDeformer(increment).has_memory());
}

// Reference: the solver, LBS and the metrics, called directly.

using experiments::ReadMotion;

experiments::Scene bending()
{
    experiments::Scene scene;
    scene.name = "bending";
    scene.motion.joint = "forearm";
    scene.motion.axis = pbs::Vec3::UnitZ();
    scene.motion.angle_deg = 60.0;
    scene.motion.frames = 4;
    return scene;
}

TEST(ReadMotion, OfTheScenesOwnReadingIsTheSolvers)
{
    const ReadMotion moved = experiments::move(character, bending(), own());
    ASSERT_EQ(moved.shapes.size(), 4u);
    const pbs::Pose pose = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01).steps[2];
    pbs::Positions lbs;
    pbs::BlendSkinning<double>(limb.mesh.rest, limb.weights).linear(pose, lbs);
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, {});
    solver.advance(lbs, pbs::posed_bind_points(limb.binding, pose), 0.01);
    EXPECT_EQ(moved.shapes[2], solver.positions());
    const analysis::MeshMetrics mesh_metrics(limb.mesh.rest, limb.mesh.tets);
    EXPECT_EQ(moved.pbs.volume_change_pct[2], mesh_metrics.measure(solver.positions()).volume_change_pct);
    EXPECT_EQ(moved.lbs.volume_change_pct[2], mesh_metrics.measure(lbs).volume_change_pct);
    EXPECT_EQ(moved.pbs.angle_deg, (std::vector<double>{0.0, 20.0, 40.0, 60.0}));
    EXPECT_TRUE(moved.finite);
}

TEST(ReadMotion, ByIncrementDependsOnThePathAndByStartDoesNot)
{
    experiments::Scene coarse = bending();
    coarse.motion.frames = 2;
    Reading increment = own();
    EXPECT_EQ(experiments::move(character, bending(), increment).shapes.back(),
              experiments::move(character, coarse, increment).shapes.back());
    increment.options.lbs_entry = pbs::LbsEntry::increment;
    EXPECT_NE(experiments::move(character, bending(), increment).shapes.back(),
              experiments::move(character, coarse, increment).shapes.back());
}

// The bones touch only in the middle, so near the outer ends either_end blends where nearest_end does not.
TEST(ReadMotion, EitherEndMovesWhatEqTwoLeavesToOneBone)
{
    Reading either = own();
    either.blended_bones = experiments::BlendedBones::either_end;
    const ReadMotion nearest = experiments::move(character, bending(), own()), other = experiments::move(character, bending(), either);
    EXPECT_EQ(nearest.lbs.volume_change_pct[0], other.lbs.volume_change_pct[0]);  // at rest
    EXPECT_NE(nearest.lbs.volume_change_pct[3], other.lbs.volume_change_pct[3]);
}

TEST(ReadMotion, BindPointsProjectedAnewChangeTheShape)
{
    Reading anew = own();
    anew.bind_point = experiments::BindPoint::reprojected;
    EXPECT_NE(experiments::move(character, bending(), anew).shapes[3], experiments::move(character, bending(), own()).shapes[3]);
}

}  // namespace
