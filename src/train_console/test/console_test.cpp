#include "train_console/console.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>

namespace train_console {
namespace {

/// How a process ends that does something: its exit code, or minus the signal that ended it.
int Ends(const std::function<int()>& action) {
  const pid_t child = fork();
  if (child == 0) _exit(action());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

void Redirect(int descriptor, const char* file) {
  const int opened = open(file, O_WRONLY);
  dup2(opened, descriptor);
  close(opened);
}

/// Makes the descriptor the end of a pipe without a reader.
void Break(int descriptor) {
  int ends[2];
  if (pipe(ends) != 0) _exit(100);
  close(ends[0]);
  dup2(ends[1], descriptor);
}

TEST(ConsoleTest, AShellTakesAWordAsItIs) {
  for (const std::string word :
       {"results/stop", "two words", "", "it's", "'", "$HOME `id` \\ \"x\" *", "~", "a\nb", "-x;y"}) {
    FILE* shell = popen(("printf %s " + ShellWord(word)).c_str(), "r");
    ASSERT_NE(nullptr, shell);
    std::string told;
    for (int character = 0; (character = fgetc(shell)) != EOF;) told += static_cast<char>(character);
    EXPECT_EQ(0, pclose(shell)) << word;
    EXPECT_EQ(word, told);
  }
  EXPECT_EQ("results/stop-1_a.yaml", ShellWord("results/stop-1_a.yaml"));  // as a person would write it
}

TEST(ConsoleTest, MessageToAFullDeviceIsLost) {
  EXPECT_EQ(0, Ends([] {
              Redirect(STDERR_FILENO, "/dev/full");
              Tell("{} of {}\n", 1, 2);
              Tell("again\n");
              return 0;
            }));
}

TEST(ConsoleTest, MessageToABrokenPipeIsLost) {
  EXPECT_EQ(0, Ends([] {
              PrepareProcess();
              Break(STDERR_FILENO);
              Tell("this has no reader\n");
              return 0;
            }));
}

TEST(ConsoleTest, WithoutPreparationABrokenPipeEndsTheProcess) {
  EXPECT_EQ(-SIGPIPE, Ends([] {
    Break(STDERR_FILENO);
    Tell("this has no reader\n");
    return 0;
  }));
}

TEST(ConsoleTest, FilesDoNotGetTheNumbersOfClosedStreams) {
  EXPECT_EQ(3, Ends([] {
              for (int i = 0; i < 10; ++i) close(i);
              PrepareProcess();
              return open("/dev/zero", O_RDONLY);
            }));
}

TEST(ConsoleTest, OpenStreamsStayWhatTheyAre) {
  EXPECT_EQ(0, Ends([] {
              Redirect(STDOUT_FILENO, "/dev/full");
              close(STDIN_FILENO);
              PrepareProcess();
              return write(STDOUT_FILENO, "x", 1) == -1 && errno == ENOSPC ? 0 : 1;
            }));
}

TEST(ConsoleTest, PresentableTextCommandsNoTerminal) {
  for (int c = 0; c < 0x20; ++c) {
    const std::string text = std::string("a") + static_cast<char>(c) + "b";
    EXPECT_EQ(Presentable(text), c == '\n' || c == '\t' ? text : "a?b") << c;
  }
  EXPECT_EQ(Presentable("\x1b[2J\x7f"), "?[2J?");
  EXPECT_EQ(Presentable("\xc2\x9b"
                        "31m"),
            "?31m");  // U+009B does what ESC [ does
  EXPECT_EQ(Presentable("\x9b"
                        "31m"),
            "?31m");  // so does its byte alone, in terminals without UTF-8
  EXPECT_EQ(Presentable("gpj.\u202exe"), "gpj.?xe");
  EXPECT_EQ(Presentable("\xe2\x81\xa6x\xe2\x81\xa9"), "?x?");
}

TEST(ConsoleTest, PresentableTextOfAllLanguagesStays) {
  for (const std::string text : {"Züge", "車両 1", "Поезд", "🚂", "\u00a0", "\u202f", "$x_1$ #%", ""})
    EXPECT_EQ(Presentable(text), text);
}

TEST(ConsoleTest, BytesThatAreNoCharacterAreReplaced) {
  EXPECT_EQ(Presentable("Z\xfcge"), "Z?ge");           // Latin-1
  EXPECT_EQ(Presentable("\xc0\xaf"), "??");            // '/' in two bytes
  EXPECT_EQ(Presentable("\xe2\x82"), "??");            // cut short
  EXPECT_EQ(Presentable("\xed\xa0\x80"), "???");       // half of a pair of UTF-16
  EXPECT_EQ(Presentable("\xf5\x80\x80\x80"), "????");  // beyond Unicode
  EXPECT_EQ(Presentable(std::string("a\0b", 3)), "a?b");
}

TEST(ConsoleTest, LimitOfFileSizeIsAnErrorOfTheWrite) {
  EXPECT_EQ(0, Ends([] {
              PrepareProcess();
              const rlimit limit = {10, 10};
              setrlimit(RLIMIT_FSIZE, &limit);
              const std::string name = testing::TempDir() + "console_test_limit";
              const int file = open(name.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
              const bool first = write(file, "0123456789", 10) == 10;
              const bool second = write(file, "0", 1) == -1 && errno == EFBIG;
              unlink(name.c_str());
              return first && second ? 0 : 1;
            }));
}

TEST(ConsoleTest, OutputThatCouldNotBeWrittenIsTold) {
  EXPECT_EQ(0, Ends([] {
              Redirect(STDOUT_FILENO, "/dev/full");
              Print("{}\n", 1);
              return FinishOutput() == "No space left on device" ? 0 : 1;
            }));
}

TEST(ConsoleTest, OutputThatWasFlushedBeforeIsTold) {
  EXPECT_EQ(0, Ends([] {
              Redirect(STDOUT_FILENO, "/dev/full");
              std::fputs("by another part of the program\n", stdout);
              std::fflush(stdout);
              Print("more\n");
              return FinishOutput().empty() ? 1 : 0;
            }));
}

TEST(ConsoleTest, WrittenOutputIsNoError) {
  EXPECT_EQ(0, Ends([] {
              Redirect(STDOUT_FILENO, "/dev/null");
              Print("{}\n", 1);
              return FinishOutput().empty() ? 0 : 1;
            }));
}

}  // namespace
}  // namespace train_console
