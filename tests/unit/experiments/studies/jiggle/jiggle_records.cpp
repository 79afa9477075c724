// Truth: a run is the result of all that can be asked of it, so that two runs that differ in anything have different settings on record.
#include "experiments/studies/jiggle/jiggle_records.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using experiments::JoltCase;
using experiments::read_scene;
using experiments::WalkCase;

TEST(JiggleRecords, JoltsThatDifferInAnythingHaveOtherSettings)
{
    const JoltCase first{read_scene("limb_twist", {}), {}, {{}}};
    std::vector<JoltCase> cases(9, first);
    cases[1].scene = read_scene("limb_twist", {"character.vertices=400"});
    cases[2].jolt.direction = pbs::Vec3::UnitX();
    cases[3].jolt.length_m = 0.03;
    cases[4].jolt.steps = 151;
    cases[5].jolt.still_steps = 3;
    cases[6].settings = {{.k_stretch = 0.3}};
    cases[7].settings = {{.masses = pbs::Masses::lumped}};
    cases[8].with_reference = true;
    std::set<std::string> different;
    for (const JoltCase& of : cases) different.insert(experiments::settings_of(of).dump());
    EXPECT_EQ(different.size(), cases.size());
    EXPECT_EQ(experiments::settings_of(first), experiments::settings_of(JoltCase(first)));
}

TEST(JiggleRecords, WalksThatDifferInAnythingHaveOtherSettings)
{
    std::vector<WalkCase> cases(4, WalkCase{read_scene("limb_twist", {}), {0.1}});
    cases[1].scene = read_scene("limb_twist", {"pbs.gravity_m_s2=[0.0,-1.0,0.0]"});
    cases[2].k_stretch = {0.1, 0.2};
    cases[3].still_steps = 99;
    std::set<std::string> different;
    for (const WalkCase& of : cases) different.insert(experiments::settings_of(of).dump());
    EXPECT_EQ(different.size(), cases.size());
}

}  // namespace
