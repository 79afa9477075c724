#include "experiments/command_line/measure/file_reference.hpp"

#include "experiments/command_line/verbs.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {

FileReference::FileReference(const std::string& name, const RestMesh& rest, FileShape shape)
    : name_(name),
      rest_(rest.mesh()),
      shape_(std::move(shape)),
      at_tips_(flags("at_tips")),
      has_joints_(shape_.fields.of_points.contains("blended") && shape_.fields.of_points.contains("bone_distance_m")),
      norms_(domain())
{
}

ReferenceError FileReference::error_of(const pbs::Positions& positions, const analysis::SkinErrorMetrics& skin) const
{
    const analysis::ErrorNorms norms = norms_.measure(positions, shape_.positions, at_tips_);
    ReferenceError error{.reference = name_, .l2_pct = norms.l2_pct, .linf_m = norms.linf_m};
    if (has_joints_) error.joint_pct = norms.joint_pct;
    error.skin_rms_mm = skin.measure(positions, shape_.positions, at_tips_).rms_mm;
    if (const auto own = shape_.fields.facts.find("own_error_pct"); own != shape_.fields.facts.end())
        error.own_error_pct = own->second;
    if (error.joint_pct && error.own_error_pct) error.above_own_error = *error.joint_pct > *error.own_error_pct;
    return error;
}

std::vector<bool> FileReference::flags(const std::string& field) const
{
    std::vector<bool> set(rest_.rest.rows(), false);
    if (const auto values = shape_.fields.of_points.find(field); values != shape_.fields.of_points.end())
        for (std::size_t v = 0; v < set.size(); ++v) set[v] = values->second(static_cast<Eigen::Index>(v), 0) != 0.0;
    return set;
}

analysis::ErrorDomain FileReference::domain() const
{
    analysis::ErrorDomain domain{rest_.rest, rest_.tets, {}, {}, {}};
    if (!has_joints_) return domain;
    const std::vector<bool> blended = flags("blended");
    for (std::size_t v = 0; v < blended.size(); ++v)
        if (blended[v]) domain.blended.push_back(static_cast<int>(v));
    domain.bone_distance_m = shape_.fields.of_points.at("bone_distance_m").col(0);
    return domain;
}

std::vector<FileReference> file_references(const std::string& argument, std::size_t frames, const RestMesh& rest)
{
    std::vector<FileReference> references;
    if (argument.empty()) return references;
    const std::vector<std::string> paths = frame_files({argument}), names = frame_names(paths);
    if (paths.size() != 1 && paths.size() != frames)
        throw pbs::InputError(argument, 0, "references", std::to_string(paths.size()),
                              fmt::format("expected one, or one for each of the {} frames", frames));
    for (std::size_t i = 0; i < paths.size(); ++i) references.emplace_back(names[i], rest, rest.read_shape(paths[i]));
    if (std::ranges::all_of(references, &FileReference::is_at_rest))
        throw pbs::InputError(paths.front(), 0, "displacement", "",
                              "missing: its points are those of the rest mesh, so that it states no deformed shape; "
                              "expected deformed points, "
                              "or the field `displacement` in plain text as `pbskin references export` writes it");
    return references;
}

}  // namespace experiments
