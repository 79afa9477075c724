#include "pbs/rig/fbx_curves.hpp"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

namespace pbs {
namespace {

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
