// The movements of scenes/movements.toml, and the motion that carries a body through them.
#include "analysis/records/toml_keys.hpp"
#include "experiments/scene/movements.hpp"
#include "generated/movements_texts.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <set>

namespace experiments {
namespace {

constexpr const char* file_name = "movements.toml";

struct Movement {
    std::string name, source;
    std::vector<std::string> joints;
    std::string axis_name;       // along, along_parent, across
    std::vector<double> axis;    // or the direction
    bool perpendicular = false;  // of the direction, only the part across the bone counts
    std::string start = "rest";  // rest, straight, hanging: where to_deg is counted from
    double to_deg = 0.0;
};

struct MovementTable {
    std::vector<Movement> movements;
    std::vector<std::vector<std::string>> pairs;
};

Movement read_movement(const toml::table& table, const std::string& file)
{
    Movement read;
    analysis::TomlKeys keys(table, file, "movement");
    keys.required("name", read.name);
    keys.required("source", read.source);
    keys.required("joints", read.joints);
    if (const toml::node* axis = keys.node("axis"); axis && axis->is_array())
        keys.required("axis", read.axis);
    else
        keys.required("axis", read.axis_name);
    keys.optional("perpendicular", read.perpendicular);
    keys.optional("start", read.start);
    keys.required("to_deg", read.to_deg);
    keys.require_nothing_unknown();
    if (read.joints.empty()) keys.refuse("joints", "expected at least one joint");
    static const std::set<std::string> axes = {"along", "along_parent", "across"},
                                       starts = {"rest", "straight", "hanging"};
    if (read.axis.size() != 3 && !axes.contains(read.axis_name))
        keys.refuse("axis", "expected three numbers, along, along_parent or across");
    if (!starts.contains(read.start)) keys.refuse("start", "expected rest, straight or hanging");
    return read;
}

const MovementTable& table()
{
    static const MovementTable read = [] {
        MovementTable read_tables;
        const std::string file = file_name;
        const toml::table document =
            analysis::parse_toml_document(movements::movements_toml, file, {"movement", "pair"});
        for (const toml::table* entry : analysis::toml_tables(document, "movement", file))
            read_tables.movements.push_back(read_movement(*entry, file));
        for (const toml::table* entry : analysis::toml_tables(document, "pair", file)) {
            analysis::TomlKeys keys(*entry, file, "pair");
            keys.required("of", read_tables.pairs.emplace_back());
            keys.require_nothing_unknown();
            for (const std::string& name : read_tables.pairs.back())
                if (std::ranges::count(read_tables.movements, name, &Movement::name) == 0)
                    keys.refuse("of", "expected movements of this file");
        }
        return read_tables;
    }();
    return read;
}

pbs::Vec3 direction_of(const pbs::Bone& bone)
{
    return (bone.tail - bone.head).normalized();
}

double angle_rad(const pbs::Vec3& one, const pbs::Vec3& other)
{
    return std::atan2(one.cross(other).norm(), one.dot(other));
}

// A movement of a skeleton, from the rest pose to the end of the range.
struct Turn {
    pbs::Vec3 axis;
    double of_joint_rad = 0.0;
    // from rest to where the range begins, before the turn about the axis
    Eigen::AngleAxisd to_start{0.0, pbs::Vec3::UnitX()};
    std::vector<int> joints;

    // Each joint has this rotation relative to its parent when the given fraction of the movement is done.
    Eigen::Quaterniond rotation(double fraction) const
    {
        return Eigen::AngleAxisd(fraction * of_joint_rad, axis) *
               Eigen::AngleAxisd(fraction * to_start.angle(), to_start.axis());
    }
};

// The axis need not be a unit vector.
pbs::Vec3 axis_of(const Movement& movement, const pbs::Vec3& parent, const pbs::Vec3& along)
{
    if (movement.axis_name == "along") return along;
    if (movement.axis_name == "along_parent") return parent;
    if (movement.axis_name == "across") return parent.cross(along);
    const pbs::Vec3 stated = pbs::Vec3::Map(movement.axis.data());
    return movement.perpendicular ? pbs::Vec3(stated - stated.dot(along) * along) : stated;
}

// InputError where the limb is straight at rest, so that its two bones define no axis.
Turn turn_of(const Movement& movement, const pbs::Skeleton& skeleton, const std::string& scene_file)
{
    constexpr double straight = 0.02;  // sine of the angle between two bones
    Turn turn;
    for (const std::string& joint : movement.joints) turn.joints.push_back(pbs::find_bone(skeleton, joint));
    const pbs::Bone& bone = skeleton.bones[turn.joints.front()];
    const pbs::Vec3 along = direction_of(bone),
                    parent = bone.parent < 0 ? along : direction_of(skeleton.bones[bone.parent]);
    turn.axis = axis_of(movement, parent, along);
    if (turn.axis.norm() < straight)
        throw pbs::InputError(
            scene_file, 0, "motion.movements", movement.name,
            fmt::format("expected a character that is bent at the joint {} at rest, since this is the axis",
                        bone.name));
    turn.axis.normalize();
    double angle = movement.to_deg * std::numbers::pi / 180.0;
    if (movement.start == "straight") angle -= angle_rad(parent, along);
    if (movement.start == "hanging") turn.to_start = Eigen::Quaterniond::FromTwoVectors(along, -pbs::Vec3::UnitY());
    turn.of_joint_rad = angle / static_cast<double>(turn.joints.size());
    return turn;
}

bool has_joints(const pbs::Skeleton& skeleton, const Movement& movement)
{
    return std::ranges::all_of(movement.joints,
                               [&](const std::string& joint) { return pbs::find_bone(skeleton, joint) >= 0; });
}

// The movements of A+B. InputError for a name that is not in the table.
std::vector<const Movement*> parts_of(const std::string& name, const std::string& scene_file)
{
    std::vector<const Movement*> parts;
    for (std::size_t from = 0, plus = 0; plus != std::string::npos; from = plus + 1) {
        plus = name.find('+', from);
        const std::string single = name.substr(from, plus - from);
        const auto found = std::ranges::find(table().movements, single, &Movement::name);
        if (found != table().movements.end()) {
            parts.push_back(&*found);
            continue;
        }
        std::vector<std::string> names;
        for (const Movement& known : table().movements) names.push_back(known.name);
        throw pbs::InputError(
            scene_file, 0, "motion.movements", single,
            "no such movement; the nearest is '" + pbs::nearest_name(single, names) + "' (`pbskin list movements`)");
    }
    return parts;
}

std::vector<Turn> turns_of(const std::string& name, const pbs::Skeleton& skeleton, const std::string& scene_file)
{
    std::vector<Turn> turns;
    for (const Movement* movement : parts_of(name, scene_file)) {
        if (!has_joints(skeleton, *movement))
            throw pbs::InputError(
                scene_file, 0, "motion.movements", movement->name,
                fmt::format("expected a character with the joints {}", fmt::join(movement->joints, ", ")));
        turns.push_back(turn_of(*movement, skeleton, scene_file));
    }
    return turns;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> listed_movements()
{
    std::vector<std::pair<std::string, std::string>> listed;
    for (const Movement& movement : table().movements)
        listed.emplace_back(movement.name,
                            fmt::format("{} to {} degrees (source: {})", fmt::join(movement.joints, ", "),
                                        movement.to_deg, movement.source));
    for (const auto& pair : table().pairs) listed.emplace_back(fmt::format("{}", fmt::join(pair, "+")), "both at once");
    return listed;
}

std::vector<std::string> joints_of(const std::string& movement)
{
    std::vector<std::string> joints;
    for (const Movement* part : parts_of(movement, ""))
        joints.insert(joints.end(), part->joints.begin(), part->joints.end());
    return joints;
}

bool is_twist(const std::string& movement)
{
    return std::ranges::all_of(parts_of(movement, ""),
                               [](const Movement* part) { return part->axis_name.starts_with("along"); });
}

std::vector<std::string> movements_of(const pbs::Skeleton& skeleton)
{
    std::vector<std::string> names;
    for (const Movement& movement : table().movements)
        if (has_joints(skeleton, movement)) names.push_back(movement.name);
    for (const auto& pair : table().pairs)
        if (std::ranges::all_of(pair, [&](const std::string& name) { return std::ranges::count(names, name) > 0; }))
            names.push_back(fmt::format("{}", fmt::join(pair, "+")));
    return names;
}

pbs::Motion through_movements(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file)
{
    const int steps_per_frame = pbs::steps_per_frame(sampling_of(spec)), steps = spec.frames * steps_per_frame;
    const pbs::Pose rest(skeleton.bones.size(), Eigen::Isometry3d::Identity());
    pbs::Motion motion{.steps = {rest}, .time_step_s = spec.time_step_s, .steps_per_frame = steps_per_frame};
    for (const std::string& name : spec.movements) {
        const std::vector<Turn> turns = turns_of(name, skeleton, scene_file);
        for (int step = 1; step <= steps; ++step) {
            std::vector<Eigen::Quaterniond> local(skeleton.bones.size(), Eigen::Quaterniond::Identity());
            for (const Turn& turn : turns)
                for (const int joint : turn.joints)
                    local[joint] = local[joint] * turn.rotation(static_cast<double>(step) / steps);
            motion.steps.push_back(pbs::pose_from_joints(skeleton, local, pbs::Vec3::Zero()));
        }
    }
    return motion;
}

}  // namespace experiments
