// Invalid scenes, one by one: each is refused with its file, line, key, value and rule.
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace {

struct WrongScene {
    const char* name;
    const char* text;
    const char* message;  // a part of the message
};

const char* const head = "schema = 1\n[character]\nbody = \"limb\"\n[motion]\njoint = \"forearm\"\n";  // 5 lines
const char* const stated = "[pbs]\nk_stretch = 0.2\nk_volume = 1.0\nk_bind = 1.0\ngravity_m_s2 = [0.0, 0.0, 0.0]\n";

const WrongScene wrong_scenes[] = {
    {"empty", "", "schema: missing"},
    {"not_toml", "schema = = 1\n", "scene.toml:1: "},
    {"noise", "\x01\x02\xff\xfe", "scene.toml"},
    {"wrong_schema", "schema = 2\n", "scene.toml:1: schema = 2: expected an integer from 1 to 1"},
    {"no_motion", "schema = 1\n[character]\nbody = \"limb\"\n", "motion.joint"},
    {"no_body", "schema = 1\n[motion]\njoint = \"forearm\"\n", "character.body"},
    {"unknown_body", "schema = 1\n[character]\nbody = \"dragon\"\n", "scene.toml:3: character.body = dragon: expected one of"},
    {"body_and_files", "schema = 1\n[character]\nbody = \"limb\"\nmesh = \"a.msh\"\n", "scene.toml:4: character.mesh = a.msh"},
    {"mesh_without_skeleton", "schema = 1\n[character]\nmesh = \"a.msh\"\n", "character.skeleton"},
    {"unknown_table", "schema = 1\n[caracter]\nbody = \"limb\"\n",
     "scene.toml:2: caracter: unknown key; the nearest known one is character"},
    {"joint_and_clip", "schema = 1\n[character]\nbody = \"limb\"\n[motion]\njoint = \"forearm\"\nclip = \"01_01.bvh\"\n",
     "scene.toml:5: motion.joint = forearm: expected either a joint (a sweep), a clip, or an animation"},
    {"table_as_value", "schema = 1\npbs = 3\n", "scene.toml:2: pbs: expected a table"},
    {"fem_with_a_dot_in_quotes", "schema = 1\n\"fem.0\" = 1\n", "scene.toml:2: fem.0: expected a key without a dot in quotes"},
    {"path_in_quotes", "schema = 1\n\"pbs.jiggle.k_stretch\" = 0.5\n",
     "scene.toml:2: pbs.jiggle.k_stretch: expected a key without a dot in quotes"},
    {"path_in_quotes_of_a_table", "schema = 1\n[pbs]\n\"jiggle.k_stretch\" = 0.5\n",
     "scene.toml:3: pbs.jiggle.k_stretch: expected a key without a dot in quotes"},
    {"fem_not_an_array", "schema = 1\n[fem]\nname = \"fem\"\n", "expected [[fem]] tables"},
};

const WrongScene wrong_lines[] = {
    // appended to `head` and `stated`, so the line is the eleventh
    {"unknown_key", "k_volum = 1.0\n", "scene.toml:11: pbs.k_volum = 1.0: unknown key; the nearest known one is pbs.k_volume"},
    {"negative_iterations", "iterations = -1\n", "scene.toml:11: pbs.iterations = -1: expected an integer from 0 to"},
    {"fractional_iterations", "iterations = 2.5\n", "scene.toml:11: pbs.iterations = 2.5: expected an integer"},
    {"text_for_number", "time_step_s = \"ten\"\n", "scene.toml:11: pbs.time_step_s = ten: expected a number from 1e-09 to 1000"},
    {"zero_time_step", "time_step_s = 0.0\n", "pbs.time_step_s = 0.0: expected a number from 1e-09 to 1000"},
    {"infinite_time_step", "time_step_s = inf\n", "scene.toml:11: pbs.time_step_s"},
    {"sleep_in_plain_order", "sleep = true\norder = \"plain\"\n", "expected false with order plain"},
    {"ordered_in_print", "order = \"ordered\"\n[pbs.variant]\nvolume_form = \"sign\"\n", "expected plain with a printed volume_form"},
    {"nan_residual", "stop_residual = nan\n", "scene.toml:11: pbs.stop_residual"},
    {"unknown_order", "order = \"sideways\"\n", "scene.toml:11: pbs.order = sideways: expected one of plain"},
    {"unknown_precision", "precision = \"f16\"\n", "expected one of f32, f64"},
    {"jiggle_too_stiff", "[pbs.jiggle]\nk_stretch = 1.5\n", "scene.toml:12: pbs.jiggle.k_stretch = 1.5: expected a number from 0 to 1"},
    {"unknown_variant", "[pbs.variant]\nvolume_form = \"guessed\"\n", "expected one of derived, labels_relative"},
    {"unknown_bind_to", "[pbs.improved]\nbind_to = \"skin\"\n", "expected one of bone_distance, blended_position"},
    {"empty_regions", "[pbs.improved]\nregion_tets = 0\n", "scene.toml:12: pbs.improved.region_tets = 0: expected an integer from 1 to"},
    {"negative_edge_length", "[pbs.improved]\nk_stretch_length_m = -0.1\n", "scene.toml:12: pbs.improved.k_stretch_length_m = -0.1"},
    {"regions_that_sleep", "sleep = true\n[pbs.improved]\nvolume_of = \"regions\"\n", "expected tets with sleep or a printed volume_form"},
    {"unknown_deformer", "[deformers]\nuse = [\"lbs\", \"spline\"]\n", "scene.toml:12: deformers.use"},
    {"deformer_twice", "[deformers]\nuse = [\"lbs\", \"lbs\"]\n", "names lbs twice"},
    {"no_deformer", "[deformers]\nuse = []\n", "expected at least one deformer"},
    {"reference_not_used", "[reference]\nname = \"fem\"\n", "expected a deformer that the scene uses"},
    {"incompressible_linear", "[[fem]]\npoisson = 0.5\n", "scene.toml:12: fem.0.poisson = 0.5: expected a number from 0 to"},
    {"cubic_elements", "[[fem]]\nelement_order = 3\n", "expected an integer from 1 to 2"},
    {"unknown_model", "[[fem]]\nmodel = \"jelly\"\n", "scene.toml:12: fem.0.model = jelly: expected one of linear, corotational"},
    {"unknown_formulation", "[[fem]]\nformulation = \"mixed\"\n", "expected one of displacement, mean_dilatation, taylor_hood"},
    {"taylor_hood_of_order_1", "[[fem]]\nformulation = \"taylor_hood\"\nelement_order = 1\n",
     "scene.toml:12: fem.0.formulation = taylor_hood: expected taylor_hood only with"},
    {"taylor_hood_of_a_nonlinear_model", "[[fem]]\nmodel = \"corotational\"\nformulation = \"taylor_hood\"\n",
     "scene.toml:13: fem.0.formulation = taylor_hood: expected taylor_hood only with model linear"},
    {"unknown_dynamics", "[[fem]]\ndynamics = \"verlet\"\n", "expected one of quasi_static, newmark, generalized_alpha"},
    {"unknown_attachment", "[[fem]]\nattachment = \"glue\"\n", "expected one of smooth, embedded, nodes, bind"},
    {"kernel_of_another_attachment", "[[fem]]\nattachment = \"embedded\"\nattachment_kernel = \"wendland\"\n",
     "expected attachment smooth, which alone has it"},
    {"ends_of_another_attachment", "[[fem]]\nattachment = \"embedded\"\nattachment_ends = 2.0\n",
     "expected attachment smooth, which alone has it"},
    {"samples_of_nodes", "[[fem]]\nattachment = \"nodes\"\nattachment_samples = 2\n",
     "expected attachment smooth or embedded, which have sample points"},
    {"spring_factor_of_nodes", "[[fem]]\nattachment = \"nodes\"\nspring_factor = 10.0\n",
     "scene.toml:13: fem.0.spring_factor = 10.0: expected attachment smooth, embedded or bind: prescribed nodes have no springs"},
    {"core_radius_of_bind", "[[fem]]\nmodel = \"neo_hookean\"\nattachment = \"bind\"\ncore_radius = 0.5\n",
     "scene.toml:14: fem.0.core_radius = 0.5: expected attachment smooth, embedded or nodes, which have capsules"},
    {"bind_of_a_linear_model", "[[fem]]\nattachment = \"bind\"\n",
     "scene.toml:12: fem.0.attachment = bind: expected smooth, embedded or nodes with model linear"},
    {"cg_ml_of_a_nonlinear_model", "[[fem]]\nmodel = \"stable_neo_hookean\"\nsolver = \"cg_ml\"\n",
     "scene.toml:13: fem.0.solver = cg_ml: expected cholmod with a nonlinear model"},
    {"umfpack_of_a_nonlinear_model", "[[fem]]\nmodel = \"corotational\"\nsolver = \"umfpack\"\n",
     "scene.toml:13: fem.0.solver = umfpack: expected cholmod with a nonlinear model"},
    {"nested_start_of_order_1", "[[fem]]\nmodel = \"corotational\"\nelement_order = 1\nnested_start = true\n",
     "scene.toml:14: fem.0.nested_start = true: expected false unless element_order is 2"},
    {"negative_rayleigh", "[[fem]]\nrayleigh = [-1.0, 0.0]\n", "scene.toml:12: fem.0.rayleigh = [-1.0,0.0]: expected a list of numbers"},
    {"rayleigh_without_dynamics", "[[fem]]\nrayleigh = [0.0, 0.1]\n",
     "scene.toml:12: fem.0.rayleigh = [0.0,0.1]: expected [0, 0] with dynamics quasi_static"},
    {"rayleigh_of_three", "[[fem]]\ndynamics = \"newmark\"\nrayleigh = [0.0, 0.1, 0.2]\n",
     "scene.toml:13: fem.0.rayleigh = [0.0,0.1,0.2]: expected two numbers"},
    {"dynamics_without_mass", "[[fem]]\ndynamics = \"newmark\"\ndensity_kg_m3 = 0.0\n",
     "scene.toml:13: fem.0.density_kg_m3 = 0.0: expected a density > 0 with dynamics"},
    {"plain_blend_in_f32", "[[lbs]]\nname = \"own\"\nprecision = \"f32\"\npacked = false\n",
     "scene.toml:14: lbs.0.packed = false: expected true with precision = \"f32\""},
    {"fem_named_lbs", "[[fem]]\nname = \"lbs\"\n", "is the name of another deformer"},
    {"fem_twice", "[[fem]]\nname = \"a\"\n[[fem]]\nname = \"a\"\n[deformers]\nuse = [\"a\"]\n", "is used twice"},
    {"unknown_error_bar", "[reference]\nerror_bar = \"guessed\"\n", "expected one of none, orders, refined, both"},
    {"error_bar_of_no_reference", "[reference]\nerror_bar = \"refined\"\n", "expected none if the reference is not a [[fem]] table"},
    {"error_bar_of_lbs", "[reference]\nname = \"lbs\"\nerror_bar = \"refined\"\n", "expected none if the reference is not a [[fem]] table"},
    {"error_bar_beside_no_errors",
     "[[fem]]\n[deformers]\nuse = [\"fem\"]\n[reference]\nname = \"fem\"\nerror_bar = \"refined\"\n[output]\nmetrics = []\n",
     "expected none if output.metrics leaves out the errors"},
    {"orders_of_taylor_hood",
     "[[fem]]\nformulation = \"taylor_hood\"\n[deformers]\nuse = [\"fem\"]\n[reference]\nname = \"fem\"\nerror_bar = \"orders\"\n",
     "expected none or refined with formulation taylor_hood"},
    {"a_name_without_its_frame", "[output]\nframe_names = [\"crouch\"]\n", "expected a name for each of output.frames"},
    {"unknown_metrics", "[output]\nmetrics = [\"beauty\"]\n", "not beauty"},
};

std::string refused_with(const std::string& text, const std::vector<std::string>& overrides = {})
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("scene.toml", text);
    try {
        experiments::read_scene(path, overrides);
        return "accepted";
    } catch (const pbs::InputError& error) {
        return error.what();
    }
}

TEST(SceneErrors, WrongScenesNameTheirPlace)
{
    for (const auto& wrong : wrong_scenes)
        EXPECT_NE(refused_with(wrong.text).find(wrong.message), std::string::npos) << wrong.name << ": " << refused_with(wrong.text);
}

TEST(SceneErrors, WrongLinesNameTheirPlace)
{
    for (const auto& wrong : wrong_lines) {
        const std::string text = std::string(head) + stated + wrong.text;
        EXPECT_NE(refused_with(text).find(wrong.message), std::string::npos) << wrong.name << ": " << refused_with(text);
    }
}

TEST(SceneErrors, TheRightSceneIsAccepted)
{
    EXPECT_EQ(refused_with(std::string(head) + stated), "accepted");
}

TEST(SceneErrors, WhatThePaperLeavesUnstatedMustBeStated)
{
    for (const char* key : {"k_stretch", "k_volume", "k_bind", "gravity_m_s2"}) {
        std::string text = std::string(head) + stated;
        const auto at = text.find(key);
        text.erase(at, text.find('\n', at) - at);
        EXPECT_NE(refused_with(text).find(std::string("pbs.") + key + ": missing"), std::string::npos) << refused_with(text);
    }
}

TEST(SceneErrors, WrongOverrides)
{
    const std::string right = std::string(head) + stated;
    EXPECT_NE(refused_with(right, {"pbs.iterations"}).find("expected key=value"), std::string::npos);
    EXPECT_NE(refused_with(right, {"pbs.k_volume=1.4"}).find("--set: pbs.k_volume = 1.4: expected a number from 0 to 1"),
              std::string::npos);
    EXPECT_NE(refused_with(right, {"=3"}).find("expected key=value"), std::string::npos);
}

TEST(SceneErrors, OverridesOfReferencesThatAreNone)
{
    const std::string right = std::string(head) + stated, with_one = right + "[[fem]]\nmodel = \"linear\"\n";
    EXPECT_EQ(refused_with(with_one, {"fem.0.poisson=0.3", "fem.young_pa=2e4"}), "accepted");
    EXPECT_EQ(refused_with(with_one, {"fem.1.poisson=0.3"}), "--set: fem.1.poisson = 0.3: the scene has no such [[fem]] table");
    for (const char* key : {"fem.0", "fem.", "fem.00.poisson", "fem.0abc.poisson", "fem.-1.poisson", "fem.+0.poisson", "fem. 0.poisson",
                            "fem.99999999999.poisson"})
        EXPECT_NE(refused_with(with_one, {std::string(key) + "=0.3"}).find(std::string("--set: ") + key + " = 0.3: unknown key"),
                  std::string::npos)
            << refused_with(with_one, {std::string(key) + "=0.3"});
    EXPECT_EQ(refused_with(with_one, {"fem.00.poisson=0.3"}),
              "--set: fem.00.poisson = 0.3: unknown key; the nearest known one is fem.name");
    EXPECT_EQ(refused_with(right, {"pbz.jiggle.k_stretch=0.3"}),
              "--set: pbz.jiggle.k_stretch = 0.3: unknown key; the nearest known one is pbs");
    EXPECT_EQ(refused_with(right, {"fem.poisson=0.3"}), "--set: fem.poisson = 0.3: the scene has no such [[fem]] table");
}

TEST(SceneErrors, NamesThatAreNotUtf8)
{
    const std::string right = std::string(head) + stated;
    EXPECT_EQ(refused_with(right, {"character.mesh=li\xffmb.msh"}), "--set: character.mesh = li\xffmb.msh: expected UTF-8");
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("li\xffmb.toml", right);
    try {
        experiments::read_scene(path, {});
        FAIL() << "accepted";
    } catch (const pbs::InputError& error) {
        EXPECT_EQ(error.what(), path + ": expected a file's name in UTF-8: it names the scene in all records");
    }
}

TEST(SceneErrors, StepsMustDivideAFrame)
{
    const std::string text =
        std::string("schema = 1\n[character]\nbody = \"human\"\n[motion]\nclip = \"01_01.bvh\"\nrate_hz = 30.0\n") + stated;
    EXPECT_EQ(refused_with(text), "accepted");  // by default, the time step divides the frame
    EXPECT_NE(
        refused_with(text + "time_step_s = 0.01\n").find("scene.toml:6: motion.rate_hz = 30.0: expected rate_hz * pbs.time_step_s = 1/n"),
        std::string::npos)
        << refused_with(text);
}

TEST(SceneErrors, AMissingFileIsNamed)
{
    try {
        experiments::read_scene("no/such/scene.toml", {});
        FAIL() << "accepted";
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("no/such/scene.toml: cannot be read"), std::string::npos);
    }
}

}  // namespace
