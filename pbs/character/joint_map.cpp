#include "pbs/character/joint_map.hpp"

namespace pbs {
namespace {

void add_side(std::vector<JointMapping>& map, const std::string& side, const std::string& joint_prefix)
{
    const auto joint = [&](const char* name) { return joint_prefix + name; };
    map.push_back({"clavicle" + side, joint("Shoulder")});
    map.push_back({"upper_arm" + side, joint("Arm"), true});
    map.push_back({"forearm_upper" + side, joint("ForeArm"), true, false, joint("Hand"), 1.0 / 3.0});
    map.push_back({"forearm_lower" + side, joint("ForeArm"), true, false, joint("Hand"), 2.0 / 3.0});
    map.push_back({"hand" + side, joint("Hand"), true});
    map.push_back({"thigh" + side, joint("UpLeg"), true, true});
    map.push_back({"shin" + side, joint("Leg"), true, true});
    map.push_back({"foot" + side, joint("Foot"), true});
}

std::vector<JointMapping> make_cmu_map()
{
    std::vector<JointMapping> map = {
        {"pelvis", "Hips"}, {"spine", "LowerBack"}, {"chest", "Spine1"}, {"neck", "Neck"}, {"head", "Head"},
    };
    add_side(map, ".L", "Left");
    add_side(map, ".R", "Right");
    return map;
}

}  // namespace

const std::vector<JointMapping>& cmu_joint_map()
{
    static const std::vector<JointMapping> map = make_cmu_map();
    return map;
}

}  // namespace pbs
