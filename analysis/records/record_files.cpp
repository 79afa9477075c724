#include "analysis/records/record_files.hpp"

#include "pbs/system/child_process.hpp"
#include "pbs/system/files.hpp"

#include <unistd.h>

#include <regex>

namespace analysis {

std::string record_text(const nlohmann::json& record)
{
    return record.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

bool is_utf8(const std::string& text)
{
    try {
        return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::type_error&) {
        return false;
    }
}

namespace {

namespace fs = std::filesystem;

// The names that pbs::write_atomically uses: .NAME.PROCESS.RANDOM.
const std::regex temporary_name(R"(\..+\.([0-9]{1,9})\.[A-Za-z0-9]{6})");

bool is_abandoned(const fs::path& file)
{
    std::smatch match;
    const std::string name = file.filename().string();
    return std::regex_match(name, match, temporary_name) && pbs::process_is_gone(std::stoi(match[1]));
}

void require(const std::error_code& error, const fs::path& path, const char* what)
{
    if (error) throw pbs::InputError(path.string(), 0, "", "", what + error.message());
}

}  // namespace

void write_text_atomically(const std::string& path, const std::string& text)
{
    pbs::write_atomically(path, text);
}

void require_writable(const std::string& path)
{
    pbs::require_no_device(path);
    const fs::path parent = fs::path(path).parent_path(), folder = parent.empty() ? "." : parent;
    std::error_code error;
    int reason = fs::is_directory(path, error) ? EISDIR : 0;
    if (reason == 0 && fs::exists(folder, error) && !fs::is_directory(folder, error)) reason = ENOTDIR;
    if (reason == 0 && ::access(folder.c_str(), W_OK | X_OK) != 0) reason = errno;
    if (reason != 0)
        throw pbs::InputError(path, 0, "", "", "cannot be written: " + std::generic_category().message(reason));
}

namespace {

bool is_same_file(const std::string& one, const std::string& other)
{
    std::error_code error;
    if (fs::equivalent(one, other, error)) return true;
    const fs::path first = fs::weakly_canonical(fs::absolute(one), error);
    return !error && first == fs::weakly_canonical(fs::absolute(other), error) && !error;
}

}  // namespace

void require_separate(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs)
{
    for (auto output = outputs.begin(); output != outputs.end(); ++output) {
        if (output->path.empty()) continue;
        for (const std::string& input : inputs)
            if (!input.empty() && is_same_file(output->path, input))
                throw pbs::InputError("", 0, output->option, output->path,
                                      "expected another file than the input " + input);
        for (auto earlier = outputs.begin(); earlier != output; ++earlier)
            if (!earlier->path.empty() && is_same_file(output->path, earlier->path))
                throw pbs::InputError("", 0, output->option, output->path,
                                      "expected another file than that of " + earlier->option);
    }
}

void remove_abandoned_files(const std::string& folder, bool and_below)
{
    std::error_code ignored;
    std::vector<fs::path> abandoned;
    for (fs::recursive_directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
        if (!and_below) entry.disable_recursion_pending();
        if (entry->is_regular_file(ignored) && is_abandoned(entry->path())) abandoned.push_back(entry->path());
    }
    for (const fs::path& file : abandoned) fs::remove(file, ignored);
}

std::string read_text(const std::string& path)
{
    return pbs::read_text_file(path);
}

void remove_record(const fs::path& file)
{
    std::error_code error;
    fs::remove(file, error);
    require(error, file, "an earlier run's record cannot be removed: ");
}

bool make_output_folder(const fs::path& folder)
{
    std::error_code error;
    const bool is_new = fs::create_directories(folder, error);
    require(error, folder, "the output folder cannot be made: ");
    return is_new;
}

std::string path_in(const std::string& folder, const std::string& name)
{
    return (fs::path(folder) / name).string();
}

std::vector<fs::path> files_in(const fs::path& folder)
{
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        files.push_back(entry->path());
    require(error, folder, "the folder cannot be read: ");
    return files;
}

nlohmann::json read_record(const std::string& path)
{
    nlohmann::json record = nlohmann::json::parse(analysis::read_text(path), nullptr, false);
    if (record.is_discarded()) refuse_record(path);
    return record;
}

void refuse_record(const std::string& path)
{
    throw pbs::InputError(path, 0, "", "", "expected a record as this program writes it: it was changed, or cut short");
}

}  // namespace analysis
