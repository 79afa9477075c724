// The files that assimp may open to read one file: that file, and those below its folder that it refers to (a glTF's buffers, an OBJ's
// materials). Another is not there for it: a pipe would be waited for, and no file names what lies elsewhere on somebody else's machine.
//   Assimp::Importer importer;
//   const OwnFolder& files = only_own_folder(importer, path);
//   if (!importer.ReadFile(path, 0)) files.refuse_what_was_referred_to();
#pragma once

#include "pbs/geometry/input_error.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>

namespace pbs {

// Links are followed before the folder of a file is checked.
class OwnFolder : public Assimp::DefaultIOSystem {
public:
    // path: the file that is read; it may lie anywhere.
    explicit OwnFolder(const std::string& path) : path_(path) {}

    // False, too, for what may not be opened.
    bool Exists(const char* file) const override { return allows(file) && DefaultIOSystem::Exists(file); }

    // Null for what may not be opened; the first such file that is there is remembered.
    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        if (allows(file)) return DefaultIOSystem::Open(file, mode);
        std::error_code ignored;
        if (refused_.empty() && std::filesystem::exists(file, ignored)) refused_ = file;
        return nullptr;
    }

    // InputError where assimp requested a file that exists and was not given to it.
    void refuse_what_was_referred_to() const
    {
        if (!refused_.empty())
            throw InputError(path_, 0, "referred file", refused_, "expected a regular file below the folder of the one that refers to it");
    }

private:
    bool allows(const std::string& file) const
    {
        namespace fs = std::filesystem;
        std::error_code code;
        const fs::path target = fs::canonical(file, code);  // links followed
        if (code || !fs::is_regular_file(target, code)) return false;
        const fs::path own = fs::canonical(path_, code), named = fs::weakly_canonical(fs::absolute(path_).parent_path(), code);
        return target == own || lies_below(target, own.parent_path()) || lies_below(target, named);
    }

    static bool lies_below(const std::filesystem::path& file, const std::filesystem::path& folder)
    {
        return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
    }

    std::string path_, refused_;
};

// The importer owns it.
inline const OwnFolder& only_own_folder(Assimp::Importer& importer, const std::string& path)
{
    auto* files = new OwnFolder(path);
    importer.SetIOHandler(files);
    return *files;
}

}  // namespace pbs
