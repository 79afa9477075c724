#include "pbs/geometry/vtk_messages.hpp"

#include "pbs/geometry/input_error.hpp"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace pbs {
namespace {

thread_local std::string collected;

class CollectingWindow : public vtkOutputWindow {
public:
    static CollectingWindow* New();
    vtkTypeMacro(CollectingWindow, vtkOutputWindow) void DisplayText(const char* text) override { collected += text; }
    void DisplayErrorText(const char* text) override { collected += text; }
    void DisplayWarningText(const char* text) override { collect_lost_data(text); }
    void DisplayGenericWarningText(const char* text) override { collect_lost_data(text); }
    void DisplayDebugText(const char*) override {}

private:
    // VTK only warns of numbers that are missing, and leaves the memory for them as it is.
    void collect_lost_data(const std::string& text)
    {
        if (text.find("Error reading") != std::string::npos) collected += text;
    }
};
vtkStandardNewMacro(CollectingWindow);

// "ERROR: In x.cxx, line 12\nvtkReader (0x55): words\n\n" and "Generic Warning: In x.cxx, line 12\nwords\n\n" -> "words"
std::string words_of(const std::string& message)
{
    std::size_t begin = message.find("): ");
    const std::size_t first_line = message.find('\n');
    begin = begin != std::string::npos                                           ? begin + 3
            : first_line != std::string::npos && first_line + 1 < message.size() ? first_line + 1
                                                                                 : 0;
    const std::size_t end = message.find("\n\n", begin);
    std::string words = message.substr(begin, end == std::string::npos ? end : end - begin);
    for (char& c : words)
        if (c == '\n') c = ' ';
    if (words.starts_with("Algorithm ")) return "the file is damaged";  // what follows are addresses in memory
    return words;
}

}  // namespace

VtkMessages::VtkMessages()
{
    static const bool installed = [] {
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
        vtkOutputWindow::SetInstance(vtkSmartPointer<CollectingWindow>::New());
        return true;
    }();
    static_cast<void>(installed);
    collected.clear();
}

void VtkMessages::throw_if_any(const std::string& path) const
{
    if (!collected.empty()) throw InputError(path, 0, "", "", "VTK: " + words_of(collected));
}

}  // namespace pbs
