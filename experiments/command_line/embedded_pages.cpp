#include "experiments/command_line/embedded_pages.hpp"

#include "generated/pages_texts.hpp"

#include <algorithm>
#include <regex>

namespace experiments {

const std::string& page_of(const std::string& name)
{
    return *pages::by_name.at(name);
}

std::string first_paragraph(const std::string& markdown)
{
    const std::size_t begin = markdown.find("\n\n") + 2;
    std::string paragraph = markdown.substr(begin, markdown.find("\n\n", begin) - begin);
    std::replace(paragraph.begin(), paragraph.end(), '\n', ' ');
    return paragraph;
}

std::string plain_text(const std::string& markdown)
{
    static const std::regex comment_line("<!--[^\n]*-->\n"), link(R"(\[([^\]]+)\]\([^)]+\))");
    return std::regex_replace(std::regex_replace(markdown, comment_line, ""), link, "$1");
}

}  // namespace experiments
