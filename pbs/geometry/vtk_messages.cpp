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
    void DisplayWarningText(const char*) override {}
    void DisplayGenericWarningText(const char*) override {}
    void DisplayDebugText(const char*) override {}
};
vtkStandardNewMacro(CollectingWindow);

// "ERROR: In x.cxx, line 12\nvtkReader (0x55): words\n\n" -> "words"
std::string words_of(const std::string& message)
{
    std::size_t begin = message.find("): ");
    begin = begin == std::string::npos ? 0 : begin + 3;
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
