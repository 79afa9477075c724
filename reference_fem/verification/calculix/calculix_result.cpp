#include "reference_fem/verification/calculix/calculix_result.hpp"

#include "pbs/geometry/input_error.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <vector>

namespace reference_fem {
namespace {

constexpr const char* printed_name = "deck.dat";
constexpr const char* restart_name = "deck.rout";
constexpr double last_digit = 5.01e-7;  // half a unit of the 7th digit over the smallest mantissa 1.000000

// Fortran leaves out the E of an exponent of three digits: 1.234567-101.
std::optional<double> number(std::string text)
{
    const std::size_t sign = text.find_first_of("+-", 1);
    if (sign != std::string::npos && std::toupper(text[sign - 1]) != 'E') text.insert(sign, "E");
    double value = 0.0;
    const char* const begin = text.c_str() + (text.starts_with('+') ? 1 : 0);
    const char* const end = text.c_str() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, value);
    const bool underflow = error == std::errc::result_out_of_range && std::abs(value) < 1.0;
    if ((error != std::errc() && !underflow) || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

class PrintedReader {
public:
    PrintedReader(const std::string& file, Eigen::Index nodes)
        : file_(file), seen_(nodes, false), displacements_(pbs::Positions::Zero(nodes, 3))
    {
    }

    pbs::Positions read(const std::string& text)
    {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            ++line_;
            if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
            line.find("displacements") != std::string::npos ? begin_block(line) : read_node(line);
        }
        if (blocks_ == 0) refuse("displacements", "", "expected a block of them");
        for (std::size_t n = 0; n < seen_.size(); ++n)
            if (!seen_[n]) refuse("node", std::to_string(n + 1), "expected a line of every node");
        return displacements_;
    }

private:
    [[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& rule) const
    {
        throw pbs::InputError(file_, line_, field, value, rule);
    }

    void begin_block(const std::string& line)
    {
        if (++blocks_ > 1) refuse("displacements", line, "expected one block of them");
        const std::string time = line.substr(line.find_last_of(' ') + 1);
        if (number(time) != 1.0) refuse("time", time, "expected 1, the end of the step");
    }

    void read_node(const std::string& line)
    {
        std::istringstream words(line);
        std::vector<std::string> fields;
        for (std::string word; words >> word;) fields.push_back(word);
        if (blocks_ == 0 || fields.size() != 4) refuse("line", line, "expected a node and three numbers below a header");
        const std::optional<double> node = number(fields[0]);
        if (!node || *node != std::floor(*node) || *node < 1.0 || *node > static_cast<double>(seen_.size()))
            refuse("node", fields[0], "expected 1 to " + std::to_string(seen_.size()));
        const auto n = static_cast<std::size_t>(*node) - 1;
        if (seen_[n]) refuse("node", fields[0], "expected one line a node");
        seen_[n] = true;
        for (int c = 0; c < 3; ++c) {
            const std::optional<double> component = number(fields[c + 1]);
            if (!component) refuse("displacement", fields[c + 1], "expected a finite number");
            displacements_(static_cast<Eigen::Index>(n), c) = *component;
        }
    }

    std::string file_;
    int line_ = 0, blocks_ = 0;
    std::vector<bool> seen_;
    pbs::Positions displacements_;
};

bool agrees(const pbs::Positions& record, const pbs::Positions& printed)
{
    constexpr double smallest_printed = 1e-99;
    return ((record - printed).array().abs() <= last_digit * printed.array().abs() + smallest_printed).all();
}

// A record of 1 + 3 numbers a node, the first one its temperature: of the nodes, then of the ends of springs.
std::optional<pbs::Positions> displacements_in(const std::string& restart, std::size_t begin, std::size_t length, Eigen::Index nodes)
{
    using Record = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
    if (length % (sizeof(double) * 4) != 0 || length < sizeof(double) * 4 * nodes) return std::nullopt;
    Record record(nodes, 4);
    std::memcpy(record.data(), restart.data() + begin, sizeof(double) * record.size());
    return pbs::Positions(record.rightCols<3>());
}

// gfortran's unformatted records: length in 4 bytes, data, length again. A negative length (a record of 2 GiB in pieces) is not followed.
std::optional<pbs::Positions> find_in_restart(const std::string& restart, const pbs::Positions& printed)
{
    const auto length_at = [&](std::size_t at) {
        std::int32_t length = 0;
        if (at + sizeof length > restart.size()) throw pbs::InputError(restart_name, 0, "", "", "cut short");
        std::memcpy(&length, restart.data() + at, sizeof length);
        return length;
    };
    std::optional<pbs::Positions> found;
    for (std::size_t at = 0; at < restart.size();) {
        const std::int32_t length = length_at(at);
        if (length < 0) return std::nullopt;
        const std::size_t begin = at + sizeof length;
        if (length_at(begin + length) != length) throw pbs::InputError(restart_name, 0, "record", std::to_string(length), "damaged");
        const auto candidate = displacements_in(restart, begin, length, printed.rows());
        if (!found && candidate && agrees(*candidate, printed)) found = candidate;
        at = begin + length + sizeof length;
    }
    return found;
}

}  // namespace

pbs::Positions read_printed_displacements(const std::string& text, const std::string& file, Eigen::Index nodes)
{
    return PrintedReader(file, nodes).read(text);
}

CalculixDisplacements read_displacements(const std::string& printed, const std::string& restart, Eigen::Index nodes)
{
    CalculixDisplacements result;
    result.displacements = read_printed_displacements(printed, printed_name, nodes);
    const auto exact = find_in_restart(restart, result.displacements);
    if (exact) result = {*exact, true};
    return result;
}

}  // namespace reference_fem
