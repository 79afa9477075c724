// The narrowest section of a twisted limb, recomputed without CGAL and without the classes of the study. Reference: the limb lies along x
// and its twist does not move that axis, so that a station's plane is x = const; the area that a closed skin cuts out of it is half the sum
// of (p x q)_x over the segments p q in which its outward triangles meet the plane.
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
#include <cmath>
#include <limits>

namespace {

double section_area_m2(const pbs::Positions& positions, const pbs::Triangles& skin, double x)
{
    double twice = 0.0;
    for (const auto triangle : skin.rowwise()) {
        pbs::Vec3 segment[2];
        int ends = 0;
        for (int corner = 0; corner < 3; ++corner) {
            const pbs::Vec3 p = positions.row(triangle(corner)), q = positions.row(triangle((corner + 1) % 3));
            if ((p.x() < x) == (q.x() < x)) continue;
            segment[p.x() < x ? 0 : 1] = p + (x - p.x()) / (q.x() - p.x()) * (q - p);
            ++ends;
        }
        if (ends == 2) twice += segment[0].cross(segment[1]).x();
    }
    return std::abs(0.5 * twice);
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
                                    {"overrides", {R"(deformers.use=["lbs","pbs","nh_p1"])", "reference.name=nh_p1"}}};
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
        narrowest[reading] = std::numeric_limits<double>::infinity();
        for (int station = -10; station <= 10; ++station) {
            const double x = joints[0].point.x() + station * radius_m / 5.0;  // up to 2 radii
            narrowest[reading] =
                std::min(narrowest[reading], section_area_m2(shape, skin, x) / section_area_m2(character.mesh.rest, skin, x));
        }
        const auto& values = all[reading].values;
        const auto value =
            std::find_if(values.begin(), values.end(), [](const auto& one) { return one.quantity == "smallest_section_area_over_rest"; });
        ASSERT_NE(value, values.end());
        // LBS that is blended in another order may be rounded to another float, on both sides, relative to the middle of a limb that
        // reaches 1.15 m. A section whose points move by d changes by 2 d sqrt(its share) / radius of the area at rest.
        const double moved_m = std::sqrt(3.0) * test_support::rounding_error_in<float>(2, 1.15);
        EXPECT_NEAR(value->value, narrowest[reading], 2.0 * moved_m * std::sqrt(narrowest[reading]) / radius_m) << text_of(value->of);
    }
    EXPECT_GT(std::abs(narrowest[1] - narrowest[0]), 1e-3);  // the two readings differ by far more
}

}  // namespace
