#include "experiments/studies/shared/kept_references.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/run/run.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>

namespace experiments {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr int kept_schema = 1;
constexpr double same_bones = 1e-9;  // relative: sines and cosines differ by roundings from one system to the next
constexpr std::size_t most_bytes = 16 << 20;  // of an unpacked file

std::string deflated(const std::vector<std::uint8_t>& bytes)
{
    uLongf size = compressBound(bytes.size());
    std::string text(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(text.data()), &size, bytes.data(), bytes.size(), Z_BEST_COMPRESSION) != Z_OK)
        throw std::runtime_error("zlib cannot compress the references");
    text.resize(size);
    return text;
}

// Empty if the text is damaged.
std::vector<std::uint8_t> inflated(const std::string& text)
{
    std::vector<std::uint8_t> bytes(most_bytes);
    uLongf size = bytes.size();
    if (uncompress(bytes.data(), &size, reinterpret_cast<const Bytef*>(text.data()), text.size()) != Z_OK) return {};
    bytes.resize(size);
    return bytes;
}

// Small numbers of either sign have small codes, and the codes' first, second, ... bytes lie side by side, which
// compresses well.
json::binary_t planes_of(const std::vector<std::int32_t>& values)
{
    std::vector<std::uint8_t> bytes(4 * values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto value = static_cast<std::uint32_t>(values[i]);
        const std::uint32_t code = values[i] < 0 ? ~(value << 1) : value << 1;
        for (std::size_t plane = 0; plane < 4; ++plane)
            bytes[plane * values.size() + i] = static_cast<std::uint8_t>(code >> 8 * plane);
    }
    return bytes;
}

std::vector<std::int32_t> values_in(const std::vector<std::uint8_t>& bytes)
{
    std::vector<std::int32_t> values(bytes.size() / 4);
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::uint32_t code = 0;
        for (std::size_t plane = 0; plane < 4; ++plane)
            code |= std::uint32_t{bytes[plane * values.size() + i]} << 8 * plane;
        values[i] = static_cast<std::int32_t>(code >> 1) ^ -static_cast<std::int32_t>(code & 1);
    }
    return values;
}

// Each vertex as a rigid part of its nearest bone [m], #V x 3.
pbs::Positions rigid_shape(const pbs::Character& character, const pbs::Pose& bones)
{
    pbs::Positions shape = character.mesh.rest;
    for (Eigen::Index v = 0; v < shape.rows(); ++v)
        shape.row(v) =
            (bones[character.binding.bone[v]] * pbs::Vec3(character.mesh.rest.row(v).transpose())).transpose();
    return shape;
}

std::vector<std::int32_t> residual(const pbs::Positions& shape, const pbs::Positions& predicted)
{
    std::vector<std::int32_t> values;
    for (int axis = 0; axis < 3; ++axis)
        for (Eigen::Index v = 0; v < shape.rows(); ++v)
            values.push_back(
                static_cast<std::int32_t>(std::lround((shape(v, axis) - predicted(v, axis)) / kept_quantum_m)));
    return values;
}

pbs::Positions predicted_plus(const pbs::Positions& predicted, const std::vector<std::int32_t>& values,
                              double quantum_m)
{
    pbs::Positions shape = predicted;
    std::size_t next = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (Eigen::Index v = 0; v < shape.rows(); ++v) shape(v, axis) += quantum_m * values[next++];
    return shape;
}

// The numbers of a member, without its shape.
template <typename Reference, typename Visit>
void for_each_number(Reference& reference, const Visit& visit)
{
    visit("linear_distance_pct", reference.linear_distance_pct);
    visit("energy_j", reference.energy_j);
    visit("lowest_det_f", reference.lowest_det_f);
}

json json_of(const KeptReference& reference)
{
    json table = {{"member", to_json(reference.member)},
                  {"outcome", reference.outcome},
                  {"newton_steps", reference.newton_steps},
                  {"seconds", reference.seconds}};
    for_each_number(reference, [&](const char* name, const std::optional<double>& value) {
        if (value) table[name] = *value;
    });
    std::vector<int> tips;
    for (std::size_t v = 0; v < reference.at_tips.size(); ++v)
        if (reference.at_tips[v]) tips.push_back(static_cast<int>(v));
    table["tips"] = tips;
    return table;
}

KeptReference reference_of(const json& table, Eigen::Index vertices)
{
    KeptReference reference;
    const std::string name = table.at("member").at("name");
    for (const EnsembleMember& member : family())
        if (member.name == name) reference.member = member;
    if (to_json(reference.member) != table.at("member"))
        throw std::runtime_error("a member " + name + " that this program does not have");
    table.at("outcome").get_to(reference.outcome);
    table.at("newton_steps").get_to(reference.newton_steps);
    table.at("seconds").get_to(reference.seconds);
    for_each_number(reference, [&](const char* key, std::optional<double>& value) {
        if (table.contains(key)) value = table.at(key).get<double>();
    });
    reference.at_tips.assign(vertices, false);
    for (const int v : table.at("tips")) reference.at_tips.at(v) = true;
    return reference;
}

}  // namespace

double KeptReference::own_error_pct() const
{
    return share_of_linear_distance * linear_distance_pct.value_or(std::numeric_limits<double>::quiet_NaN());
}

const KeptReference* KeptReferences::find(const std::string& member) const
{
    const auto found =
        std::ranges::find_if(members, [&](const KeptReference& reference) { return reference.member.name == member; });
    return found == members.end() ? nullptr : &*found;
}

std::string packed(const KeptReferences& references, const pbs::Character& character)
{
    json table = {{"schema", kept_schema},           {"pose", references.pose},
                  {"body", references.body},         {"mesh_hash", references.mesh_hash},
                  {"revision", references.revision}, {"quantum_m", kept_quantum_m}};
    for (const Eigen::Isometry3d& bone : references.bones)
        table["bones"].push_back(std::vector<double>(bone.data(), bone.data() + bone.matrix().size()));
    pbs::Positions predicted = rigid_shape(character, references.bones);
    for (const KeptReference& reference : references.members) {
        json& entry = table["members"].emplace_back(json_of(reference));
        if (!reference.is_reached()) continue;
        const std::vector<std::int32_t> values = residual(reference.positions, predicted);
        entry["shape"] = json::binary(planes_of(values));
        predicted = predicted_plus(predicted, values, kept_quantum_m);
    }
    return deflated(json::to_cbor(table));
}

KeptReferences unpacked(const std::string& text, const std::string& file, const pbs::Character& character)
{
    KeptReferences references;
    const std::string hash = pbs::content_hash(character.mesh);
    const std::vector<std::uint8_t> bytes = inflated(text);
    try {
        const json document = json::from_cbor(bytes);
        if (document.at("schema") != kept_schema)
            throw pbs::InputError(file, 0, "schema", document.at("schema").dump(),
                                  fmt::format("expected {}", kept_schema));
        document.at("pose").get_to(references.pose);
        document.at("body").get_to(references.body);
        document.at("mesh_hash").get_to(references.mesh_hash);
        document.at("revision").get_to(references.revision);
        if (references.mesh_hash != hash)
            throw pbs::InputError(
                file, 0, "mesh_hash", references.mesh_hash,
                fmt::format(
                    "the tets of {} have the hash {}, so that these references do not belong to them; solve them with "
                    "`pbskin reproduce references --full`",
                    character.name, hash));
        for (const json& bone : document.at("bones")) {
            const std::vector<double> numbers = bone;
            if (numbers.size() != 16) throw std::runtime_error("a transform of another size");
            references.bones.emplace_back(Eigen::Map<const Eigen::Matrix4d>(numbers.data()));
        }
        if (references.bones.size() != character.skeleton.bones.size())
            throw std::runtime_error("another number of bones");
        pbs::Positions predicted = rigid_shape(character, references.bones);
        const double quantum_m = document.at("quantum_m");
        for (const json& entry : document.at("members")) {
            KeptReference& reference = references.members.emplace_back(reference_of(entry, predicted.rows()));
            if (!reference.is_reached()) continue;
            const std::vector<std::int32_t> values = values_in(entry.at("shape").get_binary());
            if (static_cast<Eigen::Index>(values.size()) != predicted.size())
                throw std::runtime_error("a shape of another size");
            reference.positions = predicted = predicted_plus(predicted, values, quantum_m);
        }
    } catch (const pbs::InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw pbs::InputError(file, 0, "", "", std::string("is no file of references, or damaged: ") + error.what());
    }
    return references;
}

std::string why_other_tets(const std::string& body)
{
    const fs::path folder = pbs::references_folder();
    std::error_code none;
    for (const fs::path& file : fs::directory_iterator(folder, none)) {
        if (file.extension() != ".ref" || !file.filename().string().starts_with(body + "_")) continue;
        const json kept = json::from_cbor(inflated(analysis::read_text(file.string())), true, false);
        if (!kept.is_object() || kept.value("body", "") != body) continue;
        const std::string hash = pbs::content_hash(pbs::make_character({.body = body, .surface = false}).mesh);
        if (kept.value("mesh_hash", "") == hash) return "";
        return fmt::format(
            "its tets do not come with the program, and CGAL {} of this system makes others than CGAL {}, which made "
            "those of the record",
            run_provenance(1).libraries["CGAL"], cgal_of_the_record);
    }
    return "";
}

void require_kept_tets(const std::string& body)
{
    const std::string why = why_other_tets(body);
    if (!why.empty())
        throw pbs::InputError(
            "", 0, "character.body", body,
            why +
                ": repeat its numbers on Debian 12, the system of the record, or solve its references on these tets "
                "with `pbskin reproduce references --full`");
}

std::string file_of_references(const std::string& pose)
{
    return (fs::path(pbs::references_folder()) / (pose + ".ref")).string();
}

KeptReferences read_references(const std::string& pose, const pbs::Character& character, const pbs::Pose& bones)
{
    const std::string file = file_of_references(pose);
    if (!fs::exists(file))
        throw pbs::InputError(
            file, 0, "", "",
            "does not exist: solve the references of this pose with `pbskin reproduce references --full`");
    KeptReferences kept = unpacked(analysis::read_text(file), file, character);
    if (kept.pose != pose) throw pbs::InputError(file, 0, "pose", kept.pose, "expected the references of " + pose);
    for (std::size_t b = 0; b < bones.size(); ++b)
        if (!kept.bones[b].isApprox(bones[b], same_bones))
            throw pbs::InputError(file, 0, "bones", character.skeleton.bones[b].name,
                                  "this bone is elsewhere than in the pose: solve the references again with `pbskin "
                                  "reproduce references --full`");
    return kept;
}

}  // namespace experiments
