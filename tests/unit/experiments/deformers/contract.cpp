// Every deformer keeps these promises. Reference: the contract of experiments/deformers/deformer.hpp, and of the keys
// that each kind declares. A kind of the registry joins by itself; finite elements, which need a table in the scene,
// are in `every_deformer`.

#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <map>

namespace {

using namespace experiments;

const pbs::Character& limb_of_tets()
{
    static const pbs::Character character = test_support::bar_character({8, 2, 2});
    return character;
}

std::vector<pbs::Pose> swept(double angle_deg = 45.0)
{
    return pbs::joint_sweep(limb_of_tets().skeleton, 1, pbs::Vec3::UnitZ(), angle_deg, 4, 0.01).steps;
}

std::unique_ptr<Deformer> at_rest(const DeformerSpec& spec, const pbs::Character& character = limb_of_tets())
{
    std::unique_ptr<Deformer> deformer = make_deformer(spec);
    deformer->reset(character);
    return deformer;
}

void play(Deformer& deformer, const std::vector<pbs::Pose>& poses)
{
    for (const pbs::Pose& pose : poses) {
        const pbs::StepSummary step = deformer.advance(pose, 0.01);
        EXPECT_EQ(step.outcome, pbs::Outcome::finished);
        EXPECT_GE(step.seconds, 0.0);
        EXPECT_TRUE(deformer.positions().allFinite());
    }
}

pbs::Positions after(const DeformerSpec& spec, const std::vector<pbs::Pose>& poses,
                     const pbs::Character& character = limb_of_tets())
{
    const auto deformer = at_rest(spec, character);
    play(*deformer, poses);
    return deformer->positions();
}

double largest_distance(const pbs::Positions& a, const pbs::Positions& b)
{
    return (a - b).rowwise().norm().maxCoeff();
}

Scene scene_with(const std::string& kind, const std::string& key_and_value)
{
    return read_scene("limb_bend", {"deformers.use=[\"" + kind + "\"]", "reference.name=\"\"", key_and_value});
}

DeformerSpec spec_of_fem(const std::string& name, reference_fem::Model model)
{
    DeformerSpec spec = default_spec("fem");
    spec.name = spec.label = name;
    options_of<FemOptions>(spec) = {.model = model, .element_order = 1};
    return spec;
}

std::map<std::string, DeformerSpec> every_deformer()
{
    std::map<std::string, DeformerSpec> specs = {
        {"fem_linear", spec_of_fem("fem_linear", reference_fem::Model::linear)},
        {"fem_neo_hookean", spec_of_fem("fem_neo_hookean", reference_fem::Model::stable_neo_hookean)}};
    for (const DeformerKind& kind : deformer_kinds())
        if (!kind.needs_list) specs[kind.name] = default_spec(kind.name);
    return specs;
}

std::vector<std::string> names_of_deformers()
{
    std::vector<std::string> names;
    for (const auto& [name, spec] : every_deformer()) names.push_back(name);
    return names;
}

class EveryDeformer : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override
    {
        try {
            make_deformer(spec);
        } catch (const pbs::InputError& not_built) {
            GTEST_SKIP() << not_built.what();
        }
    }

    bool is_fem() const { return spec.kind == "fem"; }

    bool has_key(const std::string& name) const
    {
        return std::ranges::count(find_deformer_kind(spec.kind)->keys, name, &SceneKey::name) > 0;
    }

    DeformerSpec spec = every_deformer().at(GetParam());
    const pbs::Positions& rest = limb_of_tets().mesh.rest;
    // A hundred roundings of a body of 2 m in float.
    const double rounding_m = 100 * 0x1p-24 * 2.0;
    // What an iteration to an equilibrium leaves depends on where it begins.
    const double same_pose_m = is_fem() ? rounding_m : 0.0;
};
INSTANTIATE_TEST_SUITE_P(Kind, EveryDeformer, testing::ValuesIn(names_of_deformers()),
                         [](const auto& one) { return one.param; });

TEST_P(EveryDeformer, StaysAtRestInTheRestPoseAndStatesFactsOnlyIfItHasFiniteElements)
{
    const auto deformer = at_rest(spec);
    EXPECT_EQ(deformer->positions(), rest);
    EXPECT_EQ(deformer->facts() != nullptr, is_fem());
    EXPECT_EQ(std::ranges::count(prescribed_vertices(*deformer), true), 0);
    EXPECT_TRUE(is_fem() || &last_state(*deformer) == &deformer->positions());
    EXPECT_LT(largest_distance(after(spec, {swept().front()}), rest), rounding_m);
}

// Every bone moves by the same rotation and translation.
TEST_P(EveryDeformer, FollowsARigidMotion)
{
    Eigen::Isometry3d motion(Eigen::AngleAxisd(0.7, pbs::Vec3(1.0, 2.0, -1.0).normalized()));
    motion.translation() = pbs::Vec3(0.2, -0.1, 0.4);
    const auto moved = [&](const pbs::Positions& points) -> pbs::Positions {
        return (points * motion.linear().transpose()).rowwise() + motion.translation().transpose();
    };
    pbs::Pose pose(limb_of_tets().skeleton.bones.size(), motion);
    EXPECT_LT(largest_distance(after(spec, {pose}), moved(rest)), rounding_m);
    // A bent limb that moves as a whole has the shape of the bent limb. In float, XPBD magnifies roundings of positions
    // by thousands.
    if (traits_of(spec).precision == "f32")
        spec = scene_with(spec.kind, spec.kind + ".precision=f64").deformers.front();
    for (std::size_t bone = 0; bone < pose.size(); ++bone) pose[bone] = motion * swept().back()[bone];
    EXPECT_LT(largest_distance(after(spec, {pose}), moved(after(spec, {swept().back()}))), rounding_m);
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
    const pbs::Positions far =
        after(spec, pbs::joint_sweep(moved.skeleton, 1, pbs::Vec3::UnitZ(), 45.0, 4, 0.01).steps, moved);
    EXPECT_LT(largest_distance(far.rowwise() - far_m, after(spec, swept())), rounding_m + 100 * 0x1p-53 * far_m.norm());
}

// A body of one tet is held by the springs and bones inside of it alone.
TEST_P(EveryDeformer, KeepsABodyOfOneTetAtRest)
{
    for (const double height_m : {0.3, 2.0}) {
        const pbs::TetMesh tet = {
            pbs::Positions{{-0.3, -0.2, -0.2}, {-0.3, 0.3, -0.2}, {-0.3, 0.0, 0.3}, {height_m - 0.3, 0.0, 0.0}},
            pbs::Tets{{0, 1, 2, 3}}};
        const pbs::Character character = test_support::character_of(test_support::two_bones_in(tet));
        const std::vector<pbs::Pose> still(3, pbs::Pose(2, Eigen::Isometry3d::Identity()));
        EXPECT_LT(largest_distance(after(spec, still, character), tet.rest), rounding_m) << height_m;
    }
}

TEST_P(EveryDeformer, RepeatsToTheBitAfterAResetAndWhateverTheThreads)
{
    const pbs::Positions once = after(spec, swept());
    EXPECT_NE(once, rest);
    EXPECT_EQ(after(spec, swept()), once);
    const auto again = at_rest(spec);
    again->advance(swept().back(), 0.01);
    again->reset(limb_of_tets());
    EXPECT_EQ(again->positions(), rest);
    play(*again, swept());
    EXPECT_EQ(again->positions(), once) << "after a reset";
    for (const int threads : {2, 4}) {
        spec.threads = threads;
        EXPECT_EQ(after(spec, swept()), once) << threads << " threads";
    }
}

TEST_P(EveryDeformer, NeedsThePosesBetweenFramesOnlyIfItHasMemory)
{
    const pbs::Pose last = swept().back();
    const pbs::Positions alone = after(spec, {last});
    const auto foreseen = at_rest(spec);
    foreseen->foresee({last, swept(80.0).back()});
    play(*foreseen, {last});
    EXPECT_EQ(foreseen->positions(), alone);
    EXPECT_TRUE(foreseen->has_state());
    const double remembered_m = largest_distance(after(spec, {swept(80.0).back(), last}), alone);
    EXPECT_EQ(remembered_m > same_pose_m, foreseen->has_memory()) << remembered_m;
}

TEST_P(EveryDeformer, ReportsAPoseThatIsNotANumberAndIsSoundAfterAReset)
{
    pbs::Pose broken = swept().back();
    broken[1].translation()(0) = std::numeric_limits<double>::quiet_NaN();
    const auto deformer = at_rest(spec);
    EXPECT_NE(deformer->advance(broken, 0.01).outcome, pbs::Outcome::finished);
    deformer->reset(limb_of_tets());
    play(*deformer, swept());
    EXPECT_EQ(deformer->positions(), after(spec, swept()));
}

// Zero in a record means that there was none, so every deformer of this program counts; those of the user have empty
// cells.
TEST_P(EveryDeformer, CountsItsWork)
{
    EXPECT_NE(at_rest(spec)->advance(swept().back(), 0.01).work, pbs::WorkCounters{});
}

// Reference: the same deformer on a character that has these weights itself.
TEST_P(EveryDeformer, WithOwnWeightsIsThatOfACharacterWithThem)
{
    // eight cells have the same weights by both rules
    const pbs::Character thin = test_support::bar_character({12, 3, 3});
    const pbs::Positions expected = after(spec, swept(), pbs::with_weights(pbs::WeightKind::smooth, thin));
    EXPECT_TRUE(!has_key("weights") || after(spec, swept(), thin) != expected);
    EXPECT_FALSE(to_json(spec).contains("weights"));
    spec.weights = pbs::WeightKind::smooth;
    EXPECT_EQ(after(spec, swept(), thin), expected);
    EXPECT_EQ(to_json(spec).at("weights"), "smooth");
    spec.weights = pbs::WeightKind::artist;
    EXPECT_THROW(make_deformer(spec)->reset(thin), pbs::InputError);
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
    return key.type == KeyType::integer ? std::to_string(static_cast<int>(std::floor(other)))
                                        : nlohmann::json(other).dump();
}

// The values that a scene's text has for it, and values out of range.
std::vector<std::string> refused_values(const SceneKey& key)
{
    if (key.type == KeyType::text) return {"\"no_such_choice\"", "1"};
    std::vector<std::string> refused = {"\"a text\"", "[]"};
    if (key.type == KeyType::integer) refused.push_back("1.5");
    const auto& [lowest, highest] = key.range;
    if (std::isfinite(lowest))
        refused.push_back(lowest == above_zero ? "0" : std::to_string(static_cast<int>(lowest) - 1));
    if (std::isfinite(highest)) refused.push_back(nlohmann::json(highest * 1.5 + 1.0).dump());
    return refused;
}

// Every key of the kind's own table: its value reaches the options and the record, and values out of range are refused.
TEST_P(EveryDeformer, RecordsEachOfItsKeysAndRefusesValuesOutOfRange)
{
    const DeformerKind& kind = *find_deformer_kind(spec.kind);
    for (const SceneKey& key : kind.keys) {
        if (key.in_list || key.table != kind.name) continue;  // tables within the table: scenes have them rarely
        for (const std::string& value : refused_values(key))
            EXPECT_THROW(scene_with(kind.name, key.path() + "=" + value), pbs::InputError)
                << key.path() << " = " << value;
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

// A deformer that notes the calls that reach it.
class Noting : public Deformer {
public:
    explicit Noting(std::vector<std::string>& calls) : calls_(calls) {}

    void reset(const pbs::Character& character) override
    {
        positions_ = character.mesh.rest;
        calls_.push_back("reset");
    }
    pbs::StepSummary advance(const pbs::Pose&, double) override
    {
        calls_.push_back("advance");
        return {};
    }
    const pbs::Positions& positions() const override { return positions_; }
    void foresee(const std::vector<pbs::Pose>&) override { calls_.push_back("foresee"); }
    void start_from(const pbs::Positions&) override { calls_.push_back("start_from"); }
    void continue_from(const pbs::Pose&, const pbs::Positions&) override { calls_.push_back("continue_from"); }
    void give_up_when(std::function<bool()>) override { calls_.push_back("give_up_when"); }
    bool has_state() const override { return false; }
    bool has_memory() const override { return true; }
    const FemFacts* facts() const override { return &facts_; }
    nlohmann::json record() const override { return "noted"; }

    FemFacts facts_;

private:
    std::vector<std::string>& calls_;
    pbs::Positions positions_;
};

DeformerKind noting_kind(std::vector<std::string>& calls)
{
    DeformerKind kind{.name = "noting"};
    kind.make = [&](const DeformerSpec&) { return std::make_unique<Noting>(calls); };
    return kind;
}

// Deformers that have another one do the work pass each call on.
TEST(WrappingDeformers, PassEachCallOn)
{
    static std::vector<std::string> calls;
    add_deformer_kind(noting_kind(calls));
    std::vector<std::unique_ptr<Deformer>> wrapping;
    wrapping.push_back(std::make_unique<WrappingDeformer>(std::make_unique<Noting>(calls)));
    wrapping.push_back(following(std::make_unique<Noting>(calls)));
    wrapping.push_back(
        make_deformer({.name = "noting", .kind = "noting", .label = "noting", .weights = pbs::WeightKind::smooth}));
    for (const auto& deformer : wrapping) {
        calls.clear();
        deformer->reset(limb_of_tets());
        deformer->give_up_when([] { return false; });
        deformer->foresee(swept());
        deformer->start_from(limb_of_tets().mesh.rest);
        deformer->advance(swept().back(), 0.01);
        deformer->continue_from(swept().back(), limb_of_tets().mesh.rest);
        EXPECT_EQ(calls, (std::vector<std::string>{"reset", "give_up_when", "foresee", "start_from", "advance",
                                                   "continue_from"}));
        EXPECT_FALSE(deformer->has_state());
        EXPECT_TRUE(deformer->has_memory());
        EXPECT_NE(deformer->facts(), nullptr);
        EXPECT_EQ(deformer->record(), "noted");
        EXPECT_EQ(deformer->positions(), limb_of_tets().mesh.rest);
    }
}

}  // namespace
