// LBS of a rest shape to which learned correctives are added: no state but the last pose's positions.
#include "experiments/deformers/correctives.hpp"

#include "analysis/records/toml_keys.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"
#include "pbs/system/source_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using pbs::corrective_features;
using pbs::InputError;

constexpr int correctives_schema = 1, most_modes = 1000;
constexpr double quantum = 5e-6;  // of the body's size: modes are whole multiples of it in a file
constexpr const char* hash_key = "content_hash = \"";

// The hash covers the names and places of the bones and the skinning weights.
std::string rig_hash(const pbs::Character& character)
{
    std::string bytes;
    const auto add = [&](const auto* data, std::size_t count) {
        bytes.append(reinterpret_cast<const char*>(data), count * sizeof *data);
    };
    for (const pbs::Bone& bone : character.skeleton.bones) {
        bytes += bone.name + '\0';
        add(&bone.parent, 1);
        add(bone.head.data(), 3);
        add(bone.tail.data(), 3);
    }
    const pbs::Weights& weights = character.weights;
    add(weights.first.data(), weights.first.size());
    add(weights.bone.data(), weights.bone.size());
    add(weights.weight.data(), weights.weight.size());
    return pbs::content_hash(bytes);
}

// Numbers as JSON has them are TOML.
template <typename Row>
nlohmann::json numbers_of(const Row& row)
{
    return std::vector<double>(row.begin(), row.end());
}

std::string rows_text(const Eigen::MatrixXd& rows)
{
    std::string text = "[";
    for (const auto& row : rows.rowwise()) text += (text.size() > 1 ? ",\n " : "") + numbers_of(row).dump();
    return text + "]\n";
}

std::string multiples_text(const Eigen::MatrixXd& rows)
{
    std::string text = "[";
    for (const auto& row : rows.rowwise()) {
        text += text.size() > 1 ? ",\n [" : "[";
        for (const double multiple : row)
            text += fmt::format("{}{}", text.back() == '[' ? "" : ",", std::llround(multiple));
        text += "]";
    }
    return text + "]\n";
}

// A table of the file. Its errors name the line.
class FileTable {
public:
    FileTable(const toml::table& table, const std::string& file, const std::vector<std::string>& keys)
        : table_(table), file_(file)
    {
        for (const auto& [key, value] : table)
            if (std::ranges::count(keys, std::string(key.str())) == 0)
                refuse(value, std::string(key.str()), "",
                       "unknown key; the nearest known one is " + pbs::nearest_name(std::string(key.str()), keys));
    }

    const toml::node& at(const char* key) const
    {
        const toml::node* node = table_.get(key);
        if (!node) refuse(table_, key, "", "missing");
        return *node;
    }
    std::string text(const char* key) const
    {
        const toml::node& node = at(key);
        if (!node.is_string()) refuse(node, key, "", "expected a text in quotation marks");
        return node.as_string()->get();
    }
    // A text that has to be this one.
    void expect(const char* key, const std::string& expected, const std::string& rule) const
    {
        if (const std::string own = text(key); own != expected) refuse(at(key), key, own, rule);
    }
    long long whole(const toml::node& node, const char* key, long long low, long long high) const
    {
        const auto number = node.value_exact<std::int64_t>();
        if (!number || *number < low || *number > high)
            refuse(node, key, number ? std::to_string(*number) : "", pbs::expected_whole("an integer", low, high));
        return *number;
    }
    double positive(const char* key) const
    {
        const toml::node& node = at(key);
        const double number = node.value<double>().value_or(std::nan(""));
        if (!std::isfinite(number) || number <= 0.0) refuse(node, key, "", "expected a finite number above 0");
        return number;
    }
    const toml::array& list(const char* key) const
    {
        const toml::node& node = at(key);
        if (!node.is_array()) refuse(node, key, "", "expected a list");
        return *node.as_array();
    }
    Eigen::RowVectorXd numbers(const toml::node& node, const char* key, Eigen::Index count) const
    {
        const toml::array* list = node.as_array();
        if (!list || static_cast<Eigen::Index>(list->size()) != count)
            refuse(node, key, list ? std::to_string(list->size()) + " numbers" : "",
                   fmt::format("expected a list of {} numbers", count));
        Eigen::RowVectorXd row(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            const toml::node& element = *list->get(static_cast<std::size_t>(i));
            row(i) = element.value<double>().value_or(std::nan(""));
            if (!std::isfinite(row(i))) refuse(element, key, "", "expected a finite number");
        }
        return row;
    }
    Eigen::MatrixXd rows(const char* key, Eigen::Index count, Eigen::Index columns) const
    {
        const toml::array& rows = list(key);
        if (static_cast<Eigen::Index>(rows.size()) != count)
            refuse(rows, key, std::to_string(rows.size()) + " rows", fmt::format("expected {}", count));
        Eigen::MatrixXd matrix(count, columns);
        for (Eigen::Index k = 0; k < count; ++k)
            matrix.row(k) = numbers(*rows.get(static_cast<std::size_t>(k)), key, columns);
        return matrix;
    }
    // The tables [[key]].
    std::vector<FileTable> tables(const char* key, const std::vector<std::string>& keys) const
    {
        std::vector<FileTable> tables;
        for (const toml::node& node : list(key)) {
            if (!node.is_table()) refuse(node, key, "", fmt::format("expected a table: [[{}]]", key));
            tables.emplace_back(*node.as_table(), file_, keys);
        }
        return tables;
    }
    [[noreturn]] void refuse(const toml::node& node, const std::string& key, const std::string& value,
                             const std::string& rule) const
    {
        throw InputError(file_, static_cast<int>(node.source().begin.line), key, value, rule);
    }

private:
    const toml::table& table_;
    std::string file_;
};

void require_character(const FileTable& top, const pbs::Character& character)
{
    const auto fitted_for = [&](const char* what, const std::string& hash) {
        return fmt::format(
            "the correctives were fitted for {}; {} of {} have the hash {}: expected those of the same character "
            "(`pbskin try MODEL --bake` fits them)",
            top.text("character"), what, character.name, hash);
    };
    const std::string tets = pbs::content_hash(character.mesh), rig = rig_hash(character);
    top.expect("tets_hash", tets, fitted_for("the tets", tets));
    top.expect("rig_hash", rig, fitted_for("the bones and weights", rig));
}

pbs::JointCorrective joint_in(const FileTable& table, double unit_m, const pbs::Character& character)
{
    const auto bones = static_cast<long long>(character.skeleton.bones.size());
    pbs::JointCorrective joint{.joint = static_cast<int>(table.whole(table.at("bone"), "bone", 0, bones - 1))};
    for (const toml::node& vertex : table.list("vertices"))
        joint.vertices.push_back(static_cast<int>(table.whole(vertex, "vertices", 0, character.mesh.rest.rows() - 1)));
    const auto modes = static_cast<Eigen::Index>(table.list("drivers").size());
    if (modes < 1 || modes > most_modes)
        table.refuse(table.at("drivers"), "drivers", std::to_string(modes) + " rows",
                     fmt::format("expected from 1 to {}", most_modes));
    joint.drivers = table.rows("drivers", modes, corrective_features);
    joint.lowest = table.numbers(table.at("lowest"), "lowest", modes).transpose();
    joint.highest = table.numbers(table.at("highest"), "highest", modes).transpose();
    joint.modes = unit_m * table.rows("modes", modes, 3 * static_cast<Eigen::Index>(joint.vertices.size())).transpose();
    return joint;
}

class CorrectivesDeformer : public TimedDeformer {
public:
    explicit CorrectivesDeformer(const CorrectivesOptions& options) : options_(options) {}

private:
    void set_up(const pbs::Character& character) override
    {
        const pbs::SourceFile source(options_.file);
        const std::string& text = source.text();
        if (pbs::content_hash(text) != options_.file_hash)
            throw InputError(options_.file, 0, "", "", "was changed while it was read");
        const pbs::Correctives correctives = parse_correctives(text, options_.file, character);
        if (options_.precision == pbs::Precision::f32)
            apply_ = applying<float>(correctives, character);
        else
            apply_ = applying<double>(correctives, character);
    }
    pbs::StepSummary deform(const pbs::Pose& pose, double /*dt_s*/, pbs::Positions& x) override
    {
        apply_(pose, x);
        return {.work = {.vertex_visits = x.rows()}};
    }
    template <class Scalar>
    static std::function<void(const pbs::Pose&, pbs::Positions&)> applying(const pbs::Correctives& correctives,
                                                                           const pbs::Character& character)
    {
        auto skinning =
            std::make_shared<pbs::CorrectiveSkinning<Scalar>>(correctives, character.mesh.rest, character.weights);
        return [skinning](const pbs::Pose& pose, pbs::Positions& x) { skinning->apply(pose, x); };
    }

    CorrectivesOptions options_;
    std::function<void(const pbs::Pose&, pbs::Positions&)> apply_;
};

void find_correctives(const SceneValues& values, const std::string& table, CorrectivesOptions& options,
                      DeformerSpec& /*spec*/)
{
    options.file = fs::absolute(fs::path(values.file()).parent_path() / options.file).string();
    if (!fs::is_regular_file(options.file))
        values.refuse(table + ".file", "no such file: expected one that `pbskin try --bake` has written");
    options.file_hash = pbs::hash_of_file(options.file);
}

}  // namespace

std::string text_of(const pbs::Correctives& correctives, const pbs::Character& character)
{
    const double unit_m = quantum * pbs::diagonal_m(character.mesh.rest);
    std::string contents = fmt::format("unit_m = {:.17g}\n", unit_m);
    contents += "lowest = " + rows_text(correctives.lowest) + "highest = " + rows_text(correctives.highest);
    for (const pbs::JointCorrective& joint : correctives.joints)
        contents += fmt::format(
            "[[joint]]\nbone = {}\nvertices = {}\nlowest = {}\nhighest = {}\ndrivers = {}modes = {}", joint.joint,
            nlohmann::json(joint.vertices).dump(), numbers_of(joint.lowest).dump(), numbers_of(joint.highest).dump(),
            rows_text(joint.drivers), multiples_text(joint.modes.transpose() / unit_m));
    const std::string name =
        nlohmann::json(character.name).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    return fmt::format(
        "# Shapes that are added to the rest shape of a character before linear blend skinning: `pbskin explain "
        "correctives`.\n"
        "schema = {}\ncharacter = {}\ntets_hash = \"{}\"\nrig_hash = \"{}\"\n{}{}\"\n{}",
        correctives_schema, name, pbs::content_hash(character.mesh), rig_hash(character), hash_key,
        pbs::content_hash(contents), contents);
}

pbs::Correctives parse_correctives(const std::string& text, const std::string& file, const pbs::Character& character)
{
    const toml::table parsed = analysis::parse_toml(text, file);
    const FileTable top(
        parsed, file,
        {"schema", "character", "tets_hash", "rig_hash", "content_hash", "unit_m", "lowest", "highest", "joint"});
    top.whole(top.at("schema"), "schema", correctives_schema, correctives_schema);
    require_character(top, character);
    pbs::Correctives correctives{.vertices = static_cast<int>(character.mesh.rest.rows())};
    for (const pbs::Bone& bone : character.skeleton.bones) correctives.parents.push_back(bone.parent);
    const auto bones = static_cast<Eigen::Index>(correctives.parents.size());
    const double unit_m = top.positive("unit_m");
    correctives.lowest = top.rows("lowest", bones, corrective_features);
    correctives.highest = top.rows("highest", bones, corrective_features);
    if (parsed.contains("joint"))
        for (const FileTable& table :
             top.tables("joint", {"bone", "vertices", "lowest", "highest", "drivers", "modes"}))
            correctives.joints.push_back(joint_in(table, unit_m, character));
    const std::size_t contents = text.find('\n', text.find(hash_key)) + 1;
    top.expect("content_hash", pbs::content_hash(text.substr(contents)),
               "the lines below have another hash: the file was changed");
    return correctives;
}

std::string file_of_correctives(const std::string& body)
{
    return (fs::path(pbs::references_folder()) / "correctives" / (body + ".toml")).string();
}

DeformerSpec kept_correctives(const std::string& body)
{
    DeformerSpec spec = default_spec("correctives");
    auto& options = options_of<CorrectivesOptions>(spec);
    options.file = file_of_correctives(body);
    options.file_hash = pbs::hash_of_file(options.file);
    spec.weights = pbs::WeightKind::diffused;
    return spec;
}

DeformerKind correctives_kind()
{
    using Options = CorrectivesOptions;
    DeformerKind kind = kind_of<CorrectivesDeformer>(
        "correctives",
        "LBS with shapes that were learned from a reference (Kry 2002), of a file that `pbskin try MODEL --bake` "
        "writes",
        OptionFields<Options>("correctives", true)
            .key("name", KeyType::text, "",
                 {.is_stated = true, .meaning = "the name of this deformer in deformers.use and in the records"})
            .add("file", &Options::file,
                 {.is_stated = true, .meaning = "the fitted correctives, relative to the scene"})
            .add("precision", &Options::precision, {.meaning = "floating point of the displacements and of the blend"})
            .record("file_hash", &Options::file_hash)
            .complete(),
        find_correctives);
    kind.needs_list = true;
    kind.options_json = [recorded = kind.options_json](const DeformerSpec& spec) {
        nlohmann::json json = recorded(spec);
        json["file"] = pbs::file_name(options_of<Options>(spec).file);
        return json;
    };
    return kind;
}

}  // namespace experiments
