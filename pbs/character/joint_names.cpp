// The names that clips and models give to the joints of a body, and the joint of a clip that moves each bone by them.
#include "pbs/character/clip.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

namespace pbs {
namespace {

enum class PartKind { trunk, girdle, limb, leg };  // all but the trunk have two sides

// A part of the body under its name in each scheme, in lower case without separators and side; "" where a scheme has no such joint.
struct BodyPart {
    PartKind kind;
    int next;            // its limb ends at the part so many rows below; 0: none
    double twist_share;  // of the twist of that part, for the bodies by name
    std::array<std::string_view, 7> names;
};

// The schemes are those of the bodies by name, of CMU's clips as BVH (cgspeed) and as ASF/AMC, of other recordings, of Mixamo, of Blender's
// Rigify and of Unreal's mannequin. CMU keeps the twist of the forearm in the wrist. Three joints can carry it here, elbow, mid-forearm and
// wrist; equal steps of a third at each keep the largest step least: 1/3 on the upper half, 2/3 on the lower half, all of it on the hand.
constexpr BodyPart body_parts[] = {
    {PartKind::trunk, 0, 0.0, {"pelvis", "hips", "root", "hips", "hips", "spine", "pelvis"}},
    {PartKind::trunk, 0, 0.0, {"spine", "lowerback", "lowerback", "ab", "spine", "spine001", "spine01"}},
    {PartKind::trunk, 0, 0.0, {"", "spine", "upperback", "", "spine1", "spine002", "spine02"}},
    {PartKind::trunk, 0, 0.0, {"chest", "spine1", "thorax", "chest", "spine2", "spine003", "spine03"}},
    {PartKind::trunk, 0, 0.0, {"neck", "neck", "lowerneck", "neck", "neck", "spine004", "neck01"}},
    {PartKind::trunk, 0, 0.0, {"", "neck1", "upperneck", "", "", "spine005", "neck02"}},
    {PartKind::trunk, 0, 0.0, {"head", "head", "head", "head", "head", "spine006", "head"}},
    {PartKind::girdle, 0, 0.0, {"clavicle", "shoulder", "clavicle", "collar", "shoulder", "shoulder", "clavicle"}},
    {PartKind::limb, 1, 0.0, {"upperarm", "arm", "humerus", "shoulder", "arm", "upperarm", "upperarm"}},
    {PartKind::limb, 2, 1.0 / 3.0, {"forearmupper", "forearm", "radius", "elbow", "forearm", "forearm", "lowerarm"}},
    {PartKind::limb, 1, 2.0 / 3.0, {"forearmlower", "forearm", "radius", "elbow", "forearm", "forearm", "lowerarm"}},
    {PartKind::limb, 0, 0.0, {"hand", "hand", "wrist", "wrist", "hand", "hand", "hand"}},
    {PartKind::leg, 1, 0.0, {"thigh", "upleg", "femur", "hip", "upleg", "thigh", "thigh"}},
    {PartKind::leg, 1, 0.0, {"shin", "leg", "tibia", "knee", "leg", "shin", "calf"}},
    {PartKind::limb, 1, 0.0, {"foot", "foot", "foot", "ankle", "foot", "foot", "foot"}},
    {PartKind::limb, 0, 0.0, {"", "toebase", "toes", "toes", "toebase", "toe", "ball"}},
};

constexpr int thigh = 12;  // row of body_parts; the shin follows

// Words in the names of joints that a body may lack without being another one: fingers, toes, the face, twists, goals of kinematics.
const std::set<std::string> small_parts = {"finger", "fingers", "thumb", "index", "middle", "ring", "pinky", "little", "metacarpal",
                                           "palm",   "toe",     "toes",  "ball",  "eye",    "jaw",  "twist", "ik"};

struct JointKey {
    std::string stem;  // in lower case without separators, side, namespace and prefix of a rig
    char side = ' ';   // l, r, or ' ' for none
    bool is_small = false;
};

// In lower case, at separators and at capitals: LHipJoint -> l, hip, joint. A namespace ends with a colon.
std::vector<std::string> words_of(const std::string& name)
{
    const auto byte = [&](std::size_t at) -> unsigned char { return at < name.size() ? name[at] : '\0'; };
    std::vector<std::string> words(1);
    const std::size_t first = name.find_last_of(":|") + 1;
    for (std::size_t at = first; at < name.size(); ++at) {
        const bool separates = byte(at) < 128 && !std::isalnum(byte(at));
        const bool begins = std::isupper(byte(at)) && at > first && (!std::isupper(byte(at - 1)) || std::islower(byte(at + 1)));
        if ((separates || begins) && !words.back().empty()) words.emplace_back();
        if (!separates) words.back() += static_cast<char>(std::tolower(byte(at)));
    }
    return words;
}

bool is_small_part(const std::string& word)
{
    return small_parts.count(word.substr(0, word.find_last_not_of("0123456789") + 1)) > 0;
}

bool has_two_sides(const std::string& stem)
{
    return is_small_part(stem) || std::ranges::any_of(body_parts, [&](const BodyPart& part) {
               return part.kind != PartKind::trunk && !stem.empty() && std::ranges::count(part.names, stem) > 0;
           });
}

// mixamorig:LeftUpLeg, DEF-up_leg.l, R_UpLeg and rupleg are all "upleg" of a side.
JointKey key_of(const std::string& name)
{
    JointKey key;
    const std::vector<std::string> words = words_of(name);
    for (std::size_t w = 0; w < words.size(); ++w) {
        const std::string& word = words[w];
        if (w == 0 && words.size() > 1 && (word == "def" || word == "org" || word.starts_with("mixamorig"))) continue;
        if (word == "l" || word == "r" || word == "left" || word == "right")
            key.side = word[0];
        else
            key.stem += word;
        key.is_small = key.is_small || is_small_part(word);
    }
    for (const std::string side : {"left", "right", "l", "r"})
        if (key.side == ' ' && key.stem.starts_with(side) && has_two_sides(key.stem.substr(side.size())))
            key = {key.stem.substr(side.size()), side[0], key.is_small || is_small_part(key.stem.substr(side.size()))};
    return key;
}

// The row of body_parts; -1: none.
int part_of(const JointKey& key, int scheme)
{
    const auto* found = std::ranges::find_if(body_parts, [&](const BodyPart& part) {
        return !key.stem.empty() && key.stem == part.names[scheme] && (key.side != ' ') == (part.kind != PartKind::trunk);
    });
    return found == std::end(body_parts) ? -1 : static_cast<int>(found - body_parts);
}

// The scheme that knows most of the names, thighs and shins among them; -1: none.
int scheme_of(const std::vector<JointKey>& keys)
{
    int scheme = -1;
    std::size_t most = 0;
    for (int s = 0; s < static_cast<int>(body_parts[0].names.size()); ++s) {
        std::multiset<int> parts;
        for (const JointKey& key : keys) parts.insert(part_of(key, s));
        const std::size_t known = parts.size() - parts.count(-1);
        if (known <= most || parts.count(thigh) == 0 || parts.count(thigh + 1) == 0) continue;
        most = known;
        scheme = s;
    }
    return scheme;
}

int joint_with(const std::vector<JointKey>& joints, std::string_view stem, char side)
{
    const auto found = std::ranges::find_if(joints, [&](const JointKey& key) { return key.stem == stem && key.side == side; });
    return stem.empty() || found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

}  // namespace

JointMap joint_map(const Clip& clip, const Skeleton& skeleton)
{
    std::vector<JointKey> joints, bones;
    for (const std::string& name : clip.joints) joints.push_back(key_of(name));
    for (const Bone& bone : skeleton.bones) bones.push_back(key_of(bone.name));
    const int own = scheme_of(bones), of_clip = scheme_of(joints);
    const bool is_known = own >= 0 && of_clip >= 0, by_parts = is_known && own != of_clip;
    JointMap map;
    for (std::size_t b = 0; b < bones.size(); ++b) {
        JointMapping mapping;
        const int part = by_parts ? part_of(bones[b], own) : -1;
        const auto joint_of = [&](int row) { return joint_with(joints, body_parts[row].names[of_clip], bones[b].side); };
        if (part >= 0) {
            const BodyPart& of = body_parts[part];
            mapping = {.joint = joint_of(part), .aligned = of.kind >= PartKind::limb, .leg = of.kind == PartKind::leg};
            if (of.next > 0) mapping.limb_end = joint_of(part + of.next);
            if (own == 0 && of.twist_share > 0.0) mapping.twist_joint = mapping.limb_end;
            mapping.twist_share = of.twist_share;
        } else {
            const auto same = std::ranges::find(clip.joints, skeleton.bones[b].name);
            mapping.joint =
                same == clip.joints.end() ? joint_with(joints, bones[b].stem, bones[b].side) : static_cast<int>(same - clip.joints.begin());
            // The hip of one scheme is the thigh of another.
            if (by_parts && mapping.joint >= 0 && part_of(joints[mapping.joint], of_clip) >= 0) mapping.joint = -1;
            mapping.aligned = mapping.joint >= 0 && std::ranges::count(clip.parent, mapping.joint) == 1;
        }
        map.bones.push_back(mapping);
    }
    for (const JointKey& joint : joints) map.is_small.push_back(is_known && joint.is_small);
    return map;
}

}  // namespace pbs
