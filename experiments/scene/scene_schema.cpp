#include "experiments/scene/scene_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace experiments {
namespace {

using enum KeyType;
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double above_zero = std::numeric_limits<double>::min();

SceneKey key(std::string table, std::string name, KeyType type, std::string default_json, std::string unit, std::string meaning)
{
    return {std::move(table), std::move(name), type, std::move(default_json), std::move(unit), -infinite, infinite, {}, std::move(meaning)};
}
SceneKey within(SceneKey entry, double lowest, double highest)
{
    entry.lowest = lowest;
    entry.highest = highest;
    return entry;
}
SceneKey one_of(SceneKey entry, std::vector<std::string> choices)
{
    entry.choices = std::move(choices);
    return entry;
}

std::vector<SceneKey> character_and_motion_keys()
{
    return {
        within(key("", "schema", integer, "", "", "version of this format"), 1, 1),
        one_of(key("character", "body", text, "\"\"", "",
                   "built-in limb, bar or ring (with a handle), human (MakeHuman's body from Debian's assimp-testmodels), or man, lady, "
                   "frankie (`pbskin fetch`); empty: from files"),
               {"", "limb", "bar", "ring", "human", "man", "lady", "frankie"}),
        key("character", "mesh", text, "\"\"", "", "tet mesh file, relative to the scene: .msh .vtu .vtk .mesh .ele"),
        key("character", "skeleton", text, "\"\"", "",
            "skeleton file, relative to the scene: .toml with [[joint]] tables, or a clip's zero pose (.bvh .gltf .glb .fbx)"),
        within(key("character", "skeleton_scale", number, "1.0", "m", "metres a unit of the skeleton file; CMU's clips: 0.0254 / 0.45"),
               above_zero, 1e6),
        within(key("character", "vertices", integer, "0", "", "wanted number of vertices of a named body; 0: its own default"), 0, 1e7),
        within(key("character", "refine", integer, "0", "",
                   "how often every tet is cut into eight (8 and 64 times the tets); bones' sizes stay, the other metrics are of the finer "
                   "mesh"),
               0, 2),
        key("motion", "joint", text, "\"\"", "", "the joint a sweep turns"),
        key("motion", "axis", vec3, "[1.0, 0.0, 0.0]", "", "axis of a sweep in rest world axes"),
        within(key("motion", "angle_deg", number, "0.0", "deg", "angle of a sweep's last frame; frame i has angle_deg * i / (frames - 1)"),
               -7200, 7200),
        within(key("motion", "frames", integer, "18", "", "frames of a sweep, the rest pose included"), 2, 1e6),
        key("motion", "clip", text, "\"\"", "",
            "motion capture clip: relative to the scene, or by name from Debian's assimp-testmodels (01_01.bvh)"),
        within(key("motion", "start_s", number, "0.0", "s", "where in the clip the motion starts, its T-pose frame dropped"), 0, 1e6),
        within(key("motion", "duration_s", number, "0.0", "s", "how much of the clip is played; 0: to its end"), 0, 1e6),
        within(key("motion", "rate_hz", number, "100.0", "1/s", "frames a second; rate_hz * pbs.time_step_s must be 1/n: n steps a frame"),
               1e-3, 1e5),
        key("skinning", "weights", text, "\"paper\"", "", "paper (Eq. 2), rigid (nearest bone), or a CSV file vertex,joint,weight"),
    };
}

std::vector<SceneKey> pbs_keys()
{
    return {
        within(key("pbs", "iterations", integer, "24", "", "N_iterations of Algorithm 1"), 0, 1e6),
        within(key("pbs", "time_step_s", number, "0.01", "s", "time step of Algorithm 1"), 1e-9, 1e3),
        within(key("pbs", "k_stretch", number, "", "",
                   "stiffness of Eq. 10; the paper leaves it unstated outside the jiggling zone; 0 leaves the class out"),
               0, 1),
        within(key("pbs", "k_volume", number, "", "", "stiffness of Eq. 11; the paper leaves it unstated; 0 leaves the class out"), 0, 1),
        within(key("pbs", "k_bind", number, "", "",
                   "stiffness of the bind constraint (Sec. 3.6); the paper leaves it unstated; 0 leaves the class out"),
               0, 1),
        key("pbs", "gravity_m_s2", vec3, "", "m/s^2",
            "external acceleration on the integrated (jiggling) particles; the paper leaves it unstated"),
        one_of(
            key("pbs", "order", text, "\"ordered\"", "",
                "order of projection within a class: plain is file order, as the paper reads; ordered takes sixteen constraints that share "
                "no vertex side by side; grouped the same with neighbouring constraints in groups, the quickest; printed volume_forms "
                "know plain alone"),
            {"plain", "ordered", "grouped"}),
        one_of(key("pbs", "precision", text, "\"f32\"", "", "floating point of the projections"), {"f32", "f64"}),
        one_of(key("pbs", "masses", text, "\"unit\"", "",
                   "unit: m_i = 1 (the paper); lumped: a quarter of the rest volume of each tet around"),
               {"unit", "lumped"}),
        within(key("pbs", "stop_residual", number, "0.0", "", "stop when every residual is below; 0: all iterations"), 0, infinite),
        key("pbs", "sleep", boolean, "false", "",
            "let constraints that LBS satisfies, and all around them, sleep for the frame; at its end they are looked at again and the "
            "frame "
            "is redone with those that are not satisfied any more; orders ordered and grouped"),
        within(key("pbs", "sleep_tolerance", number, "1e-3", "",
                   "what a sleeping constraint may be off: |l / l0 - 1|, |V / V0 - 1|, bind in shares of the mean edge"),
               0, 1),
        key("pbs", "record_iterations", boolean, "false", "", "write iterations.csv: residuals per frame and iteration"),
        within(key("pbs.jiggle", "k_stretch", number, "0.1", "",
                   "stiffness of edges with both ends in the jiggling zone; jiggle is off unless this table is there"),
               0, 1),
        one_of(key("pbs.variant", "stiffness", text, "\"per_iteration\"", "",
                   "per_iteration: the factor k in every iteration, as printed; exponent: 1 - (1 - k)^(1 / iterations) instead (Mueller "
                   "2006), "
                   "so that a lone constraint is left with 1 - k of its error whatever their number"),
               {"per_iteration", "exponent"}),
        one_of(key("pbs.variant", "class_order", text, "\"bind_stretch_volume\"", "",
                   "in which order an iteration takes the classes; bind_stretch_volume is Algorithm 1's, lines 11-13"),
               {"bind_stretch_volume", "bind_volume_stretch", "stretch_bind_volume", "stretch_volume_bind", "volume_bind_stretch",
                "volume_stretch_bind"}),
        one_of(key("pbs.variant", "lbs_entry", text, "\"start\"", "",
                   "where LBS enters Algorithm 1: start: what does not jiggle starts every step at its LBS position; increment: all is "
                   "integrated, and moved by what LBS has moved since the last step"),
               {"start", "increment"}),
        one_of(key("pbs.variant", "bind_on_bone", text, "\"pinned\"", "",
                   "a vertex on its bone: pinned to it, or unbound: without a bind constraint"),
               {"pinned", "unbound"}),
        one_of(key("pbs.variant", "volume_form", text, "\"derived\"", "",
                   "the volume correction: derived from Eq. 11, or with errors of print (labels_relative, labels_absolute: Eq. 12-14 under "
                   "the printed particles; sign: Eq. 17-20; as_printed: all)"),
               {"derived", "labels_relative", "labels_absolute", "sign", "as_printed"}),
    };
}

std::vector<SceneKey> further_deformer_keys()
{
    return {
        within(key("xpbd", "young_pa", number, "1.0e5", "Pa", "Young's modulus of xpbd and xpbd_small_steps"), above_zero, infinite),
        within(key("xpbd", "poisson", number, "0.45", "", "Poisson's ratio; springs alone have 1/4, volume constraints raise it"), 0.25,
               0.499999),
        within(key("xpbd", "density_kg_m3", number, "1000.0", "kg/m^3", "density, lumped"), above_zero, infinite),
        within(key("delta_mush", "iterations", integer, "20", "", "iterations of Laplacian smoothing"), 0, 1e6),
        within(key("delta_mush", "step", number, "0.5", "", "share of the way to the neighbours' mean in each"), 0, 1),
    };
}

std::vector<SceneKey> fem_keys()
{
    return {
        key("fem", "name", text, "\"fem\"", "", "the name this reference has in the records"),
        one_of(key("fem", "model", text, "\"linear\"", "",
                   "constitutive model; linear strain is fictitious by 1 - cos of the rotation and st_venant_kirchhoff gives way under "
                   "compression: both are negative controls at large rotations"),
               {"linear", "corotational", "stable_neo_hookean", "neo_hookean", "st_venant_kirchhoff"}),
        within(key("fem", "element_order", integer, "2", "", "polynomial order of the simplices"), 1, 2),
        one_of(
            key("fem", "formulation", text, "\"displacement\"", "",
                "how volume enters: displacement; mean_dilatation (one volume constraint a tet), which on order 1 is the same; taylor_hood "
                "(order 2 with a continuous pressure, the most accurate near nu = 1/2; of the linear model, quasi-static)"),
            {"displacement", "mean_dilatation", "taylor_hood"}),
        within(key("fem", "young_pa", number, "1.0e5", "Pa", "Young's modulus; cancels where displacements alone drive the body"),
               above_zero, 1e15),
        within(key("fem", "poisson", number, "0.45", "", "Poisson's ratio"), 0, 0.4999999),
        within(key("fem", "density_kg_m3", number, "1000.0", "kg/m^3", "density, for gravity and dynamics"), 0, 1e6),
        key("fem", "gravity_m_s2", vec3, "[0.0, 0.0, 0.0]", "m/s^2", "gravity on the reference"),
        one_of(key("fem", "dynamics", text, "\"quasi_static\"", "",
                   "time integration: quasi_static (equilibrium in every frame), newmark (average acceleration), generalized_alpha"),
               {"quasi_static", "newmark", "generalized_alpha"}),
        within(key("fem", "rayleigh", numbers, "[0.0, 0.0]", "1/s, s",
                   "Rayleigh damping [mass, stiffness]: C = mass M + stiffness K(rest); without dynamics, zero"),
               0, 1e6),
        one_of(
            key("fem", "attachment", text, "\"embedded\"", "",
                "embedded: bones as rigid capsules tied to the flesh by springs; nodes: whole tets inside the capsules prescribed; bind: "
                "the paper's bind constraint as an energy on every vertex, for nonlinear models"),
            {"embedded", "nodes", "bind"}),
        within(key("fem", "core_radius", number, "0.35", "", "radius of the bone's capsule over the local limb radius"), 0.01, 1),
        within(key("fem", "spring_factor", number, "1.0e4", "",
                   "q: the attachment's density is q E / r^2, r the capsule's radius (embedded) or the local limb radius (bind)"),
               1e-3, 1e9),
        one_of(key("fem", "solver", text, "\"cholmod\"", "",
                   "cholmod; umfpack is the second opinion on the linear model; cg_ml: conjugate gradients with algebraic "
                   "multigrid, linear model, for what a factor does not fit in memory for"),
               {"cholmod", "umfpack", "cg_ml"}),
        within(key("fem", "most_newton_steps", integer, "0", "",
                   "nonlinear model, dynamics quasi_static: a stage of the way to a pose that has taken so many of Newton's steps ends, "
                   "and the "
                   "pose is not reached; 0: no limit"),
               0, 1e9),
        key("fem", "nested_start", boolean, "false", "",
            "element_order 2 or a refined character, nonlinear model: to a pose in which a bone is turned by more than 15 degrees from the "
            "last, Newton's iterations start from the solution with order 1, of the unrefined one: a shorter way to the same solution"),
    };
}

std::vector<SceneKey> output_keys()
{
    return {
        key("reference", "name", text, "\"\"", "", "the deformer that errors are measured against; empty: none"),
        one_of(
            key("reference", "error_bar", text, "\"none\"", "",
                "the reference's own discretisation error beside the deformers' errors: orders (solved again with the other element order "
                "on the same tets: cheap for order 2), refined (on tets cut into eight: some 30 times the time of order 2), both (three "
                "solutions, the order of convergence observed); bounds by the grid convergence index, see run.json"),
            {"none", "orders", "refined", "both"}),
        key("deformers", "use", texts, "[\"lbs\", \"pbs\"]", "",
            "what moves the character: names of `pbskin list deformers` and of the [[fem]] tables"),
        within(key("output", "frames_every", integer, "1", "", "write every n-th frame as VTU; 0: none"), 0, 1e9),
        within(key("output", "frames", integers, "[]", "", "further frames to write, by number"), 0, 1e9),
        key("output", "frame_names", texts, "[]", "", "what `frames` show, in the same order: titles of stills"),
        key("output", "metrics", texts, "[\"all\"]", "",
            "groups of metrics beyond the volume columns: errors, sections, surface, all; [] leaves them out"),
    };
}

std::vector<SceneKey> all_keys()
{
    std::vector<SceneKey> keys = character_and_motion_keys();
    for (const auto& more : {pbs_keys(), further_deformer_keys(), fem_keys(), output_keys()})
        keys.insert(keys.end(), more.begin(), more.end());
    return keys;
}

}  // namespace

std::string SceneKey::rule() const
{
    if (!choices.empty()) {
        std::vector<std::string> shown;
        for (const auto& choice : choices) shown.push_back(choice.empty() ? "\"\"" : choice);
        return fmt::format("expected one of {}", fmt::join(shown, ", "));
    }
    static constexpr const char* names[] = {"a text",        "a number",          "an integer",      "true or false",
                                            "three numbers", "a list of numbers", "a list of texts", "a list of integers"};
    std::string words = fmt::format("expected {}", names[static_cast<int>(type)]);
    if (lowest == above_zero)
        words += highest < infinite ? fmt::format(" > 0 and <= {:.10g}", highest) : " > 0";
    else if (lowest > -infinite && highest < infinite)
        words += fmt::format(" from {:.10g} to {:.10g}", lowest, highest);
    else if (lowest > -infinite)
        words += fmt::format(" >= {:g}", lowest);
    return words;
}

const std::vector<SceneKey>& scene_keys()
{
    static const std::vector<SceneKey> keys = all_keys();
    return keys;
}

const SceneKey* find_scene_key(const std::string& path)
{
    const auto& keys = scene_keys();
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.path() == path; });
    return found == keys.end() ? nullptr : &*found;
}

}  // namespace experiments
