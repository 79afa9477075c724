#include "analysis/text_columns.hpp"

#include <algorithm>
#include <sstream>

namespace analysis {
namespace {

const std::string gap = "  ", colours_off = "\033[0m";

bool begins_character(char byte)
{
    return (static_cast<unsigned char>(byte) & 0xC0) != 0x80;
}

// Takes the first `count` characters; the rest stays in `word`.
std::string taken_from(std::string& word, std::size_t count)
{
    std::size_t end = 0;
    for (std::size_t seen = 0; end < word.size(); ++end)
        if (begins_character(word[end]) && seen++ == count) break;
    const std::string head = word.substr(0, end);
    word.erase(0, end);
    return head;
}

void wrap_paragraph(const std::string& paragraph, std::size_t width, std::vector<std::string>& lines)
{
    std::istringstream words(paragraph);
    std::string line;
    for (std::string word; words >> word;) {
        if (!line.empty() && characters(line) + 1 + characters(word) > width) {
            lines.push_back(line);
            line.clear();
        }
        while (characters(word) > width) lines.push_back(taken_from(word, width));
        line += (line.empty() ? "" : " ") + word;
    }
    lines.push_back(line);
}

std::string coloured(const std::string& text, const std::string& colour)
{
    return colour.empty() || text.empty() ? text : colour + text + colours_off;
}

}  // namespace

std::size_t characters(const std::string& text)
{
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

std::vector<std::string> wrapped(const std::string& text, std::size_t width)
{
    std::vector<std::string> lines;
    std::istringstream paragraphs(text);
    for (std::string paragraph; std::getline(paragraphs, paragraph);) wrap_paragraph(paragraph, std::max<std::size_t>(width, 1), lines);
    return lines;
}

std::string side_by_side(const std::vector<TextColumn>& columns)
{
    std::vector<std::vector<std::string>> cells;
    std::size_t height = 0;
    for (const TextColumn& column : columns) {
        cells.push_back(wrapped(column.text, column.width));
        height = std::max(height, cells.back().size());
    }
    std::string text;
    for (std::size_t row = 0; row < height; ++row) {
        std::string line, blanks;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const std::string cell = row < cells[i].size() ? cells[i][row] : "";
            if (!cell.empty()) line += blanks + coloured(cell, columns[i].colour);
            blanks = cell.empty() ? blanks + std::string(columns[i].width, ' ') + gap
                                  : std::string(columns[i].width - std::min(columns[i].width, characters(cell)), ' ') + gap;
        }
        text += line + "\n";
    }
    return text;
}

}  // namespace analysis
