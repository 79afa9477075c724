// The two-bone bar held by its bones, as the finite element deformers deform it, for their tests.
//   const pbs::Positions bent = deformed(bar_character({12, 2, 2}), {.element_order = 1}, {turned(40.0)});
#pragma once

#include "experiments/deformers/fem/fem_deformers.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace test_support {

// The joint turned about an axis, from rest.
inline pbs::Pose turned(double angle_deg, const pbs::Vec3& axis = pbs::Vec3::UnitZ())
{
    static const pbs::Character bar = bar_character({1, 1, 1});
    return pbs::joint_sweep(bar.skeleton, 1, axis, angle_deg, 2, 0.01).steps.back();
}

// A motion of the whole body.
inline const Eigen::Isometry3d rigid_motion =
    Eigen::Translation3d(3, -1, 2) * Eigen::AngleAxisd(2.0, pbs::Vec3(1, 2, -3).normalized());

inline pbs::Positions moved(const pbs::Positions& points)
{
    return (points * rigid_motion.linear().transpose()).rowwise() + rigid_motion.translation().transpose();
}

inline pbs::Pose moved(pbs::Pose pose)
{
    for (auto& bone : pose) bone = rigid_motion * bone;
    return pose;
}

// The deformer that the module makes for a model.
inline std::unique_ptr<experiments::Deformer> fem_deformer(const experiments::FemOptions& options)
{
    if (options.model == reference_fem::Model::linear) return std::make_unique<experiments::LinearFemDeformer>(options);
    return std::make_unique<experiments::ElasticFemDeformer>(options);
}

// The positions [m], #V x 3, after frames that must all be reached.
inline pbs::Positions deformed(const pbs::Character& character, const experiments::FemOptions& options,
                               const std::vector<pbs::Pose>& frames)
{
    const auto fem = fem_deformer(options);
    fem->reset(character);
    for (const pbs::Pose& pose : frames) EXPECT_EQ(fem->advance(pose, 0.01).outcome, pbs::Outcome::finished);
    return fem->positions();
}

inline double largest_distance(const pbs::Positions& a, const pbs::Positions& b)
{
    return (a - b).rowwise().norm().maxCoeff();
}

}  // namespace test_support
