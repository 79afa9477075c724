#include "pbs/geometry/toml_text.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

namespace pbs {
namespace {

constexpr int most_parts = 64;

// Behind the text in quotes that begins at `place`; one that is not closed ends with its line, or with the file where it may have many.
std::size_t after_quotes(const std::string& text, std::size_t place)
{
    const char quote = text[place];
    const std::string three(3, quote);
    const bool many_lines = text.compare(place, 3, three) == 0;
    for (std::size_t at = place + (many_lines ? 3 : 1); at < text.size(); ++at) {
        if (!many_lines && text[at] == '\n') return at;
        if (!many_lines && text[at] == quote) return at + 1;
        if (text.compare(at, 3, three) == 0) return std::min(text.find_first_not_of(quote, at), at + 5);  // two more belong to the text
        if (text[at] == '\\' && quote == '"') ++at;
    }
    return text.size();
}

// Dots of the keys that lead to a place of the text, those of the inline tables around it among them. Dots of numbers are counted with
// the key before them.
class DotsOfKeys {
public:
    int after(char bare)
    {
        if (bare == '{') around_.push_back(dots_);
        if (bare == '}' && around_.size() > 1) around_.pop_back();
        if (bare == '{' || bare == '}' || bare == ',' || bare == '\n') dots_ = around_.back();
        return dots_ += bare == '.';
    }

private:
    std::vector<int> around_ = {0};
    int dots_ = 0;
};

[[noreturn]] void refuse(const std::string& text, std::size_t place, const std::string& file, const std::string& field,
                         const std::string& value, const std::string& rule)
{
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
    throw InputError(file, static_cast<int>(line), field, value, rule);
}

std::string beginning_of_line(const std::string& text, std::size_t place)
{
    const std::size_t before = place == 0 ? std::string::npos : text.rfind('\n', place - 1);
    return text.substr(before == std::string::npos ? 0 : before + 1, 40) + "...";
}

bool is_within_a_word(char before)
{
    return std::isalnum(static_cast<unsigned char>(before)) || std::string_view("_-+\"'").find(before) != std::string_view::npos;
}

}  // namespace

void check_toml_keys(const std::string& text, const std::string& file)
{
    DotsOfKeys dots;
    for (std::size_t place = 0; place < text.size();) {
        const char c = text[place];
        if (c == '"' || c == '\'') {
            if (place > 0 && is_within_a_word(text[place - 1]))  // the parser goes on with its word, whatever letters the text has
                refuse(text, place, file, "quote", beginning_of_line(text, place), "expected a text apart from what is before it");
            place = after_quotes(text, place);
        } else if (c == '#') {
            place = std::min(text.find('\n', place), text.size());
        } else {
            if ((c < ' ' && c != '\t' && c != '\r' && c != '\n') || c > '~')  // TOML's bare words are ASCII
                refuse(text, place, file, "byte", std::to_string(static_cast<unsigned char>(c)), "expected ASCII outside of texts");
            if (dots.after(c) >= most_parts)
                refuse(text, place, file, "key", beginning_of_line(text, place), "nested too deep: expected at most 64 parts");
            ++place;
        }
    }
}

}  // namespace pbs
