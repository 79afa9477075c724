#include "experiments/command_line/embedded_pages.hpp"

#include "generated/pages_texts.hpp"

namespace experiments {

const std::string& page_of(const std::string& name)
{
    return *pages::by_name.at(name);
}

}  // namespace experiments
