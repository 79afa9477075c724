// The kept references in plain files, for solvers that share nothing with this program. exported_references.md is the
// manual of the files and is written along with them.
//   ReferenceExport files("kit");
//   for (const ReferencePose& pose : poses_to_export({"limb_twist_60"}).poses) files.add(pose);
//   files.write_manual();
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/studies/reference_poses.hpp"
#include "experiments/studies/shared/kept_references.hpp"

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace experiments {

struct PosesToExport {
    std::vector<ReferencePose> poses = {};
    std::vector<std::string> left_out = {};  // "3 poses are left out: " and the reason
};

// The poses of these names. Without names: all poses whose body is installed and whose references are kept.
// pbs::InputError for a name that is no pose, and for one whose body is not installed.
PosesToExport poses_to_export(const std::vector<std::string>& names);

// The folder that the files are written to. It is made with the first pose that can be exported. A file of the folder
// that was changed since, by its user or by another version of the program, is kept.
class ReferenceExport {
public:
    explicit ReferenceExport(std::string folder) : folder_(std::move(folder)) {}

    // pbs::InputError if no reference of the pose is kept, or if it belongs to other tets.
    void add(const ReferencePose& pose);
    // Call it last, so that a folder with a manual is whole. The manual also lists the poses that an earlier export has
    // written there.
    void write_manual();

    int poses() const { return poses_; }
    std::size_t bodies() const { return written_bodies_.size(); }
    // Files that differ from what this program writes and were kept.
    const std::vector<std::string>& not_replaced() const { return not_replaced_; }

private:
    void write(const std::string& path, const std::string& text);
    void write_body(const std::string& name, const pbs::Character& character);
    void write_springs(const std::string& body, const pbs::Character& character, const FemOptions& flesh,
                       const EnsembleMember& member);
    std::string table_of_poses();
    std::string table_of_bodies() const;
    const pbs::Character& body_of(const ReferencePose& pose);
    std::string body_file(const std::string& name) const;

    std::string folder_;
    std::vector<std::string> not_replaced_;
    std::map<std::string, pbs::Character> bodies_;
    std::set<std::string> written_bodies_, written_springs_;
    int poses_ = 0;
};

}  // namespace experiments
