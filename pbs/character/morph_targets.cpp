#include "pbs/character/morph_targets.hpp"

#include "pbs/character/body_cache.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace pbs {
namespace {

constexpr double decimetres_a_step = 1e-3;

}  // namespace

MorphTargets::MorphTargets(const std::string& list_file, const std::string& data_file, Eigen::Index vertices)
    : list_(list_file), data_file_(data_file), row_bytes_(6 * static_cast<std::size_t>(vertices))
{
    const auto& targets = list_.at("targets");
    if (!targets.is_object() || targets.empty()) list_.refuse("targets", "expected the targets by name");
    for (const auto& [key, words] : targets.items()) keys_.push_back(key);
    std::sort(keys_.begin(), keys_.end());

    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(data_file_, error), wanted = keys_.size() * row_bytes_;
    if (error) throw InputError(data_file_, 0, "", "", "cannot be read: " + error.message());
    if (bytes != wanted)
        throw InputError(data_file_, 0, "bytes", std::to_string(bytes),
                         "expected " + std::to_string(wanted) + ": " + std::to_string(keys_.size()) + " targets of " +
                             std::to_string(vertices) + " vertices");
}

// "asian-male-young" is the end of "caucasian-male-young": names are matched from a slash.
std::size_t MorphTargets::row_of(const std::string& target) const
{
    std::vector<std::size_t> rows;
    for (std::size_t k = 0; k < keys_.size(); ++k)
        if (("/" + keys_[k]).ends_with("/" + target + ".target")) rows.push_back(k);
    if (rows.size() != 1) list_.refuse("targets", std::to_string(rows.size()) + " are named " + target + ", expected one");
    return rows.front();
}

std::string MorphTargets::add(const std::string& target, Positions& vertices) const
{
    std::ifstream file(data_file_, std::ios::binary);
    std::string row(row_bytes_, '\0');
    file.seekg(static_cast<std::streamoff>(row_of(target) * row_bytes_));
    if (!file.read(row.data(), static_cast<std::streamsize>(row_bytes_))) throw InputError(data_file_, 0, target, "", "cannot be read");
    for (Eigen::Index i = 0; i < vertices.size(); ++i) {
        const unsigned low = static_cast<std::uint8_t>(row[2 * i]), high = static_cast<std::uint8_t>(row[2 * i + 1]);
        vertices.data()[i] += decimetres_a_step * static_cast<std::int16_t>(low | high << 8);
    }
    return content_hash(row);
}

}  // namespace pbs
