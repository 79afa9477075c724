// Reference: deformations that correctives can express exactly, made here; the regression repeated without each sample;
// rest and LBS. Tolerances: rounding, times the condition number of what is solved.
#include "pbs/skinning/correctives.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

namespace correctives_tests {
namespace {

using namespace pbs;
using test_support::RandomPoints;
using test_support::TwoBoneLimb;

// A bar of three bones, 3 m long.
TwoBoneLimb chain()
{
    TwoBoneLimb limb;
    limb.mesh = test_support::structured_bar({0.0, -0.15, -0.15}, {3.0, 0.15, 0.15}, {12, 2, 2});
    limb.skeleton.bones = {
        {"a", -1, {0, 0, 0}, {1, 0, 0}}, {"b", 0, {1, 0, 0}, {2, 0, 0}}, {"c", 1, {2, 0, 0}, {3, 0, 0}}};
    limb.binding = bind_to_nearest_bone(limb.mesh.rest, limb.skeleton);
    limb.weights = paper_weights(limb.binding, limb.skeleton);
    return limb;
}

const TwoBoneLimb& bar()
{
    static const TwoBoneLimb limb = test_support::two_bone_limb({8, 2, 2}, Vec3::UnitZ(), 0.0);
    return limb;
}

// Each joint turned about a random axis by up to the angle [rad], and the whole body moved.
Pose random_pose(const Skeleton& skeleton, RandomPoints& random, double angle)
{
    std::vector<Eigen::Quaterniond> turns;
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b)
        turns.emplace_back(Eigen::AngleAxisd(random.number(-angle, angle), random.point(1.0).normalized()));
    return pose_from_joints(skeleton, turns, random.point(1.0));
}

// Poses with shapes that can be learned in part: those of dual quaternions, and noise.
std::vector<CorrectiveSample> solved(const TwoBoneLimb& limb, int count, double noise_m, unsigned seed)
{
    RandomPoints random(seed);
    std::vector<CorrectiveSample> samples(count);
    for (CorrectiveSample& sample : samples) {
        sample.pose = random_pose(limb.skeleton, random, 1.0);
        dual_quaternion_skinning(limb.mesh.rest, limb.weights, sample.pose, sample.shape);
        for (auto point : sample.shape.rowwise()) point += random.point(noise_m).transpose();
    }
    return samples;
}

// The sum that a fit minimises, without the ridge.
double weighted_residual(const TwoBoneLimb& limb, const Correctives& correctives,
                         const std::vector<CorrectiveSample>& samples)
{
    Eigen::VectorXd residuals(samples.size()), left(samples.size());
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const Positions residual =
            rest_residual(limb.mesh.rest, limb.weights, samples[s], CorrectiveOptions().least_stretch);
        residuals(s) = residual.squaredNorm();
        left(s) = (residual - corrective_displacements(correctives, samples[s].pose)).squaredNorm();
    }
    return sample_weights(residuals).dot(left);
}

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, RandomPoints& random)
{
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.number(-1.0, 1.0); });
}

// A joint's displacements of rank four, linear in its features, which are learned from other poses.
TEST(Correctives, ReproduceADeformationOfTheirOwnForm)
{
    constexpr int rank = 4;
    const TwoBoneLimb& limb = bar();
    RandomPoints random(3);
    Correctives made{.vertices = limb.weights.vertices(), .parents = {-1, 0}};
    made.joints.push_back({.joint = 1});
    for (int v = 0; v < made.vertices; ++v) made.joints[0].vertices.push_back(v);
    made.joints[0].modes = 0.05 * random_matrix(3 * made.vertices, rank, random);
    made.joints[0].drivers = random_matrix(rank, corrective_features, random);
    made.joints[0].lowest = Eigen::VectorXd::Constant(rank, -100.0);
    made.joints[0].highest = Eigen::VectorXd::Constant(rank, 100.0);
    std::vector<CorrectiveSample> samples(60);
    for (CorrectiveSample& sample : samples) {
        sample.pose = random_pose(limb.skeleton, random, 1.2);
        corrected_skinning(made, limb.mesh.rest, limb.weights, sample.pose, sample.shape);
    }
    const Correctives learned =
        fit_correctives(limb.skeleton, limb.mesh.rest, limb.weights, samples, {.least_strength = 0.0});
    EXPECT_EQ(learned.modes(), rank);
    Positions posed, expected, lbs;
    for (int trial = 0; trial < 10; ++trial) {
        const Pose pose = random_pose(limb.skeleton, random, 0.6);
        ASSERT_TRUE(is_within_training(learned, pose));
        corrected_skinning(learned, limb.mesh.rest, limb.weights, pose, posed);
        corrected_skinning(made, limb.mesh.rest, limb.weights, pose, expected);
        linear_blend_skinning(limb.mesh.rest, limb.weights, pose, lbs);
        // Some hundred roundings of coordinates up to 3 m, times the condition number of the features, which is below
        // 1e3 here.
        EXPECT_LT((posed - expected).cwiseAbs().maxCoeff(), 1e-10);
        EXPECT_GT((expected - lbs).cwiseAbs().maxCoeff(), 1e-3);
    }
}

TEST(Correctives, AreZeroAtRestToTheBit)
{
    const TwoBoneLimb limb = chain();
    const Correctives correctives =
        fit_correctives(limb.skeleton, limb.mesh.rest, limb.weights, solved(limb, 40, 0.003, 4));
    ASSERT_GT(correctives.modes(), 0);
    EXPECT_TRUE(corrective_displacements(correctives, Pose(3, Eigen::Isometry3d::Identity())).isZero(0.0));
}

// The same samples, each moved as a whole. The residuals change by rounding alone, of some 60 operations over the least
// stretch.
TEST(Correctives, DoNotDependOnTheRootsMotionOfTheTrainingPoses)
{
    const TwoBoneLimb limb = chain();
    const CorrectiveOptions options{.least_strength = 1e-2};
    std::vector<CorrectiveSample> samples = solved(limb, 40, 0.003, 5);
    const Correctives here = fit_correctives(limb.skeleton, limb.mesh.rest, limb.weights, samples, options);
    RandomPoints random(6);
    for (CorrectiveSample& sample : samples) {
        const Eigen::Isometry3d motion = random.rigid_motion(1.0);
        for (Eigen::Isometry3d& bone : sample.pose) bone = motion * bone;
        sample.shape = test_support::transformed(sample.shape, motion);
    }
    const Correctives there = fit_correctives(limb.skeleton, limb.mesh.rest, limb.weights, samples, options);
    ASSERT_GT(here.modes(), 0);
    for (const CorrectiveSample& sample : samples)
        EXPECT_LT((corrective_displacements(here, sample.pose) - corrective_displacements(there, sample.pose))
                      .cwiseAbs()
                      .maxCoeff(),
                  test_support::rounding_error(60.0 * 40.0 * std::sqrt(30.0) * 1.75 / options.least_strength, 4.0));
}

// The residual r brings LBS to the shape exactly where the blended matrix is far from singular.
TEST(Correctives, AResidualMovesTheRestShapeSoThatLbsReachesTheShape)
{
    const TwoBoneLimb limb = chain();
    for (const CorrectiveSample& sample : solved(limb, 5, 0.1, 7)) {
        const Positions residual = rest_residual(limb.mesh.rest, limb.weights, sample, 0.2);
        Positions posed;
        linear_blend_skinning(limb.mesh.rest + residual, limb.weights, sample.pose, posed);
        EXPECT_LT((posed - sample.shape).cwiseAbs().maxCoeff(), test_support::rounding_error(60.0 / 0.2, 5.0));
    }
}

// The blended matrix of a half turn about the bone has the singular values 1, 0 and 0.
TEST(Correctives, AFlattenedVertexHasABoundedResidual)
{
    const TwoBoneLimb& limb = bar();
    CorrectiveSample sample{joint_sweep(limb.skeleton, 1, Vec3::UnitX(), 180.0, 2, 0.01).steps.back(), limb.mesh.rest};
    Positions lbs;
    linear_blend_skinning(limb.mesh.rest, limb.weights, sample.pose, lbs);
    const double largest = (sample.shape - lbs).rowwise().norm().maxCoeff();
    EXPECT_LT(rest_residual(limb.mesh.rest, limb.weights, sample, 0.2).rowwise().norm().maxCoeff(),
              1.001 * largest / 0.2);
}

TEST(Correctives, CoefficientsStayInTheRangeOfTheTraining)
{
    const TwoBoneLimb& limb = bar();
    std::vector<CorrectiveSample> samples;
    const auto bent = [&](double deg) {
        return joint_sweep(limb.skeleton, 1, Vec3::UnitZ(), deg, 2, 0.01).steps.back();
    };
    for (const double deg : {-60.0, -30.0, 30.0, 60.0}) {
        samples.push_back({bent(deg), {}});
        dual_quaternion_skinning(limb.mesh.rest, limb.weights, samples.back().pose, samples.back().shape);
    }
    const Correctives correctives = fit_correctives(limb.skeleton, limb.mesh.rest, limb.weights, samples);
    ASSERT_EQ(correctives.joints.size(), 1u);
    EXPECT_TRUE(is_within_training(correctives, bent(45.0)));
    EXPECT_FALSE(is_within_training(correctives, bent(61.0)));
    const JointCorrective& joint = correctives.joints[0];
    const Eigen::VectorXd free =
        joint.drivers * corrective_features_of(correctives.parents, bent(120.0)).row(1).transpose();
    const Eigen::VectorXd kept = corrective_coefficients(correctives, bent(120.0));
    EXPECT_EQ(kept, free.cwiseMax(joint.lowest).cwiseMin(joint.highest));
    EXPECT_GT((kept - free).norm(), 0.1);
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(joint.drivers.rows());
    for (const CorrectiveSample& sample : samples) {
        const Eigen::VectorXd own = corrective_coefficients(correctives, sample.pose);
        EXPECT_LE(
            (own - joint.drivers * corrective_features_of(correctives.parents, sample.pose).row(1).transpose()).norm(),
            1e-12);
        largest = largest.cwiseMax(own.cwiseAbs());
    }
    EXPECT_LE((largest.array() - 1.0).abs().maxCoeff(), 1e-12);
}

// Reference: the regression without the sample, by the normal equations.
TEST(RidgeRegression, LeavesOutEachSampleInClosedForm)
{
    RandomPoints random(8);
    const Eigen::MatrixXd features = random_matrix(14, 5, random), targets = random_matrix(14, 3, random);
    const RidgeRegression ridge(features);
    for (const double strength : {0.0, 1e-3, 0.3, 10.0}) {
        double expected = 0.0;
        for (int out = 0; out < 14; ++out) {
            Eigen::MatrixXd others = features, values = targets;
            others.row(out).setZero();
            values.row(out).setZero();
            const Eigen::MatrixXd normal = others.transpose() * others + strength * Eigen::MatrixXd::Identity(5, 5);
            expected +=
                (features.row(out) * normal.ldlt().solve(others.transpose() * values) - targets.row(out)).squaredNorm();
        }
        // Fourteen samples, normal equations of a condition number below 100, some 100 roundings each.
        EXPECT_NEAR(ridge.left_out_error(targets, strength), expected,
                    test_support::rounding_error(100.0 * 100.0 * 14.0, expected));
        const Eigen::MatrixXd normal = features.transpose() * features + strength * Eigen::MatrixXd::Identity(5, 5);
        EXPECT_LT((ridge.coefficients(targets, strength) - normal.ldlt().solve(features.transpose() * targets)).norm(),
                  test_support::rounding_error(100.0 * 100.0, 14.0));
    }
}

TEST(RidgeRegression, TakesTheStrengthThatPredictsBest)
{
    RandomPoints random(9);
    const Eigen::MatrixXd features = random_matrix(20, 4, random), exact = features * random_matrix(4, 6, random);
    EXPECT_EQ(RidgeRegression(features).best_strength(exact, 0.0), 0.0);
    const Eigen::MatrixXd unrelated = random_matrix(5, 4, random);  // as many samples as features, and one
    const double strength = RidgeRegression(unrelated).best_strength(random_matrix(5, 6, random), 0.0);
    EXPECT_GT(strength, 0.01);
}

TEST(Correctives, APoseThatDeformsLittleCountsAsOneThatDeformsALot)
{
    const Eigen::VectorXd weights = sample_weights(Eigen::Vector4d(1.0, 4.0, 15.0, 0.0));
    for (int s = 0; s < 4; ++s)
        EXPECT_NEAR(weights(s), 1.0 / (Eigen::Vector4d(1.0, 4.0, 15.0, 0.0)(s) + 0.25), 1e-15) << s;
    EXPECT_EQ(sample_weights(Eigen::Vector2d::Zero()), Eigen::Vector2d::Ones());
    EXPECT_EQ(sample_weights(Eigen::VectorXd()).size(), 0);
}

// With one joint and no ridge, the weighted sum of |r|^2 falls with the rank. With several it is never above that of
// LBS, since each fit of a joint minimises the sum with the ridge.
TEST(Correctives, TheFitNeverEnlargesTheResidualOfItsTraining)
{
    const TwoBoneLimb three = chain();
    const auto left = [](const TwoBoneLimb& limb, const std::vector<CorrectiveSample>& samples, int rank) {
        const CorrectiveOptions options{.rank = rank, .least_strength = 0.0, .negligible = 0.0};
        const Correctives correctives = fit_correctives(limb.skeleton, limb.mesh.rest, limb.weights, samples, options);
        EXPECT_GT(correctives.modes(), 0);
        return weighted_residual(limb, correctives, samples);
    };
    for (const unsigned seed : {11u, 12u}) {
        const std::vector<CorrectiveSample> of_bar = solved(bar(), 40, 0.003, seed),
                                            of_chain = solved(three, 60, 0.003, seed);
        double before =
            weighted_residual(bar(), fit_correctives(bar().skeleton, bar().mesh.rest, bar().weights, {}), of_bar);
        const double without =
            weighted_residual(three, fit_correctives(three.skeleton, three.mesh.rest, three.weights, {}), of_chain);
        for (const int rank : {1, 2, 4, 8}) {
            const double after = left(bar(), of_bar, rank);
            EXPECT_LT(after, before) << rank;
            before = after;
            EXPECT_LT(left(three, of_chain, rank), without) << rank;
        }
    }
}

TEST(Correctives, OfNoPoseAndOfOneAreLbs)
{
    const std::vector<CorrectiveSample> one = solved(bar(), 1, 0.1, 14);
    for (const auto& samples : {std::vector<CorrectiveSample>{}, one}) {
        const Correctives correctives = fit_correctives(bar().skeleton, bar().mesh.rest, bar().weights, samples);
        EXPECT_EQ(correctives.modes(), 0);
        Positions posed, lbs;
        corrected_skinning(correctives, bar().mesh.rest, bar().weights, one[0].pose, posed);
        linear_blend_skinning(bar().mesh.rest, bar().weights, one[0].pose, lbs);
        EXPECT_EQ(posed, lbs);
    }
}

TEST(Correctives, OfResidualsThatAreZeroAreLbs)
{
    std::vector<CorrectiveSample> samples = solved(bar(), 20, 0.0, 15);
    for (CorrectiveSample& sample : samples)
        linear_blend_skinning(bar().mesh.rest, bar().weights, sample.pose, sample.shape);
    EXPECT_EQ(fit_correctives(bar().skeleton, bar().mesh.rest, bar().weights, samples).modes(), 0);
}

TEST(Correctives, OfJointsThatDoNotTurnAreLbs)
{
    std::vector<CorrectiveSample> samples = solved(bar(), 20, 0.003, 16);
    for (CorrectiveSample& sample : samples) sample.pose[1] = sample.pose[0];
    EXPECT_EQ(
        fit_correctives(bar().skeleton, bar().mesh.rest, bar().weights, samples, {.least_strength = 1e-2}).modes(), 0);
}

TEST(Correctives, AJointWithoutVerticesHasNone)
{
    TwoBoneLimb limb = chain();
    for (const char* name : {"d", "e"})
        limb.skeleton.bones.push_back({name, static_cast<int>(limb.skeleton.bones.size()) - 1, {3, 0, 0}, {4, 0, 0}});
    const Correctives correctives =
        fit_correctives(limb.skeleton, limb.mesh.rest, limb.weights, solved(limb, 60, 0.003, 17));
    for (const JointCorrective& joint : correctives.joints) EXPECT_LT(joint.joint, 4) << "no vertex follows d or e";
}

TEST(Correctives, SamplesOfAnotherSizeOrNotFiniteAreRefused)
{
    std::vector<CorrectiveSample> samples = solved(bar(), 3, 0.01, 18);
    samples[1].shape(4, 2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(fit_correctives(bar().skeleton, bar().mesh.rest, bar().weights, samples), InputError);
    samples[1].shape = samples[0].shape.topRows(5);
    EXPECT_THROW(fit_correctives(bar().skeleton, bar().mesh.rest, bar().weights, samples), InputError);
}

TEST(Correctives, OptionsOutOfRangeAreRefused)
{
    for (const CorrectiveOptions& options :
         {CorrectiveOptions{.rank = 0}, CorrectiveOptions{.sweeps = 0}, CorrectiveOptions{.least_strength = -1.0},
          CorrectiveOptions{.least_strength = 2.0}, CorrectiveOptions{.least_stretch = 0.0},
          CorrectiveOptions{.least_stretch = 1.5}, CorrectiveOptions{.negligible = 1.0}})
        EXPECT_THROW(fit_correctives(bar().skeleton, bar().mesh.rest, bar().weights, {}, options), InputError);
}

}  // namespace
}  // namespace correctives_tests
