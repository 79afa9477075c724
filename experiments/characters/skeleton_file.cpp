#include "experiments/characters/skeleton_file.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pbs {
namespace {

int line_of(const toml::node& node)
{
    return static_cast<int>(node.source().begin.line);
}

std::string text_of(const toml::node& node)
{
    std::stringstream lines;
    node.visit([&](const auto& value) { lines << value; });
    std::string text, word;
    while (lines >> word) text += (text.empty() ? "" : " ") + word;  // on one line
    return text;
}

void check_keys(const toml::table& table, const std::vector<std::string>& known, const std::string& file)
{
    for (const auto& [key, value] : table)
        if (std::find(known.begin(), known.end(), key.str()) == known.end())
            throw InputError(file, line_of(value), std::string(key.str()), "",
                             "unknown key; the nearest known one is " + nearest_name(std::string(key.str()), known));
}

const toml::node& required(const toml::table& joint, const char* key, const std::string& file)
{
    const toml::node* node = joint.get(key);
    if (!node) throw InputError(file, line_of(joint), key, "", "missing: a joint has name, parent, head_m and tail_m");
    return *node;
}

std::string read_string(const toml::table& joint, const char* key, const std::string& file)
{
    const toml::node& node = required(joint, key, file);
    if (!node.is_string()) throw InputError(file, line_of(node), key, text_of(node), "expected a string");
    return node.as_string()->get();
}

Vec3 read_point(const toml::table& joint, const char* key, const std::string& file)
{
    const toml::node& node = required(joint, key, file);
    const toml::array* array = node.as_array();
    Vec3 point = Vec3::Constant(std::nan(""));
    if (array && array->size() == 3)
        for (int axis = 0; axis < 3; ++axis) point(axis) = array->get(axis)->value<double>().value_or(std::nan(""));
    if (!point.allFinite())
        throw InputError(file, line_of(node), key, text_of(node), "expected three finite numbers [m]");
    return point;
}

NamedJoint read_joint(const toml::node& node, const std::string& file)
{
    const toml::table* table = node.as_table();
    if (!table) throw InputError(file, line_of(node), "joint", text_of(node), "expected a table: [[joint]]");
    check_keys(*table, {"name", "parent", "head_m", "tail_m"}, file);
    NamedJoint joint;
    joint.line = line_of(*table);
    joint.name = read_string(*table, "name", file);
    if (joint.name.empty()) throw InputError(file, joint.line, "name", "\"\"", "expected a name");
    joint.parent = read_string(*table, "parent", file);
    joint.head = read_point(*table, "head_m", file);
    joint.tail = read_point(*table, "tail_m", file);
    return joint;
}

toml::table parse_toml(const std::string& text, const std::string& name)
{
    check_toml_keys(text, name);
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& error) {
        throw InputError(name, static_cast<int>(error.source().begin.line), "", "", std::string(error.description()));
    }
}

}  // namespace

Skeleton parse_skeleton(const std::string& text, const std::string& name)
{
    const toml::table table = parse_toml(text, name);
    check_keys(table, {"joint"}, name);
    std::vector<NamedJoint> joints;
    if (const toml::node* node = table.get("joint")) {
        if (!node->is_array())
            throw InputError(name, line_of(*node), "joint", "", "expected an array of tables: [[joint]]");
        for (const toml::node& joint : *node->as_array()) joints.push_back(read_joint(joint, name));
    }
    return order_skeleton(joints, name);
}

}  // namespace pbs
