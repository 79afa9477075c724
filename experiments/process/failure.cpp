#include "experiments/process/failure.hpp"

#include "experiments/process/interruption.hpp"
#include "pbs/geometry/input_error.hpp"

#include <exception>
#include <filesystem>
#include <new>
#include <sstream>

namespace experiments {
namespace {

// Messages of libraries may have several paragraphs.
std::string on_one_line(const std::string& text)
{
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
    return line;
}

}  // namespace

std::string Failure::message() const
{
    return status == exit_internal ? "internal error: " + on_one_line(words) + "; please report it with the command line" : words;
}

Failure caught_failure()
{
    try {
        throw;
    } catch (const pbs::InputError& error) {
        return {error.what(), exit_input};
    } catch (const Interrupted&) {
        return {"interrupted; what was finished is kept", exit_interrupted};
    } catch (const std::filesystem::filesystem_error& error) {
        return {pbs::InputError(error.path1().string(), 0, "", "", error.code().message()).what(), exit_input};
    } catch (const std::bad_alloc&) {
        return {"not enough memory for this task", exit_input};
    } catch (const std::exception& error) {
        return {error.what(), exit_internal};
    } catch (...) {
        return {"an exception without a message", exit_internal};
    }
}

}  // namespace experiments
