// References of frames: any deformed frame, or one that `pbskin references export` has written, whose fields state
// where errors are measured.
//   for (const FileReference& reference : file_references("ref_%04d.vtu", frames, rest))
//       reference.error_of(positions, skin);
#pragma once

#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/skin_error.hpp"
#include "experiments/command_line/measure/rest_mesh.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// A frame against a reference.
struct ReferenceError {
    std::string reference;  // the name of its file
    double l2_pct = 0.0;
    std::optional<double> joint_pct = {};  // the reference's file does not state the vertices that Eq. 2 blends
    double linf_m = 0.0, skin_rms_mm = 0.0;
    // U, the reference's own error in the norm of joint_pct; nothing: not known
    std::optional<double> own_error_pct = {};
    std::optional<bool> above_own_error = {};  // otherwise the reference's own error may be the whole difference
};

class FileReference {
public:
    FileReference(const std::string& name, const RestMesh& rest, FileShape shape);  // rest outlives it

    ReferenceError error_of(const pbs::Positions& positions, const analysis::SkinErrorMetrics& skin) const;
    bool is_at_rest() const { return shape_.is_at_rest; }

private:
    std::vector<bool> flags(const std::string& field) const;
    analysis::ErrorDomain domain() const;

    std::string name_;
    const pbs::TetMesh& rest_;
    FileShape shape_;
    std::vector<bool> at_tips_;  // of creases, where nothing is measured, #V
    bool has_joints_ = false;
    analysis::ErrorMetrics norms_;
};

// One for all frames, or one for each. InputError for another number of them, and if all are the rest mesh itself.
std::vector<FileReference> file_references(const std::string& argument, std::size_t frames, const RestMesh& rest);

}  // namespace experiments
