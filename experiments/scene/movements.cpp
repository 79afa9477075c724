// The movements of scenes/movements.toml, and the motion that carries a body through them.
#include "analysis/records/toml_keys.hpp"
#include "experiments/scene/scene.hpp"
#include "generated/movements_texts.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>

namespace experiments {
namespace {

constexpr const char* file_name = "movements.toml";

struct Movement {
    std::string name, source;
    std::vector<std::string> joints;
    std::string axis_name, rest = "zero";  // along, along_parent, across; zero, straight, hanging
    std::vector<double> axis;              // or the direction
    double to_deg = 0.0;                   // from the anatomical position
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
    keys.optional("joints", read.joints);
    if (const toml::node* axis = keys.node("axis"); axis && axis->is_array())
        keys.required("axis", read.axis);
    else
        keys.required("axis", read.axis_name);
    keys.optional("rest", read.rest);
    keys.required("to_deg", read.to_deg);
    keys.require_nothing_unknown();
    return read;
}

const MovementTable& table()
{
    static const MovementTable read = [] {
        MovementTable all;
        const std::string file = file_name;
        const toml::table document = analysis::parse_toml_document(movements::movements_toml, file, {"movement", "pair"});
        for (const toml::table* one : analysis::toml_tables(document, "movement", file)) all.movements.push_back(read_movement(*one, file));
        for (const toml::node& pair : *document.get_as<toml::array>("pair")) {
            std::vector<std::string>& names = all.pairs.emplace_back();
            for (const toml::node& name : *pair.as_array()) names.push_back(*name.value<std::string>());
        }
        return all;
    }();
    return read;
}

pbs::Vec3 direction_of(const pbs::Bone& bone)
{
    return (bone.tail - bone.head).normalized();
}

double angle_deg(const pbs::Vec3& one, const pbs::Vec3& other)
{
    return std::atan2(one.cross(other).norm(), one.dot(other)) * 180.0 / std::numbers::pi;
}

// A movement of a skeleton, from the rest pose to the end of the range.
struct Turn {
    pbs::Vec3 axis;
    double of_joint_rad = 0.0;
    std::vector<int> joints;
};

Turn turn_of(const Movement& movement, const pbs::Skeleton& skeleton)
{
    Turn turn;
    for (const std::string& joint : movement.joints) turn.joints.push_back(pbs::find_bone(skeleton, joint));
    const pbs::Bone& bone = skeleton.bones[turn.joints.front()];
    const pbs::Vec3 along = direction_of(bone), parent = bone.parent < 0 ? along : direction_of(skeleton.bones[bone.parent]);
    double angle = movement.to_deg;
    if (movement.rest == "straight") angle -= angle_deg(parent, along);
    if (movement.rest == "hanging") angle -= angle_deg(-pbs::Vec3::UnitY(), along);
    turn.of_joint_rad = angle * std::numbers::pi / 180.0 / static_cast<double>(turn.joints.size());
    turn.axis = movement.axis_name == "along"          ? along
                : movement.axis_name == "along_parent" ? parent
                : movement.axis_name == "across"       ? parent.cross(along)
                                                       : pbs::Vec3::Map(movement.axis.data());
    turn.axis.normalize();
    return turn;
}

bool has_joints(const pbs::Skeleton& skeleton, const Movement& movement)
{
    return std::ranges::all_of(movement.joints, [&](const std::string& joint) { return pbs::find_bone(skeleton, joint) >= 0; });
}

// The movements of A+B. InputError for a name that is not in the table.
std::vector<const Movement*> parts_of(const std::string& name, const std::string& scene_file)
{
    std::vector<const Movement*> parts;
    for (std::size_t from = 0, plus = 0; plus != std::string::npos; from = plus + 1) {
        plus = name.find('+', from);
        const std::string one = name.substr(from, plus - from);
        const auto found = std::ranges::find(table().movements, one, &Movement::name);
        if (found != table().movements.end()) {
            parts.push_back(&*found);
            continue;
        }
        std::vector<std::string> names;
        for (const Movement& known : table().movements) names.push_back(known.name);
        throw pbs::InputError(scene_file, 0, "motion.movements", one,
                              "no such movement; the nearest is '" + pbs::nearest_name(one, names) + "' (`pbskin list movements`)");
    }
    return parts;
}

std::vector<Turn> turns_of(const std::string& name, const pbs::Skeleton& skeleton, const std::string& scene_file)
{
    std::vector<Turn> turns;
    for (const Movement* movement : parts_of(name, scene_file)) {
        if (!has_joints(skeleton, *movement))
            throw pbs::InputError(scene_file, 0, "motion.movements", movement->name,
                                  fmt::format("expected a character with the joints {}", fmt::join(movement->joints, ", ")));
        turns.push_back(turn_of(*movement, skeleton));
    }
    return turns;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> listed_movements()
{
    std::vector<std::pair<std::string, std::string>> listed;
    for (const Movement& one : table().movements)
        listed.emplace_back(one.name, fmt::format("{} to {} degrees (source: {})", fmt::join(one.joints, ", "), one.to_deg, one.source));
    for (const auto& pair : table().pairs) listed.emplace_back(fmt::format("{}", fmt::join(pair, "+")), "both at once");
    return listed;
}

std::vector<std::string> joints_of(const std::string& movement)
{
    std::vector<std::string> joints;
    for (const Movement* part : parts_of(movement, "")) joints.insert(joints.end(), part->joints.begin(), part->joints.end());
    return joints;
}

bool is_twist(const std::string& movement)
{
    return std::ranges::all_of(parts_of(movement, ""), [](const Movement* part) { return part->axis_name.starts_with("along"); });
}

std::vector<std::string> movements_of(const pbs::Skeleton& skeleton)
{
    std::vector<std::string> names;
    for (const Movement& one : table().movements)
        if (has_joints(skeleton, one)) names.push_back(one.name);
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
                    local[joint] = Eigen::AngleAxisd(turn.of_joint_rad * step / steps, turn.axis) * local[joint];
            motion.steps.push_back(pbs::pose_from_joints(skeleton, local, pbs::Vec3::Zero()));
        }
    }
    return motion;
}

}  // namespace experiments
