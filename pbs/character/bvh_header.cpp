#include "pbs/character/bvh_header.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>

namespace pbs {
namespace {

constexpr int deepest_nesting = 500;
constexpr double shortest_frame_s = 1e-6, longest_frame_s = 1e3;

int line_at(const std::string& text, std::size_t place)
{
    return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
}

// The word that follows `label` after `from`; empty where there is none. `place` becomes where it was looked for.
std::string word_after(const std::string& text, const std::string& label, std::size_t& place)
{
    const std::size_t found = text.find(label, place);
    if (found == std::string::npos) return {};
    place = found + label.size();
    std::string word;
    std::istringstream(text.substr(place, 80)) >> word;
    return word;
}

double number_of(const std::string& word)
{
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    return *end == '\0' ? number : std::nan("");
}

void check_nesting(const std::string& text, std::size_t header_end, const std::string& path)
{
    int depth = 0;
    for (std::size_t place = 0; place < header_end; ++place) {
        depth += text[place] == '{' ? 1 : text[place] == '}' ? -1 : 0;
        if (depth > deepest_nesting)
            throw InputError(path, line_at(text, place), "JOINT", "", "nested deeper than " + std::to_string(deepest_nesting) + " joints");
    }
}

// Words after the frame time's line: the numbers of all frames, so many channels each. Fewer is assimp's to refuse; of more it reads a
// part.
void check_rows(const std::string& text, std::size_t place, double frames, const std::string& path)
{
    double channels = 0.0, words = 0.0;
    for (std::size_t at = 0; at < text.size();) {
        const std::string count = word_after(text, "CHANNELS", at);
        if (count.empty()) break;
        channels += number_of(count);
    }
    std::istringstream rest(text.substr(std::min(text.find('\n', place), text.size())));
    for (std::string word; rest >> word;) ++words;
    if (words > frames * channels)
        throw InputError(path, line_at(text, place) + 1, "motion", std::to_string(static_cast<long long>(words)) + " numbers",
                         "expected Frames times channels: " + std::to_string(static_cast<long long>(frames * channels)));
}

}  // namespace

bool is_bvh(const std::string& text, const std::string& path)
{
    constexpr std::string_view mark = "\xef\xbb\xbf", first_word = "HIERARCHY";
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::size_t word = text.find_first_not_of(" \t\r\n\v\f", text.starts_with(mark) ? mark.size() : 0);
    return extension == ".bvh" || (word != std::string::npos && text.compare(word, first_word.size(), first_word) == 0);
}

void check_bvh_header(const std::string& text, const std::string& path)
{
    std::size_t place = std::min(text.rfind("MOTION"), text.size());
    check_nesting(text, place, path);

    const std::string frames = word_after(text, "Frames:", place);
    const double number = number_of(frames);
    if (!frames.empty() && !(number >= 1.0 && number == std::floor(number)))
        throw InputError(path, line_at(text, place), "Frames", frames, "expected a whole number of frames, 1 or more");
    if (number > static_cast<double>(text.size()) / 2.0)
        throw InputError(path, line_at(text, place), "Frames", frames, "the file is too short to hold them");

    const std::string frame_time = word_after(text, "Time:", place);
    const double seconds = number_of(frame_time);
    if (!frame_time.empty() && !(seconds >= shortest_frame_s && seconds <= longest_frame_s))
        throw InputError(path, line_at(text, place), "Frame Time", frame_time, "expected a time from 1e-6 to 1000 s");
    check_rows(text, place, number, path);
}

}  // namespace pbs
