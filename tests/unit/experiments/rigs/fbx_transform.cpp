// Reference: the formula of the format as its documentation states it, as a product of 4 x 4 matrices in the order of
// that page, and closed forms that follow from the meaning of each property. Reals are in double precision: at most 64
// roundings of numbers of at most 100.

#include "experiments/rigs/fbx_transform.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace pbs;

const double formula_rounding = test_support::rounding_error_in<double>(64, 100.0);

using Matrix = Eigen::Matrix4d;

Matrix moved_by(const Vec3& distance)
{
    Matrix matrix = Matrix::Identity();
    matrix.block<3, 1>(0, 3) = distance;
    return matrix;
}

Matrix scaled_by(const Vec3& factors)
{
    return Eigen::Vector4d(factors.x(), factors.y(), factors.z(), 1.0).asDiagonal();
}

Matrix turned_about(char axis, double degrees)
{
    const double c = std::cos(degrees * M_PI / 180.0), s = std::sin(degrees * M_PI / 180.0);
    const int i = axis == 'x' ? 1 : axis == 'y' ? 2 : 0, j = (i + 1) % 3;
    Matrix matrix = Matrix::Identity();
    matrix(i, i) = matrix(j, j) = c;
    matrix(i, j) = -s;
    matrix(j, i) = s;
    return matrix;
}

// The first axis of the order is the first to turn a point.
Matrix turned_by(const Vec3& degrees, const std::string& order)
{
    Matrix matrix = Matrix::Identity();
    for (const char axis : order) matrix = turned_about(axis, degrees(axis - 'x')) * matrix;
    return matrix;
}

const std::array<std::string, 6> orders = {"xyz", "xzy", "yzx", "yxz", "zxy", "zyx"};

Matrix local_by_formula(const FbxTransform& node)
{
    const auto& [translation, rotation, scaling] = node.lcl;
    return moved_by(translation) * moved_by(node.rotation_offset) * moved_by(node.rotation_pivot) *
           turned_by(node.pre_rotation_deg, "xyz") * turned_by(rotation, orders[node.rotation_order]) *
           turned_by(node.post_rotation_deg, "xyz").inverse() * moved_by(node.rotation_pivot).inverse() *
           moved_by(node.scaling_offset) * moved_by(node.scaling_pivot) * scaled_by(scaling) *
           moved_by(node.scaling_pivot).inverse();
}

Vec3 random_vector(std::mt19937& random, double largest)
{
    std::uniform_real_distribution<double> number(-largest, largest);
    const double x = number(random), y = number(random), z = number(random);
    return {x, y, z};
}

// Each part is left at its default by chance, so that single properties occur as well as all combinations.
FbxTransform random_transform(std::mt19937& random)
{
    const auto chance = [&] { return random() % 2 == 0; };
    FbxTransform node;
    for (Vec3* part :
         {&node.lcl[0], &node.rotation_offset, &node.rotation_pivot, &node.scaling_offset, &node.scaling_pivot})
        if (chance()) *part = random_vector(random, 5.0);
    for (Vec3* part : {&node.lcl[1], &node.pre_rotation_deg, &node.post_rotation_deg})
        if (chance()) *part = random_vector(random, 170.0);
    if (chance()) node.lcl[2] = Vec3::Ones() + random_vector(random, 0.7);
    node.rotation_order = static_cast<int>(random() % 6);
    return node;
}

TEST(FbxTransform, IsTheProductThatTheFormatDefines)
{
    std::mt19937 random(7);
    for (int tried = 0; tried < 500; ++tried) {
        const FbxTransform node = random_transform(random), above = random_transform(random);
        const FbxPlacement placed = placed_below({}, node);
        EXPECT_LE((placed.world.matrix() - local_by_formula(node)).cwiseAbs().maxCoeff(), formula_rounding) << tried;
        const Matrix below = placed_below(placed_below({}, above), node).world.matrix();  // RSrs: the product of both
        EXPECT_LE((below - local_by_formula(above) * local_by_formula(node)).cwiseAbs().maxCoeff(),
                  10.0 * formula_rounding)
            << tried;
    }
}

TEST(FbxTransform, InheritsScalesAsItsTypeStates)
{
    std::mt19937 random(11);
    for (int tried = 0; tried < 200; ++tried) {
        FbxTransform grandparent, parent, node = random_transform(random);
        const Vec3 scale = Vec3::Ones() + random_vector(random, 0.7);
        grandparent.lcl[1] = random_vector(random, 170.0);
        parent = random_transform(random);
        parent.lcl[2] = scale;
        const FbxPlacement above = placed_below(placed_below({}, grandparent), parent);
        const Matrix parents = local_by_formula(grandparent) * local_by_formula(parent), own = local_by_formula(node);
        const Vec3 place = (parents * own).block<3, 1>(0, 3);  // the same for each type
        const Eigen::Matrix3d turned =
            (turned_by(grandparent.lcl[1], "xyz") * turned_by(parent.pre_rotation_deg, "xyz") *
             turned_by(parent.lcl[1], orders[parent.rotation_order]) *
             turned_by(parent.post_rotation_deg, "xyz").inverse())
                .block<3, 3>(0, 0);
        Eigen::Matrix3d rotation = own.block<3, 3>(0, 0);
        for (int axis = 0; axis < 3; ++axis) rotation.col(axis) /= node.lcl[2](axis);

        node.inheritance = FbxInheritance::Rrs;  // the parent's own scale is left out
        Eigen::Affine3d placed = placed_below(above, node).world;
        EXPECT_LE((placed.linear() - turned * own.block<3, 3>(0, 0)).cwiseAbs().maxCoeff(), formula_rounding) << tried;
        EXPECT_LE((placed.translation() - place).cwiseAbs().maxCoeff(), 10.0 * formula_rounding) << tried;

        node.inheritance = FbxInheritance::RrSs;  // both scales are along the node's axes
        placed = placed_below(above, node).world;
        const Eigen::Matrix3d expected = turned * rotation * scale.asDiagonal() * node.lcl[2].asDiagonal();
        EXPECT_LE((placed.linear() - expected).cwiseAbs().maxCoeff(), 10.0 * formula_rounding) << tried;
        EXPECT_LE((placed.translation() - place).cwiseAbs().maxCoeff(), 10.0 * formula_rounding) << tried;
    }
}

TEST(FbxTransform, ASegmentWithScaleCompensationKeepsItsSize)
{
    FbxTransform elbow, hand;
    elbow.lcl = {Vec3(0, 50, 0), Vec3(0, 0, 90), Vec3(1.6, 1.6, 1.6)};
    hand.lcl[0] = {0, 35, 0};
    hand.inheritance = FbxInheritance::Rrs;
    const Eigen::Affine3d placed = placed_below(placed_below({}, elbow), hand).world;
    EXPECT_LE((placed * Vec3::Zero() - Vec3(-56, 50, 0)).norm(), formula_rounding) << "35 times 1.6";
    EXPECT_LE((placed * Vec3(0, 10, 0) - Vec3(-66, 50, 0)).norm(), formula_rounding);
    elbow.lcl[2] = {1, 0, 1};
    EXPECT_LE((placed_below(placed_below({}, elbow), hand).world * Vec3(0, 10, 0) - Vec3(0, 50, 0)).norm(),
              formula_rounding)
        << "nothing";
}

FbxCurve curve(FbxInterpolation interpolation, double slope = 0.0, double next_slope = 0.0)
{
    return {{1.0, 10.0, interpolation, slope, next_slope}, {3.0, 30.0}};
}

TEST(FbxCurve, IsConstantOrLinearBetweenItsKeysAndConstantBeyond)
{
    using enum FbxInterpolation;
    for (const auto& [interpolation, at_start, between] :
         {std::tuple(constant, 10.0, 10.0), std::tuple(constant_next, 10.0, 30.0), std::tuple(linear, 10.0, 15.0)}) {
        EXPECT_EQ(value_at(curve(interpolation), 0.0), 10.0);
        EXPECT_EQ(value_at(curve(interpolation), 1.0), at_start);
        EXPECT_NEAR(value_at(curve(interpolation), 1.5), between, 1e-12);
        EXPECT_EQ(value_at(curve(interpolation), 3.0), 30.0);
        EXPECT_EQ(value_at(curve(interpolation), 9.0), 30.0);
    }
}

// With tangents of a third of the time, time is the parameter, and the curve is Hermite's cubic polynomial.
TEST(FbxCurve, IsABezierCurveInTimeAndValueWhereItIsCubic)
{
    for (const auto& [weight, next_weight] : {std::pair(1.0 / 3.0, 1.0 / 3.0), std::pair(0.9, 0.2)}) {
        FbxCurve keys = curve(FbxInterpolation::cubic, 7.0, -4.0);
        if (weight > 0.5) keys[0].weight = weight, keys[0].next_weight = next_weight;  // a third is the default
        for (double t = 0.0; t <= 1.0; t += 0.125) {
            const auto bezier = [&](double a, double b, double c, double d) {
                const double u = 1.0 - t;
                return u * u * u * a + 3.0 * u * u * t * b + 3.0 * u * t * t * c + t * t * t * d;
            };
            const double time_s = bezier(1.0, 1.0 + weight * 2.0, 3.0 - next_weight * 2.0, 3.0);
            EXPECT_NEAR(value_at(keys, time_s),
                        bezier(10.0, 10.0 + 7.0 * 2.0 * weight, 30.0 + 4.0 * 2.0 * next_weight, 30.0), 1e-10);
        }
    }
}

}  // namespace
