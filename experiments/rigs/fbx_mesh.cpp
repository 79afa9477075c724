#include "experiments/rigs/fbx_polygons.hpp"
#include "experiments/rigs/fbx_rig.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "pbs/geometry/input_error.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace pbs {
namespace {

constexpr std::size_t most_corners = 1000;  // of a polygon
constexpr float same_look = 1e-4F;  // of normals and texture coordinates; what differs less is rounding of the exporter

// Numbers per corner of polygons, such as normals: a LayerElement of a Geometry. Directly or by an index, for each of
// what it is mapped to.
class Layer {
public:
    // components: numbers per entry. `values` and `indices` are the names of its records.
    Layer(const FbxRecord& record, std::string_view values, std::string_view indices, int components)
        : values_(record.numbers(values)),
          indices_(record.numbers(indices)),
          components_(static_cast<std::size_t>(components))
    {
        const FbxRecord* mapping = record.record("MappingInformationType");
        if (const std::string* text = mapping ? mapping->text(0) : nullptr) mapping_ = *text;
    }

    // The first number of an entry; null where there is none for this corner.
    const double* at(std::size_t corner, std::size_t polygon, std::size_t point) const
    {
        std::size_t entry = mapping_ == "ByPolygonVertex" ? corner
                            : mapping_ == "ByPolygon"     ? polygon
                            : mapping_ == "AllSame"       ? 0
                                                          : point;
        if (!indices_.empty()) {
            if (entry >= indices_.size() || !(indices_[entry] >= 0.0 && indices_[entry] < double(values_.size())))
                return nullptr;
            entry = static_cast<std::size_t>(indices_[entry]);
        }
        return (entry + 1) * components_ <= values_.size() ? &values_[entry * components_] : nullptr;
    }

private:
    std::vector<double> values_, indices_;
    std::size_t components_;
    std::string mapping_;
};

Eigen::Affine3d geometric_transform(const FbxObject& model, const FbxObjects& objects)
{
    return Eigen::Translation3d(objects.vector(model, "GeometricTranslation", Vec3::Zero())) *
           euler_rotation(objects.vector(model, "GeometricRotation", Vec3::Zero()), 0) *
           Eigen::Scaling(objects.vector(model, "GeometricScaling", Vec3::Ones()));
}

// One Geometry of a Model while it is read.
class MeshOfModel {
public:
    MeshOfModel(const FbxObject& geometry, const FbxObject& model, FbxReading& reading)
        : geometry_(geometry),
          model_(model),
          reading_(reading),
          objects_(reading.objects),
          geometric_(geometric_transform(model, objects_))
    {
        mesh_.name = geometry.name.empty() ? model.name : geometry.name;
        mesh_.node = reading.node_of.at(&model);
    }

    void add()
    {
        read_polygons();
        if (polygons_.triangles.empty()) return;
        const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> look = look_of_corners();
        number_points(look);
        add_triangles();
        add_skin();
        remark_on_morphs();
        reading_.rig.meshes.push_back(std::move(mesh_));
    }

private:
    void read_polygons()
    {
        const std::vector<double> numbers = geometry_.record->numbers("Vertices");
        if (numbers.size() % 3 != 0)
            objects_.refuse(geometry_, "Vertices", std::to_string(numbers.size()) + " numbers",
                            "expected three for each point");
        control_ = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
            numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
        for (const double index : geometry_.record->numbers("PolygonVertexIndex")) {
            const double point = index < 0.0 ? -index - 1.0 : index;  // a negative one is the last of its polygon
            if (!(point < double(control_.rows())))
                objects_.refuse(geometry_, "PolygonVertexIndex", std::to_string(static_cast<long long>(index)),
                                "expected a point of the " + std::to_string(control_.rows()) + " in Vertices");
            polygons_.corners.push_back(static_cast<int>(point));
            if (!(index < 0.0)) continue;
            if (polygons_.corners.size() > most_corners + (polygons_.ends.empty() ? 0 : polygons_.ends.back()))
                objects_.refuse(geometry_, "PolygonVertexIndex", "",
                                "expected polygons of at most 1000 corners: triangulate the mesh");
            polygons_.ends.push_back(polygons_.corners.size());
        }
        if (polygons_.corners.size() != (polygons_.ends.empty() ? 0 : polygons_.ends.back()))
            objects_.refuse(geometry_, "PolygonVertexIndex", "",
                            "expected a negative number at the end of the last polygon");
        triangulate(control_, polygons_);
    }

    Layer layer_of(const FbxRecord& record, const std::string& values, int components) const
    {
        return {record, values, values == "Normals" ? "NormalsIndex" : "UVIndex", components};
    }

    // The normal and the texture coordinates of each corner of a polygon, #corners x (3 + 2 #sets), or no columns.
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> look_of_corners()
    {
        const FbxRecord* normals = geometry_.record->record("LayerElementNormal");
        std::vector<Layer> textures;
        for (const FbxRecord& record : geometry_.record->records)
            if (record.name == "LayerElementUV") textures.push_back(layer_of(record, "UV", 2));
        const auto sets = static_cast<Eigen::Index>(textures.size());
        Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> look;
        look.setZero(static_cast<Eigen::Index>(polygons_.corners.size()), normals || sets > 0 ? 3 + 2 * sets : 0);
        const std::optional<Layer> normal_layer =
            normals ? std::optional(layer_of(*normals, "Normals", 3)) : std::nullopt;
        const Eigen::Matrix3d turn = geometric_.linear().inverse().transpose();
        std::size_t polygon = 0;
        for (std::size_t corner = 0; corner < polygons_.corners.size(); ++corner) {
            if (polygon < polygons_.ends.size() && corner == polygons_.ends[polygon]) ++polygon;
            const auto point = static_cast<std::size_t>(polygons_.corners[corner]);
            const auto row = static_cast<Eigen::Index>(corner);
            if (const double* normal = normal_layer ? normal_layer->at(corner, polygon, point) : nullptr)
                look.block<1, 3>(row, 0) =
                    (turn * Vec3(normal[0], normal[1], normal[2])).normalized().cast<float>().transpose();
            for (Eigen::Index set = 0; set < sets; ++set)
                if (const double* uv = textures[static_cast<std::size_t>(set)].at(corner, polygon, point))
                    // glTF's v: down
                    look.block<1, 2>(row, 3 + 2 * set) << static_cast<float>(uv[0]), static_cast<float>(1.0 - uv[1]);
        }
        return look.unaryExpr([](float x) { return std::isfinite(x) ? x : 0.0F; });
    }

    // A point is a control point that a triangle uses, with one look; points are in the order of their control points.
    void number_points(const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& look)
    {
        std::vector<int> order = polygons_.triangles;  // corners
        std::ranges::sort(order);
        order.erase(std::unique(order.begin(), order.end()), order.end());
        const auto rounded = (look / same_look).array().round().eval();
        const auto row = [&](int corner) {
            return std::span(rounded.data() + corner * look.cols(), static_cast<std::size_t>(look.cols()));
        };
        const auto control = [&](int corner) { return polygons_.corners[static_cast<std::size_t>(corner)]; };
        std::ranges::stable_sort(order, [&](int a, int b) {
            return control(a) != control(b) ? control(a) < control(b)
                                            : std::ranges::lexicographical_compare(row(a), row(b));
        });
        point_of_corner_.assign(polygons_.corners.size(), -1);
        std::vector<int> first_corner;
        for (const int corner : order) {
            const bool is_new = first_corner.empty() || control(corner) != control(first_corner.back()) ||
                                !std::ranges::equal(row(corner), row(first_corner.back()));
            if (is_new) first_corner.push_back(corner);
            point_of_corner_[static_cast<std::size_t>(corner)] = static_cast<int>(first_corner.size()) - 1;
        }
        mesh_.points.resize(static_cast<Eigen::Index>(first_corner.size()), 3);
        mesh_.look.numbers.resize(look.cols() > 0 ? mesh_.points.rows() : 0, look.cols());
        for (Eigen::Index p = 0; p < mesh_.points.rows(); ++p) {
            const int corner = first_corner[static_cast<std::size_t>(p)];
            control_of_point_.push_back(control(corner));
            mesh_.points.row(p) = geometric_ * Vec3(control_.row(control(corner)));
            if (look.cols() > 0) mesh_.look.numbers.row(p) = look.row(corner);
        }
    }

    void add_triangles()
    {
        const std::vector<const FbxObject*> materials = objects_.below(model_, "Material");
        const FbxRecord* record = geometry_.record->record("LayerElementMaterial");
        const std::optional<Layer> layer = record ? std::optional(Layer(*record, "Materials", "", 1)) : std::nullopt;
        const auto faces = static_cast<Eigen::Index>(polygons_.triangles.size() / 3);
        const bool is_mirrored = geometric_.linear().determinant() < 0.0;
        mesh_.triangles.resize(faces, 3);
        for (Eigen::Index f = 0; f < faces; ++f) {
            const int* corners = &polygons_.triangles[static_cast<std::size_t>(3 * f)];
            for (int c = 0; c < 3; ++c)
                mesh_.triangles(f, is_mirrored ? 2 - c : c) = point_of_corner_[static_cast<std::size_t>(corners[c])];
            const double* number = layer ? layer->at(0, polygons_.polygon[static_cast<std::size_t>(f)], 0) : nullptr;
            const double place = number ? *number : 0.0;
            const bool is_known = place >= 0.0 && place < double(materials.size());
            mesh_.look.material.push_back(is_known ? reading_.material_of.at(materials[static_cast<std::size_t>(place)])
                                                   : -1);
        }
    }

    void add_skin()
    {
        std::vector<std::vector<JointShare>> control_shares(static_cast<std::size_t>(control_.rows()));
        const FbxObject* used = nullptr;
        for (const FbxObject* skin : objects_.below(geometry_, "Deformer"))
            for (const FbxObject* cluster : objects_.below(*skin, "Deformer")) {
                if (cluster->kind != "Cluster" || cluster->record->numbers("Indexes").empty()) continue;
                if (used && used != skin)
                    objects_.refuse(geometry_, "Deformer", skin->name,
                                    "expected one skin: merge them, or export glTF 2.0 (.glb)");
                used = skin;
                add_cluster(*cluster, control_shares);
            }
        if (!used) return;
        std::vector<std::vector<JointShare>> shares;
        for (const int control : control_of_point_) shares.push_back(control_shares[static_cast<std::size_t>(control)]);
        Rig& rig = reading_.rig;
        mesh_.skin = normalised_skin(with_weights_of_neighbours(shares, mesh_, rig.file, rig.remarks), rig.file,
                                     mesh_.name, rig.remarks, rig.notes);
        set_kind_of_skinning(*used);
    }

    void add_cluster(const FbxObject& cluster, std::vector<std::vector<JointShare>>& control_shares)
    {
        const std::vector<double> points = cluster.record->numbers("Indexes"),
                                  weights = cluster.record->numbers("Weights"),
                                  bind = cluster.record->numbers("Transform");
        if (weights.size() != points.size())
            objects_.refuse(cluster, "Weights", std::to_string(weights.size()) + " numbers",
                            "expected one for each of the " + std::to_string(points.size()) + " in Indexes");
        const FbxRecord* mode = cluster.record->record("Mode");
        if (mode && mode->text(0) && *mode->text(0) == "Additive")
            objects_.refuse(cluster, "Mode", "Additive", "expected Normalize or Total1: export glTF 2.0 (.glb)");
        const int joint = static_cast<int>(mesh_.joints.size());
        mesh_.joints.push_back({node_of(cluster), bind_of(cluster, bind)});
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!(points[i] >= 0.0 && points[i] < double(control_.rows())))
                objects_.refuse(cluster, "Indexes", number_text(points[i], 12),
                                expected_whole("a point", 0, control_.rows() - 1));
            control_shares[static_cast<std::size_t>(points[i])].push_back({joint, weights[i]});
        }
    }

    int node_of(const FbxObject& cluster) const
    {
        for (const FbxObject* joint : objects_.below(cluster, "Model"))
            if (const auto node = reading_.node_of.find(joint); node != reading_.node_of.end()) return node->second;
        objects_.refuse(cluster, "joint", "", "missing: expected a node of the scene that moves the points");
    }

    Eigen::Affine3d bind_of(const FbxObject& cluster, const std::vector<double>& numbers) const
    {
        if (numbers.size() != 16)
            objects_.refuse(cluster, "Transform", std::to_string(numbers.size()) + " numbers", "expected 16");
        Eigen::Affine3d bind;
        bind.matrix() = Eigen::Map<const Eigen::Matrix4d>(numbers.data());  // column by column
        if (!bind.matrix().allFinite() || !(std::abs(bind.linear().determinant()) > 0.0))
            objects_.refuse(cluster, "Transform", "", "expected a matrix of finite numbers that has an inverse");
        return bind;
    }

    void set_kind_of_skinning(const FbxObject& skin)
    {
        const FbxRecord* record = skin.record->record("SkinningType");
        const std::string kind = record && record->text(0) ? *record->text(0) : "";
        if (kind == "DualQuaternion") {
            mesh_.dual_quaternion_share.assign(static_cast<std::size_t>(mesh_.points.rows()), 1.0);
        } else if (kind == "Blend") {
            const std::vector<double> points = skin.record->numbers("Indexes"),
                                      weights = skin.record->numbers("BlendWeights");
            std::vector<double> share(static_cast<std::size_t>(control_.rows()), 0.0);
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (i >= weights.size() || !(points[i] >= 0.0 && points[i] < double(share.size())) ||
                    !(weights[i] >= 0.0 && weights[i] <= 1.0))
                    objects_.refuse(skin, "BlendWeights", i < weights.size() ? number_text(weights[i]) : "missing",
                                    "expected a number from 0 to 1 for each point in Indexes");
                share[static_cast<std::size_t>(points[i])] = weights[i];
            }
            for (const int control : control_of_point_)
                mesh_.dual_quaternion_share.push_back(share[static_cast<std::size_t>(control)]);
        } else if (!kind.empty() && kind != "Linear" && kind != "Rigid") {
            objects_.refuse(skin, "SkinningType", kind,
                            "expected Linear, Rigid, DualQuaternion or Blend: export glTF 2.0 (.glb)");
        }
    }

    void remark_on_morphs()
    {
        std::size_t targets = 0;
        for (const FbxObject* shapes : objects_.below(geometry_, "Deformer"))
            for (const FbxObject* channel : objects_.below(*shapes, "Deformer"))
                targets += objects_.below(*channel, "Geometry").size();
        if (targets > 0)
            reading_.rig.remarks.push_back("mesh " + mesh_.name + ": " + std::to_string(targets) +
                                           " morph targets are left out");
    }

    const FbxObject &geometry_, &model_;
    FbxReading& reading_;
    const FbxObjects& objects_;
    Eigen::Affine3d geometric_;
    RigMesh mesh_;
    Positions control_;  // the file's points, #control points x 3
    FbxPolygons polygons_;
    std::vector<int> point_of_corner_, control_of_point_;
};

}  // namespace

void add_fbx_meshes(const FbxObject& model, FbxReading& reading)
{
    for (const FbxObject* geometry : reading.objects.below(model, "Geometry")) {
        if (geometry->kind == "Mesh")
            MeshOfModel(*geometry, model, reading).add();
        else
            reading.rig.remarks.push_back("geometry " + geometry->name + " of node " + model.name +
                                          " is left out: it is a " + geometry->kind +
                                          "; convert it into a polygon mesh");
    }
}

}  // namespace pbs
