// Reference: the interpolations of glTF 2.0, Appendix C, and skinned points, computed by hand. Tolerances: at most 64 roundings of numbers
// of at most 8.
#include "pbs/rig/rig_pose.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const double pose_rounding = test_support::rounding_error(64, 8.0);

KeyTrack track_with(Interpolation interpolation, const std::vector<double>& times_s, const std::vector<Eigen::Vector4d>& values)
{
    KeyTrack track;
    track.interpolation = interpolation;
    track.times_s = times_s;
    track.values = values;
    return track;
}

TEST(KeyTracks, LinearVectorsLieBetweenTheirKeys)
{
    const KeyTrack track = track_with(Interpolation::linear, {1.0, 3.0}, {{0, 2, 4, 0}, {4, 2, 0, 0}});
    EXPECT_EQ(vector_at(track, 1.5), Vec3(1, 2, 3));
    EXPECT_EQ(vector_at(track, 3.0), Vec3(4, 2, 0));
}

TEST(KeyTracks, BeforeTheFirstAndAfterTheLastKeyTheValueIsThatKeys)
{
    for (const Interpolation kind : {Interpolation::step, Interpolation::linear}) {
        const KeyTrack track = track_with(kind, {1.0, 3.0}, {{1, 0, 0, 0}, {2, 0, 0, 0}});
        EXPECT_EQ(vector_at(track, -5.0).x(), 1.0);
        EXPECT_EQ(vector_at(track, 9.0).x(), 2.0);
    }
    const KeyTrack spline = track_with(Interpolation::cubic_spline, {1.0, 3.0},
                                       {{7, 0, 0, 0},
                                        {1, 0, 0, 0},
                                        {7, 0, 0, 0},  //
                                        {7, 0, 0, 0},
                                        {2, 0, 0, 0},
                                        {7, 0, 0, 0}});
    EXPECT_EQ(vector_at(spline, 0.0).x(), 1.0);
    EXPECT_EQ(vector_at(spline, 3.0).x(), 2.0);
    EXPECT_EQ(vector_at(spline, 4.0).x(), 2.0);
}

TEST(KeyTracks, AStepKeepsTheKeyBefore)
{
    const KeyTrack track = track_with(Interpolation::step, {0.0, 1.0, 2.0}, {{1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}});
    EXPECT_EQ(vector_at(track, 0.999).x(), 1.0);
    EXPECT_EQ(vector_at(track, 1.0).x(), 2.0);
    EXPECT_EQ(vector_at(track, 1.5).x(), 2.0);
}

TEST(KeyTracks, ASingleKeyHoldsAtAllTimes)
{
    const KeyTrack track = track_with(Interpolation::linear, {0.5}, {{1, 2, 3, 0}});
    for (const double time_s : {0.0, 0.5, 1.0}) EXPECT_EQ(vector_at(track, time_s), Vec3(1, 2, 3));
}

TEST(KeyTracks, TwoKeysAtOneTimeAreAJump)
{
    const KeyTrack track =
        track_with(Interpolation::linear, {0.0, 1.0, 1.0, 2.0}, {{0, 0, 0, 0}, {1, 0, 0, 0}, {5, 0, 0, 0}, {6, 0, 0, 0}});
    EXPECT_EQ(vector_at(track, 0.5).x(), 0.5);
    EXPECT_EQ(vector_at(track, 1.0).x(), 5.0);
    EXPECT_EQ(vector_at(track, 1.5).x(), 5.5);
}

// At the middle of two keys: (p0 + p1) / 2 + distance (m0 - m1) / 8.
TEST(KeyTracks, ACubicSplineAtItsMiddle)
{
    const KeyTrack track = track_with(Interpolation::cubic_spline, {0.0, 2.0},
                                      {{9, 9, 9, 0},
                                       {1, 0, 2, 0},
                                       {4, 0, 1, 0},  //
                                       {2, 8, 1, 0},
                                       {3, 1, 6, 0},
                                       {9, 9, 9, 0}});
    EXPECT_EQ(vector_at(track, 1.0), Vec3(2.0 + 2.0 * 2.0 / 8.0, 0.5 - 2.0 * 8.0 / 8.0, 4.0));
}

// Tangents are derivatives with respect to seconds.
TEST(KeyTracks, ACubicSplineReproducesACubicPolynomial)
{
    const auto value = [](double t) { return t * t * t - 2.0 * t * t + 0.5 * t + 1.0; };
    const auto slope = [](double t) { return 3.0 * t * t - 4.0 * t + 0.5; };
    KeyTrack track = track_with(Interpolation::cubic_spline, {0.25, 1.0, 2.0}, {});
    for (const double t : track.times_s)
        for (const double number : {slope(t), value(t), slope(t)}) track.values.emplace_back(number, 0, 0, 0);
    for (const double t : {0.25, 0.3, 0.7, 1.0, 1.1, 1.9, 2.0}) EXPECT_NEAR(vector_at(track, t).x(), value(t), pose_rounding) << t;
}

TEST(KeyTracks, RotationsTurnAtAConstantRateTheShorterWay)
{
    for (const double sign : {1.0, -1.0}) {  // q and -q are one rotation
        const Eigen::Quaterniond end(Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitX()));
        const KeyTrack track = track_with(Interpolation::linear, {0.0, 1.0}, {{0, 0, 0, 1}, sign * end.coeffs()});
        const Eigen::Quaterniond third = rotation_at(track, 1.0 / 3.0);
        const Eigen::Quaterniond expected(Eigen::AngleAxisd(M_PI / 6.0, Vec3::UnitX()));
        EXPECT_NEAR(std::abs(third.dot(expected)), 1.0, pose_rounding);
        EXPECT_NEAR(third.angularDistance(expected), 0.0, pose_rounding);
    }
}

TEST(KeyTracks, RotationsOfASplineHaveUnitLength)
{
    const Eigen::Vector4d still = Eigen::Vector4d::Zero();
    const KeyTrack track = track_with(Interpolation::cubic_spline, {0.0, 1.0}, {still, {0, 0, 0, 1}, still, still, {0, 0, 1, 0}, still});
    const Eigen::Quaterniond middle = rotation_at(track, 0.5);  // (0, 0, 1, 1) / 2 before it is normalised
    EXPECT_NEAR(middle.z(), std::sqrt(0.5), pose_rounding);
    EXPECT_NEAR(middle.w(), std::sqrt(0.5), pose_rounding);
}

TEST(KeyTracks, RotationsThatAreNotNormalisedAreMadeSo)
{
    const KeyTrack track = track_with(Interpolation::step, {0.0}, {{0, 0, 3, 4}});
    EXPECT_EQ(rotation_at(track, 0.0).coeffs(), Eigen::Vector4d(0, 0, 0.6, 0.8));
}

TEST(FindAnimation, TheFirstOneWithoutANameAndAnErrorThatListsTheNames)
{
    Rig rig = test_support::two_joint_rig();
    rig.animations.push_back({"Walk", 0.0, 1.0, {}});
    EXPECT_EQ(find_animation(rig, ""), &rig.animations[0]);
    EXPECT_EQ(find_animation(rig, "Walk"), &rig.animations[1]);
    expect_input_error([&] { find_animation(rig, "walk"); }, "arm.gltf: animation = walk: ", "expected one of Bend, Walk");
    rig.animations.clear();
    EXPECT_EQ(find_animation(rig, ""), nullptr);
    expect_input_error([&] { find_animation(rig, "Walk"); }, "arm.gltf: animation = Walk: ", "the file has no animation");
}

}  // namespace
