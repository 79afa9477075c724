#include "experiments/rigs/fbx_rig.hpp"

#include "experiments/rigs/rig_formats.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <cmath>

namespace pbs {
namespace {

constexpr double metres_per_centimetre = 0.01;  // FBX states its unit in centimetres
constexpr int most_nodes_deep = 4096;

double setting(const FbxObjects& objects, std::string_view name, double otherwise)
{
    const FbxRecord* settings = objects.record("GlobalSettings");
    const std::vector<double> numbers = settings ? fbx_property(*settings, name) : std::vector<double>();
    return numbers.empty() ? otherwise : numbers[0];
}

FbxInheritance inheritance_of(const FbxObject& model, const FbxObjects& objects)
{
    const double type = objects.number(model, "InheritType", 1.0);  // as other programs read files that state none
    if (type != 0.0 && type != 1.0 && type != 2.0)
        objects.refuse(model, "InheritType", number_text(type), "expected 0 (RrSs), 1 (RSrs) or 2 (Rrs)");
    return static_cast<FbxInheritance>(static_cast<int>(type));
}

// Without RotationActive, the order of rotations and those before and after are ignored: they are of no use in the
// program either.
void set_rotations(const FbxObject& model, FbxReading& reading, FbxTransform& transform)
{
    const FbxObjects& objects = reading.objects;
    const Vec3 before = objects.vector(model, "PreRotation", Vec3::Zero()),
               after = objects.vector(model, "PostRotation", Vec3::Zero());
    const double order = objects.number(model, "RotationOrder", 0.0);
    if (objects.number(model, "RotationActive", 0.0) == 0.0) {
        if (order != 0.0 || !before.isZero() || !after.isZero())
            reading.rig.remarks.push_back("RotationOrder, PreRotation and PostRotation of node " + model.name +
                                          " are ignored, since its RotationActive is 0");
        return;
    }
    if (!(order >= 0.0 && order <= 5.0 && order == std::floor(order)))
        objects.refuse(model, "RotationOrder", number_text(order),
                       "expected an order of Euler angles, 0 to 5: change it in the program that made the file, or "
                       "export glTF 2.0 (.glb)");
    transform.rotation_order = static_cast<int>(order);
    transform.pre_rotation_deg = before;
    transform.post_rotation_deg = after;
}

FbxTransform transform_of(const FbxObject& model, FbxReading& reading)
{
    const FbxObjects& objects = reading.objects;
    FbxTransform transform;
    transform.lcl = {objects.vector(model, "Lcl Translation", Vec3::Zero()),
                     objects.vector(model, "Lcl Rotation", Vec3::Zero()),
                     objects.vector(model, "Lcl Scaling", Vec3::Ones())};
    transform.rotation_offset = objects.vector(model, "RotationOffset", Vec3::Zero());
    transform.rotation_pivot = objects.vector(model, "RotationPivot", Vec3::Zero());
    transform.scaling_offset = objects.vector(model, "ScalingOffset", Vec3::Zero());
    transform.scaling_pivot = objects.vector(model, "ScalingPivot", Vec3::Zero());
    transform.inheritance = inheritance_of(model, objects);
    set_rotations(model, reading, transform);
    return transform;
}

void add_nodes(const FbxObject& above, int parent, int depth, FbxReading& reading)
{
    std::vector<RigNode>& nodes = reading.rig.nodes;
    for (const FbxObject* model : reading.objects.below(above, "Model")) {
        if (depth > most_nodes_deep || !reading.node_of.emplace(model, static_cast<int>(nodes.size())).second)
            reading.objects.refuse(*model, "parent", above.name,
                                   "expected one parent, and at most 4096 nodes above each other");
        nodes.push_back({model->name, parent, NodeTransform(), transform_of(*model, reading)});
        add_nodes(*model, static_cast<int>(nodes.size()) - 1, depth + 1, reading);
    }
}

}  // namespace

std::vector<std::string> fbx_material_names(const std::string& path)
{
    const FbxObjects objects(read_fbx_document(read_text_file(path, most_mesh_bytes), path), path);
    std::vector<std::string> names;
    for (const FbxObject* material : objects.of_type("Material")) names.push_back(material->name);
    return names;
}

Rig read_fbx_rig(const std::string& path)
{
    const FbxObjects objects(read_fbx_document(read_text_file(path, most_mesh_bytes), path), path);
    Rig rig;
    rig.file = path;
    rig.unit_m = metres_per_centimetre * setting(objects, "UnitScaleFactor", 1.0);
    rig.nodes.push_back({"RootNode", -1, NodeTransform()});
    FbxReading reading{objects, {}, {}, rig};
    for (const FbxObject* material : objects.of_type("Material"))
        reading.material_of.emplace(material, static_cast<int>(reading.material_of.size()));
    add_nodes(objects.scene(), 0, 0, reading);
    for (const FbxObject* model : objects.of_type("Model"))
        if (reading.node_of.contains(model)) add_fbx_meshes(*model, reading);
    add_fbx_animations(reading);
    if (const std::size_t count = objects.of_type("Constraint").size(); count > 0)
        rig.remarks.push_back(std::to_string(count) +
                              " constraints are left out; bake the animation to keep what they move");
    return rig;
}

}  // namespace pbs
