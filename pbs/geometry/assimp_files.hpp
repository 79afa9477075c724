// assimp opens only files that own_folder.hpp allows: the file itself and regular files below its folder.
//   Assimp::Importer importer;
//   const OwnFolder& files = only_own_folder(importer, path);
//   if (!importer.ReadFile(path, 0)) files.refuse_what_was_referred_to();
#pragma once

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/own_folder.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>

#include <filesystem>
#include <string>
#include <system_error>

namespace pbs {

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
    bool allows(const std::string& file) const { return may_be_opened_for(path_, file); }

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
