#include "experiments/rigs/fbx_objects.hpp"

#include "pbs/geometry/input_error.hpp"

#include <cmath>

namespace pbs {
namespace {

// "elbow" of "Model::elbow" in text, and of "elbow\0\1Model" in binary files.
std::string name_in(const std::string& stated)
{
    if (const std::size_t end = stated.find(std::string("\0\1", 2)); end != std::string::npos)
        return stated.substr(0, end);
    const std::size_t type = stated.find("::");
    return type == std::string::npos ? stated : stated.substr(type + 2);
}

// The defaults of the properties of each type of object.
std::map<std::string, const FbxRecord*> defaults_in(const FbxRecord& file)
{
    std::map<std::string, const FbxRecord*> defaults;
    if (const FbxRecord* definitions = file.record("Definitions"))
        for (const FbxRecord& type : definitions->records)
            if (const std::string* name = type.text(0)) defaults[*name] = type.record("PropertyTemplate");
    return defaults;
}

}  // namespace

std::vector<double> fbx_property(const FbxRecord& record, std::string_view name)
{
    const FbxRecord* properties = record.record("Properties70");
    std::vector<double> numbers;
    if (!properties) return numbers;
    for (const FbxRecord& property : properties->records) {
        if (const std::string* own = property.text(0); !own || *own != name) continue;
        // behind the name, two words for its type and its flags
        for (std::size_t place = 4; place < property.values.size(); ++place)
            if (const std::optional<double> number = property.number(place)) numbers.push_back(*number);
        break;
    }
    return numbers;
}

FbxObjects::FbxObjects(FbxRecord file, const std::string& path) : file_(std::move(file)), path_(path)
{
    by_id_[0] = {.type = "Scene"};
    add_objects();
    connect();
}

void FbxObjects::add_objects()
{
    const FbxRecord* objects = file_.record("Objects");
    if (!objects) throw InputError(path_, 0, "Objects", "", "missing: the file has no scene");
    const auto defaults = defaults_in(file_);
    for (const FbxRecord& record : objects->records) {
        const std::int64_t* id = record.whole(0);
        const std::string *name = record.text(1), *kind = record.text(2);
        if (!id) continue;
        const auto known = defaults.find(record.name);
        const auto [object, added] =
            by_id_.emplace(*id, FbxObject{*id, record.name, name ? name_in(*name) : "", kind ? *kind : "", &record,
                                          known == defaults.end() ? nullptr : known->second});
        if (added)
            in_order_.push_back(&object->second);
        else if (record.name == "Model" || record.name == "Geometry" || record.name == "Deformer")
            throw InputError(path_, 0, record.name, std::to_string(*id),
                             "expected numbers of objects that are unique, and not 0");
    }
}

void FbxObjects::connect()
{
    const FbxRecord* connections = file_.record("Connections");
    if (!connections) throw InputError(path_, 0, "Connections", "", "missing: no object belongs to the scene");
    for (const FbxRecord& connection : connections->records) {
        const std::int64_t *below = connection.whole(1), *above = connection.whole(2);
        if (!below || !above) continue;
        const auto lower = by_id_.find(*below), upper = by_id_.find(*above);
        if (lower == by_id_.end() || upper == by_id_.end()) continue;  // to what this reader does not read
        const std::string* property = connection.text(3);
        below_[&upper->second].push_back({&lower->second, property ? *property : ""});
        above_[&lower->second].push_back({&upper->second, property ? *property : ""});
    }
}

std::vector<const FbxObject*> FbxObjects::of_type(std::string_view type) const
{
    std::vector<const FbxObject*> objects;
    for (const FbxObject* object : in_order_)
        if (object->type == type) objects.push_back(object);
    return objects;
}

const std::vector<FbxConnection>& FbxObjects::below(const FbxObject& object) const
{
    static const std::vector<FbxConnection> none;
    const auto found = below_.find(&object);
    return found == below_.end() ? none : found->second;
}

const std::vector<FbxConnection>& FbxObjects::above(const FbxObject& object) const
{
    static const std::vector<FbxConnection> none;
    const auto found = above_.find(&object);
    return found == above_.end() ? none : found->second;
}

std::vector<const FbxObject*> FbxObjects::below(const FbxObject& object, std::string_view type) const
{
    std::vector<const FbxObject*> objects;
    for (const FbxConnection& connection : below(object))
        if (connection.object->type == type && connection.property.empty()) objects.push_back(connection.object);
    return objects;
}

double FbxObjects::number(const FbxObject& object, std::string_view property, double otherwise) const
{
    std::vector<double> numbers = fbx_property(*object.record, property);
    if (numbers.empty() && object.defaults) numbers = fbx_property(*object.defaults, property);
    if (numbers.empty()) return otherwise;
    if (!std::isfinite(numbers[0]))
        refuse(object, std::string(property), number_text(numbers[0]), "expected a finite number");
    return numbers[0];
}

Vec3 FbxObjects::vector(const FbxObject& object, std::string_view property, const Vec3& otherwise) const
{
    std::vector<double> numbers = fbx_property(*object.record, property);
    if (numbers.empty() && object.defaults) numbers = fbx_property(*object.defaults, property);
    if (numbers.empty()) return otherwise;
    if (numbers.size() < 3)
        refuse(object, std::string(property), std::to_string(numbers.size()) + " numbers", "expected 3");
    const Vec3 vector(numbers[0], numbers[1], numbers[2]);
    if (!vector.allFinite()) refuse(object, std::string(property), "", "expected finite numbers");
    return vector;
}

void FbxObjects::refuse(const FbxObject& object, const std::string& field, const std::string& value,
                        const std::string& rule) const
{
    const std::string name = object.name.empty() ? std::to_string(object.id) : object.name;
    throw InputError(path_, 0, object.type + " " + name + ", " + field, value, rule);
}

}  // namespace pbs
