#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/named_bodies.hpp"
#include "experiments/characters/skeleton_file.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/system/files.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <cstring>

namespace pbs {
namespace {

// The header's words after the magic by their places; those that are read here.
constexpr std::size_t version = 0, file_size = 1, text_bytes = 3, text_at = 4, array_count = 7, vertex_count = 8,
                      arrays_at = 9;
constexpr std::size_t triangle_count = 10, triangles_at = 11, joint_count = 13, joints_at = 14;
constexpr const char* magic = "INTERQUAKEMODEL";  // and a zero
constexpr std::size_t magic_bytes = 16, header_bytes = 124, array_bytes = 20, triangle_bytes = 12, joint_bytes = 48;
constexpr std::uint32_t position_type = 0, float_format = 7;

class IqmFile {
public:
    explicit IqmFile(const std::string& path) : path_(path), bytes_(read_text_file(path))
    {
        if (bytes_.size() < header_bytes || std::memcmp(bytes_.data(), magic, magic_bytes) != 0)
            refuse("magic", "", "no IQM file, or cut short within its header");
        if (header(version) != 2) refuse("version", std::to_string(header(version)), "expected 2");
        if (header(file_size) != bytes_.size())
            refuse("filesize", std::to_string(header(file_size)),
                   "the file has " + std::to_string(bytes_.size()) + " bytes: cut short?");
    }

    std::uint32_t header(std::size_t word) const { return word_at(magic_bytes + 4 * word); }
    std::uint32_t word_at(std::size_t byte) const { return value_at<std::uint32_t>(byte); }
    float float_at(std::size_t byte) const { return value_at<float>(byte); }

    // The position at which a block begins, after a check that it lies inside the file.
    std::size_t block(const std::string& field, std::size_t at, std::size_t count, std::size_t bytes_each) const
    {
        if (at > bytes_.size() || count > (bytes_.size() - at) / bytes_each)
            refuse(field, std::to_string(at),
                   std::to_string(count) + " of " + std::to_string(bytes_each) + " bytes end beyond the file");
        return at;
    }

    std::string text(std::size_t offset) const
    {
        const std::size_t begin = block("ofs_text", header(text_at), header(text_bytes), 1);
        if (offset >= header(text_bytes)) refuse("name", std::to_string(offset), "expected an offset within the text");
        const std::string all = bytes_.substr(begin, header(text_bytes));
        return all.substr(offset, all.find('\0', offset) - offset);
    }

    [[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& rule) const
    {
        throw InputError(path_, 0, field, value, rule);
    }

private:
    template <typename Value>
    Value value_at(std::size_t byte) const
    {
        Value value;
        std::memcpy(&value, bytes_.data() + byte, sizeof value);  // little-endian, as every machine this is built on
        return value;
    }

    std::string path_, bytes_;
};

Positions read_positions(const IqmFile& file)
{
    const std::size_t arrays =
        file.block("ofs_vertexarrays", file.header(arrays_at), file.header(array_count), array_bytes);
    for (std::size_t a = 0; a < file.header(array_count); ++a) {
        const std::size_t array = arrays + a * array_bytes;
        if (file.word_at(array) != position_type) continue;
        if (file.word_at(array + 8) != float_format || file.word_at(array + 12) != 3)
            file.refuse("vertexarrays.position", "", "expected three floats per vertex");
        const std::size_t count = file.header(vertex_count);
        const std::size_t values = file.block("vertexarrays.position", file.word_at(array + 16), count, 12);
        Positions points(static_cast<Eigen::Index>(count), 3);
        for (Eigen::Index i = 0; i < points.size(); ++i)
            points.data()[i] = file.float_at(values + 4 * static_cast<std::size_t>(i));
        if (!points.allFinite()) file.refuse("vertexarrays.position", "", "expected finite coordinates");
        return points;
    }
    file.refuse("vertexarrays.position", "", "missing");
}

// Clockwise in the file, as seen from outside; ours are counter-clockwise.
Triangles read_triangles(const IqmFile& file)
{
    const std::size_t count = file.header(triangle_count);
    if (count == 0) file.refuse("num_triangles", "0", "expected a mesh");
    const std::size_t corners = file.block("ofs_triangles", file.header(triangles_at), count, triangle_bytes);
    Triangles triangles(static_cast<Eigen::Index>(count), 3);
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = file.word_at(corners + triangle_bytes * t + 4 * corner);
            if (vertex >= file.header(vertex_count))
                file.refuse("triangles", std::to_string(vertex), "expected a vertex's number");
            triangles(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(2 - corner)) = static_cast<int>(vertex);
        }
    return triangles;
}

// Points of equal coordinates become one; triangles that lose a corner by it are dropped.
SurfaceMesh joined(const Positions& points, const Triangles& triangles)
{
    Triangles all = joined_triangles(points, triangles);
    Eigen::Index kept = 0;
    for (Eigen::Index t = 0; t < all.rows(); ++t)
        if (all(t, 0) != all(t, 1) && all(t, 1) != all(t, 2) && all(t, 2) != all(t, 0))
            all.row(kept++) = all.row(t).eval();
    all.conservativeResize(kept, 3);
    return {points(renumbered(all, points.rows()), Eigen::all), all};
}

// A joint: name, parent, translation, rotation (x, y, z, w) and scale relative to its parent.
std::vector<IqmJoint> read_joints(const IqmFile& file)
{
    const std::size_t count = file.header(joint_count),
                      begin = file.block("ofs_joints", file.header(joints_at), count, joint_bytes);
    std::vector<IqmJoint> joints;
    std::vector<Eigen::Affine3d> in_rest;
    for (std::size_t j = 0; j < count; ++j) {
        const std::size_t at = begin + j * joint_bytes;
        IqmJoint joint;
        joint.name = file.text(file.word_at(at));
        joint.parent = static_cast<int>(file.word_at(at + 4));
        if (joint.parent < -1 || joint.parent >= static_cast<int>(j))
            file.refuse("joint " + joint.name + ", parent", std::to_string(joint.parent),
                        "expected a joint before it, or -1");
        Eigen::Matrix<double, 10, 1> values;
        for (Eigen::Index v = 0; v < 10; ++v) values(v) = file.float_at(at + 8 + 4 * static_cast<std::size_t>(v));
        const Eigen::Quaterniond rotation(values(6), values(3), values(4), values(5));
        if (!values.allFinite() || !(rotation.norm() > 0.0))
            file.refuse("joint " + joint.name, "", "expected finite numbers and a rotation");
        const Eigen::Affine3d local =
            Eigen::Translation3d(values.head<3>()) * rotation.normalized() * Eigen::Scaling(Vec3(values.tail<3>()));
        in_rest.push_back(joint.parent < 0 ? local : in_rest[joint.parent] * local);
        joint.position = in_rest.back().translation();
        joints.push_back(joint);
    }
    return joints;
}

constexpr int skeleton_version = 1;  // raised with `fold`, so that the cache knows

// 52 joints to 26 bones, with the human's names where clips know them. The forearm is cut in two, as the human's is, so
// that the wrist's twist can be spread along it; the tail follows the pelvis, the ears the head.
const std::vector<FoldedBone> fold = {
    {"pelvis", "", {"CTRL_Pelvis"}, {"CTRL_FK_Femur.L", "CTRL_FK_Femur.R"}},
    {"spine", "pelvis", {"CTRL_Spin"}, {"CTRL_Spin.M"}},
    {"chest", "spine", {"CTRL_Spin.M"}, {"CTRL_RibCage"}},
    {"neck", "chest", {"CTRL_RibCage"}, {"CTRL_Head"}},
    {"head", "neck", {"CTRL_Head"}, {"CTRL_Eartip.L", "CTRL_Eartip.R"}},
    {"tail_1", "pelvis", {"Tail_1"}, {"Tail_3"}},
    {"tail_2", "tail_1", {"Tail_3"}, {"Tail_5"}},
    {"tail_3", "tail_2", {"Tail_5"}, {"Tail_8"}},
    {"clavicle.*", "chest", {"CTRL_RibCage"}, {"CTRL_FK_Humerus.*"}},
    {"upper_arm.*", "clavicle.*", {"CTRL_FK_Humerus.*"}, {"CTRL_FK_Forearm.*"}},
    {"forearm_upper.*", "upper_arm.*", {"CTRL_FK_Forearm.*"}, {"CTRL_FK_Forearm.*", "CTRL_FK_Hand.*"}},
    {"forearm_lower.*", "forearm_upper.*", {"CTRL_FK_Forearm.*", "CTRL_FK_Hand.*"}, {"CTRL_FK_Hand.*"}},
    {"hand.*", "forearm_lower.*", {"CTRL_FK_Hand.*"}, {"CTRL_FK_Fingers.*"}},
    {"hip.*", "pelvis", {"CTRL_Pelvis"}, {"CTRL_FK_Femur.*"}},
    {"thigh.*", "hip.*", {"CTRL_FK_Femur.*"}, {"CTRL_FK_Shin.*"}},
    {"shin.*", "thigh.*", {"CTRL_FK_Shin.*"}, {"CTRL_FK_Foot.*"}},
    {"foot.*", "shin.*", {"CTRL_FK_Foot.*"}, {"CTRL_FK_Toe.*"}},
};

// x left, z up, he looks along -y  ->  x left, y up, z forward.
Vec3 turned(const Vec3& point)
{
    return {point(0), point(2), -point(1)};
}

Skeleton skeleton_of(const IqmModel& model, const std::string& file)
{
    return fold_skeleton(fold, file, [&](const std::string& name) {
        for (const IqmJoint& joint : model.joints)
            if (joint.name == name) return turned(joint.position);
        throw InputError(file, 0, "joints", name, "missing");
    });
}

}  // namespace

IqmModel read_iqm(const std::string& path)
{
    const IqmFile file(path);
    return {joined(read_positions(file), read_triangles(file)), read_joints(file)};
}

std::string frankie_file()
{
    return "/usr/share/games/cube2/packages/models/frankie/Frankie.iqm";
}

std::vector<std::string> frankie_files(const std::string&)
{
    return {frankie_file()};
}

Character make_frankie(const std::string& name, int vertices, bool)
{
    const std::string file = frankie_file(), hash = hash_of_file(file);
    const IqmModel model = read_iqm(file);
    const auto turned_skin = [&] {
        SurfaceMesh skin = model.surface;
        for (Eigen::Index i = 0; i < skin.points.rows(); ++i)
            skin.points.row(i) = turned(model.surface.points.row(i)).transpose();
        return skin;
    };
    const SurfaceBody body{.name = name,
                           .made_from = hash + std::to_string(skeleton_version),
                           .skeleton = skeleton_of(model, file),
                           .surface = turned_skin};
    Character frankie = make_surface_body(body, vertices, false);
    frankie.inputs = {{file_name(file), hash}};
    return frankie;
}

}  // namespace pbs
