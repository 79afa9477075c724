// Reference: Unicode's definition of UTF-8 (RFC 3629).
#include "analysis/records/record_text.hpp"

#include <gtest/gtest.h>

namespace {

using analysis::is_utf8;
using analysis::record_text;

TEST(RecordText, KnowsUtf8)
{
    for (const char* text : {"", "limb", "Gelenk \xc3\xa4", "\xe2\x82\xac", "\xf0\x9d\x84\x9e"})
        EXPECT_TRUE(analysis::is_utf8(text)) << text;
    for (const char* text : {"\xff", "limb\xfe", "\xc3", "\xc0\xaf", "\xed\xa0\x80", "\xf5\x80\x80\x80"})
        EXPECT_FALSE(analysis::is_utf8(text)) << text;
}

TEST(RecordText, ANameThatIsNotUtf8LosesNothingElse)
{
    const auto record = nlohmann::json::parse(analysis::record_text({{"name", "li\xffmb"}, {"frames", 3}}));
    EXPECT_EQ(record.at("name"), "li\xef\xbf\xbdmb");
    EXPECT_EQ(record.at("frames"), 3);
}

}  // namespace
