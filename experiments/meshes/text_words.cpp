#include "experiments/meshes/text_words.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <utility>

namespace pbs {
namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

void append_utf8(std::string& text, unsigned long code)
{
    if (code < 0x80) {
        text += static_cast<char>(code);
        return;
    }
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;  // bytes behind the first one
    text += static_cast<char>((0xFF00 >> (more + 1) & 0xFF) | code >> 6 * more);
    for (int byte = more - 1; byte >= 0; --byte) text += static_cast<char>(0x80 | (code >> 6 * byte & 0x3F));
}

}  // namespace

std::string as_utf8(std::string bytes)
{
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
    const bool is_little = bytes.starts_with("\xFF\xFE");
    if (!is_little && !bytes.starts_with("\xFE\xFF")) return bytes;
    const auto unit = [&](std::size_t at) -> unsigned long {
        const auto first = static_cast<unsigned char>(bytes[at]), second = static_cast<unsigned char>(bytes[at + 1]);
        return is_little ? first | second << 8 : second | first << 8;
    };
    std::string text;
    for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
        unsigned long code = unit(at);
        if (code >= 0xD800 && code < 0xDC00 && at + 3 < bytes.size())  // the first half of a pair (RFC 2781)
            code = 0x10000 + ((code - 0xD800) << 10) + (unit(at += 2) & 0x3FF);
        append_utf8(text, code);
    }
    return text;
}

std::optional<double> number_in(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    std::string fortran;
    const std::size_t exponent = word.find_first_of("dD");
    if (exponent != std::string_view::npos && word.find_first_not_of("+-.0123456789") == exponent) {
        fortran = word;
        fortran[exponent] = 'e';
        word = fortran;
    }
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (word.empty() || end != word.data() + word.size()) return std::nullopt;
    // infinity, or next to zero
    if (error == std::errc::result_out_of_range) return std::strtod(std::string(word).c_str(), nullptr);
    return number;
}

std::string in_lower_case(std::string text)
{
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

TextWords::TextWords(std::string path, std::string text, char comment)
    : path_(std::move(path)), text_(std::move(text)), comment_(comment)
{
}

std::string_view TextWords::peek()
{
    at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
    while (comment_ != '\0' && at_ < text_.size() && text_[at_] == comment_) {
        skip_line();
        at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
    }
    if (at_ == text_.size()) return {};
    std::size_t end = std::string::npos;
    if (text_[at_] == '"' && (end = text_.find('"', at_ + 1)) != std::string::npos) ++end;
    if (end == std::string::npos) end = std::min(text_.find_first_of(blanks, at_), text_.size());
    if (comment_ != '\0' && text_[at_] != '"') end = std::min(end, text_.find(comment_, at_));
    return std::string_view(text_).substr(at_, end - at_);
}

std::string_view TextWords::next(const char* field)
{
    const std::string_view word = peek();
    begin_ = at_;
    at_ += word.size();
    if (word.empty()) fail(field, "", "truncated: the file ends here");
    return word;
}

double TextWords::number(const char* field)
{
    const std::string_view word = next(field);
    const std::optional<double> number = number_in(word);
    if (!number) fail(field, std::string(word), "expected a number");
    return *number;
}

long long TextWords::whole(const char* field, long long low, long long high)
{
    const std::string_view word = next(field);
    long long number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || number < low || number > high)
        fail(field, std::string(word), expected_whole("a whole number", low, high));
    return number;
}

void TextWords::fail(const std::string& field, const std::string& value, const std::string& rule) const
{
    throw InputError(path_, line_at(text_, std::min(begin_, text_.size())), field, value, rule);
}

void TextWords::skip_line()
{
    const std::size_t end = text_.find('\n', at_);
    at_ = end == std::string::npos ? text_.size() : end + 1;
}

std::string_view TextWords::bytes(std::size_t count, const char* field)
{
    begin_ = at_;
    if (count > text_.size() - at_) throw InputError(path_, 0, field, "", "truncated: the file ends here");
    at_ += count;
    return std::string_view(text_).substr(begin_, count);
}

}  // namespace pbs
