// A deformer added by another program: its own options and keys, in a scene, a frame and the records, without a change
// elsewhere. Reference: the specification in experiments/deformers/deformer_kind.hpp.

#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/run.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace {

using namespace experiments;

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
    DeformerKind kind = kind_of<Lift>(
        "lift", "the rest shape, lifted",
        OptionFields<LiftOptions>("lift")
            .add("height_m", &LiftOptions::height_m, {.unit = "m", .range = {0, 10}, .meaning = "by how much"})
            .add("steps", &LiftOptions::steps, {.range = {1}, .meaning = "how often"})
            .add("direction", &LiftOptions::direction, {.meaning = "up or down"})
            .record("seen", &LiftOptions::seen));
    kind.traits = [](const DeformerSpec& spec) {
        return DeformerTraits{.iterations = options_of<LiftOptions>(spec).steps};
    };
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
