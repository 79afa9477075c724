// Reads back the record of a run, which may have been changed since it was written.
//   const double total_s = from_record(folder + "/run.json", [](const auto& run) { return run.at("cost").at("total").get<double>(); });
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace analysis {

nlohmann::json read_record(const std::string& path);       // InputError if it is not valid JSON
[[noreturn]] void refuse_record(const std::string& path);  // throws InputError

// The result of `read`; InputError with the file if an entry is missing or has another type.
template <typename Read>
auto from_record(const std::string& path, const Read& read)
{
    const nlohmann::json record = read_record(path);
    try {
        return read(record);
    } catch (const nlohmann::json::exception&) {
        refuse_record(path);
    }
}

}  // namespace analysis
