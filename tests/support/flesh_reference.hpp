// The finite element reference's own solution on linear tets for the material of the energy-minimising deformers, in one pose of a body:
// what they have to converge to.
//   const FleshReference reference("limb_twist", {"motion.angle_deg=90", "motion.frames=2"}, 1, 0.45);
//   reference.difference(positions)   // over the difference of LBS
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace test_support {

class FleshReference {
public:
    FleshReference(const std::string& scene, const std::vector<std::string>& settings, int frame, double poisson)
        : posed_(experiments::read_scene(scene, settings), {frame})
    {
        experiments::DeformerSpec spec = experiments::default_spec("fem");
        auto& fem = experiments::options_of<experiments::FemOptions>(spec);
        fem.model = reference_fem::Model::stable_neo_hookean;
        fem.element_order = 1;
        fem.poisson = poisson;
        fem.attachment = experiments::FemAttachment::smooth;
        const experiments::Shapes shapes = posed_.shapes(spec);
        EXPECT_TRUE(shapes.front().finished);
        solution_ = shapes.front().positions;
        distance_of_lbs_ = (experiments::blended(posed_.character(), posed_.pose(0)) - solution_).norm();
    }

    // Root mean square over the vertices.
    double difference(const pbs::Positions& positions) const { return (positions - solution_).norm() / distance_of_lbs_; }
    double difference(const experiments::DeformerSpec& spec) const { return difference(posed_.shapes(spec).front().positions); }
    const experiments::PosedCharacter& posed() const { return posed_; }

private:
    experiments::PosedCharacter posed_;
    pbs::Positions solution_;
    double distance_of_lbs_ = 0.0;
};

}  // namespace test_support
