#include "analysis/records/report_table.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <regex>
#include <sstream>
#include <string_view>

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

using Row = std::vector<std::string>;

std::string trimmed(const std::string& text)
{
    const std::size_t begin = text.find_first_not_of(' ');
    return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

Row cells_of(const std::string& line)
{
    Row cells;
    std::string cell;
    for (std::size_t at = 1; at < line.size(); ++at)
        if (line[at] == '|') {
            cells.push_back(trimmed(cell));
            cell.clear();
        } else {
            if (line.compare(at, 2, "\\|") == 0) ++at;
            cell += line[at];
        }
    return cells;
}

// Each column is as wide as its widest cell, but the widest columns are narrowed until all fit next to each other.
std::vector<std::size_t> column_widths(const std::vector<Row>& rows, std::size_t width)
{
    constexpr std::size_t gap = 2, least = 6;
    std::vector<std::size_t> widths(rows.front().size(), 1);
    for (const Row& row : rows)
        for (std::size_t i = 0; i < std::min(row.size(), widths.size()); ++i)
            widths[i] = std::max(widths[i], characters(row[i]));
    const auto sum = [&] { return std::accumulate(widths.begin(), widths.end(), gap * (widths.size() - 1)); };
    for (auto widest = std::max_element(widths.begin(), widths.end()); sum() > width && *widest > least;
         widest = std::max_element(widths.begin(), widths.end()))
        --*widest;
    return widths;
}

// Collects the lines of a block and writes it when the next one begins.
class PlainText {
public:
    explicit PlainText(std::size_t width) : width_(width) {}

    void add(const std::string& line)
    {
        static const std::regex separator(R"(\|[-|]+)"), item(R"(\s*(-|\d+\.) .*)"), bar(R"(\\\|)");
        if (line.starts_with("<!--") || std::regex_match(line, separator)) return;
        if (line.starts_with("|")) return rows_.push_back(cells_of(line));
        const bool is_code = line.starts_with("    "), is_heading = line.starts_with("#");
        if (line.empty() || is_code || is_heading || !rows_.empty() || std::regex_match(line, item)) end_block();
        if (is_code && characters(line) <= width_)
            text_ += line + "\n";
        else if (line.empty())
            text_ += text_.ends_with("\n\n") ? "" : "\n";
        else
            paragraph_ +=
                (paragraph_.empty() ? "" : " ") +
                std::regex_replace(trimmed(line.substr(is_heading ? line.find_first_not_of('#') : 0)), bar, "|");
        if (is_code || is_heading) end_block();
    }

    std::string end()
    {
        end_block();
        return text_;
    }

private:
    void end_block()
    {
        if (!rows_.empty()) {
            const std::vector<std::size_t> widths = column_widths(rows_, width_);
            for (const Row& row : rows_) {
                std::vector<TextColumn> columns;
                for (std::size_t i = 0; i < std::min(row.size(), widths.size()); ++i)
                    columns.push_back({row[i], widths[i]});
                text_ += side_by_side(columns);
            }
        }
        if (!paragraph_.empty()) {
            static const std::regex item(R"((-|\d+\.) (.*))");
            std::smatch parts;
            if (std::regex_match(paragraph_, parts, item))
                text_ += side_by_side(
                    {{parts[1].str(), parts[1].str().size()}, {parts[2].str(), width_ - parts[1].str().size() - 2}});
            else
                text_ += side_by_side({{paragraph_, width_}});
        }
        rows_.clear();
        paragraph_.clear();
    }

    std::size_t width_;
    std::vector<Row> rows_;
    std::string paragraph_, text_;
};

// Whether the asterisk there begins or ends an emphasised word; it is a sign of multiplication in a*b and a * b.
bool is_emphasis(const std::string& text, std::size_t at)
{
    const unsigned char before = at == 0 ? ' ' : text[at - 1], after = at + 1 == text.size() ? ' ' : text[at + 1];
    const bool begins = (std::isspace(before) || before == '(') && std::isalnum(after);
    return begins || (std::isalnum(before) &&
                      (std::isspace(after) || std::string_view(".,;:?!)").find(after) != std::string_view::npos));
}

// Without the marks of Markdown: the text of links, of code and of emphasised words. Pictures are left out.
std::string without_marks(const std::string& markdown)
{
    static const std::regex picture(R"(!\[[^\]]*\]\([^)]+\)\n?)"), link(R"(\[([^\]]+)\]\([^)]+\))"), mark(R"(`|\*\*)");
    const std::string text =
        std::regex_replace(std::regex_replace(std::regex_replace(markdown, picture, ""), link, "$1"), mark, "");
    std::string plain;
    for (std::size_t at = 0; at < text.size(); ++at)
        if (text[at] != '*' || !is_emphasis(text, at)) plain += text[at];
    return plain;
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
    for (std::string paragraph; std::getline(paragraphs, paragraph);)
        wrap_paragraph(paragraph, std::max<std::size_t>(width, 1), lines);
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
            blanks = cell.empty()
                         ? blanks + std::string(columns[i].width, ' ') + gap
                         : std::string(columns[i].width - std::min(columns[i].width, characters(cell)), ' ') + gap;
        }
        text += line + "\n";
    }
    return text;
}

std::string plain_text(const std::string& markdown, std::size_t width)
{
    PlainText plain(width);
    std::istringstream lines(without_marks(markdown));
    for (std::string line; std::getline(lines, line);) plain.add(line);
    return plain.end();
}

std::string markdown_cell(std::string text)
{
    std::replace(text.begin(), text.end(), '\n', ' ');
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
}

std::string first_paragraph(const std::string& markdown)
{
    const std::size_t begin = markdown.find("\n\n") + 2;
    std::string paragraph = markdown.substr(begin, markdown.find("\n\n", begin) - begin);
    std::replace(paragraph.begin(), paragraph.end(), '\n', ' ');
    return without_marks(paragraph);
}

}  // namespace analysis
