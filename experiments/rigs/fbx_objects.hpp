// The objects of an FBX file, their properties and how they are connected.
//   const FbxObjects objects(read_fbx_document(bytes, path), path);
//   for (const FbxObject* skin : objects.below(*mesh, "Deformer")) ...
#pragma once

#include "experiments/rigs/fbx_document.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <map>
#include <string>
#include <vector>

namespace pbs {

struct FbxObject {
    std::int64_t id = 0;
    std::string type = {}, name = {}, kind = {};  // "Model", "elbow", "LimbNode"
    const FbxRecord* record = nullptr;            // null of the scene
    const FbxRecord* defaults = nullptr;          // of the properties of its type; null where the file states none
};

// A connection from an object to one that belongs to it; property: to which of the upper object's properties it is
// connected, or empty.
struct FbxConnection {
    const FbxObject* object = nullptr;
    std::string property;
};

class FbxObjects {
public:
    // An InputError where the file has no objects or connections, or a Model, a Geometry or a Deformer has the number
    // of another object.
    FbxObjects(FbxRecord file, const std::string& path);
    FbxObjects(const FbxObjects&) = delete;
    FbxObjects& operator=(const FbxObjects&) = delete;

    const std::string& path() const { return path_; }
    const FbxObject& scene() const { return by_id_.at(0); }  // to which the roots of the nodes are connected
    const FbxRecord* record(std::string_view name) const { return file_.record(name); }

    // In the order of the file.
    std::vector<const FbxObject*> of_type(std::string_view type) const;

    // What is connected to an object, or an object to what, in the order of the file's connections.
    const std::vector<FbxConnection>& below(const FbxObject& object) const;
    const std::vector<FbxConnection>& above(const FbxObject& object) const;
    std::vector<const FbxObject*> below(const FbxObject& object, std::string_view type) const;

    // A property of an object, or else of the defaults of its type, or else `otherwise`. An InputError where it is no
    // finite number.
    double number(const FbxObject& object, std::string_view property, double otherwise) const;
    Vec3 vector(const FbxObject& object, std::string_view property, const Vec3& otherwise) const;

    // An InputError that names an object by its name, or else by its number: "Model elbow, FIELD = VALUE: RULE".
    [[noreturn]] void refuse(const FbxObject& object, const std::string& field, const std::string& value,
                             const std::string& rule) const;

private:
    void add_objects();
    void connect();

    FbxRecord file_;
    std::string path_;
    std::map<std::int64_t, FbxObject> by_id_;
    std::vector<const FbxObject*> in_order_;
    std::map<const FbxObject*, std::vector<FbxConnection>> below_, above_;
};

// A property of a record with Properties70: its numbers, empty where it has none of this name.
std::vector<double> fbx_property(const FbxRecord& record, std::string_view name);

}  // namespace pbs
