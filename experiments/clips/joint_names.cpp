// The joint of a clip that moves each bone, by the names that clips and models give to the joints of a body
// (joint_names.csv).
#include "experiments/clips/clip.hpp"
#include "generated/clip_data_texts.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace pbs {
namespace {

enum class PartKind { trunk, girdle, limb, leg };  // all but the trunk have two sides

struct BodyPart {
    std::string_view name;  // of its column in joint_names.csv
    PartKind kind;
    int next = 0;              // its limb ends at the part so many rows below; 0: none
    double twist_share = 0.0;  // of the twist of that part, for the bodies by name
};

// CMU keeps the twist of the forearm in the wrist. Three joints can carry it here, elbow, mid-forearm and wrist; equal
// steps of a third at each keep the largest step least: 1/3 on the upper half, 2/3 on the lower half, all of it on the
// hand.
constexpr BodyPart body_parts[] = {
    {"pelvis", PartKind::trunk},
    {"spine", PartKind::trunk},
    {"middle_spine", PartKind::trunk},
    {"chest", PartKind::trunk},
    {"upper_chest", PartKind::trunk},
    {"neck", PartKind::trunk},
    {"upper_neck", PartKind::trunk},
    {"head", PartKind::trunk},
    {"clavicle", PartKind::girdle},
    {"upper_arm", PartKind::limb, 1},
    {"forearm_upper", PartKind::limb, 2, 1.0 / 3.0},
    {"forearm_lower", PartKind::limb, 1, 2.0 / 3.0},
    {"hand", PartKind::limb},
    {"thigh", PartKind::leg, 1},
    {"shin", PartKind::leg, 1},
    {"foot", PartKind::limb, 1},
    {"toes", PartKind::limb},
};
constexpr int parts = static_cast<int>(std::size(body_parts));

constexpr int chest_row = 3, neck_row = 5, head_row = 7, upper_arm_row = 9, forearm_row = 10, hand_row = 12,
              thigh_row = 13, shin_row = 14, foot_row = 15;

// Words in the names of joints that a body may lack without being another one: fingers, toes, the face, twists, goals
// of kinematics.
const std::set<std::string> small_parts = {"finger", "fingers", "thumb",      "index", "middle", "ring",
                                           "pinky",  "little",  "metacarpal", "palm",  "toe",    "toes",
                                           "ball",   "eye",     "jaw",        "twist", "ik"};

// Words that rigs put in front of all their joints: Rigify, Mixamo, 3ds Max, Character Creator, VRoid, Source, SMPL's
// averages.
const std::set<std::string> rig_prefixes = {"def", "org",  "bip", "bip01",      "bip001",
                                            "cc",  "base", "j",   "valvebiped", "avg"};

struct JointKey {
    std::string stem;  // in lower case without separators, side, namespace and prefix of a rig
    char side = ' ';   // l, r, or ' ' for none
    bool is_small = false;
};

// In lower case, at separators and at capitals: LHipJoint -> l, hip, joint. A namespace ends with a colon.
std::vector<std::string> words_in_name(const std::string& name)
{
    const auto byte = [&](std::size_t at) -> unsigned char { return at < name.size() ? name[at] : '\0'; };
    std::vector<std::string> words(1);
    const std::size_t first = name.find_last_of(":|") + 1;
    for (std::size_t at = first; at < name.size(); ++at) {
        const bool separates = byte(at) < 128 && !std::isalnum(byte(at));
        const bool begins =
            std::isupper(byte(at)) && at > first && (!std::isupper(byte(at - 1)) || std::islower(byte(at + 1)));
        if ((separates || begins) && !words.back().empty()) words.emplace_back();
        if (!separates) words.back() += static_cast<char>(std::tolower(byte(at)));
    }
    return words;
}

bool is_small_part(const std::string& word)
{
    return small_parts.count(word.substr(0, word.find_last_not_of("0123456789") + 1)) > 0;
}

using PartNames = std::array<std::vector<std::string>, parts>;  // a scheme: the names of each part

std::vector<std::string> cells_of(const std::string& row)
{
    std::vector<std::string> cells(1);
    for (const char c : row)
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    return cells;
}

// The table of joint_names.csv, of which the first scheme is that of the bodies by name.
std::vector<PartNames> read_schemes()
{
    std::vector<PartNames> read;
    std::istringstream table(clip_data::joint_names_csv);
    for (std::string row; std::getline(table, row);) {
        if (row.starts_with('#')) continue;
        const std::vector<std::string> cells = cells_of(row);
        if (cells.size() != parts + 1) throw std::logic_error("joint_names.csv: expected a cell for each part: " + row);
        if (cells[0] == "scheme") {
            for (int part = 0; part < parts; ++part)
                if (cells[part + 1] != body_parts[part].name)
                    throw std::logic_error("joint_names.csv: unexpected column " + cells[part + 1]);
            continue;
        }
        if (!cells[0].empty()) read.emplace_back();
        for (int part = 0; part < parts; ++part)
            if (!cells[part + 1].empty()) read.back()[part].push_back(cells[part + 1]);
    }
    return read;
}

constexpr int scheme_of_bodies = 0;

const std::vector<PartNames>& schemes()
{
    static const std::vector<PartNames> read = read_schemes();
    return read;
}

bool is_called(const PartNames& scheme, int part, const std::string& stem)
{
    return std::ranges::find(scheme[part], stem) != scheme[part].end();
}

bool has_two_sides(const std::string& stem)
{
    return is_small_part(stem) || std::ranges::any_of(schemes(), [&](const PartNames& scheme) {
               for (int part = 0; part < parts; ++part)
                   if (body_parts[part].kind != PartKind::trunk && is_called(scheme, part, stem)) return true;
               return false;
           });
}

bool is_side(const std::string& word)
{
    return word == "l" || word == "r" || word == "left" || word == "right";
}

bool is_number(const std::string& word)
{
    return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
}

// mixamorig:LeftUpLeg, DEF-up_leg.l, R_UpLeg and rupleg are all "upleg" of a side.
JointKey key_of(const std::vector<std::string>& words)
{
    JointKey key;
    bool is_prefix = true;
    for (std::size_t w = 0; w < words.size(); ++w) {
        const std::string& word = words[w];
        is_prefix = is_prefix && w + 1 < words.size() && (rig_prefixes.contains(word) || word.starts_with("mixamorig"));
        if (is_prefix) continue;
        if (is_side(word))
            key.side = word[0];
        else if (word != "c" || w + 1 == words.size())  // VRoid's centre
            key.stem += word;
        key.is_small = key.is_small || is_small_part(word);
    }
    for (const std::string side : {"left", "right", "l", "r"})
        if (key.side == ' ' && key.stem.starts_with(side) && has_two_sides(key.stem.substr(side.size())))
            key = {key.stem.substr(side.size()), side[0], key.is_small || is_small_part(key.stem.substr(side.size()))};
    return key;
}

// Without what exporters add to all names, the words that most of them begin with and the number that most of them end
// with (Model_Hips, Hips_01): of two thirds of the names, end sites aside, and of four or more. Names that would become
// equal keep their numbers.
std::vector<JointKey> keys_of(const std::vector<std::string>& names)
{
    using Words = std::vector<std::string>;
    std::vector<Words> words;
    for (const std::string& name : names) words.push_back(words_in_name(name));
    const auto is_common = [&](auto has) {
        std::size_t with = 0, joints = 0;
        for (std::size_t n = 0; n < names.size(); ++n) {
            if (names[n].starts_with("EndSite_")) continue;
            ++joints;
            with += words[n].size() > 1 && has(words[n]);
        }
        return with >= 4 && 3 * with >= 2 * joints;
    };
    const auto ends_with_number = [](const Words& name) { return is_number(name.back()); };
    if (is_common(ends_with_number)) {
        std::vector<Words> shorter = words;
        for (Words& name : shorter)
            if (name.size() > 1 && ends_with_number(name)) name.pop_back();
        if (std::set<Words>(shorter.begin(), shorter.end()).size() ==
            std::set<Words>(words.begin(), words.end()).size())
            words = shorter;
    }
    for (std::size_t n = 0; n < words.size(); ++n) {  // the first word of each name may be that of most
        const std::string first = words[n].front();
        const auto begins_with_it = [&](const Words& name) { return name.front() == first; };
        if (words[n].size() < 2 || is_side(first) || !is_common(begins_with_it)) continue;
        for (Words& name : words)
            if (name.size() > 1 && begins_with_it(name)) name.erase(name.begin());
        n = static_cast<std::size_t>(-1);
    }
    std::vector<JointKey> keys;
    for (const Words& name : words) keys.push_back(key_of(name));
    return keys;
}

// The row of body_parts; -1: none.
int part_of(const JointKey& key, int scheme)
{
    if (scheme < 0) return -1;
    for (int part = 0; part < parts; ++part)
        if (is_called(schemes()[scheme], part, key.stem) &&
            (key.side != ' ') == (body_parts[part].kind != PartKind::trunk))
            return part;
    return -1;
}

// The scheme that knows most of the names, thighs and shins among them; -1: none.
int scheme_of(const std::vector<JointKey>& keys)
{
    int scheme = -1;
    std::size_t most = 0;
    for (int s = 0; s < static_cast<int>(schemes().size()); ++s) {
        std::multiset<int> parts;
        for (const JointKey& key : keys) parts.insert(part_of(key, s));
        const std::size_t known = parts.size() - parts.count(-1);
        if (known <= most || parts.count(thigh_row) == 0 || parts.count(shin_row) == 0) continue;
        most = known;
        scheme = s;
    }
    return scheme;
}

int joint_with(const std::vector<JointKey>& keys, std::string_view stem, char side)
{
    const auto found =
        std::ranges::find_if(keys, [&](const JointKey& key) { return key.stem == stem && key.side == side; });
    return stem.empty() || found == keys.end() ? -1 : static_cast<int>(found - keys.begin());
}

// The joint of a part of the body; -1: none. Of a part with several names, the first one that occurs.
int joint_of_part(const std::vector<JointKey>& keys, int row, int scheme, char side)
{
    if (scheme < 0) return -1;
    for (const std::string& name : schemes()[scheme][row])
        if (const int joint = joint_with(keys, name, side); joint >= 0) return joint;
    return -1;
}

BodyJoints joints_of_scheme(const std::vector<JointKey>& keys, int scheme)
{
    BodyJoints body;
    const auto joint = [&](int row, char side) { return joint_of_part(keys, row, scheme, side); };
    body.chest = joint(chest_row, ' ');
    body.neck = joint(neck_row, ' ');
    body.head = joint(head_row, ' ');
    for (const auto& [s, side] : {std::pair(0, 'l'), std::pair(1, 'r')}) {
        body.upper_arm[s] = joint(upper_arm_row, side);
        body.forearm[s] = joint(forearm_row, side);
        body.hand[s] = joint(hand_row, side);
        body.thigh[s] = joint(thigh_row, side);
        body.shin[s] = joint(shin_row, side);
        body.foot[s] = joint(foot_row, side);
    }
    return body;
}

std::vector<std::string> known_names(const Clip& clip)
{
    std::vector<std::string> names = clip.joints;
    for (std::size_t j = 0; j < clip.body_parts.size(); ++j)
        if (!clip.body_parts[j].empty()) names[j] = clip.body_parts[j];
    return names;
}

// What a name means decides between schemes: the hip of one is the thigh of another. Parts of the trunk are told apart
// by their names alone.
bool is_same_part(int part_of_bone, int part_of_joint)
{
    const auto is_trunk = [](int row) { return row >= 0 && body_parts[row].kind == PartKind::trunk; };
    return part_of_joint < 0 || part_of_bone == part_of_joint ||
           (is_trunk(part_of_joint) && (part_of_bone < 0 || is_trunk(part_of_bone)));
}

bool is_below(const std::vector<int>& parent, int joint, int above)
{
    while (joint >= 0 && joint != above) joint = parent[joint];
    return joint >= 0;
}

// Bones of a limb without a joint between two that have one, or below one, whose own joint the clip has under another
// name: it moves between (or below) theirs, on the same side, and no bone follows it.
std::vector<std::string> torn_limbs(const Clip& clip, const Skeleton& skeleton, const JointMap& map,
                                    const std::vector<JointKey>& joints, const std::vector<JointKey>& bones, int own)
{
    std::set<int> followed;
    for (const JointMapping& mapping : map.bones) followed.insert({mapping.joint, mapping.twist_joint});
    std::vector<int> bone_parent;
    for (const Bone& bone : skeleton.bones) bone_parent.push_back(bone.parent);
    std::vector<std::string> torn;
    for (int b = 0; b < static_cast<int>(bones.size()); ++b) {
        if (map.bones[b].joint >= 0 || bones[b].side == ' ' || bones[b].is_small) continue;
        int above = skeleton.bones[b].parent, below = -1;
        while (above >= 0 && map.bones[above].joint < 0) above = skeleton.bones[above].parent;
        for (int other = b + 1; other < static_cast<int>(bones.size()) && below < 0; ++other)
            if (map.bones[other].joint >= 0 && !bones[other].is_small && is_below(bone_parent, other, b)) below = other;
        const int part = part_of(bones[b], own);
        const bool is_lower_half = part == forearm_row || part == forearm_row + 1 || part == shin_row;
        if (above < 0 || (below < 0 && !is_lower_half)) continue;
        for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
            const bool is_between =
                j != map.bones[above].joint && is_below(clip.parent, j, map.bones[above].joint) &&
                (below < 0 || (j != map.bones[below].joint && is_below(clip.parent, map.bones[below].joint, j)));
            if (!is_between || followed.contains(j) || joints[j].is_small ||
                !joint_moves(clip, static_cast<std::size_t>(j)))
                continue;
            torn.push_back(skeleton.bones[b].name + " (its joint may be " + clip.joints[j] + ")");
            break;
        }
    }
    return torn;
}

}  // namespace

BodyJoints body_joints(const Clip& clip)
{
    const std::vector<JointKey> keys = keys_of(known_names(clip));
    return joints_of_scheme(keys, scheme_of(keys));
}

JointMap joint_map(const Clip& clip, const Skeleton& skeleton)
{
    std::vector<std::string> bone_names, own_names;
    for (const Bone& bone : skeleton.bones) {
        own_names.push_back(bone.name);
        bone_names.push_back(bone.body_part.empty() ? bone.name : bone.body_part);
    }
    const std::vector<JointKey> own_joints = keys_of(clip.joints), own_bones = keys_of(own_names);  // without tables
    const std::vector<JointKey> joints = keys_of(known_names(clip)), bones = keys_of(bone_names);
    const int own = scheme_of(bones), of_clip = scheme_of(joints);
    const bool is_known = own >= 0 && of_clip >= 0, by_parts = is_known && own != of_clip;
    JointMap map;
    map.of_clip = joints_of_scheme(joints, of_clip);
    map.of_skeleton = joints_of_scheme(bones, own);
    for (std::size_t b = 0; b < bones.size(); ++b) {
        JointMapping mapping;
        const int part = is_known ? part_of(bones[b], own) : -1;
        const auto joint_of = [&](int row) { return joint_of_part(joints, row, of_clip, bones[b].side); };
        const auto is_taken = [&](int joint) {
            return joint >= 0 && (!by_parts || is_same_part(part, part_of(joints[joint], of_clip)));
        };
        const auto same = std::ranges::find(clip.joints, skeleton.bones[b].name);
        const int equal = same == clip.joints.end() ? -1 : static_cast<int>(same - clip.joints.begin());
        int alike = joint_with(joints, bones[b].stem, bones[b].side);
        if (alike < 0) alike = joint_with(own_joints, own_bones[b].stem, own_bones[b].side);
        if (is_taken(equal))
            mapping.joint = equal;
        else if (by_parts && part >= 0)
            mapping.joint = joint_of(part);
        else if (is_taken(alike) && (!by_parts || part_of(joints[alike], of_clip) < 0))
            mapping.joint = alike;
        mapping.aligned = mapping.joint >= 0 && std::ranges::count(clip.parent, mapping.joint) == 1;
        if (part >= 0) {
            const BodyPart& of = body_parts[part];
            mapping.leg = of.kind == PartKind::leg;
            if (of.next > 0) mapping.limb_end = joint_of(part + of.next);
            if (by_parts) mapping.aligned = of.kind >= PartKind::limb;
            if (mapping.limb_end >= 0) mapping.aligned = true;
            if (by_parts && own == scheme_of_bodies && of.twist_share > 0.0) mapping.twist_joint = mapping.limb_end;
            mapping.twist_share = of.twist_share;
        }
        map.bones.push_back(mapping);
    }
    for (const JointKey& joint : joints) map.is_small.push_back(is_known && joint.is_small);
    map.torn = torn_limbs(clip, skeleton, map, joints, bones, own);
    return map;
}

}  // namespace pbs
