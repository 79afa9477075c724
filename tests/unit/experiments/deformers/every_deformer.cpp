// What every registered deformer must do. Reference: the contract of experiments/deformers/deformer.hpp, and of the keys that each kind
// declares.
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

const pbs::Character& limb_of_tets()
{
    static const pbs::Character character = test_support::bar_character({8, 2, 2});
    return character;
}

pbs::Motion sweep()
{
    return pbs::joint_sweep(limb_of_tets().skeleton, 1, pbs::Vec3::UnitZ(), 45.0, 4, 0.01);
}

std::unique_ptr<Deformer> at_rest(const DeformerSpec& spec)
{
    std::unique_ptr<Deformer> deformer = make_deformer(spec);
    deformer->reset(limb_of_tets());
    return deformer;
}

pbs::Positions after(const DeformerSpec& spec, const std::vector<pbs::Pose>& poses)
{
    const auto deformer = at_rest(spec);
    for (const pbs::Pose& pose : poses) {
        const pbs::StepSummary step = deformer->advance(pose, 0.01);
        EXPECT_EQ(step.outcome, pbs::Outcome::finished) << spec.kind;
        EXPECT_GE(step.seconds, 0.0) << spec.kind;
        EXPECT_TRUE(deformer->positions().allFinite()) << spec.kind;
    }
    return deformer->positions();
}

double largest_distance(const pbs::Positions& a, const pbs::Positions& b)
{
    return (a - b).rowwise().norm().maxCoeff();
}

std::vector<std::string> kinds_without_tables()
{
    std::vector<std::string> names;
    for (const DeformerKind& kind : deformer_kinds())
        if (!kind.needs_list) names.push_back(kind.name);
    return names;
}

class EveryDeformer : public testing::TestWithParam<std::string> {
protected:
    DeformerSpec spec = default_spec(GetParam());
    const pbs::Positions& rest = limb_of_tets().mesh.rest;
    // Of a body of 2 m, in float: a hundred roundings.
    const double rounding_m = 100 * 0x1p-24 * 2.0;
};
INSTANTIATE_TEST_SUITE_P(Kind, EveryDeformer, testing::ValuesIn(kinds_without_tables()), [](const auto& one) { return one.param; });

TEST_P(EveryDeformer, StaysAtRestInTheRestPose)
{
    EXPECT_EQ(at_rest(spec)->positions(), rest);
    EXPECT_LT(largest_distance(after(spec, {sweep().steps.front()}), rest), rounding_m);
}

// Every bone moves by the same rotation and translation.
TEST_P(EveryDeformer, FollowsARigidMotion)
{
    Eigen::Isometry3d motion(Eigen::AngleAxisd(0.7, pbs::Vec3(1.0, 2.0, -1.0).normalized()));
    motion.translation() = pbs::Vec3(0.2, -0.1, 0.4);
    const pbs::Pose pose(limb_of_tets().skeleton.bones.size(), motion);
    const pbs::Positions expected = (rest * motion.linear().transpose()).rowwise() + motion.translation().transpose();
    EXPECT_LT(largest_distance(after(spec, {pose}), expected), rounding_m);
}

TEST_P(EveryDeformer, RepeatsToTheBitAndWhateverTheThreads)
{
    const pbs::Positions once = after(spec, sweep().steps);
    EXPECT_NE(once, rest);
    EXPECT_EQ(after(spec, sweep().steps), once);
    const auto again = at_rest(spec);
    again->advance(sweep().steps.back(), 0.01);
    again->reset(limb_of_tets());
    EXPECT_EQ(again->positions(), rest) << "reset";
    spec.threads = 3;
    EXPECT_EQ(after(spec, sweep().steps), once);
}

TEST_P(EveryDeformer, StatesFactsOnlyIfItHasFiniteElements)
{
    const auto deformer = at_rest(spec);
    EXPECT_EQ(deformer->facts(), nullptr);
    EXPECT_TRUE(prescribed_vertices(*deformer).empty());
    EXPECT_EQ(&last_state(*deformer), &deformer->positions());
}

// Another value of the key: within its range, or another choice.
std::string other_value(const SceneKey& key)
{
    const nlohmann::json now = nlohmann::json::parse(key.default_json.empty() ? "0.5" : key.default_json);
    if (!key.choices.empty()) return '"' + key.choices[key.choices.front() == now ? 1 : 0] + '"';
    if (key.type == KeyType::boolean) return now.get<bool>() ? "false" : "true";
    if (key.type == KeyType::vec3) return "[1.0, 2.0, 3.0]";
    const double number = now.get<double>(), lowest = std::isfinite(key.lowest) ? key.lowest : 0.0;
    const double halfway = (number == lowest ? number + 1.0 : 0.5 * (number + lowest));
    const double other = halfway <= key.highest ? halfway : 0.5 * (key.highest + lowest);
    return key.type == KeyType::integer ? std::to_string(static_cast<int>(std::floor(other))) : nlohmann::json(other).dump();
}

// The values that a scene's text has for it, and values out of range.
std::vector<std::string> refused_values(const SceneKey& key)
{
    if (key.type == KeyType::text) return {"\"no_such_choice\"", "1"};
    std::vector<std::string> refused = {"\"a text\"", "[]"};
    if (key.type == KeyType::integer) refused.push_back("1.5");
    if (std::isfinite(key.lowest)) refused.push_back(key.lowest == above_zero ? "0" : std::to_string(static_cast<int>(key.lowest) - 1));
    if (std::isfinite(key.highest)) refused.push_back(nlohmann::json(key.highest * 1.5 + 1.0).dump());
    return refused;
}

Scene scene_with(const std::string& kind, const std::string& key_and_value)
{
    return read_scene("limb_bend", {"deformers.use=[\"" + kind + "\"]", "reference.name=\"\"", key_and_value});
}

// Every key of the kind's own table: its value reaches the options and the record, and values out of range are refused.
TEST_P(EveryDeformer, RecordsEachOfItsKeysAndRefusesValuesOutOfRange)
{
    const DeformerKind& kind = *find_deformer_kind(GetParam());
    for (const SceneKey& key : kind.keys) {
        if (key.in_list || key.table != kind.name) continue;  // tables within the table: scenes have them rarely
        for (const std::string& value : refused_values(key))
            EXPECT_THROW(scene_with(kind.name, key.path() + "=" + value), pbs::InputError) << key.path() << " = " << value;
        nlohmann::json by_default, changed;
        try {
            by_default = to_json(scene_with(kind.name, "deformers.use=[\"" + kind.name + "\"]").deformers.front());
            changed = to_json(scene_with(kind.name, key.path() + "=" + other_value(key)).deformers.front());
        } catch (const pbs::InputError&) {
            continue;  // it contradicts the default of another key
        }
        EXPECT_NE(changed, by_default) << key.path() << " = " << other_value(key);
    }
}

}  // namespace
