// Reference: C04 has two values per pose and joint, the smallest radius and the smallest area, and a shape that is not finite has none.
#include "experiments/studies/ambiguity/reading_values.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using experiments::Reading;

experiments::ArtefactCase twisted()
{
    experiments::ArtefactCase of;
    of.scene = experiments::read_scene("limb_twist", {"character.vertices=400", R"(deformers.use=["lbs","pbs"])", R"(reference.name="")",
                                                      "motion.angle_deg=90", "motion.frames=3"});
    of.claim = experiments::ArtefactCase::Claim::candy_wrapper;
    of.poses = {{1, "twist_45_deg"}, {2, "twist_90_deg"}};
    return of;
}

Reading own()
{
    return {.place = "",
            .name = "own",
            .baseline = "own",
            .options = experiments::options_of<pbs::PbsOptions>(experiments::spec_of(twisted().scene, "pbs"))};
}

TEST(ReadingSections, AreTwoFiguresAPoseThatTheReadingChanges)
{
    Reading either = own();
    either.blended_bones = experiments::BlendedBones::either_end;
    const auto all = values_of_sections(twisted(), {own(), either});
    ASSERT_EQ(all[0].values.size(), 4u);
    ASSERT_EQ(all[1].values.size(), 4u);
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(all[0].values[i].claim, "C04");
        EXPECT_EQ(all[0].values[i].of, all[1].values[i].of);
        EXPECT_NE(all[0].values[i].value, all[1].values[i].value);
    }
}

TEST(ReadingSections, OfAReadingThatBreaksDownAreNone)
{
    Reading falling = own();
    falling.options.jiggle = pbs::Jiggle{};
    falling.options.gravity_m_s2.y() = -std::numeric_limits<double>::infinity();
    const auto all = values_of_sections(twisted(), {own(), falling});
    EXPECT_FALSE(all[0].broke_down);
    EXPECT_TRUE(all[1].broke_down);
    EXPECT_TRUE(all[1].values.empty());
}

}  // namespace
