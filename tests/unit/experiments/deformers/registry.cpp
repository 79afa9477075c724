// What every registered deformer must do. Reference: the contract of experiments/deformers/deformer.hpp, and of the keys that each kind
// declares.

#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/run.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

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
    // A hundred roundings of a body of 2 m in float.
    const double rounding_m = 100 * 0x1p-24 * 2.0;
};
INSTANTIATE_TEST_SUITE_P(Kind, EveryDeformer, testing::ValuesIn(kinds_without_tables()), [](const auto& one) { return one.param; });

TEST_P(EveryDeformer, StaysAtRestInTheRestPoseAndStatesFactsOnlyIfItHasFiniteElements)
{
    const auto deformer = at_rest(spec);
    EXPECT_EQ(deformer->positions(), rest);
    EXPECT_EQ(deformer->facts(), nullptr);
    EXPECT_TRUE(prescribed_vertices(*deformer).empty());
    EXPECT_EQ(&last_state(*deformer), &deformer->positions());
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

// Positions 1e5 sizes away have 17 bits less behind the point: a hundred of their roundings, and those at the origin.
TEST_P(EveryDeformer, DoesNotDependOnTheDistanceFromTheOrigin)
{
    const Eigen::RowVector3d far_m(0x1p17, -0x1p18, 0x1p16);
    pbs::Character moved = limb_of_tets();
    moved.mesh.rest.rowwise() += far_m;
    for (pbs::Bone& bone : moved.skeleton.bones) {
        bone.head += far_m.transpose();
        bone.tail += far_m.transpose();
    }
    moved.binding = pbs::bind_to_nearest_bone(moved.mesh.rest, moved.skeleton);
    const std::unique_ptr<Deformer> deformer = make_deformer(spec);
    deformer->reset(moved);
    for (const pbs::Pose& pose : pbs::joint_sweep(moved.skeleton, 1, pbs::Vec3::UnitZ(), 45.0, 4, 0.01).steps)
        EXPECT_EQ(deformer->advance(pose, 0.01).outcome, pbs::Outcome::finished);
    const pbs::Positions back = deformer->positions().rowwise() - far_m;
    EXPECT_LT(largest_distance(back, after(spec, sweep().steps)), rounding_m + 100 * 0x1p-53 * far_m.norm());
}

// A body of one tet is held by the springs and bones inside of it alone.
TEST_P(EveryDeformer, KeepsABodyOfOneTetAtRest)
{
    for (const double height_m : {0.3, 2.0}) {
        const pbs::TetMesh tet = {pbs::Positions{{-0.3, -0.2, -0.2}, {-0.3, 0.3, -0.2}, {-0.3, 0.0, 0.3}, {height_m - 0.3, 0.0, 0.0}},
                                  pbs::Tets{{0, 1, 2, 3}}};
        const pbs::Character character = test_support::character_of(test_support::two_bones_in(tet));
        const std::unique_ptr<Deformer> deformer = make_deformer(spec);
        deformer->reset(character);
        for (int frame = 0; frame < 3; ++frame)
            EXPECT_EQ(deformer->advance(pbs::Pose(2, Eigen::Isometry3d::Identity()), 0.01).outcome, pbs::Outcome::finished);
        EXPECT_LT(largest_distance(deformer->positions(), tet.rest), rounding_m) << height_m;
    }
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

// Another value of the key: within its range, or another choice.
std::string other_value(const SceneKey& key)
{
    const nlohmann::json now = nlohmann::json::parse(key.default_json.empty() ? "0.5" : key.default_json);
    if (!key.choices.empty()) return '"' + key.choices[nlohmann::json(key.choices.front()) == now ? 1 : 0] + '"';
    if (key.type == KeyType::boolean) return now.get<bool>() ? "false" : "true";
    if (key.type == KeyType::vec3) return "[1.0, 2.0, 3.0]";
    const double number = now.get<double>(), lowest = std::isfinite(key.range.lowest) ? key.range.lowest : 0.0;
    const double halfway = (number == lowest ? number + 1.0 : 0.5 * (number + lowest));
    const double other = halfway <= key.range.highest ? halfway : 0.5 * (key.range.highest + lowest);
    return key.type == KeyType::integer ? std::to_string(static_cast<int>(std::floor(other))) : nlohmann::json(other).dump();
}

// The values that a scene's text has for it, and values out of range.
std::vector<std::string> refused_values(const SceneKey& key)
{
    if (key.type == KeyType::text) return {"\"no_such_choice\"", "1"};
    std::vector<std::string> refused = {"\"a text\"", "[]"};
    if (key.type == KeyType::integer) refused.push_back("1.5");
    const auto& [lowest, highest] = key.range;
    if (std::isfinite(lowest)) refused.push_back(lowest == above_zero ? "0" : std::to_string(static_cast<int>(lowest) - 1));
    if (std::isfinite(highest)) refused.push_back(nlohmann::json(highest * 1.5 + 1.0).dump());
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

// A deformer added by another program: its own options and keys, in a scene, a frame and the records, without a change elsewhere.
// Reference: the specification in experiments/deformers/deformer_kind.hpp.

enum class Direction { up, down };

struct LiftOptions {
    double height_m = 0.5;
    int steps = 1;
    Direction direction = Direction::up;
    bool seen = false;
};

// The rest shape, lifted.
class Lift : public TimedDeformer {
public:
    explicit Lift(const LiftOptions& options) : options_(options) {}

private:
    void set_up(const pbs::Character& character) override { rest_ = character.mesh.rest; }
    pbs::StepSummary deform(const pbs::Pose&, double, pbs::Positions& x) override
    {
        const double height_m = options_.direction == Direction::up ? options_.height_m : -options_.height_m;
        x = rest_.rowwise() + Eigen::RowVector3d(0.0, height_m, 0.0);
        return {};
    }

    LiftOptions options_;
    pbs::Positions rest_;
};

}  // namespace

namespace experiments {

NAMED_OPTIONS(Direction, up, down)

}  // namespace experiments

namespace {

void register_lift()
{
    if (find_deformer_kind("lift")) return;
    DeformerKind kind =
        kind_of<Lift>("lift", "the rest shape, lifted",
                      OptionFields<LiftOptions>("lift")
                          .add("height_m", &LiftOptions::height_m, {.unit = "m", .range = {0, 10}, .meaning = "by how much"})
                          .add("steps", &LiftOptions::steps, {.range = {1}, .meaning = "how often"})
                          .add("direction", &LiftOptions::direction, {.meaning = "up or down"})
                          .record("seen", &LiftOptions::seen));
    kind.traits = [](const DeformerSpec& spec) { return DeformerTraits{.iterations = options_of<LiftOptions>(spec).steps}; };
    add_deformer_kind(kind);
}

const std::string scene_text = R"(schema = 1
[character]
body = "limb"
vertices = 400
[motion]
joint = "forearm"
angle_deg = 10
frames = 2
[deformers]
use = ["lbs", "lift"]
[output]
frames_every = 0
metrics = []
[lift]
height_m = 0.25
steps = 3
)";

class AddedDeformer : public testing::Test {
protected:
    AddedDeformer() { register_lift(); }

    Scene scene(const std::vector<std::string>& overrides = {}) const
    {
        return read_scene(folder.file("lift.toml", scene_text), overrides);
    }

    test_support::ScratchFolder folder;
};

TEST_F(AddedDeformer, ReadsItsOwnKeys)
{
    const LiftOptions options = options_of<LiftOptions>(scene({"lift.direction=down"}).deformers.at(1));
    EXPECT_EQ(options.height_m, 0.25);
    EXPECT_EQ(options.steps, 3);
    EXPECT_EQ(options.direction, Direction::down);
    EXPECT_EQ(options_if<LiftOptions>(scene().deformers.at(0)), nullptr);
    EXPECT_EQ(find_deformer_with<LiftOptions>(scene())->name, "lift");
}

TEST_F(AddedDeformer, DocumentsItsKeysAndRefusesOthersAndValuesOutOfRange)
{
    const SceneSchema schema = scene_schema();
    ASSERT_TRUE(schema.find("lift.height_m"));
    EXPECT_EQ(schema.find("lift.height_m")->default_json, "0.5");
    EXPECT_EQ(schema.find("lift.height_m")->rule(), "expected a number from 0 to 10");
    EXPECT_EQ(schema.find("lift.direction")->default_json, "\"up\"");
    EXPECT_EQ(schema.find("lift.direction")->rule(), "expected one of up, down");
    EXPECT_FALSE(schema.find("lift.seen"));  // only in the records
    for (const char* refused : {"lift.height_m=11", "lift.direction=left", "lift.hight_m=1"})
        EXPECT_THROW(scene({refused}), pbs::InputError) << refused;
}

TEST_F(AddedDeformer, RunsAndIsOnRecord)
{
    const std::string output = folder / "run";
    const Scene lifted = scene();
    run_scene(lifted, output);
    nlohmann::json run;
    std::ifstream(output + "/run.json") >> run;
    const nlohmann::json options = {{"height_m", 0.25}, {"steps", 3}, {"direction", "up"}, {"seen", false}};
    EXPECT_EQ(run["scene"]["runs"][1]["options"], options);
    EXPECT_EQ(run["scene"]["lift"]["direction"], "up");
    EXPECT_TRUE(run["state_hash"].contains("lift"));
    EXPECT_NE(run["state_hash"]["lift"], run["state_hash"]["lbs"]);
    std::ifstream metrics(output + "/metrics.csv");
    const std::string text((std::istreambuf_iterator<char>(metrics)), std::istreambuf_iterator<char>());
    EXPECT_NE(text.find("lift,lift,default,,f64,3,1,0,"), std::string::npos) << text;
}

}  // namespace
