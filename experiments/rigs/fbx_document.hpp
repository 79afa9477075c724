// The syntax of FBX files, binary and text, without what their records mean: a file is a tree of records, each with a
// name, values and records of its own. Written from the files themselves; Blender's developers have published a
// description of the binary form.
//   const FbxRecord file = read_fbx_document(read_text_file("hero.fbx"), "hero.fbx");
//   const FbxRecord* objects = file.record("Objects");
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace pbs {

using FbxValue = std::variant<std::int64_t, double, std::string, std::vector<double>>;

struct FbxRecord {
    std::string name;
    std::vector<FbxValue> values;
    std::vector<FbxRecord> records;

    // The first record of this name; null where there is none.
    const FbxRecord* record(std::string_view of_name) const;

    // A value by its place; nothing where there is none, or one of another type. Whole numbers count as numbers.
    const std::string* text(std::size_t place) const;
    const std::int64_t* whole(std::size_t place) const;
    std::optional<double> number(std::size_t place) const;
    // The numbers of the record of this name: of its array, or its values one by one; empty where there are none.
    std::vector<double> numbers(std::string_view of_name) const;
};

// bytes: of the whole file, `path` for messages. Returns a record whose records are those of the file. An InputError
// names the line (text) or the byte (binary) where the file is damaged or cut off, and refuses versions below 7000
// (before FBX 2011), whose records have other meanings.
FbxRecord read_fbx_document(const std::string& bytes, const std::string& path);

}  // namespace pbs
