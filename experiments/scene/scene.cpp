#include "experiments/scene/scene.hpp"

#include "experiments/deformers/option_names.hpp"
#include "experiments/deformers/registry.hpp"
#include "analysis/records/record_text.hpp"
#include "experiments/scene/scene_values.hpp"
#include "generated/scenes_texts.hpp"
#include "pbs/character/clip.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/text_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

pbs::Vec3 vec3(const std::vector<double>& values)
{
    return {values[0], values[1], values[2]};
}

std::string beside(const std::string& folder, const std::string& path)
{
    return path.empty() || fs::path(path).is_absolute() ? path : (fs::path(folder) / path).string();
}

pbs::CharacterSource read_character(const SceneValues& values, const std::string& folder)
{
    pbs::CharacterSource source;
    source.body = values.text("character.body");
    source.mesh_file = beside(folder, values.text("character.mesh"));
    source.skeleton_file = beside(folder, values.text("character.skeleton"));
    source.skeleton_scale = values.number("character.skeleton_scale");
    source.vertices = values.integer("character.vertices");
    source.refinements = values.integer("character.refine");
    if (source.body.empty() && source.mesh_file.empty()) values.refuse("character.body", "expected a body, or mesh and skeleton files");
    if (!source.body.empty() && !source.mesh_file.empty()) values.refuse("character.mesh", "expected either a body or files, not both");
    if (source.body.empty() && source.skeleton_file.empty()) values.refuse("character.skeleton", "expected the skeleton of the mesh");
    const std::string weights = values.text("skinning.weights");
    if (weights == "rigid")
        source.weights = pbs::WeightKind::rigid;
    else if (weights != "paper")
        source.weights_file = beside(folder, weights);
    return source;
}

std::string found_clip(const SceneValues& values, const std::string& folder)
{
    try {
        return pbs::find_clip(values.text("motion.clip"), folder);
    } catch (const pbs::InputError&) {
        values.refuse("motion.clip", "expected a file beside the scene, or a clip of Debian's package assimp-testmodels");
    }
}

MotionSpec read_motion(const SceneValues& values, const std::string& folder)
{
    MotionSpec motion;
    motion.joint = values.text("motion.joint");
    motion.axis = vec3(values.numbers("motion.axis"));
    motion.angle_deg = values.number("motion.angle_deg");
    motion.frames = values.integer("motion.frames");
    motion.clip = values.text("motion.clip");
    motion.start_s = values.number("motion.start_s");
    motion.duration_s = values.number("motion.duration_s");
    motion.rate_hz = values.number("motion.rate_hz");
    motion.time_step_s = values.number("pbs.time_step_s");
    if (motion.joint.empty() == motion.clip.empty()) values.refuse("motion.joint", "expected either a joint (a sweep) or a clip");
    if (!motion.joint.empty() && motion.axis.norm() == 0.0) values.refuse("motion.axis", "expected an axis of non-zero length");
    if (!motion.clip.empty()) {
        motion.clip = found_clip(values, folder);
        const double steps = 1.0 / (motion.rate_hz * motion.time_step_s);
        if (steps < 1.0 - 1e-9 || std::abs(steps - std::round(steps)) > 1e-6 * steps)
            values.refuse("motion.rate_hz", "expected rate_hz * pbs.time_step_s = 1/n with a whole n: n steps a frame");
    }
    return motion;
}

// The printed forms are written in the plain order alone.
void take_as_printed(const SceneValues& values, DeformerSpec& spec)
{
    if (values.given("pbs.order") && spec.pbs.order != pbs::Order::plain)
        values.refuse("pbs.order", "expected plain with a printed volume_form");
    spec.pbs.order = pbs::Order::plain;
    spec.variant = name_of(spec.pbs.volume_form);
}

DeformerSpec pbs_spec(const SceneValues& values)
{
    DeformerSpec spec{"pbs", "pbs", "pbs", "default", {}, {}};
    pbs::PbsOptions& options = spec.pbs;
    options.iterations = values.integer("pbs.iterations");
    options.k_stretch = values.number("pbs.k_stretch");
    options.k_volume = values.number("pbs.k_volume");
    options.k_bind = values.number("pbs.k_bind");
    options.gravity_m_s2 = vec3(values.numbers("pbs.gravity_m_s2"));
    options.order = option_of<pbs::Order>(values.text("pbs.order"));
    options.precision = option_of<pbs::Precision>(values.text("pbs.precision"));
    options.masses = option_of<pbs::Masses>(values.text("pbs.masses"));
    options.sleep = values.boolean("pbs.sleep");
    if (options.sleep && options.order == pbs::Order::plain)
        values.refuse("pbs.sleep", "expected false with order plain, which projects all");
    options.sleep_tolerance = values.number("pbs.sleep_tolerance");
    options.stop_residual = values.number("pbs.stop_residual");
    options.record_iterations = values.boolean("pbs.record_iterations");
    if (values.has_table("pbs.jiggle")) {
        options.jiggle = pbs::Jiggle{values.number("pbs.jiggle.k_stretch")};
        spec.variant = "jiggle";
    }
    if (values.has_table("pbs.variant")) {
        options.stiffness_form = option_of<pbs::StiffnessForm>(values.text("pbs.variant.stiffness"));
        if (options.stiffness_form != pbs::StiffnessForm::per_iteration) spec.variant = name_of(options.stiffness_form);
        options.class_order = option_of<pbs::ClassOrder>(values.text("pbs.variant.class_order"));
        options.lbs_entry = option_of<pbs::LbsEntry>(values.text("pbs.variant.lbs_entry"));
        options.bind_on_bone = option_of<pbs::BindOnBone>(values.text("pbs.variant.bind_on_bone"));
        if (options.class_order != pbs::ClassOrder::bind_stretch_volume) spec.variant = name_of(options.class_order);
        if (options.lbs_entry != pbs::LbsEntry::start) spec.variant = name_of(options.lbs_entry);
        if (options.bind_on_bone != pbs::BindOnBone::pinned) spec.variant = name_of(options.bind_on_bone);
        options.volume_form = option_of<pbs::VolumeForm>(values.text("pbs.variant.volume_form"));
        if (options.volume_form != pbs::VolumeForm::derived) take_as_printed(values, spec);
    }
    return spec;
}

// The same iterations, or as many substeps, as pbs; what jiggles there jiggles here.
DeformerSpec xpbd_spec(const SceneValues& values, const std::string& kind)
{
    DeformerSpec spec{kind, kind, kind, "default", {}, {}};
    const int iterations = values.integer("pbs.iterations");
    const bool small_steps = kind == "xpbd_small_steps";
    spec.xpbd = {.young_pa = values.number("xpbd.young_pa"),
                 .poisson = values.number("xpbd.poisson"),
                 .density_kg_m3 = values.number("xpbd.density_kg_m3"),
                 .iterations = small_steps ? 1 : iterations,
                 .substeps = small_steps ? std::max(iterations, 1) : 1,
                 .gravity_m_s2 = vec3(values.numbers("pbs.gravity_m_s2")),
                 .jiggle = values.has_table("pbs.jiggle")};
    if (spec.xpbd.jiggle) spec.variant = "jiggle";
    return spec;
}

DeformerSpec delta_mush_spec(const SceneValues& values)
{
    DeformerSpec spec{"delta_mush", "delta_mush", "delta_mush", "default", {}, {}};
    spec.delta_mush = {.iterations = values.integer("delta_mush.iterations"), .step = values.number("delta_mush.step")};
    return spec;
}

// Rules that more than one key takes part in.
void check_fem_keys(const SceneValues& values, const std::string& at, const FemOptions& options)
{
    const bool linear = options.model == reference_fem::Model::linear;
    const bool quasi_static = options.dynamics == reference_fem::Dynamics::quasi_static;
    if (linear && options.attachment == FemAttachment::bind)
        values.refuse(at + "attachment", "expected embedded or nodes with model linear: the bind constraint is not linear");
    if (!linear && options.solver != reference_fem::LinearSolver::cholmod)
        values.refuse(at + "solver",
                      "expected cholmod with a nonlinear model: Newton must be told of a matrix that is not positive definite");
    if (options.formulation == reference_fem::Formulation::taylor_hood)
        if (!linear || !quasi_static || options.element_order != 2 || !(options.poisson > 0.0) ||
            options.solver == reference_fem::LinearSolver::cg_ml)
            values.refuse(
                at + "formulation",
                "expected taylor_hood only with model linear, dynamics quasi_static, element_order 2, poisson > 0 and a direct solver");
    if (quasi_static && (options.rayleigh_mass_1_s > 0.0 || options.rayleigh_stiffness_s > 0.0))
        values.refuse(at + "rayleigh", "expected [0, 0] with dynamics quasi_static: nothing moves there that could be damped");
    if (options.nested_start && (linear || !quasi_static || (options.element_order != 2 && values.integer("character.refine") == 0)))
        values.refuse(at + "nested_start",
                      "expected false unless element_order is 2 or character.refine > 0, the model nonlinear and dynamics quasi_static");
    if (!quasi_static && !(options.density_kg_m3 > 0.0)) values.refuse(at + "density_kg_m3", "expected a density > 0 with dynamics");
}

FemOptions fem_options(const SceneValues& values, const std::string& at)
{
    FemOptions options;
    options.name = values.text(at + "name");
    options.model = option_of<reference_fem::Model>(values.text(at + "model"));
    options.element_order = values.integer(at + "element_order");
    options.formulation = option_of<reference_fem::Formulation>(values.text(at + "formulation"));
    options.young_pa = values.number(at + "young_pa");
    options.poisson = values.number(at + "poisson");
    options.density_kg_m3 = values.number(at + "density_kg_m3");
    options.gravity_m_s2 = vec3(values.numbers(at + "gravity_m_s2"));
    options.dynamics = option_of<reference_fem::Dynamics>(values.text(at + "dynamics"));
    const std::vector<double> rayleigh = values.numbers(at + "rayleigh");
    if (rayleigh.size() != 2) values.refuse(at + "rayleigh", "expected two numbers, [mass, stiffness]");
    options.rayleigh_mass_1_s = rayleigh[0];
    options.rayleigh_stiffness_s = rayleigh[1];
    options.attachment = option_of<FemAttachment>(values.text(at + "attachment"));
    options.core_radius = values.number(at + "core_radius");
    options.spring_factor = values.number(at + "spring_factor");
    options.solver = option_of<reference_fem::LinearSolver>(values.text(at + "solver"));
    options.nested_start = values.boolean(at + "nested_start");
    options.most_newton_steps = values.integer(at + "most_newton_steps");
    check_fem_keys(values, at, options);
    return options;
}

DeformerSpec fem_spec(const SceneValues& values, int index)
{
    const std::string at = "fem." + std::to_string(index) + ".";
    const std::string name = values.text(at + "name");
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    if (name.empty() || !std::all_of(name.begin(), name.end(), is_plain) || name.starts_with("pbs"))
        values.refuse(at + "name", "expected letters, digits and underscores, not beginning with pbs: it names files");
    for (const DeformerKind& kind : deformer_kinds())
        if (name == kind.kind && kind.kind != "fem") values.refuse(at + "name", "is the name of another deformer");
    return {name, "fem", name, "default", {}, fem_options(values, at)};
}

std::vector<DeformerSpec> read_deformers(const SceneValues& values)
{
    std::vector<DeformerSpec> references, used;
    for (int i = 0; i < values.fem_tables(); ++i) {
        references.push_back(fem_spec(values, i));
        for (int j = 0; j < i; ++j)
            if (references[j].name == references[i].name) values.refuse("fem." + std::to_string(i) + ".name", "is used twice");
    }
    for (const std::string& name : values.texts("deformers.use")) {
        const auto same = [&](const DeformerSpec& spec) { return spec.name == name; };
        if (std::any_of(used.begin(), used.end(), same)) values.refuse("deformers.use", "names " + name + " twice");
        const auto reference = std::find_if(references.begin(), references.end(), same);
        const auto kind = std::find_if(deformer_kinds().begin(), deformer_kinds().end(),
                                       [&](const DeformerKind& entry) { return entry.kind == name && !entry.has_options; });
        if (kind != deformer_kinds().end())
            used.push_back({name, name, name, "default", {}, {}});
        else if (name == "pbs")
            used.push_back(pbs_spec(values));
        else if (name == "xpbd" || name == "xpbd_small_steps")
            used.push_back(xpbd_spec(values, name));
        else if (name == "delta_mush")
            used.push_back(delta_mush_spec(values));
        else if (reference != references.end())
            used.push_back(*reference);
        else
            values.refuse("deformers.use", "expected a deformer of `pbskin list deformers` or the name of a [[fem]] table, not " + name);
    }
    if (used.empty()) values.refuse("deformers.use", "expected at least one deformer");
    return used;
}

std::string read_reference(const SceneValues& values, const std::vector<DeformerSpec>& deformers)
{
    const std::string name = values.text("reference.name");
    const bool used = std::any_of(deformers.begin(), deformers.end(), [&](const DeformerSpec& spec) { return spec.name == name; });
    if (!name.empty() && !used) values.refuse("reference.name", "expected a deformer that the scene uses");
    return name;
}

OutputSpec read_output(const SceneValues& values)
{
    OutputSpec output;
    output.frames_every = values.integer("output.frames_every");
    output.frames = values.integers("output.frames");
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

ErrorBar read_error_bar(const SceneValues& values, const std::string& reference, const std::vector<DeformerSpec>& deformers,
                        const OutputSpec& output)
{
    const ErrorBar error_bar = option_of<ErrorBar>(values.text("reference.error_bar"));
    const auto reference_spec = std::find_if(deformers.begin(), deformers.end(),
                                             [&](const DeformerSpec& spec) { return spec.name == reference && spec.kind == "fem"; });
    if (error_bar == ErrorBar::none) return error_bar;
    if (reference_spec == deformers.end())
        values.refuse("reference.error_bar", "expected none where the reference is not a [[fem]] table: it has no elements to refine");
    const bool other_order = error_bar == ErrorBar::orders || error_bar == ErrorBar::both;
    if (other_order && reference_spec->fem.formulation == reference_fem::Formulation::taylor_hood)
        values.refuse("reference.error_bar", "expected none or refined with formulation taylor_hood, which is of order 2 alone");
    if (!output.errors)
        values.refuse("reference.error_bar", "expected none where output.metrics leaves out the errors that it stands beside");
    return error_bar;
}

std::string read_scene_text(const std::string& path)
{
    std::error_code code;
    if (!fs::is_regular_file(path, code))
        throw pbs::InputError(path, 0, "", "", "cannot be read: expected a scene file, or a name of `pbskin list scenes`");
    return pbs::read_text_file(path, pbs::most_settings_bytes);
}

}  // namespace

bool OutputSpec::writes(int frame) const
{
    return (frames_every > 0 && frame % frames_every == 0) || std::count(frames.begin(), frames.end(), frame) > 0;
}

nlohmann::json resolved_with_deformers(const Scene& scene)
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
        {"lady_01_01", scenes::lady_01_01_toml, "Lady, as large as Table 1's, through the same clip (`pbskin fetch lady`)"},
        {"frankie_01_01", scenes::frankie_01_01_toml,
         "Frankie, as large as Table 1's bunny, through the same clip (`pbskin fetch frankie`)"},
        {"lady_walk", scenes::lady_walk_toml, "Lady walking: the first two and a half seconds of CMU's clip 01_03 (`pbskin fetch lady`)"},
    };
    return built_in;
}

Scene read_scene(const std::string& file_or_name, const std::vector<std::string>& overrides)
{
    const auto& built_in = built_in_scenes();
    const auto found =
        std::find_if(built_in.begin(), built_in.end(), [&](const BuiltInScene& scene) { return scene.name == file_or_name; });
    const bool from_file = found == built_in.end();
    const std::string file = from_file ? file_or_name : file_or_name + ".toml";
    const std::string folder = from_file ? fs::path(file).parent_path().string() : "";
    const SceneValues values(from_file ? read_scene_text(file) : found->text, file, overrides);

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
    scene.error_bar = read_error_bar(values, scene.reference, scene.deformers, scene.output);
    scene.resolved = values.resolved();
    return scene;
}

}  // namespace experiments
