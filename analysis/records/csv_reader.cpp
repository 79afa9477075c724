#include "analysis/records/csv_table.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <set>
#include <string_view>

namespace analysis {
namespace {

[[noreturn]] void refuse(const std::string& file, int line, std::size_t column, const std::string& value, const std::string& rule)
{
    throw pbs::InputError(fmt::format("{}:{}", file, line), static_cast<int>(column), value.empty() ? "" : "column", value, rule);
}

// Reads one record at a time from the text and resolves quotes and line ends.
class RecordReader {
public:
    RecordReader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

    bool at_end() const { return at_ == text_.size(); }
    int line() const { return line_; }

    std::vector<std::string> next()
    {
        std::vector<std::string> fields;
        do {
            fields.emplace_back();
            if (take('"'))
                read_quoted(fields);
            else
                read_plain(fields);
        } while (take(','));
        take('\r');
        if (!take('\n'))
            refuse(file_, line_, fields.size(), "", at_end() ? "the file ends within a line: cut off?" : "unexpected text after a field");
        ++line_;
        return fields;
    }

private:
    bool take(char c)
    {
        if (at_end() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    void read_plain(std::vector<std::string>& fields)
    {
        for (; !at_end() && std::string_view(",\r\n").find(text_[at_]) == std::string_view::npos; ++at_) {
            if (text_[at_] == '"' || text_[at_] == '\0')
                refuse(file_, line_, fields.size(), "", "unexpected quote or zero byte within a field");
            fields.back() += text_[at_];
        }
    }

    void read_quoted(std::vector<std::string>& fields)
    {
        const int first_line = line_;
        while (!at_end()) {
            const char c = text_[at_++];
            if (c == '"' && !take('"')) return;
            if (c == '\n') ++line_;
            fields.back() += c;
        }
        refuse(file_, first_line, fields.size(), "", "a quote is never closed");
    }

    const std::string& text_;
    const std::string& file_;
    std::size_t at_ = 0;
    int line_ = 1;
};

}  // namespace

CsvTable parse_csv(const std::string& text, const std::string& file)
{
    if (text.empty()) throw pbs::InputError(file, 0, "", "", "the file is empty: expected a line of column names");
    RecordReader reader(text, file);
    CsvTable table(reader.next());
    table.file_ = file;
    std::set<std::string> names;
    for (std::size_t i = 0; i < table.columns_.size(); ++i)
        if (!names.insert(table.columns_[i]).second) refuse(file, 1, i + 1, table.columns_[i], "expected each column once");
    while (!reader.at_end()) {
        const int line = reader.line();
        table.rows_.push_back(reader.next());
        table.lines_.push_back(line);
        const std::size_t fields = table.rows_.back().size(), wanted = table.columns_.size();
        if (fields != wanted) refuse(file, line, fields, "", fmt::format("{} fields: expected {} as in the first line", fields, wanted));
    }
    return table;
}

}  // namespace analysis
