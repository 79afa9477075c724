// C04 from a twisted limb, with the correct solver and with broken ones. Reference:
// - nothing projected: LBS remains, with radii down to cos 85 deg = 0.09 of the radius and less: a candy wrapper.
// - bind dropped: only bind constraints contain the distance from the bone, so at 170 degrees sections are narrower
// than with them.
// - volume sign: the volume projections undo the effect of the bind constraints, so sections are narrower.
// - volume or stretch dropped: the bind constraints still put every vertex at its distance, so the verdict stays at 60
// degrees. There is no
//   theory for the effect of the remaining class on the skin between the vertices. At 170 degrees, where the verdict
//   was also expected to stay, sections fall below the bound, although they are far above those of LBS.
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "tests/support/artefact_samples.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using namespace test_support;
using analysis::Measurement;

constexpr int vertices = 1200;  // on a coarser mesh, sections between the vertices narrow by themselves

// On one mesh. Flesh is taken to keep its sections; it narrows by 3 % when the limb is twisted by 180 degrees.
std::vector<Measurement> twisted(Broken how, const std::string& angle_deg = "170")
{
    const ArtefactCase of = twisted_limb(vertices, angle_deg, how);
    const ArtefactBody body(of);
    std::vector<ArtefactSample> samples = {sample("reference", 0, 1.0, 1)};
    for (const DeformerSpec& spec : of.scene.deformers) {
        const Shape shape = body.posed.shapes(spec).at(0);
        samples.push_back(sample(spec.kind, 0, 0.0));
        samples.back().extremes = extremes_of(body.sections.at(0).measure(shape.positions, body.posed.pose(0)));
    }
    return section_values(of, body, samples);
}

double smallest(const std::vector<Measurement>& measured, const std::string& deformer = "pbs")
{
    return values_of(measured, "smallest_section_radius_over_rest", {.deformer = deformer}).at(0).value;
}

bool lies_within_bound(const std::vector<Measurement>& measured)
{
    return own_cases("C04", measured).cases.at(0).holds;
}

TEST(BrokenArtefacts, AsItIsThereIsNoCandyWrapper)
{
    const auto measured = twisted(Broken::nothing);
    EXPECT_TRUE(lies_within_bound(measured)) << smallest(measured);
    EXPECT_LT(smallest(measured, "lbs"), 0.5);  // there is an artefact to remove
}

TEST(BrokenArtefacts, NothingProjectedIsLbs)
{
    const auto measured = twisted(Broken::nothing_projected);
    EXPECT_FALSE(lies_within_bound(measured));
    // Positions go through 24 roundings of two motions, on both sides.
    const ArtefactCase of = twisted_limb(vertices, "170");
    const ArtefactBody body(of);
    const pbs::Positions lbs = body.posed.shapes(spec_of(of.scene, "lbs")).at(0).positions;
    const auto value = [&](const pbs::Positions& positions) {
        return extremes_of(body.sections.at(0).measure(positions, body.posed.pose(0))).smallest_radius;
    };
    EXPECT_NEAR(smallest(measured), smallest(measured, "lbs"),
                value_rounding(lbs, coordinate_rounding_m(lbs, 2 * 24), value));
}

TEST(BrokenArtefacts, WithoutBindOrWithTheSignTurnedRoundSectionsAreNarrower)
{
    const double sound = smallest(twisted(Broken::nothing));
    for (const Broken how : {Broken::bind_dropped, Broken::volume_sign}) {
        const auto measured = twisted(how);
        EXPECT_LT(smallest(measured), sound) << name_of(how);
        EXPECT_FALSE(lies_within_bound(measured)) << name_of(how);
    }
}

// Only without bind constraints, the candy wrapper returns: narrower than half of what remains without any other class.
TEST(BrokenArtefacts, WithoutVolumeOrStretchTheBindConstraintsStillHold)
{
    const double sound = smallest(twisted(Broken::nothing)), without_bind = smallest(twisted(Broken::bind_dropped));
    for (const Broken how : {Broken::volume_dropped, Broken::stretch_dropped}) {
        EXPECT_TRUE(lies_within_bound(twisted(how, "60"))) << name_of(how);
        const double radius = smallest(twisted(how));
        EXPECT_LT(radius, sound) << name_of(how);
        EXPECT_GT(radius, 0.5) << name_of(how);  // half way from LBS
        EXPECT_LT(without_bind, 0.5 * radius) << name_of(how);
    }
}

}  // namespace
