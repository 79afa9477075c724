// Jitter, error and starts along a motion. Reference: the definition of the jitter on shapes that are made in another
// way, a rigid motion, whose shapes are known, and the rows of the frames for those of the clip.
#include "experiments/studies/temporal/temporal.hpp"

#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace {

using namespace experiments;

// A sweep of a joint in 32 frames.
TemporalCase sweep(const std::string& joint, double angle_deg, const std::vector<std::string>& keys = {})
{
    TemporalCase of;
    of.of = {.body = "limb", .motion = "twist"};
    std::vector<std::string> overrides = {"character.vertices=300", "motion.frames=32", "motion.joint=" + joint,
                                          "motion.angle_deg=" + std::to_string(angle_deg)};
    overrides.insert(overrides.end(), keys.begin(), keys.end());
    of.scene = read_scene("limb_twist", overrides);
    of.cold = {default_spec("lbs")};
    of.warm = {spec_of(of.scene, "pbs")};
    of.flesh = reference_flesh(of.scene);
    options_of<FemOptions>(of.flesh).element_order = 1;
    of.compared_every = 10;
    return of;
}

std::vector<TemporalFrame> frames_of(const TemporalRecords& records, const std::string& deformer, FrameStart start)
{
    std::vector<TemporalFrame> frames;
    for (const TemporalFrame& frame : records.frames)
        if (frame.deformer == deformer && frame.start == start) frames.push_back(frame);
    return frames;
}

TEST(Temporal, JitterIsTheDifferenceOfTheSecondDifferencesOverTheSkin)
{
    const TemporalCase of = sweep("forearm", 90.0);
    const TemporalRecords records = measure_temporal(of);
    EXPECT_EQ(records.breakdown, "");
    ASSERT_EQ(records.summary.size(), 3u);
    const pbs::Character limb = pbs::make_character(of.scene.character);
    const pbs::Motion motion = make_motion(of.scene.motion, limb.skeleton, of.scene.file);
    const auto x = shapes_in_motion(limb, motion, of.warm[0]), y = shapes_in_motion(limb, motion, of.cold[0]);
    const auto frames = frames_of(records, "pbs", FrameStart::own);
    ASSERT_EQ(frames.size(), 32u);
    const pbs::Triangles skin = pbs::boundary_of(limb.mesh.tets);
    Eigen::VectorXd area = Eigen::VectorXd::Zero(limb.mesh.rest.rows());
    Eigen::AlignedBox3d box;
    for (const auto face : skin.rowwise()) {
        const pbs::Vec3 a = limb.mesh.rest.row(face(0)), b = limb.mesh.rest.row(face(1)),
                        c = limb.mesh.rest.row(face(2));
        for (const int v : face)
            area(v) += (b - a).cross(c - a).norm() / 6.0, box.extend(pbs::Vec3(limb.mesh.rest.row(v)));
    }
    const double to_mm = 1700.0 / box.sizes().maxCoeff();
    std::vector<double> jitter_mm;
    for (int t = 24; t < 31; ++t) {
        const pbs::Positions apart = (x[t + 1] - y[t + 1]) - 2.0 * (x[t] - y[t]) + (x[t - 1] - y[t - 1]);
        const Eigen::VectorXd squares = apart.rowwise().squaredNorm();
        jitter_mm.push_back(to_mm * std::sqrt(area.dot(squares) / area.sum()));
        EXPECT_NEAR(frames[t].jitter_mm.value(), jitter_mm.back(), 1e-9 * jitter_mm.back() + 1e-9) << t;
        EXPECT_GT(jitter_mm.back(), 1e-6);
    }
    for (const int t : {0, 23, 31}) EXPECT_FALSE(frames[t].jitter_mm) << t;
    const TemporalRow& row = records.summary[1];
    const double squares = std::inner_product(jitter_mm.begin(), jitter_mm.end(), jitter_mm.begin(), 0.0);
    EXPECT_NEAR(row.jitter_mm, std::sqrt(squares / 7.0), 1e-9);
    EXPECT_GE(row.largest_jitter_mm, *std::ranges::max_element(jitter_mm));
    EXPECT_GT(row.pose_mm, 0.0);
    EXPECT_LT(records.summary[0].jitter_mm, 1e-9) << "of LBS itself: the rounding of positions of 1 m";
}

TEST(Temporal, ComparesTheStartsInTheFramesWithFlesh)
{
    const TemporalRecords records = measure_temporal(sweep("forearm", 60.0));
    const auto own = frames_of(records, "pbs", FrameStart::own),
               before = frames_of(records, "pbs", FrameStart::frame_before);
    int worse = 0, compared = 0;
    for (std::size_t t = 0; t < own.size(); ++t) {
        ASSERT_EQ(own[t].error_joint_pct.has_value(), t % 10 == 0) << t;
        if (t % 10 != 0) continue;
        ++compared;
        worse += *before[t].error_joint_pct > *own[t].error_joint_pct;
    }
    EXPECT_GT(worse, 0) << "no frame shows that they are counted";
    EXPECT_EQ(records.summary[1].compared, compared);
    EXPECT_FALSE(records.summary[1].worse_than_cold_frames);
    EXPECT_EQ(records.summary[2].worse_than_cold_frames, worse);
    EXPECT_EQ(before[0].error_joint_pct, own[0].error_joint_pct) << "the first frame has none before it";
    EXPECT_NE(before[10].error_joint_pct, own[10].error_joint_pct);
}

TEST(Temporal, PlansEachClipWithFleshThatIsNoneOfItsDeformers)
{
    for (const bool full : {false, true})
        for (const StudyRun& run : temporal_study().plan(full).runs) {
            EXPECT_EQ(run.settings.at("flesh").at("options").at("element_order"), 1);
            EXPECT_EQ(run.settings.at("cold").size(), 6u);
            EXPECT_EQ(run.settings.at("warm").size(), 7u);
        }
}

// All bones turn as one, and nothing is projected: the shape of the frame before is carried to that of LBS.
TEST(Temporal, ARigidMotionCarriesTheFrameBeforeAlong)
{
    const TemporalRecords records = measure_temporal(sweep("upper", 60.0, {"pbs.iterations=0", "pbs.precision=f64"}));
    EXPECT_LT(records.summary[2].largest_jitter_mm, 1e-8);
    EXPECT_GT(records.summary[2].pose_mm, 1e-3);
}

}  // namespace
