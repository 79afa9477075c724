#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/assimp_rig.hpp"

#include <minizip/unzip.h>
#include <pugixml.hpp>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

namespace pbs {
namespace {

// The .dae files of an archive; none where it is damaged.
std::vector<std::string> collada_files_in(const std::string& path)
{
    std::vector<std::string> texts;
    unzFile archive = unzOpen(path.c_str());
    if (!archive) return texts;
    for (int state = unzGoToFirstFile(archive); state == UNZ_OK; state = unzGoToNextFile(archive)) {
        unz_file_info about{};
        char name[1024] = {};
        if (unzGetCurrentFileInfo(archive, &about, name, sizeof name - 1, nullptr, 0, nullptr, 0) != UNZ_OK) break;
        if (lower_extension(name) != ".dae" || unzOpenCurrentFile(archive) != UNZ_OK) continue;
        char buffer[1 << 14];
        std::string text;
        for (int count = 0; (count = unzReadCurrentFile(archive, buffer, sizeof buffer)) > 0;)
            text.append(buffer, static_cast<std::size_t>(count));
        unzCloseCurrentFile(archive);
        texts.push_back(std::move(text));
    }
    unzClose(archive);
    return texts;
}

std::vector<std::string_view> words_of(std::string_view text)
{
    constexpr const char* spaces = " \t\r\n";
    std::vector<std::string_view> words;
    for (std::size_t at = text.find_first_not_of(spaces); at != std::string_view::npos; at = text.find_first_not_of(spaces, at)) {
        const std::size_t end = std::min(text.find_first_of(spaces, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end;
    }
    return words;
}

// Nothing is added for words that are no whole numbers: the reader refuses the file.
std::vector<std::size_t> whole_numbers_of(std::string_view text)
{
    std::vector<std::size_t> numbers;
    for (const std::string_view word : words_of(text)) {
        std::size_t number = 0;
        if (std::from_chars(word.data(), word.data() + word.size(), number).ec == std::errc()) numbers.push_back(number);
    }
    return numbers;
}

bool is_weight(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    double weight = std::numeric_limits<double>::quiet_NaN();
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), weight);
    if (error == std::errc::result_out_of_range) return !word.starts_with('-') && word.find("e-") != std::string_view::npos;  // nearly zero
    return end == word.data() + word.size() && std::isfinite(weight) && weight >= 0.0;
}

std::size_t number_of(const pugi::xml_node& node, const char* attribute, unsigned missing = 0)
{
    return node.attribute(attribute).as_uint(missing);
}

// The weight of each pair of a joint and a weight, with the point of the pair.
struct WeightIndices {
    std::string source;  // its name
    std::vector<std::pair<std::size_t, std::size_t>> point_and_weight;
};

WeightIndices weight_indices_of(const pugi::xml_node& vertex_weights)
{
    WeightIndices indices;
    std::size_t stride = 1, offset = 0;
    for (const pugi::xml_node input : vertex_weights.children("input")) {
        stride = std::max(stride, number_of(input, "offset") + 1);
        if (input.attribute("semantic").as_string() != std::string_view("WEIGHT")) continue;
        offset = number_of(input, "offset");
        indices.source = input.attribute("source").as_string();
    }
    const std::vector<std::size_t> counts = whole_numbers_of(vertex_weights.child("vcount").text().as_string());
    const std::vector<std::size_t> numbers = whole_numbers_of(vertex_weights.child("v").text().as_string());
    std::size_t at = offset;
    for (std::size_t point = 0; point < counts.size(); ++point)
        for (std::size_t pair = 0; pair < counts[point] && at < numbers.size(); ++pair, at += stride)
            indices.point_and_weight.emplace_back(point, numbers[at]);
    return indices;
}

void check_skin(const pugi::xml_node& controller, const std::string& path)
{
    const pugi::xml_node skin = controller.child("skin");
    const WeightIndices indices = weight_indices_of(skin.child("vertex_weights"));
    if (!indices.source.starts_with('#')) return;
    const pugi::xml_node source = skin.find_child_by_attribute("source", "id", indices.source.c_str() + 1);
    const pugi::xml_node accessor = source.child("technique_common").child("accessor");
    const std::vector<std::string_view> weights = words_of(source.child("float_array").text().as_string());
    const std::size_t first = number_of(accessor, "offset"), stride = number_of(accessor, "stride", 1);
    for (const auto& [point, index] : indices.point_and_weight) {
        const std::size_t at = first + stride * index;
        if (at < weights.size() && !is_weight(weights[at]))
            throw InputError(
                path, 0, "controller " + std::string(controller.attribute("id").as_string()) + ", weight of point " + std::to_string(point),
                std::string(weights[at]), "expected a finite number of 0 or more");
    }
}

void check_document(const std::string& text, const std::string& path)
{
    pugi::xml_document document;
    if (!document.load_buffer(text.data(), text.size())) return;
    std::set<std::string> used;
    for (const pugi::xpath_node& node : document.select_nodes("//instance_controller"))
        used.insert(node.node().attribute("url").as_string());
    for (const pugi::xml_node library : document.child("COLLADA").children("library_controllers"))
        for (const pugi::xml_node controller : library.children("controller"))
            if (used.contains(std::string("#") + controller.attribute("id").as_string())) check_skin(controller, path);
}

using Flags = std::vector<std::int32_t>;

constexpr std::string_view name = "KeyAttrFlags";
constexpr std::int32_t linear = 4, all_kinds = 2 | 4 | 8;  // constant, linear, cubic
constexpr std::uint32_t most_keys = 1 << 24;

std::uint32_t number_at(const std::string& bytes, std::size_t at)
{
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

// A property of a binary file: the letter i, the number of keys, the encoding (1: zlib), the number of bytes, and the bytes.
std::optional<Flags> binary_flags(const std::string& bytes, std::size_t at)
{
    constexpr std::size_t header = 13;
    if (at + header > bytes.size() || bytes[at] != 'i') return std::nullopt;
    const std::uint32_t keys = number_at(bytes, at + 1), encoding = number_at(bytes, at + 5), size = number_at(bytes, at + 9);
    if (keys > most_keys || size > bytes.size() - at - header) return std::nullopt;
    Flags flags(keys);
    uLongf unpacked = sizeof(std::int32_t) * flags.size();
    if (encoding == 0 && size == unpacked)
        std::copy_n(bytes.data() + at + header, size, reinterpret_cast<char*>(flags.data()));
    else if (encoding != 1 || uncompress(reinterpret_cast<Bytef*>(flags.data()), &unpacked,
                                         reinterpret_cast<const Bytef*>(bytes.data() + at + header), size) != Z_OK)
        return std::nullopt;
    flags.resize(unpacked / sizeof(std::int32_t));
    return flags;
}

// "KeyAttrFlags: *2 { a: 4,4 }", from the colon on.
std::optional<Flags> text_flags(const std::string& bytes, std::size_t at)
{
    const std::size_t end = bytes.find('}', at), numbers = bytes.find("a:", at);
    if (end == std::string::npos || numbers > end) return std::nullopt;
    Flags flags;
    for (std::size_t next = numbers + 2; next < end;) {
        std::int32_t flag = 0;
        const auto [rest, error] = std::from_chars(bytes.data() + next, bytes.data() + end, flag);
        if (error == std::errc()) flags.push_back(flag);
        next = std::max(next + 1, static_cast<std::size_t>(rest - bytes.data()));
    }
    return flags;
}

}  // namespace

void check_collada_weights(const std::string& path)
{
    if (content_extension(path) == ".zae")
        for (const std::string& text : collada_files_in(path)) check_document(text, path);
    else
        check_document(read_text_file(path), path);
}

FbxCurves count_fbx_curves(const std::string& bytes)
{
    FbxCurves count;
    for (std::size_t found = bytes.find(name); found != std::string::npos; found = bytes.find(name, found + name.size())) {
        const std::size_t at = found + name.size();
        const bool is_text = at < bytes.size() && bytes[at] == ':';
        const std::optional<Flags> flags = is_text ? text_flags(bytes, at) : binary_flags(bytes, at);
        if (!flags) continue;
        ++count.curves;
        count.not_linear += std::any_of(flags->begin(), flags->end(), [](std::int32_t key) { return (key & all_kinds) != linear; });
    }
    return count;
}

}  // namespace pbs
