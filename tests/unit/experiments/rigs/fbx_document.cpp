// Reference: the records that the file was made of. Text, binary with 32 and with 64 bits, and packed arrays hold the
// same.

#include "experiments/rigs/fbx_document.hpp"
#include "tests/support/fbx_file.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace {

using namespace pbs;
using test_support::FbxFile;

FbxFile file_with_each_kind_of_value()
{
    FbxFile file;
    const auto node = file.node("upper arm", 0, "LimbNode", {{"Lcl Translation", {1.5, -2e-3, 3}}});
    file.mesh("skin: \303\244", node, {0, 0, 0, 1, 0, 0, 0, 1, 1e-30}, {0, 1, -3});
    file.objects.push_back(test_support::fbx_record("Empty", {std::int64_t(9), std::string(), std::vector<double>()}));
    return file;
}

void expect_same(const FbxRecord& a, const FbxRecord& b)
{
    EXPECT_EQ(a.name, b.name);
    ASSERT_EQ(a.values.size(), b.values.size()) << a.name;
    for (std::size_t v = 0; v < a.values.size(); ++v) {
        // text and binary write it in two ways
        const bool has_type = a.text(v) && a.text(v)->find("::") != std::string::npos;
        if (const auto number = a.number(v)) {
            EXPECT_EQ(number, b.number(v)) << a.name;  // 3.0 is written as 3
        } else if (!has_type) {
            EXPECT_EQ(a.values[v], b.values[v]) << a.name;
        }
    }
    ASSERT_EQ(a.records.size(), b.records.size()) << a.name;
    for (std::size_t r = 0; r < a.records.size(); ++r) expect_same(a.records[r], b.records[r]);
}

TEST(FbxDocument, IsTheSameInTextAndBinary)
{
    FbxFile file = file_with_each_kind_of_value();
    for (const std::int64_t version : {7100, 7400, 7500, 7700}) {
        file.version = version;
        const FbxRecord expected{"", {}, file.records()};
        expect_same(expected, read_fbx_document(file.text(), "a.fbx"));
        for (const bool is_packed : {false, true})
            expect_same(expected, read_fbx_document(file.binary(is_packed), "a.fbx"));
    }
}

TEST(FbxDocument, OfTextMayBeWrittenInManyWays)
{
    const std::string head = "FBXHeaderExtension: { FBXVersion: 7400 }\n";
    const auto numbers = [&](const std::string& text) {
        return read_fbx_document(head + text, "a.fbx").numbers("Numbers");
    };
    const std::vector<double> expected = {1, -2.5, 3e-5};
    for (const char* text :
         {"Numbers: *3 {\n\ta: 1,-2.5,3e-5\n}", "Numbers:1,-2.5,3E-05", "  Numbers:\t1,\r\n\t-2.5 ,+3e-5\r\n",
          "; remark {\nNumbers: *3 {\n\ta: 1,-2.5,\n\t3e-5\n} ; remark\n", "Numbers: *3 { a: 1 , -2.5 , 3e-5 }"})
        EXPECT_EQ(numbers(text), expected) << text;
    EXPECT_EQ(numbers("Numbers: 1e-400"), std::vector<double>{0.0});
    EXPECT_EQ(*read_fbx_document(head + "Word: Y, \"&quot;a&quot; { : ,\"\n", "a.fbx").record("Word")->text(1),
              "\"a\" { : ,");
}

void expect_refused(const std::string& bytes, const std::string& begins, const std::string& holds)
{
    expect_input_error([&] { read_fbx_document(bytes, "a.fbx"); }, begins, holds);
}

TEST(FbxDocument, OfAnOldVersionIsRefusedWithItsRemedy)
{
    for (const std::int64_t version : {5800, 6100}) {
        FbxFile file = file_with_each_kind_of_value();
        file.version = version;
        for (const std::string& bytes : {file.text(), file.binary(true)})
            expect_refused(bytes, "a.fbx: FBXVersion = " + std::to_string(version) + ": expected 7000 or more",
                           "export glTF 2.0");
    }
    expect_refused("Objects: {\n}\n", "a.fbx: FBXVersion: ", "missing");
}

TEST(FbxDocument, NamesTheLineThatIsDamaged)
{
    const std::string head = "FBXHeaderExtension: {\nFBXVersion: 7400\n}\n";
    for (const auto& [text, line, rule] :
         {std::tuple("Objects: {\nA: 1\n", 6, "the file ends within record Objects"),
          std::tuple("A: *2 {\na: 1,2,3\n}", 6, "states 2 numbers and has 3"),
          std::tuple("A: *2 {\na: 1,x\n}", 5, "expected a number"),
          std::tuple("A: *1 {\na: 1.#QNAN\n}", 5, "expected a number"), std::tuple("A: \"b\n", 4, "without an end"),
          std::tuple("A b\n", 4, "a colon"), std::tuple("}\n", 4, "a colon"),
          std::tuple("A: *1\nB: 2\n", 5, "expected {")})
        expect_refused(head + text, "a.fbx:" + std::to_string(line) + ":", rule);
    std::string nested = head;
    for (int depth = 0; depth < 100; ++depth) nested += "A: {";
    expect_refused(nested, "a.fbx:4:", "nested deeper than");
}

// A file that was cut off anywhere is refused, or it is whole without what was cut.
TEST(FbxDocument, ThatWasCutOffIsRefused)
{
    const FbxFile file = file_with_each_kind_of_value();
    const std::string whole = file.binary(true);
    int refused = 0;
    for (std::size_t length = 0; length + 13 < whole.size(); ++length) {
        try {
            read_fbx_document(whole.substr(0, length), "a.fbx");
        } catch (const InputError& error) {
            ++refused;
        }
    }
    EXPECT_GE(refused, static_cast<int>(whole.size()) - 13 - 5)
        << "all lengths except ends of the five records of the file";
}

}  // namespace
