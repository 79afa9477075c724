// FBX files made in memory, as text and as binary, record by record, so that a test states each property that it is
// about.
//   FbxFile file;
//   const auto root = file.node("root", 0, "LimbNode", {{"Lcl Translation", {1, 0, 0}}});
//   folder.file("arm.fbx", file.text());
#pragma once

#include "experiments/rigs/fbx_document.hpp"

#include <zlib.h>

#include <cstring>
#include <map>
#include <sstream>

namespace test_support {

using FbxNumbers = std::vector<double>;
using FbxProperties = std::map<std::string, FbxNumbers>;

constexpr double fbx_ticks_per_s = 46186158000.0;

inline pbs::FbxRecord fbx_record(const std::string& name, std::vector<pbs::FbxValue> values,
                                 std::vector<pbs::FbxRecord> records = {})
{
    return {name, std::move(values), std::move(records)};
}

inline pbs::FbxRecord fbx_properties(const FbxProperties& properties)
{
    pbs::FbxRecord record{"Properties70", {}, {}};
    for (const auto& [name, numbers] : properties) {
        std::vector<pbs::FbxValue> values = {name, std::string("Vector"), std::string(), std::string("A")};
        for (const double number : numbers) values.emplace_back(number);
        record.records.push_back(fbx_record("P", values));
    }
    return record;
}

// A curve on one axis of a property; an empty one is no curve. data: KeyAttrDataFloat.
struct FbxCurveText {
    FbxNumbers times_s, values;
    std::int64_t flags = 4;
    FbxNumbers data = {0, 0, 0, 0};
};

class FbxFile {
public:
    std::int64_t version = 7400;
    FbxProperties settings = {{"UnitScaleFactor", {1}}};
    std::vector<pbs::FbxRecord> objects, definitions;

    // An object of the file, connected to the one above it; returns its number. 0 is the scene.
    std::int64_t add(const std::string& type, const std::string& name, const std::string& kind, std::int64_t above,
                     std::vector<pbs::FbxRecord> records, const std::string& property = "")
    {
        objects.push_back(fbx_record(type, {++last_, type + "::" + name, kind}, std::move(records)));
        connect(last_, above, property);
        return last_;
    }

    void connect(std::int64_t below, std::int64_t above, const std::string& property = "")
    {
        connections_.push_back(fbx_record("C", {std::string(property.empty() ? "OO" : "OP"), below, above}));
        if (!property.empty()) connections_.back().values.emplace_back(property);
    }

    std::int64_t node(const std::string& name, std::int64_t above, const std::string& kind,
                      const FbxProperties& properties)
    {
        return add("Model", name, kind, above, {fbx_properties(properties)});
    }

    // points: #P x 3; corners: the last one of each polygon is -index - 1.
    std::int64_t mesh(const std::string& name, std::int64_t node, const FbxNumbers& points, const FbxNumbers& corners)
    {
        return add("Geometry", name, "Mesh", node,
                   {fbx_record("Vertices", {points}), fbx_record("PolygonVertexIndex", {corners})});
    }

    std::int64_t skin(std::int64_t mesh, const std::string& kind = "")
    {
        return add("Deformer", "", "Skin", mesh, {fbx_record("SkinningType", {kind})});
    }

    // transform: 16 numbers, column by column.
    void cluster(std::int64_t skin, std::int64_t joint, const FbxNumbers& points, const FbxNumbers& weights,
                 const FbxNumbers& transform)
    {
        const std::int64_t cluster = add(
            "Deformer", "", "Cluster", skin,
            {fbx_record("Indexes", {points}), fbx_record("Weights", {weights}), fbx_record("Transform", {transform})});
        connect(joint, cluster);
    }

    std::int64_t animation(const std::string& name, double start_s = 0.0, double stop_s = 0.0)
    {
        return add(
            "AnimationStack", name, "", 0,
            {fbx_properties({{"LocalStart", {start_s * fbx_ticks_per_s}}, {"LocalStop", {stop_s * fbx_ticks_per_s}}})});
    }

    std::int64_t layer(std::int64_t animation, const FbxProperties& properties = {})
    {
        return add("AnimationLayer", "Layer", "", animation, {fbx_properties(properties)});
    }

    // defaults: of axes x, y and z. curves: of axes by their numbers.
    void curves(std::int64_t layer, std::int64_t node, const std::string& property, const FbxNumbers& defaults,
                const std::map<int, FbxCurveText>& curves)
    {
        const std::int64_t curve_node =
            add("AnimationCurveNode", "", "", layer,
                {fbx_properties({{"d|X", {defaults[0]}}, {"d|Y", {defaults[1]}}, {"d|Z", {defaults[2]}}})});
        connect(curve_node, node, property);
        for (const auto& [axis, curve] : curves) {
            FbxNumbers ticks;
            for (const double time_s : curve.times_s) ticks.push_back(time_s * fbx_ticks_per_s);
            add("AnimationCurve", "", "", curve_node,
                {fbx_record("KeyTime", {ticks}), fbx_record("KeyValueFloat", {curve.values}),
                 fbx_record("KeyAttrFlags", {FbxNumbers{double(curve.flags)}}),
                 fbx_record("KeyAttrDataFloat", {curve.data}),
                 fbx_record("KeyAttrRefCount", {FbxNumbers{double(ticks.size())}})},
                std::string("d|") + "XYZ"[axis]);
        }
    }

    std::vector<pbs::FbxRecord> records() const
    {
        return {fbx_record("FBXHeaderExtension", {}, {fbx_record("FBXVersion", {version})}),
                fbx_record("GlobalSettings", {}, {fbx_properties(settings)}),
                fbx_record("Definitions", {}, definitions), fbx_record("Objects", {}, objects),
                fbx_record("Connections", {}, connections_)};
    }

    std::string text() const
    {
        std::ostringstream text;
        text.precision(17);
        text << "; FBX project file\n";
        for (const pbs::FbxRecord& record : records()) write_text(record, text);
        return text.str();
    }

    // is_packed: whether zlib packs arrays.
    std::string binary(bool is_packed) const
    {
        std::string bytes =
            std::string("Kaydara FBX Binary  \0\x1a\0", 23) + number(static_cast<std::uint32_t>(version));
        for (const pbs::FbxRecord& record : records()) write_binary(record, is_packed, bytes);
        return bytes + std::string(version < 7500 ? 13 : 25, '\0');
    }

private:
    static void write_text(const pbs::FbxRecord& record, std::ostringstream& text)
    {
        text << record.name << ": ";
        for (std::size_t v = 0; v < record.values.size(); ++v) {
            text << (v > 0 ? "," : "");
            std::visit([&](const auto& value) { write_value(value, text); }, record.values[v]);
        }
        if (!record.records.empty()) {
            text << " {\n";
            for (const pbs::FbxRecord& below : record.records) write_text(below, text);
            text << "}";
        }
        text << "\n";
    }

    static void write_value(double number, std::ostringstream& text) { text << number; }
    static void write_value(std::int64_t number, std::ostringstream& text) { text << number; }
    static void write_value(const std::string& word, std::ostringstream& text) { text << '"' << word << '"'; }
    static void write_value(const FbxNumbers& numbers, std::ostringstream& text)
    {
        text << "*" << numbers.size() << " {\na: ";
        for (std::size_t i = 0; i < numbers.size(); ++i) text << (i > 0 ? "," : "") << numbers[i];
        text << "\n}";
    }

    template <typename Number>
    static std::string number(Number number)
    {
        return {reinterpret_cast<const char*>(&number), sizeof number};
    }

    void write_binary(const pbs::FbxRecord& record, bool is_packed, std::string& bytes) const
    {
        const bool is_wide = version >= 7500;
        std::string values;
        for (const pbs::FbxValue& value : record.values)
            std::visit([&](const auto& v) { values += binary_value(v, is_packed); }, value);
        const std::size_t width = is_wide ? 8 : 4, begin = bytes.size();
        const auto wide_or_narrow = [&](std::size_t n) {
            return is_wide ? number(std::uint64_t(n)) : number(std::uint32_t(n));
        };
        bytes +=
            std::string(3 * width, '\0') + number(static_cast<std::uint8_t>(record.name.size())) + record.name + values;
        for (const pbs::FbxRecord& child : record.records) write_binary(child, is_packed, bytes);
        if (!record.records.empty()) bytes += std::string(3 * width + 1, '\0');
        bytes.replace(
            begin, 3 * width,
            wide_or_narrow(bytes.size()) + wide_or_narrow(record.values.size()) + wide_or_narrow(values.size()));
    }

    static std::string binary_value(double value, bool) { return "D" + number(value); }
    static std::string binary_value(std::int64_t value, bool) { return "L" + number(value); }
    static std::string binary_value(const std::string& word, bool)
    {
        std::string name = word;  // "Type::name" is "name\0\1Type"
        if (const std::size_t colons = word.find("::"); colons != std::string::npos)
            name = word.substr(colons + 2) + std::string("\0\1", 2) + word.substr(0, colons);
        return "S" + number(static_cast<std::uint32_t>(name.size())) + name;
    }
    static std::string binary_value(const FbxNumbers& numbers, bool is_packed)
    {
        std::string data(reinterpret_cast<const char*>(numbers.data()), sizeof(double) * numbers.size());
        if (is_packed) {
            std::string packed(compressBound(data.size()), '\0');
            uLongf size = packed.size();
            compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
                     data.size());
            data = packed.substr(0, size);
        }
        return "d" + number(static_cast<std::uint32_t>(numbers.size())) + number(std::uint32_t(is_packed)) +
               number(static_cast<std::uint32_t>(data.size())) + data;
    }

    std::int64_t last_ = 0;
    std::vector<pbs::FbxRecord> connections_;
};

}  // namespace test_support
