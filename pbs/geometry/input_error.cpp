#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>

namespace pbs {
namespace {

constexpr std::size_t longest = 80,
                      most_letters = 200;  // of a name that is looked for; a file may hold one of megabytes

std::string shortened(const std::string& text)
{
    if (text.size() <= longest) return text;
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // within a character of UTF-8
    return text.substr(0, end) + "...";
}

std::string code_of(unsigned char c)
{
    if (c == '\n') return "\\n";
    constexpr const char* digits = "0123456789abcdef";
    return std::string("\\x") + digits[c >> 4] + digits[c & 15];
}

// The bytes of the character of UTF-8 that begins here (RFC 3629, Sec. 4); 0: there is none.
std::size_t bytes_of_character(std::string_view text)
{
    const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0; };
    const int first = byte(0), second = byte(1);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                               : first >= 0xE0 && first < 0xF0 ? 3
                               : first >= 0xF0 && first < 0xF5 ? 4
                                                               : 0;
    for (std::size_t at = 1; at < length; ++at)
        if ((byte(at) & 0xC0) != 0x80) return 0;
    const bool is_overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
    // a surrogate, beyond U+10FFFF
    const bool is_none = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
    return is_overlong || is_none ? 0 : length;
}

// Control characters by their codes, those that UTF-8 has beyond ASCII (U+0080 to U+009F) among them, and bytes that
// are no UTF-8.
std::string escaped(const std::string& text)
{
    std::string shown;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string_view rest = std::string_view(text).substr(i);
        const std::size_t length = bytes_of_character(rest);
        const auto byte = static_cast<unsigned char>(rest.front());
        if (length == 2 && byte == 0xC2 && static_cast<unsigned char>(rest[1]) < 0xA0)
            shown += code_of(static_cast<unsigned char>(text[++i]));
        else if (length == 0 || byte < ' ' || byte == 0x7F)
            shown += code_of(byte);
        else {
            shown += rest.substr(0, length);
            i += length - 1;
        }
    }
    return shown;
}

std::string message(const std::string& file, int line, const std::string& field, const std::string& value,
                    const std::string& rule)
{
    std::string text = file;
    if (line > 0) text.append(":").append(std::to_string(line));
    if (!text.empty()) text += ": ";
    if (!field.empty()) text += shortened(field);
    if (!value.empty()) text.append(" = ").append(shortened(value));
    if (!field.empty() || !value.empty()) text += ": ";
    return escaped(text + rule);
}

int edit_distance(const std::string& a, const std::string& b)
{
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        int diagonal = row[0];
        row[0] = static_cast<int>(i) + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int substituted = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({substituted, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

}  // namespace

InputError::InputError(const std::string& file, int line, const std::string& field, const std::string& value,
                       const std::string& rule)
    : std::runtime_error(message(file, line, field, value, rule))
{
}

int line_at(const std::string& text, std::size_t byte)
{
    return 1 + static_cast<int>(std::count(
                   text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size())), '\n'));
}

std::string name_list(const std::vector<std::string>& names)
{
    constexpr std::size_t most = 6;
    std::string text;
    for (std::size_t n = 0; n < names.size() && n < most; ++n) text += (n ? ", " : "") + names[n];
    return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " others" : text;
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& known)
{
    if (known.empty()) return {};
    const std::string beginning = name.substr(0, most_letters);
    return *std::ranges::min_element(known, {}, [&](const std::string& one) { return edit_distance(beginning, one); });
}

}  // namespace pbs
