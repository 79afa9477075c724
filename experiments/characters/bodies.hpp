// Characters by name (the table is named_bodies()) and from files.
//   const Character human = make_character({.body = "human"});
//   const Character hero = make_character({.model_file = "hero.glb", .vertices = 4000});
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/characters/remark.hpp"
#include "experiments/meshes/meshing.hpp"

#include <string>
#include <vector>

namespace pbs {

// A body by name, a rigged model_file, or mesh_file with skeleton_file.
struct CharacterSource {
    std::string body = {};  // a name of named_bodies(); empty: from files
    // A rigged file (glTF, FBX, COLLADA) whose surface is meshed; skeleton_file is only for one without joints.
    // the animation by name that determines the model's size; empty: the first one
    std::string model_file = {}, animation = {};
    double model_scale = 1.0;  // further metres per metre of the model file
    // Tets that read_tet_mesh takes [m].
    // .bvh, .gltf, .glb, .fbx: a clip's zero pose; any other: the skeleton TOML
    std::string mesh_file = {}, skeleton_file = {};
    double skeleton_scale = 1.0;  // metres per unit of the skeleton file
    int vertices = 0;             // wanted size of a body; 0: its default, near Table 1's
    // null: artist of a model with joints, else paper; not read where there is a weights_file
    std::optional<WeightKind> weights = {};
    std::string weights_file = {};  // CSV vertex,joint,weight; empty: `weights`
    bool surface = true;            // carry the rendered surface along, where the body has one
    int refinements =
        0;  // how often every tet is cut into eight; `vertices` and a weights file refer to the unrefined mesh
};

// A body that make_character knows by name.
struct NamedBody {
    std::string name;
    int vertices;         // where none are wanted
    bool is_character;    // with a skeleton like a human's: studies of characters take those that are installed
    std::string package;  // what brings its files; empty: it is built in
    // The files that must be there, and the body with a number of vertices and, if requested and there is one, its
    // rendered surface.
    std::vector<std::string> (*files)(const std::string& name);
    Character (*make)(const std::string& name, int vertices, bool with_surface);
};
const std::vector<NamedBody>& named_bodies();
bool is_character(const std::string& body);  // as NamedBody has it; false for a name that is none

// Are the files of a named body there? Cheap: nothing is read or meshed. require_body: an InputError that names what is
// missing. Bodies that are built in have no files, and names that are none are not refused here but by make_character.
void require_body(const std::string& body);
bool body_is_installed(const std::string& body);  // whether require_body throws nothing

// Builds it, or takes the tets from the cache (content hash of what they are made from). A body that is not installed
// is an InputError that names its package. InputErrors as well: another name; a mesh without a skeleton or the other
// way round; vertices below 0, or fewer than the mesher makes; what read_tet_mesh, parse_skeleton, read_clip and
// parse_weights refuse; a skeleton from a file none of whose bones reaches the mesh's bounding box, or that is 25 times
// larger or smaller than the mesh (other units); a file that changed while it was read.
Character make_character(const CharacterSource& source);

// make_character with what was accepted in a mesh from a file although its author may not have meant it (mesh_io.hpp).
//   RemarkList remarks;
//   const Character arm = make_character({.mesh_file = "arm.msh", .skeleton_file = "arm.skeleton.toml"}, remarks);
// One line each: turned tets, parts, an extent that speaks for other units than metres; none of a body by name.
Character make_character(const CharacterSource& source, RemarkList& remarks);

// The flesh within the same skin on other tets (mesh_anew), whose InputErrors reach the caller: what finite elements
// are solved on to learn how much the character's own tets matter. It has the character's bones with their sizes, Eq.
// 2's weights, and no surface to be rendered. InputError as well for flesh that is cut between parts.
Character remeshed(const Character& character, const Remeshing& options);

}  // namespace pbs
