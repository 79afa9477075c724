#include "experiments/rigs/fbx_document.hpp"

#include "pbs/geometry/input_error.hpp"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cstring>

namespace pbs {
namespace {

constexpr std::string_view binary_magic = "Kaydara FBX Binary  ";
constexpr std::size_t binary_header = 27;             // bytes: the magic, three others, and the version
constexpr std::uint32_t version_of_wide_ends = 7500;  // from which ends and counts have 64 bits
constexpr std::int64_t oldest_version = 7000;
constexpr int deepest = 64;            // records within records
constexpr double zlib_ratio = 1032.0;  // zlib packs no byte better (its technical details)

void require_version(std::int64_t version, const std::string& path)
{
    if (version < oldest_version)
        throw InputError(path, 0, "FBXVersion", std::to_string(version),
                         "expected 7000 or more (FBX 2011): convert the file with Autodesk's FBX Converter, or export "
                         "glTF 2.0 (.glb) from "
                         "the program that made it");
}

// A number at the beginning of a text and what follows it. Numbers that are nearer to zero than a double can be are
// zero.
std::optional<double> leading_number(std::string_view& text)
{
    std::string_view rest = text;
    if (rest.starts_with('+')) rest.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (error == std::errc::invalid_argument) return std::nullopt;
    const std::string_view digits = rest.substr(0, static_cast<std::size_t>(end - rest.data()));
    if (error == std::errc::result_out_of_range && digits.find_first_of("eE") != std::string_view::npos &&
        digits[digits.find_first_of("eE") + 1] != '-')
        return std::nullopt;
    text = rest.substr(digits.size());
    return error == std::errc() ? number : 0.0;
}

// name: value, value, ... { records }   with ; before remarks and "*N { a: numbers }" as an array.
class FbxText {
public:
    FbxText(const std::string& text, const std::string& path) : text_(text), path_(path) {}

    FbxRecord file()
    {
        FbxRecord file;
        while (skip_blank(), at_ < text_.size()) file.records.push_back(record(0));
        return file;
    }

private:
    [[noreturn]] void refuse(const std::string& rule) const
    {
        const std::size_t place = std::min(at_, text_.size());
        throw InputError(path_, line_at(text_, place), "",
                         text_.substr(place, std::min<std::size_t>(20, text_.find('\n', place) - place)),
                         "no FBX text: " + rule);
    }

    char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    void skip_spaces()
    {
        while (next() == ' ' || next() == '\t' || next() == '\r') ++at_;
    }

    void skip_blank()
    {
        while (skip_spaces(), next() == '\n' || next() == ';')
            at_ = next() == ';' ? std::min(text_.find('\n', at_), text_.size()) : at_ + 1;
    }

    FbxRecord record(int depth)
    {
        if (depth > deepest) refuse("records nested deeper than " + std::to_string(deepest));
        FbxRecord record;
        const std::size_t end = text_.find_first_of(" \t\r\n:{},\"", at_);
        if (end == std::string::npos || text_[end] != ':' || end == at_)
            refuse("expected the name of a record and a colon");
        record.name = text_.substr(at_, end - at_);
        at_ = end + 1;
        add_values(record);
        if (next() != '{') return record;
        ++at_;
        while (skip_blank(), next() != '}') {
            if (at_ >= text_.size()) refuse("the file ends within record " + record.name);
            record.records.push_back(this->record(depth + 1));
        }
        ++at_;
        return record;
    }

    void add_values(FbxRecord& record)
    {
        for (skip_spaces(); next() != '\n' && next() != '{' && next() != '}' && next() != ';' && next() != '\0';) {
            record.values.push_back(next() == '*' ? array() : value());
            skip_spaces();
            if (next() != ',') break;
            ++at_;
            skip_blank();
        }
        skip_spaces();
    }

    FbxValue value()
    {
        if (next() == ',') return std::string();  // left out, as before an embedded file
        if (next() == '"') return quoted();
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n,{};", at_), text_.size());
        const std::string_view word(text_.data() + at_, end - at_);
        at_ = end;
        std::int64_t whole = 0;
        if (const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), whole);
            error == std::errc() && last == word.data() + word.size())
            return whole;
        std::string_view rest = word;
        const std::optional<double> number = leading_number(rest);
        return number && rest.empty() ? FbxValue(*number) : FbxValue(std::string(word));
    }

    std::string quoted()
    {
        const std::size_t end = text_.find('"', at_ + 1);
        if (end == std::string::npos) refuse("a quotation mark without an end");
        std::string text = text_.substr(at_ + 1, end - at_ - 1);
        at_ = end + 1;
        for (std::size_t mark = text.find("&quot;"); mark != std::string::npos; mark = text.find("&quot;", mark + 1))
            text.replace(mark, 6, "\"");
        return text;
    }

    std::vector<double> array()
    {
        std::size_t count = 0;
        ++at_;
        at_ = static_cast<std::size_t>(std::from_chars(text_.data() + at_, text_.data() + text_.size(), count).ptr -
                                       text_.data());
        skip_blank();
        if (next() != '{') refuse("expected { after the length of an array");
        ++at_;
        skip_blank();
        std::vector<double> numbers;
        if (text_.compare(at_, 2, "a:") == 0) at_ += 2;
        for (skip_blank(); next() != '}'; skip_blank()) {
            std::string_view rest(text_.data() + at_, text_.size() - at_);
            const std::optional<double> number = leading_number(rest);
            if (!number) refuse("expected a number of an array of " + std::to_string(count));
            numbers.push_back(*number);
            at_ = text_.size() - rest.size();
            skip_blank();
            if (next() == ',') ++at_;
        }
        if (numbers.size() != count)
            refuse("the array before it states " + std::to_string(count) + " numbers and has " +
                   std::to_string(numbers.size()));
        ++at_;
        return numbers;
    }

    const std::string& text_;
    const std::string& path_;
    std::size_t at_ = 0;
};

// A record: the byte at which it ends, the number of its values, their bytes, its name, its values, its records, and an
// empty record.
class FbxBinary {
public:
    FbxBinary(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path), at_(binary_header) {}

    FbxRecord file(std::uint32_t version)
    {
        is_wide_ = version >= version_of_wide_ends;
        FbxRecord file;
        while (add_record(file.records, bytes_.size(), 0)) {
        }
        return file;
    }

private:
    [[noreturn]] void refuse(const std::string& rule) const
    {
        throw InputError(path_, 0, "byte " + std::to_string(at_), "", "damaged FBX: " + rule);
    }

    template <typename Number>
    Number number()
    {
        Number number;
        std::memcpy(&number, take(sizeof number), sizeof number);
        return number;
    }

    // Moves behind so many bytes.
    const char* take(std::size_t count)
    {
        if (count > bytes_.size() - at_) refuse("the file ends here");
        at_ += count;
        return bytes_.data() + at_ - count;
    }

    std::uint64_t wide_or_narrow() { return is_wide_ ? number<std::uint64_t>() : number<std::uint32_t>(); }

    // False for the empty record that ends a list, and at its end.
    bool add_record(std::vector<FbxRecord>& records, std::size_t list_end, int depth)
    {
        if (at_ >= list_end) return false;
        if (depth > deepest) refuse("records nested deeper than " + std::to_string(deepest));
        const std::uint64_t end = wide_or_narrow(), values = wide_or_narrow();
        wide_or_narrow();
        const auto length = number<std::uint8_t>();
        if (end == 0) return false;
        if (end < at_ || end > list_end) refuse("a record ends outside its parent");
        FbxRecord record;
        record.name.assign(take(length), length);
        for (std::uint64_t v = 0; v < values; ++v) record.values.push_back(value());
        while (add_record(record.records, end, depth + 1)) {
        }
        if (at_ > end) refuse("a record is longer than it states");
        at_ = end;
        records.push_back(std::move(record));
        return true;
    }

    FbxValue value()
    {
        switch (const char type = *take(1); type) {
            case 'Y':
                return std::int64_t(number<std::int16_t>());
            case 'B':
            case 'C':
                return std::int64_t(number<std::uint8_t>());
            case 'I':
                return std::int64_t(number<std::int32_t>());
            case 'L':
                return number<std::int64_t>();
            case 'F':
                return double(number<float>());
            case 'D':
                return number<double>();
            case 'S':
            case 'R': {
                const auto length = number<std::uint32_t>();
                return std::string(take(length), length);
            }
            case 'f':
                return array<float>();
            case 'd':
                return array<double>();
            case 'l':
                return array<std::int64_t>();
            case 'i':
                return array<std::int32_t>();
            case 'b':
            case 'c':
                return array<std::uint8_t>();
            default:
                refuse("unknown type of a value");
        }
    }

    template <typename Number>
    std::vector<double> array()
    {
        const auto count = number<std::uint32_t>(), encoding = number<std::uint32_t>(), size = number<std::uint32_t>();
        const char* packed = take(size);
        uLongf unpacked = sizeof(Number) * static_cast<uLongf>(count);
        if (encoding > 1 || (encoding == 0 && size != unpacked) || double(unpacked) > zlib_ratio * (size + 1.0))
            refuse("an array of " + std::to_string(count) + " numbers in " + std::to_string(size) + " bytes");
        std::vector<Number> numbers(count);
        if (encoding == 0 && count > 0)
            std::memcpy(numbers.data(), packed, size);
        else if (count > 0 && (uncompress(reinterpret_cast<Bytef*>(numbers.data()), &unpacked,
                                          reinterpret_cast<const Bytef*>(packed), size) != Z_OK ||
                               unpacked != sizeof(Number) * static_cast<uLongf>(count)))
            refuse("an array that zlib cannot unpack");
        return {numbers.begin(), numbers.end()};
    }

    const std::string& bytes_;
    const std::string& path_;
    std::size_t at_;
    bool is_wide_ = false;
};

template <typename Value>
const Value* value_at(const std::vector<FbxValue>& values, std::size_t place)
{
    return place < values.size() ? std::get_if<Value>(&values[place]) : nullptr;
}

}  // namespace

const FbxRecord* FbxRecord::record(std::string_view of_name) const
{
    for (const FbxRecord& record : records)
        if (record.name == of_name) return &record;
    return nullptr;
}

const std::string* FbxRecord::text(std::size_t place) const
{
    return value_at<std::string>(values, place);
}

const std::int64_t* FbxRecord::whole(std::size_t place) const
{
    return value_at<std::int64_t>(values, place);
}

std::optional<double> FbxRecord::number(std::size_t place) const
{
    if (const double* number = value_at<double>(values, place)) return *number;
    if (const std::int64_t* number = whole(place)) return static_cast<double>(*number);
    return std::nullopt;
}

std::vector<double> FbxRecord::numbers(std::string_view of_name) const
{
    const FbxRecord* found = record(of_name);
    if (!found) return {};
    if (const auto* array = value_at<std::vector<double>>(found->values, 0)) return *array;
    std::vector<double> numbers;
    for (std::size_t place = 0; place < found->values.size(); ++place)
        if (const std::optional<double> number = found->number(place)) numbers.push_back(*number);
    return numbers;
}

FbxRecord read_fbx_document(const std::string& bytes, const std::string& path)
{
    if (bytes.starts_with(binary_magic)) {
        if (bytes.size() < binary_header)
            throw InputError(path, 0, "", "", "damaged FBX: the file ends within its header");
        std::uint32_t version = 0;
        std::memcpy(&version, bytes.data() + binary_header - sizeof version, sizeof version);
        require_version(version, path);
        return FbxBinary(bytes, path).file(version);
    }
    constexpr std::string_view label = "FBXVersion:";
    const std::size_t found = bytes.find(label);
    std::string_view rest =
        std::string_view(bytes).substr(found == std::string::npos ? bytes.size() : found + label.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    const std::optional<double> version = leading_number(rest);
    if (!version) throw InputError(path, 0, "FBXVersion", "", "missing: the file is no FBX, or damaged");
    require_version(static_cast<std::int64_t>(std::clamp(*version, 0.0, 1e9)), path);
    return FbxText(bytes, path).file();
}

}  // namespace pbs
