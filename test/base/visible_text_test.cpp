#include <sixdof/base/visible_text.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace sixdof {
namespace {

TEST(VisibleText, ShowsEveryByteThatDoesNotPrint) {
  EXPECT_EQ(visible_text("v 0.5 -1e3"), "v 0.5 -1e3");
  EXPECT_EQ(visible_text("\xEF\xBB\xBFOFF"), "\\xEF\\xBB\\xBFOFF");
  EXPECT_EQ(visible_text(std::string_view("1\0", 2)), "1\\x00");
  EXPECT_EQ(visible_text("1\xC2\xA0"
                         "2\t\x7F"),
            "1\\xC2\\xA02\\x09\\x7F");
  EXPECT_EQ(visible_text("\x1B[31m\r\n"), "\\x1B[31m\\x0D\\x0A");
  EXPECT_EQ(visible_text(""), "");
}

TEST(VisibleText, KeepsWhatPrintsInAnyLanguage) {
  for (const char* const text : {"Schlüssel für Tür", "кубик", "立方体", "مكعب", "µm ≤ 1e-3", "\xF0\x9F\xA6\x84"}) {
    EXPECT_EQ(visible_text(text), text);
    EXPECT_EQ(visible_json(text), text);
  }
}

TEST(VisibleText, ShowsWhatNobodySees) {
  EXPECT_EQ(visible_text("\xC2\x9B"), "\\xC2\\x9B") << "C1: begins an escape sequence, too";
  EXPECT_EQ(visible_text("\xE2\x80\xAE"), "\\xE2\\x80\\xAE") << "U+202E turns the direction";
  EXPECT_EQ(visible_text("\xE2\x80\xA8"), "\\xE2\\x80\\xA8") << "U+2028 breaks the line";
  EXPECT_EQ(visible_text("\xE2\x81\xA7"), "\\xE2\\x81\\xA7") << "U+2067 isolates";
  EXPECT_EQ(visible_text("\xF3\xA0\x80\xA0"), "\\xF3\\xA0\\x80\\xA0") << "U+E0020 is a tag";
}

TEST(VisibleText, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(visible_text("a\xFFz"), "a\\xFFz");
  EXPECT_EQ(visible_text("\xC3"), "\\xC3") << "the second byte is missing";
  EXPECT_EQ(visible_text("\xC3("), "\\xC3(");
  EXPECT_EQ(visible_text("\xC0\xAF"), "\\xC0\\xAF") << "longer than it has to be";
  EXPECT_EQ(visible_text("\xE0\x80\xAF"), "\\xE0\\x80\\xAF");
  EXPECT_EQ(visible_text("\xED\xA0\x80"), "\\xED\\xA0\\x80") << "half of a surrogate pair";
  EXPECT_EQ(visible_text("\xF4\x90\x80\x80"), "\\xF4\\x90\\x80\\x80") << "beyond the last code point";
}

TEST(VisibleText, CutsLongText) {
  EXPECT_EQ(visible_text(std::string(40, 'x')), std::string(40, 'x'));
  EXPECT_EQ(visible_text(std::string(41, 'x')), std::string(40, 'x') + "...");
  EXPECT_EQ(visible_text("abcdef", 3), "abc...");
  EXPECT_EQ(visible_text("aüdef", 2), "a...") << "not in the middle of a character";
}

TEST(VisibleWords, AreTheBeginningOfLongOnes) {
  const std::string end = "...";
  EXPECT_EQ(visible_words(std::string(k_longest_words, 'w')), std::string(k_longest_words, 'w'));
  EXPECT_EQ(visible_words("why: " + std::string(100'000, 'w')),
            "why: " + std::string(k_longest_words - 5 - end.size(), 'w') + end);
  for (const std::string& text :
       {std::string(k_longest_words, '\x1B'), std::string("a").append(600, 'b'), std::string("a\nb"),
        std::string(k_longest_words / 2, '\xC3') + std::string(600, '\xBC')}) {
    const std::string words = visible_words(text);
    EXPECT_LE(words.size(), k_longest_words);
    EXPECT_EQ(visible_words(words), words);
  }
}

TEST(VisibleJson, HasVisibleStringsAndKeys) {
  const auto read = [](const std::string& json) { return nlohmann::json::parse(visible_json(json)).dump(); };
  EXPECT_EQ(read(R"({"a\u001bb": "line\nbreak\t\u009b"})"), R"({"a\\x1Bb":"line\\x0Abreak\\x09\\xC2\\x9B"})");
  EXPECT_EQ(read("[\n \"\xFF\xE2\x80\xA8\"\r\n]"), R"(["\\xFF\\xE2\\x80\\xA8"])");
  EXPECT_EQ(read(R"(["\ud800", "\udc80x", "\ud800\u0041", "\uD83E\uDD84", "\udb40\udc20"])"),
            "[\"\\\\uD800\",\"\\\\uDC80x\",\"\\\\uD800A\",\"\xF0\x9F\xA6\x84\",\"\\\\xF3\\\\xA0\\\\x80\\\\xA0\"]");
  EXPECT_EQ(read(R"(["\\u001b", "\"\\", "\u00fc", 1e3, null])"), R"(["\\u001b","\"\\","ü",1000.0,null])");
  EXPECT_EQ(read("[\"\x1B\n\", \"\\\"\t\"]"), R"(["\\x1B\\x0A","\"\\x09"])") << "no JSON before";
  for (const char* const no_json : {"\\", "[\"\\", "[\"\\u00", "[\"\\uZZZZ\"]", "[\x1B]", "[\xFF]"}) {
    EXPECT_FALSE(nlohmann::json::accept(visible_json(no_json))) << no_json;
  }
}

}  // namespace
}  // namespace sixdof
