#include <sixdof/base/shell_text.h>

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

/// What a shell makes of a word.
std::string from_shell(const std::string& word) {
  std::string command = "printf %s ";
  command += word;
  FILE* const pipe = ::popen(command.c_str(), "r");
  std::string text;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  ::pclose(pipe);
  return text;
}

TEST(ShellText, PlainWordsStayAsTheyAre) {
  for (const char* word : {"exact", "a/b-1_2.h5", "spheres=300", "50%", "x@y:1,2+3"})
    EXPECT_EQ(shell_quoted(word), word);
}

TEST(ShellText, AShellReadsEveryWordBack) {
  for (const char* word :
       {"", "two words", "it's", "'", "''", "$HOME", "`id`", "a;b", "a\nb", "*", "~", "\\", "\"", "ä"}) {
    EXPECT_NE(shell_quoted(word), word);
    EXPECT_EQ(from_shell(shell_quoted(word)), word);
  }
}

}  // namespace
}  // namespace sixdof
