// The narrowest section of a twisted limb, recomputed without CGAL and without the classes of the study. Reference: the
// limb lies along x and its twist does not move that axis, so that a station's plane is x = const; the smallest radius
// of the outline is the distance from the centroid of the segments in which the skin's triangles meet the plane to the
// nearest of them.
#include "experiments/studies/artefacts/artefact_case.hpp"

#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace {

double smallest_radius_m(const pbs::Positions& positions, const pbs::Triangles& skin, double x)
{
    std::vector<std::array<pbs::Vec3, 2>> segments;
    pbs::Vec3 moment = pbs::Vec3::Zero();
    double length = 0.0, smallest = std::numeric_limits<double>::infinity();
    for (const auto triangle : skin.rowwise()) {
        std::array<pbs::Vec3, 2> segment;
        int ends = 0;
        for (int corner = 0; corner < 3; ++corner) {
            const pbs::Vec3 p = positions.row(triangle(corner)), q = positions.row(triangle((corner + 1) % 3));
            if ((p.x() < x) != (q.x() < x)) segment[ends++] = p + (x - p.x()) / (q.x() - p.x()) * (q - p);
        }
        if (ends != 2) continue;
        segments.push_back(segment);
        moment += (segment[1] - segment[0]).norm() * 0.5 * (segment[0] + segment[1]);
        length += (segment[1] - segment[0]).norm();
    }
    for (const auto& [p, q] : segments) {
        const double along = std::clamp((moment / length - p).dot(q - p) / (q - p).squaredNorm(), 0.0, 1.0);
        smallest = std::min(smallest, (p + along * (q - p) - moment / length).norm());
    }
    return smallest;
}

pbs::Positions shape_by_hand(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options)
{
    pbs::Positions lbs;
    pbs::linear_blend_skinning(character.mesh.rest, character.weights, pose, lbs);
    pbs::PbsSolver solver(character.mesh, character.binding.distance, {}, options);
    solver.advance(lbs, pbs::posed_bind_points(character.binding, pose), 0.01);
    return solver.positions();
}

TEST(ReadingSections, HaveTheNarrowestSectionThatPlainSlicingFinds)
{
    const nlohmann::json twisted = {{"name", "limb_twist"},
                                    {"quick_s", 1.0},
                                    {"scene", "limb_twist"},
                                    {"what", "twist"},
                                    {"step_deg", 120},
                                    {"frame_deg", 60},
                                    {"poses", 1},
                                    {"overrides", {R"(deformers.use=["lbs","pbs"])", "reference.name=lbs"}}};
    const experiments::StudyCase of("ambiguity", twisted, false);
    const experiments::Overrides readings[] = {{}, {"pbs.k_bind=0.1"}};
    const auto all = experiments::artefacts_study().read(of, {readings[0], readings[1]});
    const experiments::Scene scene = of.scene({"motion.angle_deg=120", "motion.frames=3"});

    const pbs::Character character = pbs::make_character(scene.character);
    const auto joints = experiments::limb_joints(character);
    ASSERT_EQ(joints.size(), 1u);
    const double radius_m = joints[0].radius_m;
    const pbs::Triangles skin = pbs::boundary_of(character.mesh.tets);
    const pbs::Pose pose = experiments::make_motion(scene.motion, character.skeleton, scene.file).steps.at(2);
    double narrowest[2];
    for (const int reading : {0, 1}) {
        const experiments::Scene read = of.scene(readings[reading]);
        const pbs::Positions shape =
            shape_by_hand(character, pose, experiments::options_of<pbs::PbsOptions>(experiments::spec_of(read, "pbs")));
        const auto by_hand = [&](const pbs::Positions& positions) {
            double smallest = std::numeric_limits<double>::infinity();
            for (int station = -10; station <= 10; ++station) {
                const double x = joints[0].point.x() + station * radius_m / 5.0;  // up to 2 radii
                smallest = std::min(
                    smallest, smallest_radius_m(positions, skin, x) / smallest_radius_m(character.mesh.rest, skin, x));
            }
            return smallest;
        };
        narrowest[reading] = by_hand(shape);
        const auto& values = all[reading].values;
        const auto value = std::ranges::find_if(values, [](const auto& one) { return one.of.deformer == "pbs"; });
        ASSERT_NE(value, values.end());
        // LBS that is blended in another order may be rounded to another float, on both sides.
        EXPECT_NEAR(value->value, narrowest[reading],
                    test_support::value_rounding(shape, 2 * test_support::single_rounding_m(shape), by_hand))
            << text_of(value->of);
    }
    EXPECT_GT(std::abs(narrowest[1] - narrowest[0]), 1e-3);  // the two readings differ by far more
}

}  // namespace
