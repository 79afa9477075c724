#include "pbs/rig/rig_bytes.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/packed_bytes.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

constexpr double farthest = 1e9;  // [file's units]

void put(const Eigen::Affine3d& affine, PackedBytes& bytes)
{
    bytes.put_array(affine.data(), 16);
}

void put(const std::optional<KeyTrack>& track, PackedBytes& bytes)
{
    bytes.put(static_cast<int>(track.has_value()));
    if (!track) return;
    bytes.put(static_cast<int>(track->interpolation));
    bytes.put_array(track->times_s.data(), track->times_s.size());
    bytes.put_array(track->values.empty() ? nullptr : track->values.front().data(), 4 * track->values.size());
}

void put(const RigNode& node, PackedBytes& bytes)
{
    bytes.put_text(node.name);
    bytes.put(node.parent);
    bytes.put_array(node.rest.translation.data(), 3);
    bytes.put_array(node.rest.rotation.coeffs().data(), 4);
    bytes.put_array(node.rest.scale.data(), 3);
    bytes.put(static_cast<int>(node.rest.matrix.has_value()));
    if (node.rest.matrix) put(*node.rest.matrix, bytes);
}

void put(const RigMesh& mesh, PackedBytes& bytes)
{
    bytes.put_text(mesh.name);
    bytes.put(mesh.node);
    bytes.put_array(mesh.points.data(), static_cast<std::size_t>(mesh.points.size()));
    bytes.put_array(mesh.triangles.data(), static_cast<std::size_t>(mesh.triangles.size()));
    bytes.put(static_cast<int>(mesh.joints.size()));
    for (const SkinJoint& joint : mesh.joints) {
        bytes.put(joint.node);
        put(joint.inverse_bind, bytes);
    }
    bytes.put_array(mesh.skin.first.data(), mesh.skin.first.size());
    bytes.put_array(mesh.skin.bone.data(), mesh.skin.bone.size());
    bytes.put_array(mesh.skin.weight.data(), mesh.skin.weight.size());
}

void put(const RigAnimation& animation, PackedBytes& bytes)
{
    bytes.put_text(animation.name);
    bytes.put(animation.start_s);
    bytes.put(animation.end_s);
    bytes.put(static_cast<int>(animation.nodes.size()));
    for (const NodeTracks& tracks : animation.nodes) {
        bytes.put(tracks.node);
        for (const auto* track : {&tracks.translation, &tracks.rotation, &tracks.scale}) put(*track, bytes);
    }
}

template <typename Item>
void put_all(const std::vector<Item>& items, PackedBytes& bytes)
{
    bytes.put(static_cast<int>(items.size()));
    for (const Item& item : items) put(item, bytes);
}

class RigTaker {
public:
    RigTaker(const std::string& bytes, const std::string& path) : taken_(bytes), path_(path) {}

    Rig rig()
    {
        Rig rig;
        rig.file = path_;
        rig.unit_m = taken_.take<double>();
        require(rig.unit_m > 0.0 && std::isfinite(rig.unit_m));
        for (int left = count(); left > 0; --left) rig.nodes.push_back(node(static_cast<int>(rig.nodes.size())));
        nodes_ = static_cast<int>(rig.nodes.size());
        for (int left = count(); left > 0; --left) rig.meshes.push_back(mesh());
        for (int left = count(); left > 0; --left) rig.animations.push_back(animation());
        for (int left = count(); left > 0; --left) rig.remarks.push_back(text());
        require(taken_.whole());
        return rig;
    }

private:
    void require(bool sound) const
    {
        if (!sound || !taken_.sound()) throw InputError(path_, 0, "", "", "damaged: the reader's answer is not a whole rig");
    }

    int count()
    {
        const int number = taken_.take<int>();
        require(number >= 0);
        return number;
    }

    int node_index()
    {
        const int node = taken_.take<int>();
        require(node >= 0 && node < nodes_);
        return node;
    }

    std::string text()
    {
        std::string text = taken_.take_text();
        require(true);
        return text;
    }

    std::vector<double> numbers(std::size_t expected)
    {
        std::vector<double> numbers = taken_.take_array<double>();
        require(numbers.size() == expected &&
                std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::abs(n) <= farthest; }));
        return numbers;
    }

    Eigen::Affine3d affine()
    {
        Eigen::Affine3d affine;
        affine.matrix() = Eigen::Map<const Eigen::Matrix4d>(numbers(16).data());
        return affine;
    }

    RigNode node(int index)
    {
        RigNode node;
        node.name = text();
        node.parent = taken_.take<int>();
        require(node.parent >= -1 && node.parent < index);
        node.rest.translation = Vec3(numbers(3).data());
        node.rest.rotation = Eigen::Quaterniond(numbers(4).data());
        require(node.rest.rotation.norm() > 0.0);
        node.rest.rotation.normalize();
        node.rest.scale = Vec3(numbers(3).data());
        if (taken_.take<int>() != 0) node.rest.matrix = affine();
        return node;
    }

    RigMesh mesh()
    {
        RigMesh mesh;
        mesh.name = text();
        mesh.node = node_index();
        const std::vector<double> points = taken_.take_array<double>();
        const std::vector<int> corners = taken_.take_array<int>();
        require(points.size() % 3 == 0 && corners.size() % 3 == 0);
        mesh.points = Eigen::Map<const Positions>(points.data(), static_cast<Eigen::Index>(points.size() / 3), 3);
        mesh.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
        const int rows = static_cast<int>(mesh.points.rows());
        for (const int corner : corners) require(corner >= 0 && corner < rows);
        if (!mesh.points.allFinite() || (rows > 0 && mesh.points.cwiseAbs().maxCoeff() > farthest))
            throw InputError(path_, 0, "points of mesh " + mesh.name, "", "expected finite numbers of at most 1e9");
        for (int left = count(); left > 0; --left) {
            const int node = node_index();
            mesh.joints.push_back({node, affine()});
        }
        mesh.skin = skin(rows, static_cast<int>(mesh.joints.size()));
        return mesh;
    }

    Weights skin(int points, int joints)
    {
        Weights skin;
        skin.first = taken_.take_array<int>();
        skin.bone = taken_.take_array<int>();
        skin.weight = taken_.take_array<double>();
        if (joints == 0) return skin;
        require(skin.vertices() == points && skin.first.front() == 0 && std::is_sorted(skin.first.begin(), skin.first.end()) &&
                skin.first.back() == static_cast<int>(skin.bone.size()) && skin.weight.size() == skin.bone.size());
        for (const int joint : skin.bone) require(joint >= 0 && joint < joints);
        for (const double weight : skin.weight) require(weight >= 0.0 && weight <= 1.0 + 1e-9);
        return skin;
    }

    std::optional<KeyTrack> track()
    {
        if (taken_.take<int>() == 0) return std::nullopt;
        KeyTrack track;
        const int interpolation = taken_.take<int>();
        require(interpolation >= 0 && interpolation <= static_cast<int>(Interpolation::cubic_spline));
        track.interpolation = static_cast<Interpolation>(interpolation);
        track.times_s = taken_.take_array<double>();
        require(!track.times_s.empty() && std::is_sorted(track.times_s.begin(), track.times_s.end()) &&
                std::isfinite(track.times_s.front()) && std::isfinite(track.times_s.back()));
        const std::size_t per_key = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
        const std::vector<double> values = numbers(4 * per_key * track.times_s.size());
        for (std::size_t at = 0; at < values.size(); at += 4) track.values.emplace_back(values.data() + at);
        return track;
    }

    RigAnimation animation()
    {
        RigAnimation animation;
        animation.name = text();
        animation.start_s = taken_.take<double>();
        animation.end_s = taken_.take<double>();
        require(std::isfinite(animation.start_s) && std::isfinite(animation.end_s) && animation.start_s <= animation.end_s);
        for (int left = count(); left > 0; --left) {
            NodeTracks tracks;
            tracks.node = node_index();
            tracks.translation = track();
            tracks.rotation = track();
            tracks.scale = track();
            animation.nodes.push_back(std::move(tracks));
        }
        return animation;
    }

    TakenBytes taken_;
    const std::string& path_;
    int nodes_ = 0;
};

}  // namespace

std::string packed(const Rig& rig)
{
    PackedBytes bytes;
    bytes.put(rig.unit_m);
    put_all(rig.nodes, bytes);
    put_all(rig.meshes, bytes);
    put_all(rig.animations, bytes);
    bytes.put(static_cast<int>(rig.remarks.size()));
    for (const std::string& remark : rig.remarks) bytes.put_text(remark);
    return bytes.text();
}

Rig unpacked_rig(const std::string& bytes, const std::string& path)
{
    return RigTaker(bytes, path).rig();
}

}  // namespace pbs
