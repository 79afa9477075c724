#include "experiments/scene/scene.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/settings/option_fields.hpp"
#include "generated/scenes_texts.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// Messages name the file as briefly as its folders allow.
std::string in_folder(const std::string& folder, const std::string& path)
{
    if (path.empty() || fs::path(path).is_absolute()) return path;
    const fs::path file = fs::path(folder) / path;
    if (path.rfind("..", 0) != 0) return file.string();
    const fs::path whole = fs::weakly_canonical(file), from_here = whole.lexically_proximate(fs::current_path());
    return (from_here.string().rfind("..", 0) == 0 ? whole : from_here).string();
}

// One of the three: a body, a model, mesh and skeleton files.
void check_character(const SceneValues& values, const pbs::CharacterSource& source)
{
    const int sources = !source.body.empty() + !source.model_file.empty() + !source.mesh_file.empty();
    if (sources == 0) values.refuse("character.body", "expected a body, a model, or mesh and skeleton files");
    if (sources > 1)
        values.refuse(source.mesh_file.empty() ? "character.model" : "character.mesh",
                      "expected either a body, a model or files");
    if (!source.mesh_file.empty() && source.skeleton_file.empty())
        values.refuse("character.skeleton", "expected the skeleton of the mesh");
    if (values.given("character.scale") && source.model_file.empty())
        values.refuse("character.scale", "expected a character.model, which is the only thing that it enlarges");
}

pbs::CharacterSource read_character(const SceneValues& values, const std::string& folder)
{
    pbs::CharacterSource source = character_fields().read(values, "character");
    if (values.text("motion.clip").empty()) source.animation = values.text("motion.animation");
    const bool has_named_skeleton = !source.model_file.empty() && source.skeleton_file == "human";
    for (std::string* file : {&source.model_file, &source.mesh_file, &source.skeleton_file})
        if (file != &source.skeleton_file || !has_named_skeleton) *file = in_folder(folder, *file);
    check_character(values, source);
    const std::string weights = values.text("skinning.weights");
    source.weights = pbs::weights_named(weights);
    if (source.weights == pbs::WeightKind::artist && source.model_file.empty())
        values.refuse("skinning.weights", "expected a character.model, which brings the artist's weights");
    if (!weights.empty() && !source.weights) source.weights_file = in_folder(folder, weights);
    return source;
}

std::string found_clip(const SceneValues& values, const std::string& folder)
{
    try {
        return pbs::find_clip(values.text("motion.clip"), folder);
    } catch (const pbs::InputError&) {
        values.refuse("motion.clip",
                      "expected a file in the folder of the scene, or a clip of Debian's package assimp-testmodels");
    }
}

// A frame is a whole number of steps.
void fit_time_step(const SceneValues& values, MotionSpec& motion)
{
    if (!values.given("pbs.time_step_s")) motion.time_step_s = pbs::time_step_for(motion.rate_hz);
    const double steps = 1.0 / (motion.rate_hz * motion.time_step_s);
    if (steps < 1.0 - 1e-9 || std::abs(steps - std::round(steps)) > 1e-6 * steps)
        values.refuse("motion.rate_hz",
                      "expected rate_hz * pbs.time_step_s = 1/n with a whole number n of steps per frame");
}

MotionSpec read_motion(const SceneValues& values, const std::string& folder)
{
    MotionSpec motion = motion_fields().read(values, "motion");
    motion.time_step_s = values.number("pbs.time_step_s");
    const bool has_model = !values.text("character.model").empty();
    const bool is_of_model = !motion.animation.empty() && motion.clip.empty();  // otherwise of the clip
    if (is_of_model && !has_model)
        values.refuse("motion.animation", "expected a motion.clip or a character.model, which have animations");
    const int motions = !motion.joint.empty() + !motion.clip.empty() + is_of_model + !motion.movements.empty();
    if (motions > 1 || (motions == 0 && !has_model))
        values.refuse("motion.joint",
                      "expected either a joint (a sweep), movements, a clip, or an animation of character.model");
    motion.of_model = has_model && motion.joint.empty() && motion.clip.empty() && motion.movements.empty();
    if (!motion.joint.empty() && motion.axis.norm() == 0.0)
        values.refuse("motion.axis", "expected an axis of non-zero length");
    if (!motion.clip.empty()) motion.clip = found_clip(values, folder);
    if (motion.joint.empty()) fit_time_step(values, motion);
    return motion;
}

// A deformer of this kind with the options of a table.
DeformerSpec read_spec(const SceneValues& values, const DeformerKind& kind, const std::string& table,
                       const std::string& name)
{
    DeformerSpec spec = default_spec(kind.name);
    spec.name = spec.label = name;
    if (kind.read) kind.read(values, table, spec);
    return spec;
}

bool names_a_file(const std::string& name)
{
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return !name.empty() && std::all_of(name.begin(), name.end(), is_plain) && !name.starts_with("pbs");
}

std::vector<DeformerSpec> read_deformers(const SceneValues& values)
{
    const std::vector<DeformerSpec> listed = listed_deformers(values);
    std::vector<DeformerSpec> used;
    for (const std::string& name : values.texts("deformers.use")) {
        if (std::ranges::count(used, name, &DeformerSpec::name) > 0)
            values.refuse("deformers.use", "names " + name + " twice");
        const auto of_list = std::ranges::find(listed, name, &DeformerSpec::name);
        const DeformerKind* kind = find_deformer_kind(name);
        if (of_list != listed.end())
            used.push_back(*of_list);
        else if (kind && !kind->needs_list)
            used.push_back(read_spec(values, *kind, name, name));
        else
            values.refuse("deformers.use",
                          "expected a deformer of `pbskin list deformers` or the name of a [[fem]], [[external]] or "
                          "[[correctives]] table, not " +
                              name);
    }
    if (used.empty()) values.refuse("deformers.use", "expected at least one deformer");
    return used;
}

std::string read_reference(const SceneValues& values, const std::vector<DeformerSpec>& deformers)
{
    const std::string name = values.text("reference.name");
    const bool used = std::ranges::count(deformers, name, &DeformerSpec::name) > 0;
    if (!name.empty() && !used) values.refuse("reference.name", "expected a deformer that the scene uses");
    return name;
}

OutputSpec read_output(const SceneValues& values)
{
    OutputSpec output = output_fields().read(values, "output");
    if (const auto names = values.texts("output.frame_names"); !names.empty() && names.size() != output.frames.size())
        values.refuse("output.frame_names", "expected a name for each of output.frames");
    const auto groups = values.texts("output.metrics");
    for (const auto& group : groups)
        if (group != "all" && group != "errors" && group != "sections" && group != "surface")
            values.refuse("output.metrics", "expected errors, sections, surface or all, not " + group);
    const auto asked = [&](const char* group) {
        return std::count(groups.begin(), groups.end(), group) + std::count(groups.begin(), groups.end(), "all") > 0;
    };
    output.errors = asked("errors");
    output.sections = asked("sections");
    output.surface = asked("surface");
    return output;
}

// The reference's options; null: there is no reference, or it is no [[fem]] table.
const FemOptions* fem_reference(const std::string& reference, const std::vector<DeformerSpec>& deformers)
{
    const auto spec = std::ranges::find(deformers, reference, &DeformerSpec::name);
    return spec == deformers.end() ? nullptr : options_if<FemOptions>(*spec);
}

double read_reference_seconds(const SceneValues& values, const FemOptions* fem, ErrorBar error_bar)
{
    const double seconds = values.number("reference.seconds");
    if (seconds == 0.0) return seconds;
    if (!fem || fem->dynamics != reference_fem::Dynamics::quasi_static)
        values.refuse("reference.seconds", "expected 0 if the reference is not a quasi-static [[fem]] table");
    if (error_bar != ErrorBar::none)
        values.refuse("reference.seconds",
                      "expected 0 with reference.error_bar, whose further solutions belong to every frame");
    return seconds;
}

ErrorBar read_error_bar(const SceneValues& values, const FemOptions* fem, const OutputSpec& output)
{
    const ErrorBar error_bar = option_of<ErrorBar>(values.text("reference.error_bar"));
    if (error_bar == ErrorBar::none) return error_bar;
    if (!fem)
        values.refuse("reference.error_bar",
                      "expected none if the reference is not a [[fem]] table, for it has no elements to refine");
    if (fem->formulation == reference_fem::Formulation::taylor_hood)
        values.refuse("reference.error_bar", "expected none with formulation taylor_hood, which has only order 2");
    if (!output.errors)
        values.refuse("reference.error_bar",
                      "expected none if output.metrics leaves out the errors, which it belongs to");
    return error_bar;
}

std::string read_scene_text(const std::string& path)
{
    std::error_code code;
    if (!fs::is_regular_file(path, code))
        throw pbs::InputError(path, 0, "", "",
                              "cannot be read: expected a scene file, or a name of `pbskin list scenes`");
    if (pbs::is_rig_file(path))
        throw pbs::InputError(
            path, 0, "", "",
            "is a model; a scene is a TOML file that names a model, a motion and deformers: `pbskin try " + path +
                "` runs the model and writes such a scene");
    return pbs::read_text_file(path, pbs::most_settings_bytes);
}

}  // namespace

std::vector<DeformerSpec> listed_deformers(const SceneValues& values)
{
    std::vector<DeformerSpec> listed;
    for (const DeformerKind& kind : deformer_kinds())
        for (int i = 0; kind.has_list && i < values.tables(kind.name); ++i) {
            const std::string table = kind.name + "." + std::to_string(i), name = values.text(table + ".name");
            if (!names_a_file(name))
                values.refuse(table + ".name",
                              "expected letters, digits and underscores, not beginning with pbs: it names files");
            const DeformerSpec spec = read_spec(values, kind, table, name);
            const bool is_own_name = kind.needs_list && name == kind.name;
            if (!is_own_name && find_deformer_kind(name))
                values.refuse(table + ".name", "is the name of another deformer");
            if (std::ranges::count(listed, name, &DeformerSpec::name) > 0)
                values.refuse(table + ".name", "is used twice");
            listed.push_back(spec);
        }
    return listed;
}

SceneSchema scene_schema()
{
    return scene_schema(deformer_kinds());
}

bool OutputSpec::writes(int frame) const
{
    return (frames_every > 0 && frame % frames_every == 0) || std::count(frames.begin(), frames.end(), frame) > 0;
}

nlohmann::json to_json(const Scene& scene)
{
    nlohmann::json resolved = scene.resolved;
    resolved["name"] = scene.name;
    resolved["runs"] = nlohmann::json::array();
    for (const DeformerSpec& spec : scene.deformers) resolved["runs"].push_back(to_json(spec));
    return resolved;
}

const std::vector<BuiltInScene>& built_in_scenes()
{
    static const std::vector<BuiltInScene> built_in = {
        {"limb_twist", scenes::limb_twist_toml, "the capsule limb, its forearm twisted by 0 to 180 degrees"},
        {"limb_bend", scenes::limb_bend_toml, "the capsule limb, its forearm bent by 0 to 150 degrees"},
        {"human_01_01", scenes::human_01_01_toml, "MakeHuman's body through CMU's clip 01_01 (repeated jumps)"},
        {"man_01_01", scenes::man_01_01_toml, "Man, as large as Table 1's, through the same clip (`pbskin fetch man`)"},
        {"lady_01_01", scenes::lady_01_01_toml,
         "Lady, as large as Table 1's, through the same clip (`pbskin fetch lady`)"},
        {"frankie_01_01", scenes::frankie_01_01_toml,
         "Frankie, as large as Table 1's bunny, through the same clip (`pbskin fetch frankie`)"},
        {"lady_walk", scenes::lady_walk_toml,
         "Lady walking: the first two and a half seconds of CMU's clip 01_03 (`pbskin fetch lady`)"},
    };
    return built_in;
}

Scene read_scene(const std::string& file_or_name, const std::vector<std::string>& overrides)
{
    const auto found = std::ranges::find(built_in_scenes(), file_or_name, &BuiltInScene::name);
    const bool from_file = found == built_in_scenes().end();
    const std::string file = from_file ? file_or_name : file_or_name + ".toml";
    const std::string folder = from_file ? fs::path(file).parent_path().string() : "";
    const SceneValues values(from_file ? read_scene_text(file) : found->text, file, overrides, scene_schema());
    warn(values.remarks());

    Scene scene;
    scene.file = file;
    scene.name = fs::path(file).stem().string();
    if (!analysis::is_utf8(scene.name))
        throw pbs::InputError(file, 0, "", "", "expected a file's name in UTF-8: it names the scene in all records");
    scene.character = read_character(values, folder);
    scene.motion = read_motion(values, folder);
    scene.deformers = read_deformers(values);
    scene.reference = read_reference(values, scene.deformers);
    scene.output = read_output(values);
    const FemOptions* fem = fem_reference(scene.reference, scene.deformers);
    scene.error_bar = read_error_bar(values, fem, scene.output);
    scene.reference_seconds = read_reference_seconds(values, fem, scene.error_bar);
    scene.resolved = values.resolved();
    scene.resolved["pbs"]["time_step_s"] = scene.motion.time_step_s;
    return scene;
}

}  // namespace experiments
